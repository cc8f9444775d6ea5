"""What the sections of a config demand of one another."""

import os
from collections.abc import Sequence
from math import atan, degrees, pi
from typing import Any

import numpy as np

from facegear.config.base import parse
from facegear.config.changes import (
    LUBRICATION,
    MACHINE,
    PAIR,
    SPEED,
    TEETH,
    WITHOUT_MESHING,
    movable,
    moves_pair,
    variable_part,
)
from facegear.config.contact import Contact
from facegear.config.lubrication import LubricationSection
from facegear.config.lumped_model import given_torques, other_gear_torque
from facegear.config.machine_layout import ToothNumbers, layout
from facegear.config.search import Search
from facegear.config.stiffness import MeshStiffness
from facegear.config.studies import Study
from facegear.config.tolerances import Tolerances
from facegear.config.tooth_pair import ToothPair, materials, pair_design
from facegear.config.transmission import Transmission
from facegear.errors import ConfigError, ConfigErrors, NotConverged
from facegear.geometry.design import PairDesign
from facegear.number_format import count_noun

MAX_POINTS = 200
"""Points of all studies of a config together: each is a case of its own with some five jobs."""
JAM = 1e-8
"""Negative backlash (m) that is rounding."""
CONTACT_ASKED = "where machines among many differ in their teeth, or are judged by them"
STRAIN, STEEL, WIDEST = 0.02, 206e9, 40.0
"""Force over module, face width and Young's modulus that no tooth stands; Pa; face width in modules."""
BROKEN = "beyond it the tooth force is 2 % of Young's modulus times module and face width"
SAME_PITCH = 1e-5
"""Relative difference up to which a curve's period counts as the pinion's pitch."""
TAKEN_NAMES = ("nominal", "nominal_summary", "summary", "reference", "speed_range", "study_forces")
"""Files that load sharing writes beside those of the studies."""


def pair_teeth(pair: ToothPair) -> ToothNumbers:
    """What the lumped model takes from a config's tooth pair."""
    return ToothNumbers.of_teeth(*(getattr(pair, key) for key in TEETH))


def with_backlash(pair: ToothPair, section: Transmission) -> Transmission:
    """The section with the backlash of the teeth as assembled where it gives none. Raises ConfigError."""
    if section.backlash_um is not None:
        return section
    return section.model_copy(update={"backlash_um": round(geometric_backlash(pair), 6)})


def check_pitch(stiffness: MeshStiffness, teeth: int) -> None:
    """A stiffness over the pinion's angle covers a pitch of the pinion. Raises ConfigError."""
    covered = stiffness.csv_pitch_deg
    if covered is not None and abs(covered * teeth / 360.0 - 1.0) > SAME_PITCH:
        allowed = f"over one pitch of the pinion, {360.0 / teeth:.8g} deg for {teeth} teeth"
        raise ConfigError("mesh_stiffness.csv", f"{covered:.8g} deg of pinion_angle_deg", allowed)


def check_load(stiffness: MeshStiffness, contact: Contact) -> None:
    """The stiffness is taken at a load between those solved. Raises ConfigError."""
    low, high = contact.torques_n_m[0], contact.torques_n_m[-1]
    torque = stiffness.torque_n_m
    if stiffness.source != "harmonics" and torque is not None and not low <= torque <= high:
        allowed = f"within contact.torques_n_m, {low:g} to {high:g}"
        raise ConfigError("mesh_stiffness.torque_n_m", torque, allowed)


def check_strain(pair: ToothPair, contact: Contact) -> None:
    """No torque of the contact analysis loads teeth beyond what a linear elastic one can say.

    Raises ConfigError.
    """
    largest = tooth_limit(pair_design(pair), min(material.young_modulus for material in materials(pair)))
    if contact.torques_n_m[-1] > largest:
        raise ConfigError("contact.torques_n_m", contact.torques_n_m[-1], f"at most {largest:.4g}: {BROKEN}")


def tooth_limit(design: PairDesign, modulus: float) -> float:
    """Return the torque at which a tooth leaves what a linear elastic model can say.

    Parameters
    ----------
    design : PairDesign
        The pair.
    modulus : float
        Young's modulus, Pa.

    Returns
    -------
    float
        Torque on the pinion, N m.
    """
    width = design.face_gear.outer_radius - design.face_gear.inner_radius
    return STRAIN * modulus * design.module * width * design.pinion_pitch_radius


