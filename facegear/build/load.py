"""The whole config: read, merged, validated, with defaults filled in."""

import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from facegear.build.config import Config
from facegear.errors import ConfigErrors
from facegear.schema.base import parse
from facegear.schema.yaml_file import numbers, read_yaml

FILE_KEYS = (
    ("reproduction",),
    ("tooth_pair", "pinion", "flanks", "file"),
    ("tooth_pair", "face_gear", "flanks", "file"),
    ("mesh_stiffness", "csv"),
    ("strength", "duty_csv"),
    ("strength", "pinion", "card"),
    ("strength", "face_gear", "card"),
    ("lubrication", "oil"),
    *(("transmission", "casing", key) for key in ("stiffness", "mass", "damping", "nodes", "dofs")),
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
    """Read and validate a config file, or several laid over one another.

    Parameters
    ----------
    paths : str or Path or Sequence[str | Path]
        The file, or several; values of a later one replace those of an earlier one key by key, lists
        whole.
    overrides : Mapping[str, Any] or None
        Nested values that replace those of all files; numbers written as text become numbers.

    Returns
    -------
    Config
        The validated config.

    Raises
    ------
    ConfigErrors
        With one line for every mistake.
    """
    files = [paths] if isinstance(paths, str | Path) else paths
    values: dict[str, Any] = {}
    for path in files:
        values = merge_values(values, read_layers(path))
    source = ", ".join(_short(path) for path in files)
    return parse(Config, merge_values(values, numbers(dict(overrides or {}))), source)


def config_of(values: Mapping[str, Any]) -> Config:
    """Validate a config given as nested values in memory.

    Names of files in it count from the working directory. Its key `extends` names a config file anywhere.

    Parameters
    ----------
    values : Mapping[str, Any]
        Nested values by key, NumPy numbers and arrays included.

    Returns
    -------
    Config
        The validated config.

    Raises
    ------
    ConfigErrors
        With one line for every mistake.
    """
    config_values = _with_paths(plain(values), Path())
    base = config_values.pop("extends", None)
    if base is not None and not isinstance(base, str | Path):
        raise ConfigErrors("config", [f"extends = {base!r}: must be the name of a config file"])
    return parse(Config, config_values if base is None else merge_values(read_layers(base), config_values))


def plain(value: Any) -> Any:
    """Convert NumPy numbers and arrays, paths, tuples and other iterables to values that YAML can hold.

    Parameters
    ----------
    value : Any
        Any value; mappings and iterables are converted with all that they hold.

    Returns
    -------
    Any
        Numbers, texts, lists and dicts; a value of another type is returned as it is.
    """
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
    """Read a config file, laid over the file in the same folder that its key `extends` names, and so on.

    Names of files in the values are made relative to the working directory. Nothing else is validated.

    Parameters
    ----------
    path : str or Path
        The config file.
    below : Sequence[Path]
        Files that extend this one, which it must not extend in turn; empty for the file that a user
        names.

    Returns
    -------
    dict[str, Any]
        Plain values of all layers merged, without `extends`.

    Raises
    ------
    ConfigErrors
        If that file is missing, lies elsewhere, or extends this one.
    """
    path = Path(path)
    values = _with_paths(read_yaml(path), path.parent)
    if "extends" not in values:
        return values
    base = values.pop("extends")
    possible_bases = {sibling.name for sibling in path.parent.glob("*.yaml")} - {
        path.name,
        *(layer.name for layer in below),
    }
    if not isinstance(base, str) or base not in possible_bases:
        message = f"extends = {base!r}: must be the name of another config file in the same folder"
        raise ConfigErrors(_short(path), [message])
    return merge_values(read_layers(path.with_name(base), (path, *below)), values)


def base_path(path: str | Path) -> Path | None:
    """Return the path of the config file that a config file names under `extends`; it need not exist.

    Parameters
    ----------
    path : str or Path
        The config file.

    Returns
    -------
    Path or None
        Path of the base; None if it extends none.
    """
    base = read_yaml(Path(path)).get("extends")
    return None if base is None else Path(path).with_name(str(base))


def relative_to_cwd(name: str, folder: Path) -> str:
    """Convert the name of a file from a folder to the working directory.

    Parameters
    ----------
    name : str
        Name of the file as `folder` counts it.
    folder : Path
        The folder.

    Returns
    -------
    str
        Its name as it is read from the working directory; an absolute name stays.
    """
    return name if os.path.isabs(name) else os.path.relpath(folder / name)


def _with_paths(values: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Make all file names of a config, its studies' included, relative to the current folder, in place.

    Names count from `folder`, that of the config file; FILE_KEYS lists the keys. Returns the same
    mapping.
    """
    for *sections, key in FILE_KEYS:
        inside: Any = values
        for section in sections:
            inside = inside.get(section) if isinstance(inside, dict) else None
        _locate(inside, key, folder)
    _locate_cards(values, folder)
    for point in _study_points(values):
        for *sections, key in FILE_KEYS:
            _locate(point, ".".join([*sections, key]), folder)
            _locate(point.get(sections[0]) if sections else None, key, folder)
    return values


def _locate(inside: Any, key: str, folder: Path) -> None:
    """Make the file name at one key of a section relative to the current folder, in place, if it is
    there.
    """
    if isinstance(inside, dict) and isinstance(inside.get(key), str):
        inside[key] = relative_to_cwd(inside[key], folder)


def _locate_cards(values: Mapping[str, Any], folder: Path) -> None:
    """Make the files of rolling bearings relative to the current folder, in place; names of cards of the
    package, which have no ending, stay.
    """
    transmission = values.get("transmission")
    shafts = transmission.get("shafts") if isinstance(transmission, dict) else None
    for shaft in shafts.values() if isinstance(shafts, dict) else ():
        for bearing in _dicts(shaft.get("bearings") if isinstance(shaft, dict) else None):
            rolling = bearing.get("rolling")
            inside, key = (rolling, "card") if isinstance(rolling, dict) else (bearing, "rolling")
            if isinstance(inside.get(key), str) and Path(inside[key]).suffix:
                _locate(inside, key, folder)


def _study_points(values: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the mapping `set` of every point that studies list, which may be changed in place.

    Values that do not have the form of studies are passed over: nothing is validated yet.
    """
    for study in _dicts(values.get("studies")):
        for axis in _dicts(study.get("axes")):
            for point in _dicts(axis.get("points")):
                yield from _dicts([point.get("set")])


def _dicts(values: Any) -> list[dict[str, Any]]:
    """Return the mappings among the items of a list; an empty list for any other value."""
    return [value for value in values if isinstance(value, dict)] if isinstance(values, list) else []


def merge_values(values: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Merge two nested mappings key by key into a new one; lists are replaced whole.

    Parameters
    ----------
    values : Mapping[str, Any]
        Values that are replaced where `over` has the same key.
    over : Mapping[str, Any]
        Values that win.

    Returns
    -------
    dict[str, Any]
        The merged values.
    """
    result = dict(values)
    for key, value in over.items():
        inside = result.get(key)
        if isinstance(inside, Mapping) and isinstance(value, Mapping):
            value = merge_values(inside, value)
        result[key] = value
    return result


def _short(path: str | Path) -> str:
    """Return a path relative to the current folder if it lies below it, else as it is, for messages."""
    path = Path(path)
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)


OPTIONS = ("--configfile", "--configfiles")
"""Options of Snakemake that name config files."""
ENDINGS = (".yaml", ".yml", ".json")
"""Endings of the names of config files."""


def check_configfiles(arguments: Sequence[str]) -> None:
    """End the program with one line a mistake if a config file cannot be read.

    The profiles call it with the command line: Snakemake opens these files before any code of a workflow
    runs, and what it cannot read ends in a traceback.

    Parameters
    ----------
    arguments : Sequence[str]
        Arguments of Snakemake's command line.
    """
    for name in _config_files(arguments):
        try:
            read_layers(name)
        except ConfigErrors as error:
            message = str(error)
            if not name.endswith(ENDINGS):
                message += f"\nIs {name} a target? Write -- before the targets that follow --configfile."
            sys.exit(message)


def _config_files(arguments: Sequence[str]) -> Iterator[str]:
    """Yield the arguments that stand after an option for config files, up to the next option."""
    is_file = False
    for argument in arguments:
        option, equals, value = argument.partition("=")
        if argument.startswith("-"):
            is_file = option in OPTIONS
            if is_file and equals:
                yield value
        elif is_file:
            yield argument
