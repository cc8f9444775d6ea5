"""Lubricating oil: viscosity, density, pressure coefficient and conductivity over temperature, SI units.

Temperatures of public functions are in degrees Celsius, as every oil card and standard has them.
"""

from dataclasses import dataclass
from math import log, log10

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.errors import FacegearError

ZERO = 273.15
"""Temperature 0 C in K."""
SHIFT = 0.7
"""Shift of the kinematic viscosity in ASTM D341, mm2/s."""

DENSITY_SLOPE = 0.7
"""kg/m3 that the density falls by in a degree (ISO/TR 15144-1)."""

REFERENCE = 15.0
"""Temperature (C) of the density that cards give."""


@dataclass(frozen=True)
class PowerOfViscosity:
    """Pressure coefficient s nu^t in 1/GPa, nu in mm2/s (Gold et al. 2001)."""

    scale: float
    exponent: float

    def at(self, kinematic: Array, dynamic: Array) -> Array:
        """Compute the pressure-viscosity coefficient s nu^t in 1/GPa with nu in mm2/s (Gold et al. 2001).

        Parameters
        ----------
        kinematic : (...) array
            Kinematic viscosity nu, m2/s.
        dynamic : (...) array
            Dynamic viscosity, Pa s; not used by this law.

        Returns
        -------
        (...) array
            Coefficient, 1/Pa.
        """
        return 1e-9 * self.scale * (1e6 * kinematic) ** self.exponent


@dataclass(frozen=True)
class PolyolEster:
    """Pressure coefficient of MIL-L-23699 as a public rolling bearing code has it."""

    def at(self, kinematic: Array, dynamic: Array) -> Array:
        """Compute the pressure-viscosity coefficient of MIL-L-23699, e^(1.15607 ln eta - 17.496) / eta.

        Parameters
        ----------
        kinematic : (...) array
            Kinematic viscosity, m2/s; not used by this law.
        dynamic : (...) array
            Dynamic viscosity eta, Pa s.

        Returns
        -------
        (...) array
            Coefficient, 1/Pa.
        """
        return np.exp(1.15607 * np.log(dynamic) - 17.496) / dynamic


@dataclass(frozen=True)
class FixedCoefficient:
    """A pressure coefficient (1/Pa) that does not depend on temperature."""

    value: float

    def at(self, kinematic: Array, dynamic: Array) -> Array:
        """Return the given pressure coefficient, the same for every viscosity.

        Parameters
        ----------
        kinematic : (...) array
            Kinematic viscosity, m2/s; only its shape is used.
        dynamic : (...) array
            Dynamic viscosity, Pa s; not used by this law.

        Returns
        -------
        (...) array
            Coefficient, 1/Pa.
        """
        return np.full_like(kinematic, self.value)


@dataclass(frozen=True)
class Oil:
    """Oil by kinematic `viscosities` (m2/s) at two `temperatures` (C), and its density (kg/m3) at 15 C.

    `conductivity` (W/(m K)) at `conductivity_at` (C), falling by `conductivity_slope` a degree. `flash_point`
    (C). `lubricant_factor` X_L of Schlenk's friction. Raises FacegearError unless the viscosity falls with
    temperature.
    """

    name: str
    temperatures: tuple[float, float]
    viscosities: tuple[float, float]
    density: float
    pressure_coefficient: PowerOfViscosity | PolyolEster | FixedCoefficient
    conductivity: float
    conductivity_at: float
    conductivity_slope: float
    flash_point: float
    lubricant_factor: float

    def __post_init__(self) -> None:
        (low, high), (thick, thin) = self.temperatures, self.viscosities
        if not (low < high and thick > thin > 0):
            raise FacegearError(f"oil {self.name}: viscosity must fall with temperature")

    @property
    def slope(self) -> float:
        """Slope B of ASTM D341, log10 log10(nu + 0.7) = A - B log10 T, nu in mm2/s, T in K, from the two
        viscosities.
        """
        return (_double_log(self.viscosities[0]) - _double_log(self.viscosities[1])) / (
            log10(self.temperatures[1] + ZERO) - log10(self.temperatures[0] + ZERO)
        )

    @property
    def intercept(self) -> float:
        """Intercept A of ASTM D341, log10 log10(nu + 0.7) = A - B log10 T, nu in mm2/s, T in K."""
        return _double_log(self.viscosities[0]) + self.slope * log10(self.temperatures[0] + ZERO)

    def kinematic_viscosity(self, temperature: ArrayLike) -> Array:
        """Compute the kinematic viscosity nu by ASTM D341, through both given viscosities.

        Parameters
        ----------
        temperature : ArrayLike
            Temperature of any shape, C.

        Returns
        -------
        (...) array
            Viscosity, m2/s.
        """
        kelvin = np.asarray(temperature, float) + ZERO
        return 1e-6 * (10.0**10.0 ** (self.intercept - self.slope * np.log10(kelvin)) - SHIFT)

    def density_at(self, temperature: ArrayLike) -> Array:
        """Compute the density: the given one at 15 C, less 0.7 kg/m3 per degree (ISO/TR 15144-1).

        Parameters
        ----------
        temperature : ArrayLike
            Temperature of any shape, C.

        Returns
        -------
        (...) array
            Density, kg/m3.
        """
        return self.density - DENSITY_SLOPE * (np.asarray(temperature, float) - REFERENCE)

    def viscosity(self, temperature: ArrayLike) -> Array:
        """Compute the dynamic viscosity: kinematic viscosity times density at the same temperature.

        Parameters
        ----------
        temperature : ArrayLike
            Temperature of any shape, C.

        Returns
        -------
        (...) array
            Viscosity, Pa s.
        """
        return self.kinematic_viscosity(temperature) * self.density_at(temperature)

    def thinning(self, temperature: ArrayLike) -> Array:
        """Compute the relative fall of the viscosity with temperature, beta = -d ln nu / dT.

        Parameters
        ----------
        temperature : ArrayLike
            Temperature of any shape, C.

        Returns
        -------
        (...) array
            beta, 1/K.
        """
        shifted_viscosity = 1e6 * self.kinematic_viscosity(temperature) + SHIFT
        kelvin = np.asarray(temperature, float) + ZERO
        return (
            self.slope
            * shifted_viscosity
            * np.log(shifted_viscosity)
            / ((shifted_viscosity - SHIFT) * kelvin)
        )

    def pressure_coefficient_at(self, temperature: ArrayLike) -> Array:
        """Compute the pressure coefficient alpha of Barus's law.

        Parameters
        ----------
        temperature : ArrayLike
            Temperature of any shape, C.

        Returns
        -------
        (...) array
            alpha, 1/Pa.
        """
        return self.pressure_coefficient.at(
            self.kinematic_viscosity(temperature), self.viscosity(temperature)
        )

    def conductivity_of(self, temperature: ArrayLike) -> Array:
        """Compute the thermal conductivity, which falls linearly with temperature.

        Parameters
        ----------
        temperature : ArrayLike
            Temperature of any shape, C.

        Returns
        -------
        (...) array
            Conductivity, W/(m K).
        """
        above = np.asarray(temperature, float) - self.conductivity_at
        return self.conductivity - self.conductivity_slope * above


def _double_log(viscosity: float) -> float:
    """Return log10 log10(nu + 0.7), nu in mm2/s (ASTM D341), of a kinematic viscosity given in m2/s."""
    return log10(log(1e6 * viscosity + SHIFT) / log(10.0))
