"""The request of a rating in SI units: limits of materials, duty cycle, factors."""

from pathlib import Path
from typing import TYPE_CHECKING

from facegear.errors import ConfigError
from facegear.schema.base import parse
from facegear.schema.cards import Card, Limits
from facegear.schema.strength import Strength
from facegear.schema.yaml_file import read_yaml
from facegear.strength.flank_contacts import normal_arms
from facegear.strength.materials import (
    BendingLimits,
    DutyBin,
    Life,
    MaterialCard,
    PittingLimits,
    given_duty,
    machine_duty,
)
from facegear.strength.safety import RatedBody, RatingRequest
from facegear.teeth.design import PairDesign

if TYPE_CHECKING:
    import pandas as pd


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
        Moduli and limits in Pa, lengths in m; None for pitting or bending that the card does not give.
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
    """Return numbers of load cycles and the life factor at each, from the pairs of a material card's
    limits.
    """
    cycles, factors = zip(*limits.life, strict=True)
    return Life(cycles, factors)


def duty_bins(section: Strength) -> tuple[DutyBin, ...]:
    """Return the bins of the duty cycle, torques multiplied by all load factors that section `strength`
    gives.

    Parameters
    ----------
    section : Strength
        Section `strength` of the config.

    Returns
    -------
    tuple[DutyBin, ...]
        Torque on the pinion (N m), speed of the pinion (turns a second) and time (s) of each bin.
    """
    return tuple(
        DutyBin(section.factor * load.torque_n_m, load.speed_rpm / 60.0, 3600.0 * load.hours)
        for load in section.duty
    )


def rating_request(
    section: Strength, design: PairDesign, spectrum: "pd.DataFrame | None" = None
) -> RatingRequest:
    """Return what a rating needs in SI units: limits of materials, loads and cycles of the flanks,
    factors.

    Without a spectrum a tooth of the pinion is loaded `cycles_per_turn` times a turn of the pinion, a
    tooth of the gear that often a turn of the gear. With one, loads and cycles are those of each flank in
    the machine.

    Parameters
    ----------
    section : Strength
        Section `strength` of the config.
    design : PairDesign
        Geometry of the pair.
    spectrum : pd.DataFrame or None
        Loads of the flanks in the machine from stage duty_loads, columns DUTY_SPECTRUM_COLUMNS; None
        where the section gives the load factors.

    Returns
    -------
    RatingRequest
        Material limits and root roughness (m) by `pinion` and `face_gear`, loads of the flanks, duration
        of the duty cycle (s), and the smallest safeties allowed.

    Raises
    ------
    ConfigError
        Where the section rates bearings alone.
    """
    duty, ratio = duty_bins(section), design.pinion.teeth / design.face_gear.teeth
    if section.pinion is None or section.face_gear is None:
        raise ConfigError("strength.pinion", None, "given for a rating of teeth")
    sections = {"pinion": section.pinion, "face_gear": section.face_gear}
    if spectrum is None:
        flanks = tuple(
            given_duty(gear, duty, (body.cycles_per_turn or 1) * turns, body.both_ways)
            for (gear, body), turns in zip(sections.items(), (1.0, ratio), strict=True)
        )
    else:
        arms = {flank: section.factor * arm for flank, arm in normal_arms(design).items()}
        flanks = machine_duty(spectrum, duty, ratio, arms)
    return RatingRequest(
        bodies={
            gear: RatedBody(limits_of(body.card), 1e-6 * body.root_roughness_um)
            for gear, body in sections.items()
        },
        duty=flanks,
        time=sum(load.time for load in duty),
        min_bending=section.min_bending_safety,
        min_pitting=section.min_pitting_safety,
    )
