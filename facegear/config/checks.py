"""Checks between the sections of a config."""

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
"""Reason in words why a config needs the contact analysis."""
STRAIN, STEEL, WIDEST = 0.02, 206e9, 40.0
"""Force over module, face width and Young's modulus that no tooth stands; Pa; face width in modules."""
STRAIN_REASON = "beyond it the tooth force is 2 % of Young's modulus times module and face width"
"""Reason in words why a torque beyond STRAIN is refused."""
SAME_PITCH = 1e-5
"""Relative difference up to which a curve's period counts as the pinion's pitch."""
TAKEN_NAMES = ("nominal", "nominal_summary", "summary", "reference", "speed_range", "study_forces")
"""Files that load sharing writes beside those of the studies."""


def pair_teeth(pair: ToothPair) -> ToothNumbers:
    """Return the tooth numbers of a pair for the lumped model.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    ToothNumbers
        Tooth numbers, base radius (m) and pressure angle (rad).
    """
    return ToothNumbers.of_teeth(*(getattr(pair, key) for key in TEETH))


def with_backlash(pair: ToothPair, section: Transmission) -> Transmission:
    """Fill in the backlash of the teeth as assembled where section `transmission` gives none.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    section : Transmission
        Section `transmission` of the config.

    Returns
    -------
    Transmission
        The section with a backlash.

    Raises
    ------
    ConfigError
        If the pair jams or does not mesh.
    """
    if section.backlash_um is not None:
        return section
    return section.model_copy(update={"backlash_um": round(geometric_backlash(pair), 6)})


def check_pitch(stiffness: MeshStiffness, teeth: int) -> None:
    """Require that a stiffness over the pinion's angle covers one pitch of the pinion.

    Parameters
    ----------
    stiffness : MeshStiffness
        Section `mesh_stiffness` of the config.
    teeth : int
        Number of teeth of the pinion.

    Raises
    ------
    ConfigError
        If it covers another angle.
    """
    pitch_deg = stiffness.csv_pitch_deg
    if pitch_deg is not None and abs(pitch_deg * teeth / 360.0 - 1.0) > SAME_PITCH:
        requirement = f"over one pitch of the pinion, {360.0 / teeth:.8g} deg for {teeth} teeth"
        raise ConfigError("mesh_stiffness.csv", f"{pitch_deg:.8g} deg of pinion_angle_deg", requirement)


def check_load(stiffness: MeshStiffness, contact: Contact) -> None:
    """Require that the torque of the stiffness lies between the torques of the contact analysis.

    Parameters
    ----------
    stiffness : MeshStiffness
        Section `mesh_stiffness` of the config.
    contact : Contact
        Section `contact` of the config.

    Raises
    ------
    ConfigError
        If it lies outside.
    """
    low, high = contact.torques_n_m[0], contact.torques_n_m[-1]
    torque = stiffness.torque_n_m
    if stiffness.source != "harmonics" and torque is not None and not low <= torque <= high:
        requirement = f"within contact.torques_n_m, {low:g} to {high:g}"
        raise ConfigError("mesh_stiffness.torque_n_m", torque, requirement)


def check_strain(pair: ToothPair, contact: Contact) -> None:
    """Require that no torque of the contact analysis loads teeth beyond linear elasticity.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    contact : Contact
        Section `contact` of the config.

    Raises
    ------
    ConfigError
        If the largest torque exceeds `tooth_limit`.
    """
    largest = tooth_limit(pair_design(pair), min(material.young_modulus for material in materials(pair)))
    if contact.torques_n_m[-1] > largest:
        raise ConfigError(
            "contact.torques_n_m", contact.torques_n_m[-1], f"at most {largest:.4g}: {STRAIN_REASON}"
        )


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
    """Require that no torque on a pinion exceeds what a steel tooth of this module can bear.

    The limit takes a face width of WIDEST modules.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    section : Transmission
        Section `transmission` of the config.

    Raises
    ------
    ConfigError
        For the first torque beyond the limit.
    """
    m = 1e-3 * pair.module_mm
    largest = STRAIN * STEEL * WIDEST * m**2 * 0.5 * m * pair.pinion_teeth
    torques = {"transmission.torque.per_input_n_m": section.torque.per_input_n_m}
    torques |= {
        f"transmission.pinions[{number}].torque_n_m": pinion.torque_n_m
        for number, pinion in enumerate(section.pinions)
        if pinion.torque_n_m is not None
    }
    for key, torque in torques.items():
        if abs(torque) > largest:
            raise ConfigError(key, torque, f"at most {largest:.4g}: {STRAIN_REASON}")


