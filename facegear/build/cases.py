"""The cases of a config: the machine itself, and one case for every point of every study."""

import itertools
import re
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from facegear.build.config import Config, resolved_values
from facegear.errors import ConfigError, ConfigErrors
from facegear.schema.base import parse, suggestion
from facegear.schema.studies import Study, StudyPoint

MIN_CURVE_POINTS = 3
"""Smallest number of points of a key from which a curve is drawn over them."""


def expand_cases(config: Config) -> dict[str, dict[str, Any]]:
    """Expand a config into its own case and one case for every point of every study.

    What follows from other keys is filled in. The config's own case has the id `config.case`, a study's
    case `<case>/studies/<study>/<point>`; key `case` of the values holds it.

    Parameters
    ----------
    config : Config
        The config.

    Returns
    -------
    dict[str, dict[str, Any]]
        Plain values of a config by case id, the config's own case first.

    Raises
    ------
    ConfigErrors
        With study and point of the values that are refused.
    """
    base = config.model_dump(mode="json")
    cases = {config.case: resolved_values(config)}
    for study in config.studies:
        for name, point in study_points(study).items():
            source = f"studies.{study.name}.{name}"
            values = changed_values(base, point.set, source)
            cases[f"{config.case}/studies/{study.name}/{name}"] = values
    return {case: {**values, "case": case} for case, values in cases.items()}


def changed_values(base: Mapping[str, Any], changes: Mapping[str, Any], source: str) -> dict[str, Any]:
    """Change dotted keys of a config, as `changed_config`, and fill in what follows from other keys.

    Parameters
    ----------
    base : Mapping[str, Any]
        Plain values of a whole config, as `Config.model_dump` gives them.
    changes : Mapping[str, Any]
        New values by dotted key, such as `transmission.damping.mass_per_s`.
    source : str
        What the error names as the origin of the changes.

    Returns
    -------
    dict[str, Any]
        Plain values of the new config.
    """
    return resolved_values(changed_config(base, changes, source))


def changed_config(base: Mapping[str, Any], changes: Mapping[str, Any], source: str) -> Config:
    """Change dotted keys of a config and validate the result; studies and reproduction are left out.

    A new file of a stiffness curve or of measured flanks replaces what was read from the old one.

    Parameters
    ----------
    base : Mapping[str, Any]
        Plain values of a whole config, as `Config.model_dump` gives them.
    changes : Mapping[str, Any]
        New values by dotted key; a section must come before keys inside it.
    source : str
        What the error names as the origin of the changes.

    Returns
    -------
    Config
        The validated config with the changes.

    Raises
    ------
    ConfigErrors
        For a key that does not stand in the config, and for a value that it refuses.
    """
    new_values, lines = deepcopy({**base, "studies": [], "reproduction": None}), []
    before: list[str] = []
    for key, value in changes.items():
        overwritten = [earlier for earlier in before if earlier.startswith(f"{key}.")]
        before.append(key)
        if overwritten:
            lines.append(
                f"{overwritten[0]}: must come after {key}, which holds it, or its value would be lost"
            )
        try:
            set_key(new_values, key, value)
        except ConfigError as error:
            lines.append(str(error))
    if lines:
        raise ConfigErrors(source, lines)
    if "mesh_stiffness.csv" in changes:
        new_values["mesh_stiffness"]["table"] = []
    for body in ("pinion", "face_gear"):
        if f"tooth_pair.{body}.flanks.file" in changes:
            new_values["tooth_pair"][body]["flanks"]["grids"] = []
    return parse(Config, new_values, source=source)


def study_points(study: Study) -> dict[str, StudyPoint]:
    """Return the points of a study: all combinations of the points of its axes.

    Parameters
    ----------
    study : Study
        Section of the study.

    Returns
    -------
    dict[str, StudyPoint]
        Label and new values by dotted key of each point, by the name of its folder: the labels of the
        combined points as words, joined by two underscores.

    Raises
    ------
    ConfigErrors
        If two points have the same folder name.
    """
    points: dict[str, StudyPoint] = {}
    for combination in itertools.product(*(axis.study_points() for axis in study.axes)):
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
    """A study with an axis of numbers.

    `key` is the dotted key that the numbers belong to, `label` the label of the axis. `points` holds for
    each point, by its folder name, its number and the label of its point on the other axis.
    """

    key: str
    label: str
    points: Mapping[str, tuple[float, str]]


