"""Cards of materials and oils with their source: by name, by file, or written out."""

from collections.abc import Mapping
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from facegear.errors import ConfigErrors
from facegear.schema.base import Section, parse, refuse
from facegear.schema.gear_body import SOFTEST_GPA
from facegear.schema.yaml_file import read_yaml


def read_card(model: type[Section], value: Any, folder: Path) -> Any:
    """Read the card that a config value names, for a validator that runs before that of the type.

    A text without an ending is the name of a card in `folder`, whatever path the config's loader put
    before it. Any other text is a yaml file, and a mapping is the card itself. Anything else is handed
    back. A mistake in the card is refused here, so that it is reported with all other mistakes before any
    work.

    Parameters
    ----------
    model : type[Section]
        Class of the card.
    value : Any
        Value of the config.
    folder : Path
        Folder of the cards that come with the package.

    Returns
    -------
    Any
        The validated card, or the value itself if it is neither text nor a mapping.
    """
    if not isinstance(value, str | Mapping):
        return value
    try:
        return parse(model, read_yaml(_file(value, folder)) if isinstance(value, str) else value, "the card")
    except ConfigErrors as error:
        name = value if isinstance(value, str) else value.get("name")
        refuse("", name, f"a card without mistakes: {' '.join(str(error).split())}")


def _file(name: str, folder: Path) -> Path:
    """Return the path of a card: the user's file if the name has an ending, else the package's card of
    this name.
    """
    path = Path(name)
    if path.suffix:
        return path
    card_path = folder / f"{path.name}.yaml"
    if not card_path.is_file():
        refuse("", path.name, f"one of {', '.join(sorted(card.stem for card in folder.glob('*.yaml')))}")
    return card_path


CARDS = Path(str(files("facegear") / "strength" / "cards"))
"""Folder of the cards that come with the package."""

Cycles = Annotated[float, Field(ge=1, le=1e18)]
LifeFactor = Annotated[float, Field(ge=1e-6, le=1e3)]


class Limits(Section):
    """A fatigue limit for 1 % failures, and its life factors as rising cycles with falling factors."""

    limit_mpa: float = Field(ge=1e-3, le=1e5, description="stress that lasts, at life factor 1")
    life: tuple[tuple[Cycles, LifeFactor], ...] = Field(min_length=2, description="[cycles, factor] points")
    weibull_shape: float | None = Field(
        None, ge=0.01, le=20, description="of the distribution of lives; null: no reliability is stated"
    )

    @model_validator(mode="after")
    def _check_life(self) -> "Limits":
        """Refuse life factors that do not fall while cycles rise."""
        cycles, factors = zip(*self.life, strict=True)
        cycles_rise = all(low < high for low, high in pairwise(cycles))
        factors_fall = all(high > low for high, low in pairwise(factors))
        if not (cycles_rise and factors_fall and cycles[0] >= 1 and factors[-1] > 0):
            refuse("life", self.life, "points of rising cycles (from 1 on) and falling factors above 0")
        return self


class MeanStress(Section):
    """Mean stress ratio M = constant - slope Y_S."""

    constant: float = Field(ge=0, le=1, description="M where Y_S is 0")
    slope: float = Field(ge=0, le=1, description="by which M falls for 1 of the stress correction Y_S")


class Bending(Limits):
    """Limits of the root; what the card's source does not give is left out."""

    slip_layer_mm: float | None = Field(None, ge=1e-6, le=1, description="rho' of ISO 6336-3")
    mean_stress: MeanStress | None = Field(
        None, description="mean stress ratio M; null: teeth loaded both ways are not rated"
    )


class Card(Section):
    """A material card."""

    name: str = Field(description="of the material")
    source: str = Field(min_length=1, description="where the limits are from")
    grade: str = Field(description="quality grade of the source, such as MQ")
    young_modulus_gpa: float = Field(ge=SOFTEST_GPA, le=2000, description="Young's modulus")
    poisson_ratio: float = Field(ge=0, lt=0.5, description="Poisson's ratio")
    pitting: Limits | None = Field(None, description="contact stress that flanks bear; null: not known")
    bending: Bending | None = Field(None, description="stress that roots bear; null: not known")


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
        """Refuse viscosities that do not fall with temperature."""
        if self.temperatures_c[0] >= self.temperatures_c[1]:
            refuse("temperatures_c", self.temperatures_c, "two temperatures, the lower first")
        if self.viscosities_mm2_s[0] <= self.viscosities_mm2_s[1]:
            refuse("viscosities_mm2_s", self.viscosities_mm2_s, "two viscosities, the larger first")
        return self
