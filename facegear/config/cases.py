"""The cases of a config: the machine itself, and one case for every point of every study."""

import itertools
import re
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from facegear.config.base import parse, suggestion
from facegear.config.model import Config, resolved
from facegear.config.studies import Study, StudyPoint
from facegear.errors import ConfigError, ConfigErrors

MANY = 3
"""Numbers of a key from which a curve is drawn over them."""


def expand_cases(config: Config) -> dict[str, dict[str, Any]]:
    """Case id -> plain values of a config with what follows from other keys filled in; its own case first.

    A study's case has the id `<case>/studies/<study>/<point>`. Raises ConfigErrors naming study and point.
    """
    base = config.model_dump(mode="json")
    cases = {config.case: resolved(config)}
    for study in config.studies:
        for name, point in study_points(study).items():
            where = f"studies.{study.name}.{name}"
            changed = changed_values(base, point.set, where)
            cases[f"{config.case}/studies/{study.name}/{name}"] = changed
    return {case: {**changed, "case": case} for case, changed in cases.items()}


def changed_values(base: Mapping[str, Any], changes: Mapping[str, Any], where: str) -> dict[str, Any]:
    """`changed_config` with what follows from other keys filled in."""
    return resolved(changed_config(base, changes, where))


def changed_config(base: Mapping[str, Any], changes: Mapping[str, Any], where: str) -> Config:
    """The machine of a config with some dotted keys changed; without studies and reproduction.

    Raises ConfigErrors, led by `where`, for a key that does not stand in the config and a value it refuses.
    """
    changed, lines = deepcopy({**base, "studies": [], "reproduction": None}), []
    before: list[str] = []
    for key, value in changes.items():
        lost = [earlier for earlier in before if earlier.startswith(f"{key}.")]
        before.append(key)
        if lost:
            lines.append(f"{lost[0]}: must come after {key}, which holds it, or its value would be lost")
        try:
            set_key(changed, key, value)
        except ConfigError as error:
            lines.append(str(error))
    if lines:
        raise ConfigErrors(where, lines)
    if "mesh_stiffness.csv" in changes:
        changed["mesh_stiffness"]["table"] = []
    for body in ("pinion", "face_gear"):
        if f"tooth_pair.{body}.flanks.file" in changes:
            changed["tooth_pair"][body]["flanks"]["grids"] = []
    return parse(Config, changed, source=where)


def study_points(study: Study) -> dict[str, StudyPoint]:
    """Folder name -> label and keys it sets, for the product of the study's axes."""
    points: dict[str, StudyPoint] = {}
    for combination in itertools.product(*(axis.resolved() for axis in study.axes)):
        labels = [
            f"{axis.label} = {point.label}" if axis.key else point.label
            for axis, point in zip(study.axes, combination, strict=True)
        ]
        name = "__".join(folder_name(point.label) for point in combination)
        if name in points:
            raise ConfigErrors("studies", [f"{study.name}: two points are both called {name!r}"])
        points[name] = StudyPoint(
            label=", ".join(labels),
            set={key: value for point in combination for key, value in point.set.items()},
        )
    return points


@dataclass(frozen=True)
class NumberedStudy:
    """A study with an axis of numbers: the dotted key that they belong to, the axis' label, and of each point
    by its folder name its number and the label of its point on the other axis.
    """

    key: str
    label: str
    points: Mapping[str, tuple[float, str]]


def numbered(study: Study) -> NumberedStudy | None:
    """The first axis on which at least MANY points set a key to different numbers, if there is one."""
    for number, axis in enumerate(study.axes):
        numbers = axis.numbers()
        if not numbers or len(axis.resolved()) < MANY:
            continue
        key, values = next(iter(numbers.items()))
        combinations = itertools.product(*(range(len(other.resolved())) for other in study.axes))
        points = {
            name: (float(values[chosen[number]]), _others(study, number, chosen))
            for name, chosen in zip(study_points(study), combinations, strict=True)
        }
        return NumberedStudy(key, axis.label, points)
    return None


def _others(study: Study, left_out: int, chosen: Sequence[int]) -> str:
    """Label of a point on the axis beside the one that is left out."""
    parts = [
        f"{axis.label} = {axis.resolved()[point].label}" if axis.key else axis.resolved()[point].label
        for position, (axis, point) in enumerate(zip(study.axes, chosen, strict=True))
        if position != left_out
    ]
    return ", ".join(parts)


def set_key(values: dict[str, Any], key: str, value: Any) -> None:
    """Set a dotted key (list positions as numbers). Raises ConfigError if it does not stand in `values`."""
    *sections, last = key.split(".")
    inside: Any = values
    for depth, part in enumerate(sections):
        inside = inside[_position(inside, part, key, value, sections[:depth])]
    inside[_position(inside, last, key, value, sections)] = value


FIXED = ("case", "studies", "reproduction")
"""Keys that no change of a config may touch."""


def _position(inside: Any, part: str, key: str, value: Any, before: Sequence[str]) -> str | int:
    """Key or list position of a part of a dotted key, behind the parts `before` it. Raises ConfigError."""
    if isinstance(inside, dict) and part in inside and (before or part not in FIXED):
        return part
    if isinstance(inside, list) and part.isdecimal() and int(part) < len(inside):
        return int(part)
    allowed = f"a dotted key of the config, but not {', '.join(FIXED[:-1])} or {FIXED[-1]}"
    where = ".".join(before)
    if inside is None:
        allowed += f"; {where} is null, set it as a whole"
    elif isinstance(inside, list):
        allowed += f"; {where} has the positions 0 to {len(inside) - 1}" if inside else f"; {where} is empty"
    elif isinstance(inside, dict) and part not in FIXED:
        allowed += f"; {suggestion(part, [name for name in inside if before or name not in FIXED])}"
    raise ConfigError(key, value, allowed)


def folder_name(label: str) -> str:
    """A label as the name of a folder: lower case words joined by underscores."""
    return re.sub(r"[^a-z0-9]+", "_", label.lower().replace(".", "p")).strip("_") or "point"
