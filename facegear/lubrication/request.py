"""Request of the friction chain: lubrication of the flanks and their limits, in SI units."""

from dataclasses import dataclass

import numpy as np

from facegear.lubrication.film import allowed_flash_temperature, allowed_integral_temperature
from facegear.lubrication.friction import FrictionModel
from facegear.lubrication.oil import Oil


@dataclass(frozen=True)
class FlankMaterial:
    """Material of a flank: conductivity W/(m K), density kg/m3, heat capacity J/(kg K)."""

    conductivity: float
    density: float
    heat_capacity: float

    @property
    def diffusivity(self) -> float:
        """Thermal diffusivity kappa = conductivity / (density heat capacity), m2/s."""
        return self.conductivity / (self.density * self.heat_capacity)

    @property
    def contact_coefficient(self) -> float:
        """Thermal contact coefficient B = sqrt(conductivity density heat capacity), W s^0.5/(m2 K)."""
        return float(np.sqrt(self.conductivity * self.density * self.heat_capacity))


STEEL = FlankMaterial(45.0, 7800.0, 440.0)
"""Steel of ISO/TR 15144-1."""


@dataclass(frozen=True)
class GivenBulk:
    """Bulk temperature (C) of both flanks, whatever the loss."""

    temperature: float


@dataclass(frozen=True)
class Cooling:
    """Heat (W/K) that pinion and face gear give off to the oil; bulk temperatures follow from the loss."""

    pinion: float
    face_gear: float


@dataclass(frozen=True)
class BorrowedBulk:
    """Bulk temperature of ISO/TR 13989-1: the oil's and 0.47 X_S times the mean flash along the path.

    The rule is that of cylindrical gears, borrowed. `supply_factor` X_S: 1.2 jet, 1 dip, 0.2 submerged.
    """

    supply_factor: float


@dataclass(frozen=True, eq=False)
class Lubrication:
    """Lubrication of the flanks.

    `oil_temperature` (C) as supplied; `ra` and `rq` (m) of pinion and gear; `reduced_modulus` E_r = 2 E*
    (Pa); `pitch_radius` (m) of the pinion.
    """

    oil: Oil
    oil_temperature: float
    friction: FrictionModel
    ra: tuple[float, float]
    rq: tuple[float, float]
    bulk: GivenBulk | Cooling | BorrowedBulk
    flanks: tuple[FlankMaterial, FlankMaterial]
    reduced_modulus: float
    pitch_radius: float

    @property
    def mean_ra(self) -> float:
        """Mean of the arithmetic roughness Ra of both flanks, m."""
        return 0.5 * sum(self.ra)

    @property
    def composite_rq(self) -> float:
        """Composite roughness: root of the sum of the squares of both flanks' Rq, m."""
        return float(np.hypot(*self.rq))


@dataclass(frozen=True)
class Limits:
    """Limits of temperature and film; None where one is not known.

    `contact_temperature` (C) of tests, else it follows from `fzg_stage` with the steel's `structure_factor`
    and the oil's `lubricant_factor`. `contact_temperature_source` says in words where it is from.
    `film_ratio` of ISO/TS 6336-22.
    """

    contact_temperature: float | None
    contact_temperature_source: str
    fzg_stage: float | None
    structure_factor: float
    lubricant_factor: float
    film_ratio: float | None

    def allowed_contact(self, oil: Oil, oil_temperature: float) -> float:
        """Return the allowed contact temperature for the flash temperature method of scuffing.

        The given `contact_temperature` wins. Else it follows from the FZG load stage
        (`allowed_flash_temperature`), the oil's lubricant factor being multiplied by eta^-0.05 (eta in
        mPa s at the oil's temperature).

        Parameters
        ----------
        oil : Oil
            The oil.
        oil_temperature : float
            Temperature of the oil as supplied, C.

        Returns
        -------
        float
            Temperature, C; nan where neither a temperature nor a load stage is given.
        """
        if self.contact_temperature is not None:
            return self.contact_temperature
        if self.fzg_stage is None:
            return np.nan
        factor = self.lubricant_factor * (1e3 * float(oil.viscosity(oil_temperature))) ** -0.05
        return allowed_flash_temperature(self.fzg_stage, self.structure_factor, factor)

    def allowed_integral(self, oil: Oil) -> float:
        """Return the allowed integral temperature (ISO/TS 6336-21) from the FZG load stage and the oil's
        viscosity at 40 C.

        Parameters
        ----------
        oil : Oil
            The oil.

        Returns
        -------
        float
            Temperature, C; nan without a load stage, even if a contact temperature is given.
        """
        if self.fzg_stage is None:
            return np.nan
        return allowed_integral_temperature(
            self.fzg_stage, self.structure_factor, self.lubricant_factor, float(oil.kinematic_viscosity(40.0))
        )

    def micropitting_safety(self, ratio: float) -> float:
        """Compute the safety against micropitting: smallest film ratio over the allowed one (ISO/TS
        6336-22).

        Parameters
        ----------
        ratio : float
            Smallest specific film lambda_GF, local film over mean Ra, dimensionless.

        Returns
        -------
        float
            Safety, a ratio; nan where the allowed film ratio is not known.
        """
        return ratio / self.film_ratio if self.film_ratio is not None else np.nan
