"""Hertzian contact of balls with the grooves of their rings."""

from dataclasses import dataclass

import numpy as np
import scipy

LARGEST_RATIO = 1e3
"""Largest axis ratio of a contact ellipse that is searched; grooves of 0.501 diameters have 60."""


@dataclass(frozen=True)
class PointContact:
    """Hertzian contact of a ball with a groove.

    Attributes
    ----------
    axis_ratio
        Long over short axis of the ellipse.
    curvature, modulus
        Sum of the curvatures of both bodies, 1/m, and E / (1 - nu^2), Pa.
    """

    axis_ratio: float
    curvature: float
    modulus: float

    @property
    def integrals(self) -> tuple[float, float]:
        """Complete elliptic integrals K and E of the modulus k with k^2 = 1 - 1 / axis_ratio^2."""
        parameter = 1.0 - 1.0 / self.axis_ratio**2
        return float(scipy.special.ellipk(parameter)), float(scipy.special.ellipe(parameter))

    @property
    def stiffness(self) -> float:
        """Load of this one contact over (approach of ball and ring)^1.5, by Hertz, N/m^1.5."""
        first, second = self.integrals
        length = first * (self.curvature / (self.axis_ratio**2 * second)) ** (1.0 / 3.0)
        return float(np.pi / np.sqrt(4.5) * self.modulus * length**-1.5)


def touch_groove(ball: float, groove: float, pitch_ratio: float, modulus: float) -> PointContact:
    """Solve Hertz's equation for the axis ratio of a ball's contact with a groove (ISO/TS 16281).

    Parameters
    ----------
    ball : float
        Diameter of the ball, m.
    groove : float
        Radius of the groove over the diameter of the ball, dimensionless.
    pitch_ratio : float
        gamma / (1 - gamma) at the inner ring, -gamma / (1 + gamma) at the outer one, with gamma as in
        `RollingBearing.pitch_ratio`; dimensionless.
    modulus : float
        E / (1 - nu^2), Pa.

    Returns
    -------
    PointContact
        Its axis ratio, sum of curvatures and modulus.
    """
    conformity = 0.5 / groove
    total = 2.0 + pitch_ratio - conformity
    difference = (pitch_ratio + conformity) / total

    def excess(ratio: float) -> float:
        """Return F(rho) of an ellipse with this axis ratio less the given one, dimensionless."""
        parameter = 1.0 - 1.0 / ratio**2
        integrals = scipy.special.ellipk(parameter) / scipy.special.ellipe(parameter)
        return float(1.0 - 2.0 * (integrals - 1.0) / (ratio**2 - 1.0) - difference)

    ratio = scipy.optimize.brentq(excess, 1.0 + 1e-4, LARGEST_RATIO, xtol=1e-14, rtol=1e-15)
    return PointContact(float(ratio), 2.0 / ball * total, modulus)
