"""Material cards: limits of a material with their source, read from yaml files."""

from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import Annotated

from pydantic import Field, model_validator

from facegear.config.base import Section, parse, refuse
from facegear.config.material import SOFTEST_GPA
from facegear.config.yaml_file import read_yaml
from facegear.strength.materials import BendingLimits, Life, MaterialCard, PittingLimits

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


def material_card(path: str | Path) -> MaterialCard:
    """Read a material card.

    Parameters
    ----------
    path : str or Path
        The yaml file.

    Returns
    -------
    MaterialCard
        The card in SI units.

    Raises
    ------
    ConfigErrors
        With one line for every mistake.
    """
    return limits_of(parse(Card, read_yaml(path), source=str(path)))


def limits_of(card: Card) -> MaterialCard:
    """Convert a material card to SI units.

    Parameters
    ----------
    card : Card
        The validated card.

    Returns
    -------
    MaterialCard
        Moduli and limits in Pa, lengths in m.
    """
    bending, pitting = card.bending, card.pitting
    return MaterialCard(
        name=card.name,
        source=card.source,
        grade=card.grade,
        young_modulus=1e9 * card.young_modulus_gpa,
        poisson_ratio=card.poisson_ratio,
        pitting=None
        if pitting is None
        else PittingLimits(1e6 * pitting.limit_mpa, _life(pitting), pitting.weibull_shape),
        bending=None
        if bending is None
        else BendingLimits(
            limit=1e6 * bending.limit_mpa,
            life=_life(bending),
            weibull_shape=bending.weibull_shape,
            slip_layer=None if bending.slip_layer_mm is None else 1e-3 * bending.slip_layer_mm,
            mean_stress=None
            if bending.mean_stress is None
            else (bending.mean_stress.constant, bending.mean_stress.slope),
        ),
    )


def _life(limits: Limits) -> Life:
    """Life factors over cycles."""
    cycles, factors = zip(*limits.life, strict=True)
    return Life(cycles, factors)
