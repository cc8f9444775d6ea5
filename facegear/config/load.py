"""The whole config: read, merged, validated, with defaults filled in."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from facegear.config.base import parse
from facegear.config.model import Config
from facegear.config.yaml_file import numbers, read_yaml
from facegear.errors import ConfigErrors

FILE_KEYS = (
    ("reproduction",),
    ("tooth_pair", "pinion", "flanks", "file"),
    ("tooth_pair", "face_gear", "flanks", "file"),
    ("mesh_stiffness", "csv"),
    ("strength", "duty_csv"),
    ("strength", "pinion", "card"),
    ("strength", "face_gear", "card"),
    ("lubrication", "oil"),
    ("transmission", "face_gear", "body", "corners_csv"),
    ("transmission", "face_gear", "body", "step"),
    ("transmission", "single_gears", "lower", "body", "corners_csv"),
    ("transmission", "single_gears", "lower", "body", "step"),
    ("transmission", "single_gears", "upper", "body", "corners_csv"),
    ("transmission", "single_gears", "upper", "body", "step"),
)
"""Keys whose value is the name of a file; it counts from the folder of the config file that sets it."""


def load_config(
    paths: str | Path | Sequence[str | Path], overrides: Mapping[str, Any] | None = None
) -> Config:
    """Read and validate a config file, or several laid over one another, with `overrides` on top.

    Raises ConfigErrors with one line for every mistake.
    """
    files = [paths] if isinstance(paths, str | Path) else paths
    values: dict[str, Any] = {}
    for path in files:
        values = merged(values, read_layers(path))
    source = ", ".join(_short(path) for path in files)
    return parse(Config, merged(values, numbers(dict(overrides or {}))), source)


def config_of(values: Mapping[str, Any]) -> Config:
    """Validate a config that stands in memory: names of files in it count from the working directory.

    Its key `extends` names a config file anywhere. Raises ConfigErrors with one line for every mistake.
    """
    own = _with_paths(plain(values), Path())
    base = own.pop("extends", None)
    if base is not None and not isinstance(base, str | Path):
        raise ConfigErrors("config", [f"extends = {base!r}: must be the name of a config file"])
    return parse(Config, own if base is None else merged(read_layers(base), own))


def plain(value: Any) -> Any:
    """NumPy numbers and arrays, tuples and other iterables as YAML would hold them; a copy."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, Path):
        return str(value)
    return (
        [plain(item) for item in value]
        if isinstance(value, Iterable) and not isinstance(value, str)
        else value
    )


def read_layers(path: str | Path, below: Sequence[Path] = ()) -> dict[str, Any]:
    """Values of a config file laid over those of the file its key `extends` names, in the same folder.

    Raises ConfigErrors if that file is missing, lies elsewhere, or extends this one.
    """
    path = Path(path)
    values = _with_paths(read_yaml(path), path.parent)
    if "extends" not in values:
        return values
    base = values.pop("extends")
    others = {other.name for other in path.parent.glob("*.yaml")} - {
        path.name,
        *(layer.name for layer in below),
    }
    if not isinstance(base, str) or base not in others:
        message = f"extends = {base!r}: must be the name of another config file in the same folder"
        raise ConfigErrors(_short(path), [message])
    return merged(read_layers(path.with_name(base), (path, *below)), values)


def extended(path: str | Path) -> Path | None:
    """The config file that a config file names under `extends`, if it does."""
    base = read_yaml(Path(path)).get("extends")
    return None if base is None else Path(path).with_name(str(base))


def located(name: str, folder: Path) -> str:
    """A file's name as it is read from the working directory, from its name as `folder` counts it."""
    return name if os.path.isabs(name) else os.path.relpath(folder / name)


def _with_paths(values: dict[str, Any], folder: Path) -> dict[str, Any]:
    for *sections, key in FILE_KEYS:
        inside: Any = values
        for section in sections:
            inside = inside.get(section) if isinstance(inside, dict) else None
        _locate(inside, key, folder)
    for point in _study_points(values):
        for *sections, key in FILE_KEYS:
            _locate(point, ".".join([*sections, key]), folder)
            _locate(point.get(sections[0]) if sections else None, key, folder)
    return values


def _locate(inside: Any, key: str, folder: Path) -> None:
    if isinstance(inside, dict) and isinstance(inside.get(key), str):
        inside[key] = located(inside[key], folder)


def _study_points(values: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """What the points of all studies set, as far as they have the form of studies at all."""
    for study in _dicts(values.get("studies")):
        for axis in _dicts(study.get("axes")):
            for point in _dicts(axis.get("points")):
                yield from _dicts([point.get("set")])


def _dicts(values: Any) -> list[dict[str, Any]]:
    return [value for value in values if isinstance(value, dict)] if isinstance(values, list) else []


def merged(values: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """`values` with the mappings of `over` laid over them key by key; lists are replaced whole."""
    result = dict(values)
    for key, value in over.items():
        inside = result.get(key)
        if isinstance(inside, Mapping) and isinstance(value, Mapping):
            value = merged(inside, value)
        result[key] = value
    return result


def _short(path: str | Path) -> str:
    path = Path(path)
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)
