"""Friction coefficients of lubricated rolling and sliding contacts, each with the range it was measured in.

Functions take SI units; the formulas quoted in docstrings are in those of their sources: w N/mm, v m/s, rho
mm, eta mPa s, Ra um. The models differ by a factor of five on one pair, so no number is given without the
name of its model.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from facegear.arrays import Array, Mask

Numbers = float | Array

MIN_LINE_LOAD = 150e3
"""Smallest line load, N/m, of the gear tests behind Schlenk's formula and those of the standards."""

LARGEST_SPEED = 50.0
"""Largest pitch line velocity, m/s, of the same gear tests."""

LINE_LOAD, PITCH_SPEED = "line load at least 150 N/mm", "pitch line velocity at most 50 m/s"
"""Limits of the gear tests in words."""
SLIDING, SLIDE_TO_ROLL = "sliding above 0.1 % of the rolling velocities", "slide to roll ratio at most 1"
"""Limits of the models of Benedict and Kelley and of Xu in words."""
LIMIT_SOURCES = {
    ("schlenk", LINE_LOAD): "ISO/TR 14179-2, unverified: the document was not at hand",
    ("schlenk", PITCH_SPEED): "ISO/TR 14179-2, unverified: the document was not at hand",
    ("iso_6336_22", LINE_LOAD): "ISO/TR 13989-2, by a public worked example that raises the line load to it",
    ("iso_6336_22", PITCH_SPEED): "ISO/TR 13989-2, unverified: the document was not at hand",
    ("iso_6336_20", PITCH_SPEED): "ISO/TR 13989-1, equations (25) to (28), by a public implementation",
    ("benedict_kelley", SLIDING): "this program: the logarithm of the formula has no bound on the pitch line",
    ("xu", SLIDE_TO_ROLL): "Xu (2005), by a public implementation",
}
"""Where each limit of each model is from, and whether its document was seen."""

SMALLEST_SLIDE = 1e-3
"""Sliding over u1 + u2 below which Benedict and Kelley's logarithm, infinite on the pitch line, is cut."""

XU = (-8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305)
"""Coefficients b1..b9 of Xu's regression (Xu 2005), one 75W-90 oil."""


@dataclass(frozen=True, eq=False)
class Rubbing:
    """Conditions in which flanks rub, at m points; all (m,) unless stated.

    `line_load` N/m, relative `radius` of curvature across the line m, largest `pressure` Pa, rolling
    velocities `u1` and `u2` across the line and the whole `sliding` velocity m/s. `pitch_speed` m/s;
    viscosity (Pa s) of the oil as supplied, `oil_viscosity`, and at the flanks' bulk temperature,
    `bulk_viscosity`; `film_ratio` lambda. The last two may have further axes in front, one bulk temperature
    each. `ra` the mean of both flanks' arithmetic roughness, `rq` the root of the sum of the squares of their
    root mean square roughness, m.
    """

    line_load: Array
    radius: Array
    pressure: Array
    u1: Array
    u2: Array
    sliding: Array
    pitch_speed: float
    oil_viscosity: float
    bulk_viscosity: Numbers
    film_ratio: Array
    ra: float
    rq: float

    @property
    def sum_velocity(self) -> Array:
        """Sum of the rolling velocities, v_S = u1 + u2, m/s."""
        return self.u1 + self.u2


class FrictionModel(Protocol):
    """Coefficient of friction at every point, and where it was measured."""

    @property
    def name(self) -> str: ...

    @property
    def by_film(self) -> bool:
        """Whether the coefficient depends on the film ratio."""

    def coefficient(self, at: Rubbing) -> Array:
        """Compute the friction coefficient.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless.
        """

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Find the points within each limit of the model.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, by the limit in words.
        """


@dataclass(frozen=True)
class Constant:
    """Constant coefficient: for tests, and as a bound."""

    value: float
    name: str = "constant"
    by_film: ClassVar = False

    def coefficient(self, at: Rubbing) -> Array:
        """Return the constant.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless.
        """
        return np.full_like(at.line_load, self.value)

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Return no limits.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            Empty.
        """
        return {}


@dataclass(frozen=True)
class GearTested:
    """Mean coefficient from gear tests, taken at every point: FORMULAS by name."""

    lubricant_factor: float = 1.0
    name: ClassVar[str]
    by_film: ClassVar = False

    def coefficient(self, at: Rubbing) -> Array:
        """Compute the friction coefficient by the formula of the model.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless.
        """
        formula = FORMULAS[self.name]
        return formula(
            at.line_load, at.sum_velocity, at.radius, at.oil_viscosity, at.ra, self.lubricant_factor
        )

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Find the points within line load and speed of the gear tests.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, by the limit in words.
        """
        return {
            LINE_LOAD: at.line_load >= MIN_LINE_LOAD,
            PITCH_SPEED: _within_test_speed(at),
        }


class Schlenk(GearTested):
    """ISO/TR 14179-2; X_L is 1 for mineral oil, 0.8 for PAO (the standard).

    0.65 was measured on an ester and a PAO (GEARpie).
    """

    name = "schlenk"


class Iso633622(GearTested):
    """ISO/TS 6336-21 and -22 (ISO/TR 13989-2, 15144-1)."""

    name = "iso_6336_22"


class Iso633620(GearTested):
    """ISO/TS 6336-20 (ISO/TR 13989-1)."""

    name = "iso_6336_20"

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Find the points within the speed of the gear tests.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, by the limit in words.
        """
        return {PITCH_SPEED: _within_test_speed(at)}


