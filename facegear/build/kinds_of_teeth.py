"""Stages that take spur teeth alone so far, and their refusal of all other kinds before any work.

Teeth that are helical, tapered or asymmetric, and pinions that stand elsewhere than above the middle of the
gear's face at 90 degrees, never go into formulas of spur teeth in silence: a stage that is not in SPUR_ONLY
takes them all.
"""

from collections.abc import Iterable, Mapping
from typing import Any

from facegear.errors import ConfigError
from facegear.number_format import count_noun
from facegear.schema.changes import PAIR
from facegear.schema.tooth_pair import flank_angles_deg

SPUR_VALUES: Mapping[str, float] = {
    "helix_angle_deg": 0.0,
    "taper_angle_deg": 0.0,
    "shaft_angle_deg": 90.0,
    "offset_mm": 0.0,
    "assembly.pinion_axial_um": 0.0,
}
"""Values of spur teeth in their usual place, by key of section `tooth_pair`, in the unit of the key."""
FLANKS, MIDDLE = "pressure_angle_deg", "pinion.middle_mm"
"""Keys of section `tooth_pair` whose value of spur teeth depends on others."""
ALL_KINDS = (*SPUR_VALUES, FLANKS, MIDDLE)
"""Keys of section `tooth_pair` that make teeth other than spur ones, or stand the pinion elsewhere."""

SPUR_ONLY: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(("compliance",), ALL_KINDS),
    **dict.fromkeys(("contact", "tooth_errors", "mesh_law", "pose_surface", "displaced_contact"), ALL_KINDS),
    **dict.fromkeys(("root_stress", "posed_stress", "rating"), ALL_KINDS),
    **dict.fromkeys(("dynamic_root_stress", "stress_over_speed"), ALL_KINDS),
    **dict.fromkeys(("lubrication", "machine_loss"), ALL_KINDS),
    **dict.fromkeys(("gear_bodies", "gear_waves", "operating_pose"), ALL_KINDS),
    **dict.fromkeys(("sharing_map", "duty_poses"), ALL_KINDS),
}
"""Keys of section `tooth_pair` that a stage, or an answer from Python, cannot take yet, by its name."""


def refused_keys(names: Iterable[str], pair: Mapping[str, Any]) -> dict[str, ConfigError]:
    """Find the stages that cannot take the teeth of a pair yet.

    Parameters
    ----------
    names : iterable of str
        Names of stages.
    pair : mapping
        Plain values of section `tooth_pair`, defaults included.

    Returns
    -------
    dict[str, ConfigError]
        For each key that a stage refuses, by its dotted key: the error, not raised, which names the first
        such stage.
    """
    refusing: dict[str, list[str]] = {}
    unlike = _unlike_spur(pair)
    for name in names:
        for key in SPUR_ONLY.get(name, ()):
            if key in unlike:
                refusing.setdefault(key, []).append(name)
    return {
        key: ConfigError(
            f"tooth_pair.{key}",
            unlike[key][0],
            f"{unlike[key][1]}, as stage {stages[0]} cannot take other teeth yet"
            + (f", nor can {count_noun(len(stages) - 1, 'more stage')}" if stages[1:] else ""),
        )
        for key, stages in refusing.items()
    }


def require_kind(names: Iterable[str], pair: Mapping[str, Any]) -> None:
    """Refuse teeth of a kind that one of the stages cannot take yet.

    Parameters
    ----------
    names : iterable of str
        Names of stages, or of answers in SPUR_ONLY.
    pair : mapping
        Plain values of section `tooth_pair`, defaults included.

    Raises
    ------
    ConfigError
        With the first such key, its value, what is allowed, and the stages that refuse it.
    """
    for error in refused_keys(names, pair).values():
        raise error


def require_moved_kind(key: str, moved_keys: Iterable[str], stage: str) -> None:
    """Refuse samples or designs with teeth of a kind that their stage cannot take yet.

    Parameters
    ----------
    key : str
        Key of the config that names the moved keys.
    moved_keys : iterable of str
        Dotted keys of the config that differ from sample to sample, or design to design.
    stage : str
        Name of the stage that computes them.

    Raises
    ------
    ConfigError
        For the first such key.
    """
    kinds = {f"{PAIR}{kind}" for kind in SPUR_ONLY.get(stage, ()) if kind != FLANKS}
    if FLANKS in SPUR_ONLY.get(stage, ()):
        kinds |= {f"{PAIR}{FLANKS}.{flank}" for flank in ("drive", "coast")}
    for moved_key in moved_keys:
        if moved_key in kinds:
            raise ConfigError(key, moved_key, f"another key, as stage {stage} cannot take such teeth yet")


def _unlike_spur(pair: Mapping[str, Any]) -> dict[str, tuple[Any, str]]:
    """Return value and requirement of each key of ALL_KINDS that has another value than spur teeth."""
    unlike: dict[str, tuple[Any, str]] = {}
    for key, spur_value in SPUR_VALUES.items():
        value: Any = pair
        for part in key.split("."):
            value = value[part]
        if value != spur_value:
            unlike[key] = value, f"{spur_value:g}"
    drive, coast = flank_angles_deg(pair[FLANKS])
    if drive != coast:
        unlike[FLANKS] = pair[FLANKS], "one number for both flanks"
    middle, gear = (pair["pinion"] or {}).get("middle_mm"), pair["face_gear"]
    if middle is not None and gear is not None:
        mean = 0.5 * (gear["inner_radius_mm"] + gear["outer_radius_mm"])
        if middle != mean:
            unlike[MIDDLE] = middle, f"null or {mean:g}"
    return unlike
