"""Whether the machine of a config can be put together, and notes that a user sees once."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from facegear.build.casing import misplaced_seats
from facegear.build.checks import geometric_backlash
from facegear.build.lumped_model import LumpedParts, half_backlash, lumped_parts
from facegear.build.machine_layout import layout, lumped_sections
from facegear.build.tooth_numbers import ToothNumbers
from facegear.build.tooth_pair import ToothPair
from facegear.errors import ConfigError
from facegear.machine.assembly import Assembly, assembly, interference_depths
from facegear.machine.layout import Layout
from facegear.schema.bodies import SingleGear, SinglePinion
from facegear.schema.plausibility import plausibility_notes
from facegear.schema.transmission import Transmission
from facegear.teeth.design import BACKLASH_DIFFERS_UM

NO_PUSH = 1e-12
"""Axial part of a flank's normal that is rounding."""


def require_buildable(section: Transmission, teeth: ToothNumbers, model: LumpedParts | None = None) -> None:
    """Raise ConfigError for a machine that cannot be put together.

    Manufacturing errors by which flanks or bearings are pressed together at rest are allowed, as bearings
    give way; `preloads` lists them and `require_room` refuses them.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.
    model : LumpedParts or None
        Result of `lumped_parts(section, teeth)`, computed here if None.

    Raises
    ------
    ConfigError
        If teeth do not fit, a pitch curve belongs to other tooth numbers, or no bearing holds a force.
    """
    shape, flaws = model or lumped_parts(section, teeth)
    for key, single_parts, count in (
        ("single_pinions", section.single_pinions, teeth.pinion_teeth),
        ("single_gears", section.single_gears, teeth.gear_teeth),
    ):
        for name, single_part in single_parts.items():
            given_count = len(single_part.cumulative_pitch_um)
            if given_count not in (0, count):
                pitch_key = f"transmission.{key}.{name}.cumulative_pitch_um"
                raise ConfigError(pitch_key, f"{given_count} values", f"one for each of the {count} teeth")
    bodies: dict[str, SinglePinion | SingleGear] = {**section.single_pinions, **section.single_gears}
    for name, body in bodies.items():
        _require_hold(shape, name, body)
    _require_axial_bearings(section, shape)
    _require_assembly(section, shape, assembly(shape, half_backlash(section, shape), flaws.clocking))


def require_room(section: Transmission, teeth: ToothNumbers, model: LumpedParts | None = None) -> None:
    """Raise ConfigError for a machine whose errors take up all backlash and clearance, so that it is
    pressed together at rest.

    Samples and designs are checked by it; a config of its own only gets a note, see `preloads`.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.
    model : LumpedParts or None
        Result of `lumped_parts(section, teeth)`, computed here if None.

    Raises
    ------
    ConfigError
        For the first pinion or mesh that is pressed together.
    """
    for key, amount, requirement in _find_preloads(section, model or lumped_parts(section, teeth)):
        raise ConfigError(key, amount, requirement)


def preloads(section: Transmission, teeth: ToothNumbers) -> list[str]:
    """List the pinions and meshes whose errors exceed backlash and clearance, so that they are pressed
    together.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.

    Returns
    -------
    list[str]
        One line each with key and amount: misfit between the two meshes of a pinion, or depth in a mesh,
        um.
    """
    return [f"{key}: {amount}" for key, amount, _ in _find_preloads(section, lumped_parts(section, teeth))]


def _require_hold(shape: Layout, name: str, single_part: SinglePinion | SingleGear) -> None:
    """Raise ConfigError for an external force on a body along an axis in which its bearing has no
    stiffness.

    `name` is the name of a pinion, or `lower` or `upper`; `single_part` is its section with the force.
    """
    key = "single_pinions" if isinstance(single_part, SinglePinion) else "single_gears"
    names = [pinion.name for pinion in shape.pinions] + [gear.side.value for gear in shape.gears]
    bearing = shape.bodies[names.index(name)].bearing
    for axis, force in single_part.force_n:
        if force != 0.0 and bearing["xyz".index(axis)] == 0.0:
            requirement = f"0, as the bearing has no stiffness along {axis}"
            raise ConfigError(f"transmission.{key}.{name}.force_n.{axis}", force, requirement)


def _require_axial_bearings(section: Transmission, shape: Layout) -> None:
    """Raise ConfigError for a pinion that its teeth push along its axis and that no bearing holds there."""
    axial = max(abs(frame.normal[2]) for frames in shape.flank_frames for frame in frames)
    for pinion in shape.pinions:
        if axial > NO_PUSH and pinion.body.bearing[2] == 0.0:
            single = section.single_pinions.get(pinion.name)
            has_bearing = single is not None and single.bearing_stiffness_n_per_m is not None
            part = f"single_pinions.{pinion.name}" if has_bearing else "pinion"
            requirement = "positive, as helical or tapered teeth push the pinion along its axis"
            raise ConfigError(f"transmission.{part}.bearing_stiffness_n_per_m.z", 0.0, requirement)