@dataclass(frozen=True)
class BenedictKelley:
    """Benedict and Kelley in the form of AGMA 925: low speed, thick oil."""

    name: str = "benedict_kelley"
    by_film: ClassVar = False

    def coefficient(self, at: Rubbing) -> Array:
        """Compute the friction coefficient by `benedict_kelley`.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless.
        """
        return benedict_kelley(at.line_load, at.sum_velocity, at.sliding, at.bulk_viscosity, at.ra)

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Find the points where the logarithm is not cut.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, by the limit in words.
        """
        return {SLIDING: at.sliding > SMALLEST_SLIDE * at.sum_velocity}


@dataclass(frozen=True)
class Xu:
    """Regression of elastohydrodynamic traction (Xu 2005): one 75W-90 oil."""

    name: str = "xu"
    by_film: ClassVar = False

    def coefficient(self, at: Rubbing) -> Array:
        """Compute the friction coefficient by `xu`.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless.
        """
        return xu(at.pressure, at.radius, at.u1, at.u2, at.bulk_viscosity, at.rq)

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Find the points within the slide to roll ratio of the tests.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, by the limit in words.
        """
        return {SLIDE_TO_ROLL: 2 * np.abs(at.u1 - at.u2) <= np.abs(at.sum_velocity)}


@dataclass(frozen=True)
class Doleschel:
    """Solid and fluid friction by the film's fraction of the load (Doleschel 2002).

    xi mu_F + (1 - xi) mu_EHD, xi = (1 - lambda/2)^2 below lambda = 2, with p in 1000 MPa and eta in mPa s
    at the oil's temperature: mu_F = solid p^solid_pressure v_S^solid_speed and mu_EHD = fluid
    p^fluid_pressure v_S^fluid_speed eta^fluid_viscosity. The seven constants are from a twin disc test of
    the oil.
    """

    solid: float
    solid_pressure: float
    solid_speed: float
    fluid: float
    fluid_pressure: float
    fluid_speed: float
    fluid_viscosity: float
    name: str = "doleschel"
    by_film: ClassVar = True

    def coefficient(self, at: Rubbing) -> Array:
        """Compute the friction coefficient.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless.
        """
        fraction = np.where(at.film_ratio < 2, (1 - np.minimum(at.film_ratio, 2.0) / 2) ** 2, 0.0)
        pressure = 1e-9 * at.pressure
        solid = self.solid * pressure**self.solid_pressure * at.sum_velocity**self.solid_speed
        fluid = self.fluid * pressure**self.fluid_pressure * at.sum_velocity**self.fluid_speed
        return fraction * solid + (1 - fraction) * fluid * (1e3 * at.oil_viscosity) ** self.fluid_viscosity

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Return no limits: those of the test that gave the constants are not known.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            Empty.
        """
        return {}


def schlenk(
    line_load: Numbers,
    sum_velocity: Numbers,
    radius: Numbers,
    viscosity: Numbers,
    ra: float,
    factor: float = 1.0,
) -> Array:
    """Compute 0.048 (w/(v_S rho))^0.2 eta^-0.05 Ra^0.25 X_L.

    All but roughness and factor are numbers or arrays of one shape.

    Parameters
    ----------
    line_load : Numbers
        Load over length w, N/m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    radius : Numbers
        Relative radius of curvature rho, m.
    viscosity : Numbers
        Dynamic viscosity eta of the oil as supplied, Pa s.
    ra : float
        Mean Ra of both flanks, m.
    factor : float
        Lubricant factor X_L, dimensionless.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    rough = (1e6 * ra) ** 0.25
    return 0.048 * _load_term(line_load, sum_velocity, radius) * _viscosity_term(viscosity) * rough * factor


