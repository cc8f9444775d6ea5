"""The cases of a config: the machine itself, and one case for every point of every study."""

import itertools
import re
from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from facegear.config.base import parse
from facegear.config.model import Config, resolved
from facegear.config.studies import Point, Study
from facegear.errors import ConfigError, ConfigErrors


def expand_cases(values: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Case id -> validated plain config values; the first is the config's own case.

    A study's case has the id `<case>/studies/<study>/<point>`. Raises ConfigErrors naming study and point.
    """
    base = dict(values)
    cases = {base["case"]: resolved(parse(Config, base))}
    for study in base["studies"]:
        for name, point in study_points(parse(Study, study)).items():
            where = f"studies.{study['name']}.{name}"
            changed = changed_values(base, point.set, where)
            cases[f"{base['case']}/studies/{study['name']}/{name}"] = changed
    return {case: {**changed, "case": case} for case, changed in cases.items()}


def changed_values(base: Mapping[str, Any], changes: Mapping[str, Any], where: str) -> dict[str, Any]:
    """`changed_config` with what follows from other keys filled in."""
    return resolved(changed_config(base, changes, where))


def changed_config(base: Mapping[str, Any], changes: Mapping[str, Any], where: str) -> Config:
    """The machine of a config with some dotted keys changed; without studies and reproduction.

    Raises ConfigErrors, led by `where`, for a key that does not stand in the config and a value it refuses.
    """
    changed = deepcopy({**base, "studies": [], "reproduction": None})
    try:
        for key, value in changes.items():
            set_key(changed, key, value)
        if "mesh_stiffness.csv" in changes:
            changed["mesh_stiffness"]["table"] = []
    except ConfigError as error:
        raise ConfigErrors(where, [str(error)]) from None
    return parse(Config, changed, source=where)


def study_points(study: Study) -> dict[str, Point]:
    """Folder name -> label and keys it sets, for the product of the study's axes."""
    points: dict[str, Point] = {}
    for combination in itertools.product(*(axis.resolved() for axis in study.axes)):
        told = [
            f"{axis.label} = {point.label}" if axis.key else point.label
            for axis, point in zip(study.axes, combination, strict=True)
        ]
        name = "__".join(folder_name(point.label) for point in combination)
        if name in points:
            raise ConfigErrors("studies", [f"{study.name}: two points are both called {name!r}"])
        points[name] = Point(
            label=", ".join(told),
            set={key: value for point in combination for key, value in point.set.items()},
        )
    return points


def set_key(values: dict[str, Any], key: str, value: Any) -> None:
    """Set a dotted key (list positions as numbers). Raises ConfigError if it does not stand in `values`."""
    parts = key.split(".")
    inside: Any = values
    for part in parts[:-1]:
        inside = inside[_position(inside, part, key, value)]
    inside[_position(inside, parts[-1], key, value)] = value


def _position(inside: Any, part: str, key: str, value: Any) -> str | int:
    if isinstance(inside, dict) and part in inside and part not in ("case", "studies", "reproduction"):
        return part
    if isinstance(inside, list) and part.isdecimal() and int(part) < len(inside):
        return int(part)
    raise ConfigError(key, value, "a dotted key of the config, but not case, studies or reproduction")


def folder_name(label: str) -> str:
    """A label as the name of a folder: lower case words joined by underscores."""
    return re.sub(r"[^a-z0-9]+", "_", label.lower().replace(".", "p")).strip("_") or "point"