def check_machine_strain(pair: ToothPair, section: Transmission) -> None:
    """No torque on a pinion is beyond any steel tooth of this module and WIDEST modules of face.

    Raises ConfigError.
    """
    m = 1e-3 * pair.module_mm
    largest = STRAIN * STEEL * WIDEST * m**2 * 0.5 * m * pair.pinion_teeth
    given = {"transmission.torque.per_input_n_m": section.torque.per_input_n_m}
    given |= {
        f"transmission.pinions[{number}].torque_n_m": pinion.torque_n_m
        for number, pinion in enumerate(section.pinions)
        if pinion.torque_n_m is not None
    }
    for key, torque in given.items():
        if abs(torque) > largest:
            raise ConfigError(key, torque, f"at most {largest:.4g}: {BROKEN}")


def check_positions(pair: ToothPair, section: Transmission) -> None:
    """Pinions stand at angles within a turn, far enough apart for their bodies. Raises ConfigError."""
    shape = layout(section, pair_teeth(pair))
    for number, (pinion, given) in enumerate(zip(shape.pinions, section.pinions, strict=True)):
        if abs(pinion.pitches) > shape.gear_teeth:
            key = f"transmission.pinions[{number}].angle_pitches"
            allowed = f"within a turn, -{shape.gear_teeth} to {shape.gear_teeth}"
            raise ConfigError(key, given.angle_pitches, allowed)
    radius, inner_end = _pinion_body(pair)
    needed = 2.0 * atan(radius / inner_end)
    angles = np.mod(shape.angles, 2.0 * pi)
    order = np.argsort(angles)
    for first, following in zip(order, np.roll(order, -1), strict=True):
        apart = float(np.mod(angles[following] - angles[first], 2.0 * pi))
        if first != following and apart < needed * (1.0 - 1e-9):
            names = [shape.pinions[i].name for i in (first, following)]
            angles_text = f"at least {degrees(needed):.4g} deg apart, not {degrees(apart):.4g}"
            distance = f"{angles_text}: their bodies would overlap"
            raise ConfigError("transmission.pinions", names, distance)


def check_torques(pair: ToothPair, section: Transmission) -> None:
    """Something loads the machine. Raises ConfigError."""
    on_pinions = given_torques(section, layout(section, pair_teeth(pair)))
    if not on_pinions.any() and other_gear_torque(section) == 0.0:
        allowed = "not 0 where no pinion has a torque of its own: nothing would be loaded"
        if not any(pinion.role == "input" for pinion in section.pinions):
            raise ConfigError("transmission.pinions", "no input", "at least one input, or a torque_n_m")
        if section.torque.per_input_n_m == 0.0:
            raise ConfigError("transmission.torque.per_input_n_m", 0.0, allowed)
        no_load = "not 0 at every input: nothing would be loaded"
        raise ConfigError("transmission.pinions", "torque_n_m: 0", no_load)


def check_pitch_once(pair: ToothPair, section: Transmission) -> None:
    """Grids of single teeth and pitch deviations do not say the same twice. Raises ConfigError."""
    for body, part, bodies in (
        ("pinion", "single_pinions", section.single_pinions),
        ("face_gear", "single_gears", section.single_gears),
    ):
        own = getattr(pair, body)
        if own is None or own.flanks.pitch_and_thickness == "left_out":
            continue
        if all(grid.tooth is None for grid in own.flanks.grids):
            continue
        for name, given in bodies.items():
            if given.cumulative_pitch_um:
                key = f"transmission.{part}.{name}.cumulative_pitch_um"
                allowed = f"left out, as tooth_pair.{body}.flanks has pitch and thickness included"
                raise ConfigError(key, "given", allowed)


def geometric_backlash(pair: ToothPair, beside: Sequence[float] = ()) -> float:
    """Backlash of the pair as assembled, um; `beside` as `normal_backlash` has it.

    Raises ConfigError for a pair that jams or does not mesh.
    """
    # Imported here: only a pair with assembly errors needs compiled geometry to read its config.
    from facegear.geometry.backlash import normal_backlash

    assembly = pair.assembly.model_dump()
    try:
        backlash = normal_backlash(pair_design(pair), tuple(beside))
    except NotConverged:
        raise ConfigError(
            "tooth_pair.assembly", assembly, "smaller errors, with which the flanks meet"
        ) from None
    if backlash < -JAM:
        min_thinning = (pair.pinion.thinning_um if pair.pinion else 0.0) - 1e6 * backlash
        allowed = (
            f"at least {min_thinning:.1f}: with these assembly errors the pair jams by "
            f"{-1e6 * backlash:.1f} um"
        )
        raise ConfigError("tooth_pair.pinion.thinning_um", pair.pinion and pair.pinion.thinning_um, allowed)
    return 1e6 * max(backlash, 0.0)


