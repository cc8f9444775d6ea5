"""Safe reading of YAML config files."""

import re
from pathlib import Path
from typing import Any

import yaml

from facegear.errors import ConfigErrors

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


class _Loader(yaml.SafeLoader):
    """Safe YAML that refuses a key given twice."""


def _mapping(loader: _Loader, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
    seen: set[str] = set()
    for key_node, _ in node.value:
        key = str(key_node.value)
        if key in seen:
            raise yaml.MarkedYAMLError(problem=f"key {key!r} stands twice", problem_mark=key_node.start_mark)
        seen.add(key)
    return yaml.SafeLoader.construct_mapping(loader, node, deep)


_Loader.add_constructor(
    yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, lambda loader, node: _mapping(loader, node, deep=True)
)


def read_yaml(path: str | Path) -> dict[str, Any]:
    """Read a YAML mapping with numbers as numbers (YAML 1.1 takes 1e-8 for text).

    Raises ConfigErrors naming file and line.
    """
    try:
        values = yaml.load(Path(path).read_text(encoding="utf-8"), Loader=_Loader)
    except FileNotFoundError:
        raise ConfigErrors(str(path), ["no such config file"]) from None
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigErrors(str(path), [f"cannot be read ({error})"]) from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        where = f"line {mark.line + 1}: " if mark else ""
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise ConfigErrors(str(path), [f"{where}{problem}"]) from None
    if not isinstance(values, dict):
        raise ConfigErrors(str(path), ["a config is a mapping of keys to values"])
    return numbers(values)


def numbers(value: Any) -> Any:
    """The same values with text such as '6.5e7' turned into the number it stands for."""
    if isinstance(value, dict):
        return {str(key): numbers(item) for key, item in value.items()}
    if isinstance(value, list):
        return [numbers(item) for item in value]
    if isinstance(value, str) and _NUMBER.fullmatch(value):
        return float(value)
    return value