def check_positions(pair: ToothPair, section: Transmission) -> None:
    """Require that pinions stand at angles within a turn, far enough apart for their bodies.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    section : Transmission
        Section `transmission` of the config.

    Raises
    ------
    ConfigError
        For an angle beyond a turn, or two pinions whose bodies overlap.
    """
    shape = layout(section, pair_teeth(pair))
    for number, (pinion, pinion_place) in enumerate(zip(shape.pinions, section.pinions, strict=True)):
        if abs(pinion.pitches) > shape.gear_teeth:
            key = f"transmission.pinions[{number}].angle_pitches"
            requirement = f"within a turn, -{shape.gear_teeth} to {shape.gear_teeth}"
            raise ConfigError(key, pinion_place.angle_pitches, requirement)
    radius, inner_end = _pinion_body(pair)
    min_distance = 2.0 * atan(radius / inner_end)
    angles = np.mod(shape.angles, 2.0 * pi)
    order = np.argsort(angles)
    for first, second in zip(order, np.roll(order, -1), strict=True):
        apart = float(np.mod(angles[second] - angles[first], 2.0 * pi))
        if first != second and apart < min_distance * (1.0 - 1e-9):
            names = [shape.pinions[i].name for i in (first, second)]
            angles_text = f"at least {degrees(min_distance):.4g} deg apart, not {degrees(apart):.4g}"
            distance = f"{angles_text}: their bodies would overlap"
            raise ConfigError("transmission.pinions", names, distance)


def check_torques(pair: ToothPair, section: Transmission) -> None:
    """Require that some torque loads the machine.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    section : Transmission
        Section `transmission` of the config.

    Raises
    ------
    ConfigError
        If all torques are 0.
    """
    on_pinions = given_torques(section, layout(section, pair_teeth(pair)))
    if not on_pinions.any() and other_gear_torque(section) == 0.0:
        requirement = "not 0 where no pinion has a torque of its own: nothing would be loaded"
        if not any(pinion.role == "input" for pinion in section.pinions):
            raise ConfigError("transmission.pinions", "no input", "at least one input, or a torque_n_m")
        if section.torque.per_input_n_m == 0.0:
            raise ConfigError("transmission.torque.per_input_n_m", 0.0, requirement)
        no_load = "not 0 at every input: nothing would be loaded"
        raise ConfigError("transmission.pinions", "torque_n_m: 0", no_load)


def check_pitch_once(pair: ToothPair, section: Transmission) -> None:
    """Require that pitch deviations are given once: by grids of single teeth, or by cumulative pitch
    deviations.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    section : Transmission
        Section `transmission` of the config.

    Raises
    ------
    ConfigError
        If both are given for a body.
    """
    for body, part, bodies in (
        ("pinion", "single_pinions", section.single_pinions),
        ("face_gear", "single_gears", section.single_gears),
    ):
        body_section = getattr(pair, body)
        if body_section is None or body_section.flanks.pitch_and_thickness == "left_out":
            continue
        if all(grid.tooth is None for grid in body_section.flanks.grids):
            continue
        for name, single_part in bodies.items():
            if single_part.cumulative_pitch_um:
                key = f"transmission.{part}.{name}.cumulative_pitch_um"
                requirement = f"left out, as tooth_pair.{body}.flanks has pitch and thickness included"
                raise ConfigError(key, "given", requirement)


