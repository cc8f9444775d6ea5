"""Oil cards: what the friction chain needs of an oil, with its source, read from yaml files."""

from importlib.resources import files
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.lubrication.oil import FixedCoefficient, Oil, PolyolEster, PowerOfViscosity

OIL_CARDS = Path(str(files("facegear") / "lubrication" / "cards"))
"""Folder of the cards that come with the package."""


class PowerLaw(Section):
    """Pressure coefficient scale nu^exponent in 1/GPa, nu in mm2/s."""

    law: Literal["power"] = Field(description="scale nu^exponent, nu in mm2/s")
    scale: float = Field(ge=1e-6, le=1000, description="1/GPa at 1 mm2/s")
    exponent: float = Field(ge=0, le=1, description="of the viscosity nu in mm2/s")


class EsterLaw(Section):
    """Pressure coefficient of MIL-L-23699 oils."""

    law: Literal["polyol_ester"] = Field(description="formula for MIL-L-23699 oils")


class FixedLaw(Section):
    """Pressure coefficient that is the same at every temperature."""

    law: Literal["fixed"] = Field(description="the same pressure coefficient at every temperature")
    per_gpa: float = Field(ge=1e-3, le=100, description="pressure coefficient, 1/GPa")


class Conductivity(Section):
    """Thermal conductivity at a temperature, and what it falls by in a degree."""

    w_per_m_k: float = Field(ge=1e-3, le=1, description="conductivity at the temperature at_c")
    at_c: float = Field(20.0, ge=-100, le=300, description="temperature of w_per_m_k")
    falls_per_k: float = Field(0.0, ge=0, le=0.01, description="W/(m K) lost with a kelvin more")


class OilCard(Section):
    """Properties of an oil that the friction chain needs."""

    name: str = Field(description="of the oil")
    source: str = Field(min_length=1, description="where the numbers are from")
    temperatures_c: tuple[
        Annotated[float, Field(ge=-100, le=1000)], Annotated[float, Field(ge=-100, le=1000)]
    ] = Field(description="two temperatures, the lower first")
    viscosities_mm2_s: tuple[
        Annotated[float, Field(gt=0.2, le=1e5)], Annotated[float, Field(gt=0.2, le=1e5)]
    ] = Field(description="kinematic viscosity at both; between and beyond them ASTM D341")
    density_15_c_kg_m3: float = Field(ge=500, le=2000, description="density at 15 C")
    pressure_coefficient: PowerLaw | EsterLaw | FixedLaw = Field(
        discriminator="law", description="of viscosity under pressure"
    )
    conductivity: Conductivity
    flash_point_c: float = Field(ge=1, le=600, description="no temperature of the oil may reach it")
    lubricant_factor: float = Field(
        1.0, ge=0.01, le=2, description="X_L of the friction models of gear tests"
    )
    scuffing_temperature_c: float | None = Field(
        None, ge=1, le=1000, description="mean contact temperature at which tests scuffed"
    )
    scuffing_temperature_source: str | None = Field(
        None, description="where this temperature is from, for the table of safeties; null: source"
    )
    fzg_stage: float | None = Field(None, ge=1, le=14, description="FZG failure load stage A/8.3/90")

    @model_validator(mode="after")
    def _thinning(self) -> "OilCard":
        if self.temperatures_c[0] >= self.temperatures_c[1]:
            refuse("temperatures_c", self.temperatures_c, "two temperatures, the lower first")
        if self.viscosities_mm2_s[0] <= self.viscosities_mm2_s[1]:
            refuse("viscosities_mm2_s", self.viscosities_mm2_s, "two viscosities, the larger first")
        return self


def oil_of(card: OilCard) -> Oil:
    """Convert an oil card to SI units.

    Parameters
    ----------
    card : OilCard
        The validated card.

    Returns
    -------
    Oil
        The oil; temperatures in C.
    """
    return Oil(
        name=card.name,
        temperatures=card.temperatures_c,
        viscosities=(1e-6 * card.viscosities_mm2_s[0], 1e-6 * card.viscosities_mm2_s[1]),
        density=card.density_15_c_kg_m3,
        pressure_coefficient=_law(card.pressure_coefficient),
        conductivity=card.conductivity.w_per_m_k,
        conductivity_at=card.conductivity.at_c,
        conductivity_slope=card.conductivity.falls_per_k,
        flash_point=card.flash_point_c,
        lubricant_factor=card.lubricant_factor,
    )


def _law(section: PowerLaw | EsterLaw | FixedLaw) -> PowerOfViscosity | PolyolEster | FixedCoefficient:
    if isinstance(section, PowerLaw):
        return PowerOfViscosity(section.scale, section.exponent)
    return FixedCoefficient(1e-9 * section.per_gpa) if isinstance(section, FixedLaw) else PolyolEster()
