"""Safe reading of YAML config files, with bounds on size and nesting."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    DocumentStartEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from facegear.errors import ConfigErrors, plain_reason

LARGEST_FILE = 500_000
"""Bytes of a config file that are read at most."""
DEEPEST = 32
"""Levels of nesting."""
MAX_VALUES = 50_000
"""Values of a file, what its aliases (`*name`) stand for counted as often as they are used."""

_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
"""Text that stands for a decimal number."""


def read_yaml(path: str | Path) -> dict[str, Any]:
    """Read a YAML file that holds a mapping, such as a config or a card.

    Numbers follow YAML 1.2: 1e-8 is a number, 025 is 25 and 1:20 is text. A key given twice, tags that
    stand for program objects, and files beyond the bounds above are refused.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    dict
        The nested values by their keys, not validated.

    Raises
    ------
    ConfigErrors
        With one line that names the file and, where known, the line.
    """
    text = _text(Path(path))
    try:
        _require_bounded(YAML(typ="safe", pure=True).parse(text))
        value = YAML(typ="safe", pure=True).load(text)
    except _DocumentFault as error:
        raise ConfigErrors(f"{path}:{error.line}", [str(error)]) from None
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        reasons = ", ".join(part for part in (error.context, error.problem) if part)
        location = f"{path}:{mark.line + 1}" if mark else str(path)
        raise ConfigErrors(location, [f"not valid YAML: {' '.join(reasons.split())}"]) from None
    except (YAMLError, ValueError) as error:
        raise ConfigErrors(str(path), [f"not valid YAML: {str(error).splitlines()[0]}"]) from None
    if not isinstance(value, dict):
        raise ConfigErrors(str(path), ["a config is a mapping of keys to values"])
    return value


def numbers(value: Any) -> Any:
    """Convert text such as '6.5e7' to the number it stands for, in nested values.

    For values that come from a command line, not for files, where quoted text stays text.

    Parameters
    ----------
    value : Any
        Nested mappings and lists.

    Returns
    -------
    Any
        A copy with numbers in place of such text.
    """
    if isinstance(value, dict):
        return {str(key): numbers(item) for key, item in value.items()}
    if isinstance(value, list):
        return [numbers(item) for item in value]
    if isinstance(value, str) and _FLOAT.fullmatch(value):
        return float(value)
    return value


def _text(path: Path) -> str:
    """Return the text of a config file; refuse directories, long files and other encodings."""
    if path.is_dir():
        raise ConfigErrors(str(path), ["is a directory, not a config file"])
    try:
        with open(path, "rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        raise ConfigErrors(str(path), ["no such config file"]) from None
    except (OSError, ValueError) as error:
        raise ConfigErrors(str(path), [f"cannot be read ({plain_reason(error)})"]) from None
    if len(content) > LARGEST_FILE:
        raise ConfigErrors(str(path), [f"longer than {LARGEST_FILE} bytes, the most that a config may have"])
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        message = f"byte {content[error.start]:#04x} is not UTF-8: save the file as UTF-8"
        raise ConfigErrors(f"{path}:{line}", [message]) from None


class _DocumentFault(Exception):
    """A fault of the document at an event of the parser, with the line (from 1) where it stands."""

    def __init__(self, event: Event, problem: str) -> None:
        super().__init__(problem)
        self.line = event.start_mark.line + 1


def _require_bounded(events: Iterable[Event]) -> None:
    """Refuse a document that is too deep or too large before any of its values is built."""
    sizes = [0]  # values so far of the document and of each list or mapping that is open
    names: list[str | None] = []
    anchor_sizes: dict[str | None, int] = {}
    for event in events:
        size = 1
        if isinstance(event, DocumentStartEvent) and event.version not in (None, (1, 2)):
            raise _DocumentFault(event, "a config follows YAML 1.2: leave out the line %YAML")
        if isinstance(event, MappingStartEvent | SequenceStartEvent):
            names.append(event.anchor)
            sizes.append(0)
            if len(names) > DEEPEST:
                raise _DocumentFault(event, f"nested more than {DEEPEST} levels deep")
            continue
        if isinstance(event, MappingEndEvent | SequenceEndEvent):
            size += sizes.pop()
            anchor_sizes[names.pop()] = size
        elif isinstance(event, AliasEvent):
            if event.anchor not in anchor_sizes:
                raise _DocumentFault(event, f"alias *{event.anchor} stands for nothing that came before it")
            size = anchor_sizes[event.anchor]
        elif isinstance(event, ScalarEvent):
            anchor_sizes[event.anchor] = size
        else:
            continue
        sizes[-1] += size
        if sizes[-1] > MAX_VALUES:
            raise _DocumentFault(event, f"more than {MAX_VALUES} values, aliases written out")
