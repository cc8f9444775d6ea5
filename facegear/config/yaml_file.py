"""Safe reading of YAML config files by the core schema of YAML 1.2, with bounds on size and nesting."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
    StreamEndEvent,
)

from facegear.errors import ConfigErrors

LARGEST_FILE = 500_000
"""Bytes of a config file that are read at most."""
DEEPEST = 32
"""Levels of nesting."""
MAX_VALUES = 50_000
"""Values of a file, what its aliases (`*name`) stand for counted as often as they are used."""

_INTEGER = re.compile(r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_WORDS = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}
_TAGS = {f"tag:yaml.org,2002:{name}" for name in ("map", "seq", "str", "int", "float", "bool", "null")}


def read_yaml(path: str | Path) -> dict[str, Any]:
    """Read a YAML mapping.

    Numbers follow YAML 1.2: 1e-8 is a number, 025 is 25 and 1:20 is text. A key given twice, tags other
    than the core schema's, and files beyond the bounds above are refused. Raises ConfigErrors naming file
    and line.
    """
    text = _text(Path(path))
    try:
        value = _Builder(YAML(typ="safe", pure=True).parse(text)).document()
    except _Refused as error:
        raise ConfigErrors(f"{path}:{error.line}", [error.problem]) from None
    except YAMLError as error:
        mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
        where = f"{path}:{mark.line + 1}" if mark else str(path)
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise ConfigErrors(where, [f"not valid YAML: {problem}"]) from None
    if not isinstance(value, dict):
        raise ConfigErrors(str(path), ["a config is a mapping of keys to values"])
    return value


def numbers(value: Any) -> Any:
    """The same values with text such as '6.5e7' turned into the number it stands for.

    For values that come from a command line, not for files, where quoted text stays text.
    """
    if isinstance(value, dict):
        return {str(key): numbers(item) for key, item in value.items()}
    if isinstance(value, list):
        return [numbers(item) for item in value]
    if isinstance(value, str) and _FLOAT.fullmatch(value):
        return float(value)
    return value


def _text(path: Path) -> str:
    if path.is_dir():
        raise ConfigErrors(str(path), ["is a directory, not a config file"])
    try:
        with open(path, "rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        raise ConfigErrors(str(path), ["no such config file"]) from None
    except (OSError, ValueError) as error:
        raise ConfigErrors(str(path), [f"cannot be read ({error})"]) from None
    if len(content) > LARGEST_FILE:
        raise ConfigErrors(str(path), [f"longer than {LARGEST_FILE} bytes, the most that a config may have"])
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        message = f"byte {content[error.start]:#04x} is not UTF-8: save the file as UTF-8"
        raise ConfigErrors(f"{path}:{line}", [message]) from None


class _Refused(Exception):
    """A fault of the document, with the line (from 1) where it stands."""

    def __init__(self, event: Event, problem: str) -> None:
        super().__init__(problem)
        self.line, self.problem = event.start_mark.line + 1, problem


class _Builder:
    """Builds plain values from the parser's events; `size` counts a value with all that is inside it."""

    def __init__(self, events: Iterator[Event]) -> None:
        self.events = events
        self.anchored: dict[str, tuple[Any, int]] = {}

    def document(self) -> Any:
        """The value of the only document of the stream; None if there is none."""
        next(self.events)
        if isinstance(next(self.events), StreamEndEvent):
            return None
        value, _ = self._value(next(self.events), 0)
        next(self.events)
        if not isinstance(event := next(self.events), StreamEndEvent):
            raise _Refused(event, "a second document starts here; a config is one")
        return value

    def _value(self, event: Event, depth: int) -> tuple[Any, int]:
        if isinstance(event, AliasEvent):
            if event.anchor not in self.anchored:
                raise _Refused(event, f"alias *{event.anchor} stands for nothing that came before it")
            return self.anchored[event.anchor]
        if depth > DEEPEST:
            raise _Refused(event, f"nested more than {DEEPEST} levels deep")
        tag = getattr(event, "tag", None)
        if tag is not None and str(tag) not in _TAGS and str(tag) != "!":
            raise _Refused(event, f"tag {tag} is not allowed in a config")
        value: tuple[Any, int]
        if isinstance(event, MappingStartEvent):
            value = self._mapping(depth)
        elif isinstance(event, SequenceStartEvent):
            value = self._sequence(depth)
        else:
            assert isinstance(event, ScalarEvent)
            value = _scalar(event), 1
        if value[1] > MAX_VALUES:
            raise _Refused(event, f"more than {MAX_VALUES} values, aliases written out")
        if event.anchor is not None:
            self.anchored[event.anchor] = value
        return value

    def _sequence(self, depth: int) -> tuple[list[Any], int]:
        items, size = [], 1
        while not isinstance(event := next(self.events), SequenceEndEvent):
            item, inside = self._value(event, depth + 1)
            items.append(item)
            size = _bounded(event, size + inside)
        return items, size

    def _mapping(self, depth: int) -> tuple[dict[str, Any], int]:
        items: dict[str, Any] = {}
        below: dict[str, Any] = {}
        size = 1
        while not isinstance(event := next(self.events), MappingEndEvent):
            if not isinstance(event, ScalarEvent):
                raise _Refused(event, "a key must be text")
            key = str(event.value)
            if key in items:
                raise _Refused(event, f"key {key!r} stands twice")
            value, inside = self._value(next(self.events), depth + 1)
            size = _bounded(event, size + inside)
            if key == "<<" and event.implicit[0]:
                below = {**_merged(event, value), **below}
            else:
                items[key] = value
        return {**below, **items}, size


def _bounded(event: Event, size: int) -> int:
    if size > MAX_VALUES:
        raise _Refused(event, f"more than {MAX_VALUES} values, aliases written out")
    return size


def _merged(event: Event, value: Any) -> dict[str, Any]:
    """What a merge key (`<<: *name`) lays below a mapping's own keys; of several the first wins."""
    several = value if isinstance(value, list) else [value]
    if not all(isinstance(mapping, dict) for mapping in several):
        raise _Refused(event, "'<<' takes a mapping or a list of mappings")
    return {key: item for mapping in reversed(several) for key, item in mapping.items()}


def _scalar(event: ScalarEvent) -> Any:
    """The value of a scalar by the core schema of YAML 1.2; quoted text stays text."""
    text = str(event.value)
    if not event.implicit[0] and str(event.tag or "!") in ("!", "tag:yaml.org,2002:str"):
        return text
    if text in _WORDS:
        return _WORDS[text]
    if _INTEGER.fullmatch(text) and len(text) < 400:
        base = {"0o": 8, "0x": 16}.get(text[:2], 10)
        return int(text, base)
    return float(text) if _FLOAT.fullmatch(text) or _INTEGER.fullmatch(text) else text