def memory_here() -> float:
    """Bytes of memory of this machine; without limit where the system does not tell."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return float("inf")


def check_studies(studies: Sequence[Study]) -> None:
    """Studies and their files do not meet, and are few enough. Raises ConfigError."""
    names = [study.name for study in studies]
    figures = [number for study in studies for number in study.figures or ()]
    for number, name in enumerate(names):
        if name in names[:number]:
            raise ConfigError(f"studies[{number}].name", name, "a name of its own for each study")
        if name in TAKEN_NAMES:
            raise ConfigError(
                f"studies[{number}].name", name, "another name: load sharing writes a file of this one"
            )
    if len(set(figures)) < len(figures):
        raise ConfigError("studies.figures", figures, "each number once")
    points = sum(int(np.prod([len(axis.resolved()) for axis in study.axes])) for study in studies)
    if points > MAX_POINTS:
        allowed = f"at most {MAX_POINTS} in all: fewer values, several configs, or a loop in Python"
        raise ConfigError("studies", count_noun(points, "point"), allowed)


def check_tolerances(
    section: Tolerances,
    pair: ToothPair,
    machine: Transmission,
    lubrication: LubricationSection | None,
    solved: bool,
) -> None:
    """Every cause moves numbers that this machine has; those of its teeth where contact is `solved`.

    Raises ConfigError.
    """
    keys = [key for cause in section.causes for key in cause.moves]
    if lubrication is None and any(key.startswith(LUBRICATION) for key in keys):
        raise ConfigError("lubrication", None, "given, as required by tolerances.causes that move it")
    allowed = (MACHINE, SPEED, *([LUBRICATION] if lubrication else []), *WITHOUT_MESHING)
    start = movable(_variable(pair, machine, lubrication), keys, allowed)
    if not solved and (section.tooth_contact or moves_pair(keys)):
        raise ConfigError("mesh_stiffness.source", "harmonics", f"fem or fem_scaled, {CONTACT_ASKED}")
    try:
        parse(Transmission, start["transmission"])
    except ConfigErrors as error:
        reason = error.lines[0]
        raise ConfigError(
            "tolerances.causes.moves", keys, f"keys that this machine can have; {reason}"
        ) from None


def check_search(
    section: Search, tolerances: Tolerances | None, pair: ToothPair, machine: Transmission, contact: str
) -> None:
    """Variables are numbers of this machine, goals quantities that it has. Raises ConfigError.

    `contact`: what of it the config has, none, pressure or root stress too.
    """
    # Imported here: only a search needs to know what machines are judged by.
    from facegear.load_sharing.quantity_names import matching_names, quantity_names

    keys = [key for variable in section.variables for key in variable.sets]
    causes = tolerances.causes if section.robust and tolerances is not None else ()
    oiled = [key for cause in causes for key in cause.moves if key.startswith(LUBRICATION)]
    if oiled:
        raise ConfigError(
            "tolerances.causes.moves", oiled, "without lubrication where search asks for percentiles"
        )
    movable(_variable(pair, machine), keys, (MACHINE, PAIR), "search.variables.sets")
    if contact == "none" and moves_pair(keys):
        raise ConfigError("mesh_stiffness.source", "harmonics", f"fem or fem_scaled, {CONTACT_ASKED}")
    machine_layout = layout(machine, pair_teeth(pair))
    dynamic, gauges = section.model == "dynamic", contact == "root stress"
    names = quantity_names(machine_layout, dynamic, contact != "none", gauges, jumps=True)
    for goal in (*section.objectives, *section.constraints):
        for start in goal.quantities:
            if not matching_names(start, names):
                allowed = f"the beginning of one of: {', '.join(names)}"
                key = "smallest_of" if goal.large else "largest_of"
                raise ConfigError(f"search: {goal.name}.{key}", start, allowed)
    if section.robust and tolerances is None:
        raise ConfigError("tolerances", None, "given, as required by percentiles in search")


def _variable(
    pair: ToothPair, machine: Transmission, lubrication: LubricationSection | None = None
) -> dict[str, Any]:
    oil = lubrication.model_dump(mode="json") if lubrication is not None else None
    return variable_part(machine.model_dump(mode="json"), pair.model_dump(mode="json"), 0.0, oil)


def _pinion_body(pair: ToothPair) -> tuple[float, float]:
    """Radius (m) of the pinions and the gear radius where their bodies begin.

    Without bodies in the config, what is certain: the pitch radii of pinion and gear.
    """
    if pair.pinion is None:
        half = 0.5e-3 * pair.module_mm
        return half * pair.pinion_teeth, half * pair.face_gear_teeth
    design = pair_design(pair)
    return design.pinion_tip_radius, design.mean_radius - 0.5 * design.pinion.width