def _require_assembly(section: Transmission, shape: Layout, fit: Assembly) -> None:
    """Raise ConfigError for the first pinion whose teeth do not fit both face gears at its angle.

    `fit` says how much of the misfit the backlash takes up, and the nearest angles without misfit.
    """
    for i in np.flatnonzero(~fit.fits):
        pinion = section.pinions[i]
        key, unit = (
            ("angle_deg", 360.0 / shape.gear_teeth)
            if pinion.angle_pitches is None
            else ("angle_pitches", 1.0)
        )
        value = pinion.angle_deg if pinion.angle_pitches is None else pinion.angle_pitches
        requirement = (
            f"where the teeth fit, such as {fit.below[i] * unit:.6g} and {fit.above[i] * unit:.6g} "
            f"(or clocking_deg): {1e6 * fit.misfit[i]:.0f} um are left between this pinion's meshes and "
            f"their backlash takes up {1e6 * fit.clearance[i]:.0f} um"
        )
        raise ConfigError(f"transmission.pinions[{i}].{key}", value, requirement)


def _find_preloads(section: Transmission, model: LumpedParts) -> Iterator[tuple[str, str, str]]:
    """Yield key, amount and requirement, as texts, of all pinions and meshes pressed together at rest.

    First come pinions whose two meshes do not fit with their errors, then meshes in which a pinion stands
    deeper than backlash and bearing clearance allow.
    """
    shape, flaws = model
    half = half_backlash(section, shape)
    fit = assembly(shape, half, flaws.clocking, flaws)
    for i in np.flatnonzero(~fit.fits):
        requirement = (
            f"errors of this pinion and its meshes within the {1e6 * fit.clearance[i]:.0f} um they leave"
        )
        amount = f"{1e6 * fit.misfit[i]:.0f} um between its two meshes"
        yield f"transmission.single_pinions.{shape.pinions[i].name}", amount, requirement
    squeeze = interference_depths(shape, half, flaws)
    for mesh in np.flatnonzero(squeeze > 0.0):
        pinion = shape.pinions[shape.meshes[mesh][0]].name
        amount = f"{1e6 * squeeze[mesh]:.1f} um too deep in {shape.mesh_names[mesh]}"
        requirement = "within backlash and clearance, or the pinion jams"
        yield f"transmission.single_pinions.{pinion}.position_um.y", amount, requirement


PRINTED_NOTE = (
    "transmission.mesh_kinematics = printed: equation (13) of the source paper to the letter, to compare "
    "with it; lever arms, signs of the lower meshes and back flanks are not a gearbox's "
    "(docs/explanation/theory.md)"
)
"""Note on printed kinematics."""
SLOW = (
    "transmission: runouts and cumulative pitch deviations enter the hunting cycle, at rest and running, and "
    "the vibration at the orders of turns; steady states and sweeps leave them out "
    "(docs/explanation/theory.md)"
)
"""Note on errors that turn slowly, and which results have them."""
EXTERNAL = (
    "transmission: external forces on {} act at rest and in motion, the same at every speed and torque of a "
    "duty cycle"
)
"""Note on external forces; the bodies are filled in."""
UNREPEATED = (
    "transmission.excitations: {} do not repeat with the mesh; the vibration at the orders of turns has them "
    "(dynamics/excited.csv), and motion in time refuses them"
)
"""Note on excitations that do not repeat with the mesh; their names are filled in."""
WITHOUT_FRICTION = (
    "lubrication.friction.effect = excitation: {} leave out how friction disturbs the motion; loss, "
    "temperature and film of samples are those of the forces without it (docs/explanation/friction.md)"
)
"""Note on results that leave out how friction disturbs the motion; their names are filled in."""

AS_ASSEMBLED = (
    "transmission.operating_pose = static: friction, loss, temperature and film take the contact of teeth as "
    "assembled (docs/explanation/poses.md)"
)
"""Note on friction, which takes the contact of teeth as assembled."""
SINGLE_TEETH = (
    "{}: deviations of single teeth enter the hunting cycle, at rest and running, duty loads, and the "
    "vibration at the orders of turns (dynamics/shaft_orders.csv); steady states, sweeps, branches, samples "
    "and designs take the mean flank (docs/how_to/measured_flanks.md)"
)
"""Note on deviations of single teeth, and which results have them; the keys are filled in."""


def notes(values: Mapping[str, Any]) -> list[str]:
    """Return the notes on a config that a user sees once when a run starts.

    There is a note for a config that reproduces nothing but has the kinematics of the publication, for
    errors that turn, for dynamics with a backlash other than that of the teeth, for preloads and external
    forces, for periodic torques that do not repeat with the mesh, for numbers that several causes move,
    for seats of a casing far from what they carry, for friction that samples and designs leave out of
    their motion, for friction of teeth as assembled beside an operating pose, for single teeth, and for
    values far from their usual size.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of a whole config.

    Returns
    -------
    list[str]
        One line for each note.
    """
    transmission = values["transmission"]
    implausible = plausibility_notes(values)
    if transmission is None:
        return implausible
    is_printed = values["reproduction"] is None and transmission["mesh_kinematics"] == "printed"
    return (
        [PRINTED_NOTE] * is_printed
        + [SLOW] * turns(transmission)
        + _backlash(values)
        + _preloads(values)
        + _pushes(transmission)
        + _unrepeated(values)
        + _sums(values)
        + _seats(values)
        + _without_friction(values)
        + [AS_ASSEMBLED] * (transmission["operating_pose"] == "static" and bool(values.get("lubrication")))
        + _single_teeth(values)
        + implausible
    )


