"""Hertz pressure of a strip of contact from the load it carries per length and its relative curvature.

Source: Johnson 1985, chapter 4, for a semi-elliptic pressure over a half-width b across the
contact line and a half-length a along it. Both the line contact (a far above b) and the sphere (a = b) are
met exactly.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ellipe, ellipkm1

from facegear.arrays import Array
from facegear.teeth.design import Material

DENTED = 4.0e9
"""Pressure (Pa) above which a dent remains on hardened steel: the static limit of line contact in ISO 76.
"""

SLENDEREST, ROUNDEST = 1e-6, 1.0 - 1e-6
"""Ratios of semi-axes between which the ratio of an ellipse is searched."""

HALVINGS = 60
"""Number of bisections; 60 halve any interval to the rounding of a double."""

STEPS = 8
"""Number of steps of the fixed-point iteration of pressure and half-width, each of which gains more than a
digit."""


def contact_modulus(materials: tuple[Material, Material]) -> float:
    """Compute the contact modulus E* from 1/E* = sum of (1 - nu^2)/E.

    Parameters
    ----------
    materials : tuple[Material, Material]
        Both bodies.

    Returns
    -------
    float
        E*, Pa.
    """
    return 1.0 / sum((1 - m.poisson_ratio**2) / m.young_modulus for m in materials)


@dataclass(frozen=True)
class ContactEllipse:
    """Elliptic contact of two bodies under a force.

    long, short: semi-axes (m) in the directions of the smaller and the larger relative curvature.
    pressure: largest, at the centre (Pa). approach: of points of the bodies far from the contact (m).
    """

    long: float
    short: float
    pressure: float
    approach: float


def contact_ellipse(force: float, across: float, along: float, modulus: float) -> ContactEllipse:
    """Compute the contact ellipse of two bodies, by bisection for the ratio of its semi-axes.

    Exact for any curvatures; bodies with equal curvatures give a circle. Source: Johnson 1985, chapter 4.

    Parameters
    ----------
    force : float
        Normal force, N.
    across : float
        Larger relative curvature, 1/m.
    along : float
        Smaller relative curvature, 1/m.
    modulus : float
        Contact modulus E*, Pa.

    Returns
    -------
    ContactEllipse
        Semi-axes, pressure and approach, m and Pa; all 0 without force.
    """

    def parts(ratio: float) -> tuple[float, float]:
        """Return K - E and E / ratio^2 - K for the ratio of short to long semi-axis.

        K and E are complete elliptic integrals with m = 1 - ratio^2; the ratio of both results is along /
        across.
        """
        square = ratio**2
        first, second = float(ellipkm1(square)), float(ellipe(1.0 - square))
        return first - second, second / square - first

    low, high = np.log(SLENDEREST), np.log(ROUNDEST)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        along_part, across_part = parts(float(np.exp(middle)))
        low, high = (middle, high) if along_part / across_part < along / across else (low, middle)
    ratio = float(np.exp(0.5 * (low + high)))
    _, across_part = parts(ratio)
    cubed = 3.0 * force * across_part / (pi * across * modulus * (1.0 - ratio**2))
    long = float(cubed ** (1 / 3))
    if long == 0.0:
        return ContactEllipse(0.0, 0.0, 0.0, 0.0)
    pressure = 1.5 * force / (pi * long * long * ratio)
    approach = 1.5 * force * float(ellipkm1(ratio**2)) / (pi * long * modulus)
    return ContactEllipse(long, ratio * long, pressure, approach)


def strip_pressure(
    line_load: ArrayLike, curvature: ArrayLike, modulus: float, half_length: ArrayLike = np.inf
) -> tuple[Array, Array]:
    """Compute the largest pressure and the half-width of a loaded strip.

    A footprint wider than long is taken as round.

    Parameters
    ----------
    line_load : (...) array_like
        Load at the strip's middle, N/m.
    curvature : (...) array_like
        Relative curvature across the strip, 1/m.
    modulus : float
        Contact modulus E*, Pa.
    half_length : (...) array_like
        Half-length of the loaded line, m.

    Returns
    -------
    (...) arrays
        Pressure, Pa, and half-width, m.
    """
    load, across = np.asarray(line_load, float), np.asarray(curvature, float)
    long = np.sqrt(across * modulus * load / pi)
    pressure = long
    for _ in range(STEPS):
        width = _half_width(load, pressure)
        pressure = long / np.sqrt(_shortness(width / np.asarray(half_length, float)))
    return pressure, _half_width(load, pressure)


def _half_width(load: Array, pressure: Array) -> Array:
    """Return the half-width, m, of a semi-elliptic pressure with load per length, N/m, and largest value,
    Pa.

    It is 2 load / (pi pressure), whatever the contact's length.
    """
    return 2 * load / (pi * np.where(pressure == 0, 1.0, pressure))


def _shortness(ratio: Array) -> Array:
    """Return the curvature across an ellipse of ratio b/a over that of a long strip of equal b and pressure.

    The result is 1 for a strip and pi/4 for a circle.
    """
    square = np.clip(ratio, 1e-12, 1.0 - 1e-9) ** 2
    return (ellipe(1 - square) - square * ellipkm1(square)) / (1 - square)
