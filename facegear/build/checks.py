"""Checks between the sections of a config."""

import os
from collections.abc import Sequence
from math import atan, cos, degrees, pi, radians

import numpy as np

from facegear.build.lumped_model import given_torques, other_gear_torque
from facegear.build.machine_layout import layout
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair, materials, pair_design
from facegear.errors import ConfigError, NotConverged
from facegear.quantities import is_contact_quantity
from facegear.schema.changes import moves_pair
from facegear.schema.contact import Contact
from facegear.schema.stiffness import MeshStiffness
from facegear.schema.studies import Search
from facegear.schema.tolerances import Tolerances
from facegear.schema.transmission import Transmission
from facegear.teeth.design import PairDesign
from facegear.teeth.unloaded_contact import normal_backlash

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


def pair_teeth(pair: ToothPair) -> ToothNumbers:
    """Return the tooth numbers of a pair for the lumped model.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    ToothNumbers
        Tooth numbers, arm of the drive flank's force (m) and pressure angle (rad).
    """
    return ToothNumbers.of_config(pair.model_dump())


def with_backlash(pair: ToothPair, section: Transmission) -> Transmission:
    """Return section `transmission` with the backlash of the teeth as assembled where it gives none.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    section : Transmission
        Section `transmission` of the config.

    Returns
    -------
    Transmission
        The section itself if it has `backlash_um`, else a copy with it, um.

    Raises
    ------
    ConfigError
        If the pair jams or does not mesh.
    """
    if section.backlash_um is not None:
        return section
    return section.model_copy(update={"backlash_um": round(geometric_backlash(pair), 6)})


def check_pitch(stiffness: MeshStiffness, teeth: int) -> None:
    """Require that a stiffness curve read over the pinion's angle covers one pitch of the pinion.

    A stiffness that is given in another way always passes.

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
        If the largest torque exceeds `tooth_limit` with the smaller Young's modulus of both bodies.
    """
    largest = tooth_limit(pair_design(pair), min(material.young_modulus for material in materials(pair)))
    if contact.torques_n_m[-1] > largest:
        raise ConfigError(
            "contact.torques_n_m", contact.torques_n_m[-1], f"at most {largest:.4g}: {STRAIN_REASON}"
        )


def tooth_limit(design: PairDesign, modulus: float) -> float:
    """Return the torque beyond which a tooth is no longer linearly elastic: STRAIN E m b r.

    E is Young's modulus, m the module, b the face width of the gear, r the pitch radius of the pinion.

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

    The limit is that of `tooth_limit` for steel and a face of WIDEST modules, as bodies may be missing.

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
    """Require that pinions stand at angles within a turn, far enough apart that their bodies do not
    overlap.

    Neighbours must be 2 atan(r / R) apart. r is the tip radius of a pinion and R the gear radius at which
    its body begins; both are pitch radii where the config has no bodies.

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
    """Compute the normal backlash of the pair as assembled, with its assembly errors and modified flanks.

    Parameters
    ----------
    pair : ToothPair
        Section `tooth_pair` of the config.
    beside : Sequence[float]
        Argument of `facegear.teeth.unloaded_contact.normal_backlash`: further positions, in pitches.

    Returns
    -------
    float
        Normal backlash, um, not below 0.

    Raises
    ------
    ConfigError
        If the pair jams or does not mesh.
    """
    errors = {key: value for key, value in pair.assembly.model_dump().items() if value != 0.0}
    design = pair_design(pair)
    try:
        backlash = normal_backlash(design, tuple(beside))
    except NotConverged:
        raise ConfigError(
            "tooth_pair.assembly", errors, "smaller errors, with which the flanks meet"
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


def _pinion_body(pair: ToothPair) -> tuple[float, float]:
    """Return the tip radius of the pinions and the gear radius at which their bodies begin, m.

    Without bodies in the config these are what is certain: the pitch radii of pinion and gear.
    """
    if pair.pinion is None:
        half = 0.5e-3 * pair.module_mm / cos(radians(pair.helix_angle_deg))
        return half * pair.pinion_teeth, half * pair.face_gear_teeth
    design = pair_design(pair)
    half = 0.5 * design.pinion.width
    return design.pinion_tip_radius - half * design.family.taper, design.middle - half


LINES = "flanks that touch along lines meet any pose with an edge"
"""Reason of a refusal: contact along lines cannot follow poses."""
STATIC = "where transmission.operating_pose is static"
"""Condition of a refusal, in words."""
OTHER_SURFACE = (
    f"a key of transmission, dynamics or lubrication {STATIC}: a pair that differs is another surface"
)
"""Requirement on keys that samples and designs may change beside an operating pose."""
REST = "the contact of samples and designs is that of the pair as assembled"
"""Reason of a refusal: varied machines have no contact in the loaded position."""


def check_poses(machine: Transmission, pair: ToothPair, stiffness: MeshStiffness) -> None:
    """Require that contact over pose can be computed, where the operating pose is asked for.

    Parameters
    ----------
    machine : Transmission
        Section `transmission` of the config.
    pair : ToothPair
        Section `tooth_pair` of the config.
    stiffness : MeshStiffness
        Section `mesh_stiffness` of the config.

    Raises
    ------
    ConfigError
        For a stiffness given as harmonics, or a shaper with no more teeth than the pinion, whose flanks
        touch along lines.
    """
    if machine.operating_pose == "none":
        return
    if stiffness.source == "harmonics":
        requirement = "none where mesh_stiffness.source is harmonics: no contact says what a pose changes"
        raise ConfigError("transmission.operating_pose", machine.operating_pose, requirement)
    shaper, teeth = pair.shaper, pair.pinion_teeth
    if shaper is not None and shaper.teeth <= teeth:
        raise ConfigError("tooth_pair.shaper.teeth", shaper.teeth, f"more than {teeth} {STATIC}: {LINES}")


def check_posed_variants(machine: Transmission, tolerances: Tolerances | None, search: Search | None) -> None:
    """Require that samples and designs leave the tooth pair alone where an operating pose is asked for.

    Contact over pose is computed once, for the pair of the config, and serves all of them.

    Parameters
    ----------
    machine : Transmission
        Section `transmission` of the config.
    tolerances : Tolerances or None
        Section `tolerances` of the config; None without it.
    search : Search or None
        Section `search` of the config; None without it.

    Raises
    ------
    ConfigError
        For keys of the tooth pair, or quantities of its contact, beside an operating pose.
    """
    if machine.operating_pose == "none":
        return
    for key in (key for cause in (tolerances.causes if tolerances else ()) for key in cause.moves):
        if moves_pair([key]):
            raise ConfigError("tolerances.causes.moves", key, OTHER_SURFACE)
    if tolerances is not None and tolerances.tooth_contact:
        raise ConfigError("tolerances.tooth_contact", True, f"false {STATIC}: {REST}")
    if search is None:
        return
    for key in (key for variable in search.variables for key in variable.sets):
        if moves_pair([key]):
            raise ConfigError("search.variables.sets", key, OTHER_SURFACE)
    for goal in (*search.objectives, *search.constraints):
        for text in filter(is_contact_quantity, goal.quantities):
            raise ConfigError(f"search: {goal.name}", text, f"a quantity of the machine {STATIC}: {REST}")