def _without_friction(values: Mapping[str, Any]) -> list[str]:
    """Return at most one note: samples or designs leave out how friction disturbs the motion."""
    oil = values.get("lubrication")
    if not oil or oil["friction"]["effect"] == "loss_only":
        return []
    section_words = {"tolerances": "samples of tolerances", "search": "designs of the search"}
    left = [words for section, words in section_words.items() if values.get(section)]
    return [WITHOUT_FRICTION.format(" and ".join(left))] if left else []


def _single_teeth(values: Mapping[str, Any]) -> list[str]:
    """Return at most one note that names the gears with measured deviations of single teeth."""
    pair = values.get("tooth_pair") or {}
    keys = [
        f"tooth_pair.{gear}.flanks"
        for gear in ("pinion", "face_gear")
        if any(
            grid["tooth"] is not None
            for grid in ((pair.get(gear) or {}).get("flanks") or {}).get("grids", ())
        )
    ]
    return [SINGLE_TEETH.format(" and ".join(keys))] if keys else []


def _preloads(values: Mapping[str, Any]) -> list[str]:
    """Return a note for each pinion and mesh that errors press together at rest.

    Bearings and teeth give, and carry that load beside the torque.
    """
    if "tooth_pair" not in values or values["transmission"].get("backlash_um") is None:
        return []
    lines = preloads(*lumped_sections(values["transmission"], values["tooth_pair"]))
    return [f"{line}: preloaded at rest, carried by bearings and teeth at any torque" for line in lines]


def _seats(values: Mapping[str, Any]) -> list[str]:
    """Return a note for each seat of the casing that stands far from what it carries; none where the files
    of the casing are gone, as where stored results are shown.
    """
    if values["transmission"].get("casing") is None or "tooth_pair" not in values:
        return []
    section, teeth = lumped_sections(values["transmission"], values["tooth_pair"])
    try:
        return misplaced_seats(section, layout(section, teeth))
    except (ConfigError, OSError):
        return []


def _pushes(transmission: Mapping[str, Any]) -> list[str]:
    """Return at most one note that names the bodies with an external force."""
    singles = {**transmission["single_pinions"], **transmission["single_gears"]}
    bodies = [
        name for name, single_part in singles.items() if any((single_part.get("force_n") or {}).values())
    ]
    return [EXTERNAL.format(", ".join(bodies))] if bodies else []


def _unrepeated(values: Mapping[str, Any]) -> list[str]:
    """Return at most one note that names the periodic torques which do not repeat with the mesh."""
    transmission = values["transmission"]
    if not transmission["excitations"]:
        return []
    teeth = values["tooth_pair"]
    pinions = [pinion["name"] for pinion in transmission["pinions"]]
    names = [
        f"order {torque['order']:g} of {torque['body']}"
        for torque in transmission["excitations"]
        if torque["order"] % teeth["pinion_teeth" if torque["body"] in pinions else "face_gear_teeth"]
    ]
    return [UNREPEATED.format(", ".join(names))] if names else []


def _sums(values: Mapping[str, Any]) -> list[str]:
    """Return a note for each key that several causes of section `tolerances` move: their changes are
    added.
    """
    causes = (values.get("tolerances") or {}).get("causes", ())
    movers: dict[str, list[str]] = {}
    for cause in causes:
        for key in cause["moves"]:
            movers.setdefault(key, []).append(cause["name"])
    return [
        f"tolerances.causes: {' and '.join(names)} all move {key}: what they add is summed"
        for key, names in movers.items()
        if len(names) > 1
    ]


def turns(transmission: Mapping[str, Any]) -> bool:
    """Whether any body has a runout or cumulative pitch deviations, errors that repeat with its turns.

    Parameters
    ----------
    transmission : Mapping[str, Any]
        Plain values of section `transmission`.

    Returns
    -------
    bool
        True if at least one has.
    """
    singles = (*transmission["single_pinions"].values(), *transmission["single_gears"].values())
    bodies = (transmission["pinion"], transmission["face_gear"], *singles)
    return any(body.get("runout") or body.get("cumulative_pitch_um") for body in bodies)


def _backlash(values: Mapping[str, Any]) -> list[str]:
    """Return at most one note: the given backlash differs from that of the teeth by over
    BACKLASH_DIFFERS_UM.
    """
    backlash_um = values["transmission"].get("backlash_um")
    if backlash_um is None or values.get("tooth_pair", {}).get("pinion") is None:
        return []
    teeth = geometric_backlash(ToothPair.of_config(values["tooth_pair"]))
    if abs(backlash_um - teeth) <= BACKLASH_DIFFERS_UM:
        return []
    return [
        f"transmission.backlash_um = {backlash_um:g}: the teeth as assembled have {teeth:.1f} um; "
        "without the key the dynamics take theirs"
    ]