def find_numeric_axis(study: Study) -> NumberedStudy | None:
    """Find the first axis of a study on which at least MIN_CURVE_POINTS points set a key to different
    numbers.

    Parameters
    ----------
    study : Study
        Section of the study.

    Returns
    -------
    NumberedStudy or None
        Key and label of that axis, and the number and the label on the other axes of every point of the
        study; None if there is no such axis.
    """
    for number, axis in enumerate(study.axes):
        numbers = axis.numbers()
        if not numbers or len(axis.study_points()) < MIN_CURVE_POINTS:
            continue
        key, values = next(iter(numbers.items()))
        combinations = itertools.product(
            *(range(len(study_axis.study_points())) for study_axis in study.axes)
        )
        points = {
            name: (float(values[combination[number]]), _other_axis_label(study, number, combination))
            for name, combination in zip(study_points(study), combinations, strict=True)
        }
        return NumberedStudy(key, axis.label, points)
    return None


def _other_axis_label(study: Study, left_out: int, combination: Sequence[int]) -> str:
    """Return the label of a point of a study on all its axes but one, joined by commas.

    `combination` has the index of its point on each axis, `left_out` the index of the axis left out.
    """
    parts = [
        f"{axis.label} = {axis.study_points()[point].label}" if axis.key else axis.study_points()[point].label
        for position, (axis, point) in enumerate(zip(study.axes, combination, strict=True))
        if position != left_out
    ]
    return ", ".join(parts)


def set_key(values: dict[str, Any], key: str, value: Any) -> None:
    """Set a dotted key that exists in nested values, in place.

    Parameters
    ----------
    values : dict[str, Any]
        Nested mappings and lists; written.
    key : str
        Dotted key, with list positions as numbers.
    value : Any
        New value.

    Raises
    ------
    ConfigError
        If the key does not exist in `values`, or is one of FIXED_KEYS.
    """
    *sections, last = key.split(".")
    inside: Any = values
    for depth, part in enumerate(sections):
        inside = inside[_position(inside, part, key, value, sections[:depth])]
    inside[_position(inside, last, key, value, sections)] = value


FIXED_KEYS = ("case", "studies", "reproduction")
"""Keys that no change of a config may touch."""


def _position(inside: Any, part: str, key: str, value: Any, before: Sequence[str]) -> str | int:
    """Return the key, or list index, that one part of a dotted key stands for.

    `inside` is the mapping or list that it is looked up in, `part` the part, and `before` the parts in
    front of it. `key` and `value` are the whole key and its new value, for the error. Raises ConfigError
    if the part does not exist there.
    """
    if isinstance(inside, dict) and part in inside and (before or part not in FIXED_KEYS):
        return part
    if isinstance(inside, list) and part.isdecimal() and int(part) < len(inside):
        return int(part)
    requirement = f"a dotted key of the config, but not {', '.join(FIXED_KEYS[:-1])} or {FIXED_KEYS[-1]}"
    section = ".".join(before)
    if inside is None:
        requirement += f"; {section} is null, set it as a whole"
    elif isinstance(inside, list):
        requirement += (
            f"; {section} has the positions 0 to {len(inside) - 1}" if inside else f"; {section} is empty"
        )
    elif isinstance(inside, dict) and part not in FIXED_KEYS:
        requirement += f"; {suggestion(part, [name for name in inside if before or name not in FIXED_KEYS])}"
    raise ConfigError(key, value, requirement)


def folder_name(label: str) -> str:
    """Convert a label to the name of a folder.

    Parameters
    ----------
    label : str
        Label of a point.

    Returns
    -------
    str
        Lower-case letters and digits, all else replaced by underscores, a dot by `p`; `point` where
        nothing is left.
    """
    return re.sub(r"[^a-z0-9]+", "_", label.lower().replace(".", "p")).strip("_") or "point"
