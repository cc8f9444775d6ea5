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
from facegear.lubrication.friction_formulas import (
    FORMULAS,
    SMALLEST_SLIDE,
    Rubbing,
    _within_test_speed,
    benedict_kelley,
    xu,
)

MIN_LINE_LOAD = 150e3
"""Smallest line load, N/m, of the gear tests behind Schlenk's formula and those of the standards."""


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
"""Source of each limit of each model, and whether its document was seen."""


class FrictionModel(Protocol):
    """Coefficient of friction at every point, and where it was measured."""

    @property
    def name(self) -> str:
        """Name of the model in the config."""
        ...

    @property
    def by_film(self) -> bool:
        """Whether the coefficient depends on the film ratio, so that the film must be computed first."""

    def coefficient(self, at: Rubbing) -> Array:
        """Compute the friction coefficient at every point.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points; viscosity and film ratio may have further axes in front, one bulk
            temperature each.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless, with these axes in front if the model depends on them.
        """

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Tell at which points the conditions are within each limit of the tests behind the model.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, keyed by the limit in words as in LIMIT_SOURCES; empty without known
            limits.
        """


@dataclass(frozen=True)
class Constant:
    """Constant coefficient: for tests, and as a bound."""

    value: float
    name: str = "constant"
    by_film: ClassVar = False

    def coefficient(self, at: Rubbing) -> Array:
        """Return the constant friction coefficient at every point.

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
        """Return that the constant coefficient has no limits of use.

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
        """Compute the friction coefficient at each point by the model's formula in FORMULAS.

        The formula was measured as a mean over the mesh; here it takes the load, speed and radius of each
        point, the viscosity of the oil as supplied, and `lubricant_factor`.

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
        """Tell at which points line load (at least 150 N/mm) and pitch velocity (at most 50 m/s) are as
        in the tests.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, keyed by the limits in words, LINE_LOAD and PITCH_SPEED.
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
        """Tell whether the pitch line velocity is at most 50 m/s, as in the gear tests.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, keyed by the limit in words, PITCH_SPEED.
        """
        return {PITCH_SPEED: _within_test_speed(at)}


@dataclass(frozen=True)
class BenedictKelley:
    """Benedict and Kelley in the form of AGMA 925: low speed, thick oil."""

    name: str = "benedict_kelley"
    by_film: ClassVar = False

    def coefficient(self, at: Rubbing) -> Array:
        """Compute the friction coefficient by `friction_formulas.benedict_kelley`, viscosity at the bulk
        temperature.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points; line load, u1 + u2, sliding, bulk viscosity and Ra count.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless, not below 0.
        """
        return benedict_kelley(at.line_load, at.sum_velocity, at.sliding, at.bulk_viscosity, at.ra)

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Tell at which points sliding exceeds SMALLEST_SLIDE times u1 + u2, so that the logarithm is not
        cut off.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, keyed by the limit in words, SLIDING.
        """
        return {SLIDING: at.sliding > SMALLEST_SLIDE * at.sum_velocity}


@dataclass(frozen=True)
class Xu:
    """Regression of elastohydrodynamic traction (Xu 2005): one 75W-90 oil."""

    name: str = "xu"
    by_film: ClassVar = False

    def coefficient(self, at: Rubbing) -> Array:
        """Compute the friction coefficient by `friction_formulas.xu`, viscosity at the bulk temperature.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points; pressure, radius, u1, u2, bulk viscosity and composite Rq count.

        Returns
        -------
        (m,) array
            Coefficient mu, dimensionless.
        """
        return xu(at.pressure, at.radius, at.u1, at.u2, at.bulk_viscosity, at.rq)

    def within(self, at: Rubbing) -> Mapping[str, Mask]:
        """Tell at which points the slide to roll ratio abs(u1 - u2) / ((u1 + u2)/2) is at most 1.

        Parameters
        ----------
        at : Rubbing
            Conditions at m points.

        Returns
        -------
        mapping of (m,) arrays of bool
            True within the limit, keyed by the limit in words, SLIDE_TO_ROLL.
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
        """Compute the coefficient xi mu_F + (1 - xi) mu_EHD of solid and fluid friction (see the class).

        Parameters
        ----------
        at : Rubbing
            Conditions at m points, with their film ratio.

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
