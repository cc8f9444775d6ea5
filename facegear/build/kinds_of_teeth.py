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

SPUR_ONLY: Mapping[str, tuple[str, ...]] = {}
"""Keys of section `tooth_pair` that a stage cannot take yet, by its name."""


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


def refused_moves(names: Iterable[str], values: Mapping[str, Any]) -> list[ConfigError]:
    """Find samples and designs with teeth of a kind that their stage cannot take yet.

    Parameters
    ----------
    names : iterable of str
        Names of stages.
    values : mapping
        Plain values of a whole config.

    Returns
    -------
    list of ConfigError
        An error, not raised, for each moved key, with the key of the config that names it.
    """
    stages, errors = set(names), []
    for key, stage, moved_keys in (
        ("tolerances.causes.moves", "tolerances_chunk", _moved_by(values, "tolerances", "causes", "moves")),
        ("search.variables.sets", "search_island", _moved_by(values, "search", "variables", "sets")),
    ):
        # teeth that vary have a contact of their own, which their stage solves itself
        kinds = {kind for name in (stage, "compliance", "contact") for kind in SPUR_ONLY.get(name, ())}
        refused_paths = {f"{PAIR}{kind}" for kind in kinds - {FLANKS}}
        if FLANKS in kinds:
            refused_paths |= {f"{PAIR}{FLANKS}.{flank}" for flank in ("drive", "coast")}
        requirement = f"another key, as stage {stage} cannot take such teeth yet"
        if stage in stages:
            errors += [ConfigError(key, path, requirement) for path in moved_keys if path in refused_paths]
    return errors


def _moved_by(values: Mapping[str, Any], section: str, items: str, moves: str) -> list[str]:
    """Return the dotted keys that a section's items move, each once; none without the section."""
    section_items = (values[section] or {}).get(items, ())
    return list(dict.fromkeys(key for item in section_items for key in item[moves]))


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
