"""The cases of a config with some of its keys changed: the machine itself and every study's points."""

import hashlib
import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from facegear.build.cases import expand_cases, folder_name, set_key
from facegear.build.config import Config
from facegear.schema.base import parse

DECISIVE = (
    *("tooth_pair", "mesh", "contact", "mesh_stiffness"),
    *("transmission", "dynamics", "load_sharing"),
)
"""Config sections on which the dynamics of a case depends."""

Cases = tuple[dict[str, Any], dict[tuple[str, str], dict[str, Any]]]
"""Plain config values of the machine, and of each (study, point)."""
PointChanges = Mapping[tuple[str, str], Mapping[str, Any]]
"""Dotted keys and values of some (study, point)."""


def changed_cases(
    values: Mapping[str, Any],
    changes: Mapping[str, Any],
    points: PointChanges = MappingProxyType({}),
) -> Cases:
    """Return the cases of a config with dotted keys set to new values.

    A study's own keys come after them, and `points` puts other values in their place.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of the config.
    changes : Mapping[str, Any]
        New values by dotted key.
    points : PointChanges
        New values of points of studies.

    Returns
    -------
    Cases
        Cases of the machine and of each (study, point).

    Raises
    ------
    ConfigErrors
        For a value that the config refuses.
    """
    new_values = json.loads(json.dumps({**values, "reproduction": None}))
    for key, value in changes.items():
        set_key(new_values, key, value)
    for study in new_values["studies"]:
        for point in (point for axis in study["axes"] for point in axis["points"]):
            point["set"].update(points.get((study["name"], folder_name(point["label"])), {}))
    cases = expand_cases(parse(Config, new_values))
    base = cases.pop(new_values["case"])
    return base, {_study_and_point(case): case_values for case, case_values in cases.items()}


def settings_key(base: Mapping[str, Any], points: Mapping[tuple[str, str], Mapping[str, Any]]) -> str:
    """Return a text that differs if a key on which the dynamics of a case or of its studies depends does.

    Keys left at their defaults do not count, nor those that decide no result: chunks of the sweep.

    Parameters
    ----------
    base : Mapping[str, Any]
        Plain values of the machine.
    points : Mapping[tuple[str, str], Mapping[str, Any]]
        Plain values of each (study, point).

    Returns
    -------
    str
        The first 16 digits of a SHA-256 sum.
    """
    text = json.dumps([_decisive(values) for values in (base, *points.values())], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _decisive(values: Mapping[str, Any]) -> dict[str, Any]:
    """Select the values of a case that decide its dynamics, without those at their defaults."""
    case = json.loads(json.dumps({**values, "case": "any"}))
    case["dynamics"]["sweep"]["chunks"] = 1
    case["mesh"]["thin_fillet"] = case["mesh"]["thin_fillet"] or None  # false is filled in where null stood
    return parse(Config, case).model_dump(mode="json", exclude_defaults=True, include=set(DECISIVE))


def _study_and_point(case: str) -> tuple[str, str]:
    study, point = case.split("/")[-2:]
    return study, point