def geometric_backlash(pair: ToothPair, beside: Sequence[float] = ()) -> float:
    """Compute the backlash of the pair as assembled.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    beside : Sequence[float]
        Argument of `facegear.geometry.backlash.normal_backlash`: further positions, in pitches.

    Returns
    -------
    float
        Normal backlash, um.

    Raises
    ------
    ConfigError
        If the pair jams or does not mesh.
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
        requirement = (
            f"at least {min_thinning:.1f}: with these assembly errors the pair jams by "
            f"{-1e6 * backlash:.1f} um"
        )
        raise ConfigError(
            "tooth_pair.pinion.thinning_um", pair.pinion and pair.pinion.thinning_um, requirement
        )
    return 1e6 * max(backlash, 0.0)


def memory_here() -> float:
    """Return the physical memory of this computer.

    Returns
    -------
    float
        Memory in bytes; infinite where the system does not tell.
    """
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return float("inf")


def check_studies(studies: Sequence[Study]) -> None:
    """Require that studies have different names and figures, and are few enough.

    Parameters
    ----------
    studies : Sequence[Study]
        Studies of the config.

    Raises
    ------
    ConfigError
        For a repeated or reserved name, a repeated figure, or more than MAX_POINTS points.
    """
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
    points = sum(int(np.prod([len(axis.study_points()) for axis in study.axes])) for study in studies)
    if points > MAX_POINTS:
        requirement = f"at most {MAX_POINTS} in all: fewer values, several configs, or a loop in Python"
        raise ConfigError("studies", count_noun(points, "point"), requirement)


def check_tolerances(
    section: Tolerances,
    pair: ToothPair,
    machine: Transmission,
    lubrication: LubricationSection | None,
    has_contact: bool,
) -> None:
    """Require that every cause moves numbers that this machine has.

    Causes may move the teeth only where contact is solved.

    Parameters
    ----------
    section : Tolerances
        Section `tolerances` of the config.
    pair : ToothPair
        Section `tooth_pair` of the config.
    machine : Transmission
        Section `transmission` of the config, with its backlash.
    lubrication : LubricationSection or None
        Section `lubrication` of the config.
    has_contact : bool
        Whether the mesh stiffness comes from the contact analysis.

    Raises
    ------
    ConfigError
        For a key that the machine does not have or that may not move.
    """
    keys = [key for cause in section.causes for key in cause.moves]
    if lubrication is None and any(key.startswith(LUBRICATION) for key in keys):
        raise ConfigError("lubrication", None, "given, as required by tolerances.causes that move it")
    prefixes = (MACHINE, SPEED, *([LUBRICATION] if lubrication else []), *WITHOUT_MESHING)
    start = movable(_variable(pair, machine, lubrication), keys, prefixes)
    if not has_contact and (section.tooth_contact or moves_pair(keys)):
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
    """Require that variables are numbers of this machine, and goals quantities that it has.

    Parameters
    ----------
    section : Search
        Section `search` of the config.
    tolerances : Tolerances or None
        Section `tolerances` of the config.
    pair : ToothPair
        Section `tooth_pair` of the config.
    machine : Transmission
        Section `transmission` of the config, with its backlash.
    contact : str
        Results of the contact analysis that the config has: `none`, `pressure`, or `root stress` (both).

    Raises
    ------
    ConfigError
        For the first key or goal that the machine does not have.
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
                requirement = f"the beginning of one of: {', '.join(names)}"
                key = "smallest_of" if goal.large else "largest_of"
                raise ConfigError(f"search: {goal.name}.{key}", start, requirement)
    if section.robust and tolerances is None:
        raise ConfigError("tolerances", None, "given, as required by percentiles in search")


def _variable(
    pair: ToothPair, machine: Transmission, lubrication: LubricationSection | None = None
) -> dict[str, Any]:
    oil = lubrication.model_dump(mode="json") if lubrication is not None else None
    return variable_part(machine.model_dump(mode="json"), pair.model_dump(mode="json"), 0.0, oil)


def _pinion_body(pair: ToothPair) -> tuple[float, float]:
    """Radius (m) of the pinions and the gear radius (m) where their bodies begin.

    Without bodies in the config, what is certain: the pitch radii of pinion and gear.
    """
    if pair.pinion is None:
        half = 0.5e-3 * pair.module_mm
        return half * pair.pinion_teeth, half * pair.face_gear_teeth
    design = pair_design(pair)
    return design.pinion_tip_radius, design.mean_radius - 0.5 * design.pinion.width
