"""Notes that a user sees once when a run starts."""

from collections.abc import Mapping
from typing import Any

from facegear.config.buildable import preloads
from facegear.config.checks import geometric_backlash
from facegear.config.machine_layout import lumped_sections
from facegear.config.plausibility import plausibility_notes
from facegear.config.tooth_pair import ToothPair
from facegear.geometry.design import BACKLASH_DIFFERS_UM

PRINTED_NOTE = (
    "transmission.mesh_kinematics = printed: equation (13) of the source paper to the letter, to compare "
    "with it; lever arms, signs of the lower meshes and back flanks are not a gearbox's "
    "(docs/explanation/theory.md)"
)
SLOW = (
    "transmission: runouts and cumulative pitch deviations enter the hunting cycle, at rest and running, and "
    "the vibration at the orders of turns; steady states and sweeps leave them out "
    "(docs/explanation/theory.md)"
)
EXTERNAL = (
    "transmission: external forces on {} act at rest and in motion, the same at every speed and torque of a "
    "duty cycle"
)
UNREPEATED = (
    "transmission.excitations: {} do not repeat with the mesh; the vibration at the orders of turns has them "
    "(dynamics/excited.csv), and motion in time refuses them"
)
WITHOUT_FRICTION = (
    "lubrication.friction.effect = excitation: {} leave out how friction disturbs the motion; loss, "
    "temperature and film of samples are those of the forces without it (docs/explanation/friction.md)"
)

AS_ASSEMBLED = (
    "transmission.operating_pose = static: friction, loss, temperature and film take the contact of teeth as "
    "assembled (docs/explanation/poses.md)"
)
SINGLE_TEETH = (
    "{}: deviations of single teeth enter the hunting cycle, at rest and running, duty loads, and the "
    "vibration at the orders of turns (dynamics/shaft_orders.csv); steady states, sweeps, branches, samples "
    "and designs take the mean flank (docs/how_to/measured_flanks.md)"
)


def notes(values: Mapping[str, Any]) -> list[str]:
    """Return the notes on a config that a user sees once when a run starts.

    There is a note for a config of one's own with the kinematics of the publication, for errors that turn,
    for dynamics with a backlash other than that of the teeth, for preloads and external forces, for periodic
    torques that do not repeat with the mesh, for numbers that several causes move, for friction that samples
    and designs leave out of their motion, for friction of teeth as assembled beside an operating pose, for
    single teeth, and for values far from their usual size.

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
        + _without_friction(values)
        + [AS_ASSEMBLED] * (transmission["operating_pose"] == "static" and bool(values.get("lubrication")))
        + _single_teeth(values)
        + implausible
    )


def _without_friction(values: Mapping[str, Any]) -> list[str]:
    """Samples of tolerances and designs where friction disturbs the motion of the machine itself."""
    oil = values.get("lubrication")
    if not oil or oil["friction"]["effect"] == "loss_only":
        return []
    section_words = {"tolerances": "samples of tolerances", "search": "designs of the search"}
    left = [words for section, words in section_words.items() if values.get(section)]
    return [WITHOUT_FRICTION.format(" and ".join(left))] if left else []


def _single_teeth(values: Mapping[str, Any]) -> list[str]:
    """Gears with deviations of single teeth."""
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
    """Pinions and meshes that errors press together at rest: bearings and teeth give, and carry that load."""
    if "tooth_pair" not in values or values["transmission"].get("backlash_um") is None:
        return []
    lines = preloads(*lumped_sections(values["transmission"], values["tooth_pair"]))
    return [f"{line}: preloaded at rest, carried by bearings and teeth at any torque" for line in lines]


def _pushes(transmission: Mapping[str, Any]) -> list[str]:
    """Bodies with an external force."""
    singles = {**transmission["single_pinions"], **transmission["single_gears"]}
    bodies = [
        name for name, single_part in singles.items() if any((single_part.get("force_n") or {}).values())
    ]
    return [EXTERNAL.format(", ".join(bodies))] if bodies else []


def _unrepeated(values: Mapping[str, Any]) -> list[str]:
    """Periodic torques that no mesh harmonic has."""
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
    """Numbers that several causes of the tolerances move: as in a chain of tolerances, or by mistake."""
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
    """Whether a body has a runout or a curve of cumulative pitch deviations.

    Parameters
    ----------
    transmission : Mapping[str, Any]
        Plain values of section `transmission`.

    Returns
    -------
    bool
        True if one has.
    """
    singles = (*transmission["single_pinions"].values(), *transmission["single_gears"].values())
    bodies = (transmission["pinion"], transmission["face_gear"], *singles)
    return any(body.get("runout") or body.get("cumulative_pitch_um") for body in bodies)


def _backlash(values: Mapping[str, Any]) -> list[str]:
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