def iso_6336_22(
    line_load: Numbers,
    sum_velocity: Numbers,
    radius: Numbers,
    viscosity: Numbers,
    ra: float,
    factor: float = 1.0,
) -> Array:
    """Compute 0.045 (w K/(v_S rho))^0.2 eta^-0.05 X_R X_L, X_R = 2.2 (Ra/rho)^0.25.

    All but roughness and factor are numbers or arrays of one shape.

    Parameters
    ----------
    line_load : Numbers
        Load over length w, with K in it, N/m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    radius : Numbers
        Relative radius of curvature rho, m.
    viscosity : Numbers
        Dynamic viscosity eta of the oil as supplied, Pa s.
    ra : float
        Mean Ra of both flanks, m.
    factor : float
        Lubricant factor X_L, dimensionless.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    rough = 2.2 * (1e3 * ra / np.asarray(radius, float)) ** 0.25
    return 0.045 * _load_term(line_load, sum_velocity, radius) * _viscosity_term(viscosity) * rough * factor


def iso_6336_20(
    line_load: Numbers,
    sum_velocity: Numbers,
    radius: Numbers,
    viscosity: Numbers,
    ra: float,
    factor: float = 1.0,
) -> Array:
    """Compute 0.060 (w_Bt/(v_S rho))^0.2 X_L Ra^0.25 with X_L = factor eta^-0.05.

    All but roughness and factor are numbers or arrays of one shape.

    Parameters
    ----------
    line_load : Numbers
        Load over length w_Bt, N/m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    radius : Numbers
        Relative radius of curvature rho, m.
    viscosity : Numbers
        Dynamic viscosity eta of the oil as supplied, Pa s.
    ra : float
        Mean Ra of both flanks, m.
    factor : float
        Lubricant factor without the power of the viscosity, dimensionless.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    rough = (1e6 * ra) ** 0.25
    return 0.060 * _load_term(line_load, sum_velocity, radius) * _viscosity_term(viscosity) * rough * factor


def benedict_kelley(
    line_load: Numbers, sum_velocity: Numbers, sliding: Numbers, viscosity: Numbers, ra: float
) -> Array:
    """Compute 0.0127 min(3, 1.13/(1.13 - Ra)) log10(29 660 w/(eta v_s v_S^2)), not below 0.

    All but the roughness are numbers or arrays of one shape.

    Parameters
    ----------
    line_load : Numbers
        Load over length w, N/m.
    sum_velocity : Numbers
        v_S = u1 + u2, m/s.
    sliding : Numbers
        Sliding velocity v_s, m/s; at least SMALLEST_SLIDE times v_S is taken.
    viscosity : Numbers
        Dynamic viscosity eta at the bulk temperature, Pa s.
    ra : float
        Mean Ra of both flanks, m.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    left = 1.13 - 1e6 * ra
    rough = min(3.0, 1.13 / left) if left > 0 else 3.0
    sum_velocity = np.asarray(sum_velocity, float)
    slid = np.maximum(np.asarray(sliding, float), SMALLEST_SLIDE * sum_velocity)
    inside = (
        29660
        * 1e-3
        * np.asarray(line_load, float)
        / (1e3 * np.asarray(viscosity, float) * slid * sum_velocity**2)
    )
    return np.maximum(0.0127 * rough * np.log10(inside), 0.0)


def xu(pressure: Numbers, radius: Numbers, u1: Numbers, u2: Numbers, viscosity: Numbers, rq: float) -> Array:
    """Compute `e^f p^b2 |SR|^b3 u_e^b6 eta^b7 R^b8` (Xu 2005).

    `f = b1 + b4 A + b5 e^-A + b9 e^S`, `A = |SR| p log10 eta`; p GPa, u_e = (u1 + u2)/2, SR = (u1 - u2)/u_e,
    R m, S um. All but the roughness are numbers or arrays of one shape.

    Parameters
    ----------
    pressure : Numbers
        Largest pressure p, Pa.
    radius : Numbers
        Relative radius of curvature R, m.
    u1 : Numbers
        Rolling velocity of the first flank, m/s.
    u2 : Numbers
        Rolling velocity of the second flank, m/s.
    viscosity : Numbers
        Dynamic viscosity eta at the bulk temperature, Pa s.
    rq : float
        Composite roughness S, m.

    Returns
    -------
    (...) array
        Friction coefficient, dimensionless.
    """
    p, speed, thick = (
        1e-9 * np.asarray(pressure, float),
        0.5 * (np.asarray(u1, float) + u2),
        1e3 * np.asarray(viscosity, float),
    )
    slide = np.abs(np.asarray(u1, float) - u2) / speed
    b1, b2, b3, b4, b5, b6, b7, b8, b9 = XU
    heat = slide * p * np.log10(thick)
    power = b1 + b4 * heat + b5 * np.exp(-heat) + b9 * np.exp(1e6 * rq)
    return np.exp(power) * p**b2 * slide**b3 * speed**b6 * thick**b7 * np.asarray(radius, float) ** b8


def _load_term(line_load: Numbers, sum_velocity: Numbers, radius: Numbers) -> Array:
    """Return (w/(v_S rho))^0.2 in N/mm, m/s and mm."""
    return (
        1e-6 * np.asarray(line_load, float) / (np.asarray(sum_velocity, float) * np.asarray(radius, float))
    ) ** 0.2


def _viscosity_term(viscosity: Numbers) -> Array:
    """Return eta^-0.05 in mPa s."""
    return (1e3 * np.asarray(viscosity, float)) ** -0.05


def _within_test_speed(at: Rubbing) -> Mask:
    return np.full(at.line_load.shape, at.pitch_speed <= LARGEST_SPEED)


FORMULAS = {"schlenk": schlenk, "iso_6336_22": iso_6336_22, "iso_6336_20": iso_6336_20}
"""Mean coefficients from gear tests."""
