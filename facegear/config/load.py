"""The whole config: read, merged, validated, with defaults filled in."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from facegear.config.base import parse
from facegear.config.model import Config
from facegear.config.yaml_file import numbers, read_yaml


def load_config(path: str | Path, overrides: Mapping[str, Any] | None = None) -> Config:
    """Read and validate a config file. Raises ConfigErrors with one line for every mistake."""
    return parse(Config, merged(read_yaml(path), numbers(dict(overrides or {}))), source=str(path))


def load_values(paths: Sequence[str | Path], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Validated plain values of config files laid over one another, with defaults filled in."""
    values: dict[str, Any] = {}
    for path in paths:
        values = merged(values, read_yaml(path))
    values = merged(values, numbers(dict(overrides)))
    source = ", ".join(_short(path) for path in paths)
    return parse(Config, values, source).model_dump(mode="json")


def merged(values: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """`values` with the mappings of `over` laid over them key by key; lists are replaced whole."""
    result = dict(values)
    for key, value in over.items():
        inside = result.get(key)
        both = isinstance(inside, Mapping) and isinstance(value, Mapping)
        result[key] = merged(inside, value) if both else value
    return result


def _short(path: str | Path) -> str:
    path = Path(path)
    return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)
