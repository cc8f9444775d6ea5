"""Code and names of source files, parsed once and remembered by the hash of their text."""

import hashlib
import json
import sys
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import astuple
from functools import cache
from pathlib import Path
from typing import Any

from facegear.errors import FacegearError
from facegear.io.atomic import atomic_path
from facegear.pipeline.provenance.statements import Source, Statement, read_source

READERS = ("syntax.py", "statements.py", "sources.py")
"""Modules of this package on which the remembered content of a file depends."""
REMEMBERED = 3000
"""Source files that `remember` writes: those of some versions, some kilobytes each."""
_sources: dict[str, Source] = {}
"""By the hash of a file's text: what `recall` read, and all that was parsed since; used last stands last."""
_known_keys: set[str] = set()
"""Keys of `_sources` that `recall` read."""


def recall(file: Path) -> None:
    """Fill the memory of parsed sources from a file that `remember` has written, so that these are not
    parsed again.

    Clones share such a file, as sources are known by the hash of their text. A file that cannot be
    read, or that another version wrote, is passed over.

    Parameters
    ----------
    file : Path
        The file.
    """
    with suppress(OSError, ValueError, KeyError, TypeError):
        content = json.loads(file.read_text(encoding="utf-8"))
        if content["version"] == _version():
            _sources.update({key: _source_of_lists(*lists) for key, lists in content["files"].items()})
            _known_keys.update(_sources)


def remember(file: Path) -> None:
    """Write the parsed sources that were used last to a file, for the next process, if any was parsed
    in this one.

    Where nothing can be written the next process parses again.

    Parameters
    ----------
    file : Path
        The file.
    """
    if _sources.keys() - _known_keys:
        files = {key: astuple(source) for key, source in [*_sources.items()][-REMEMBERED:]}
        with suppress(OSError, FacegearError), atomic_path(file) as partial:
            partial.write_text(json.dumps({"version": _version(), "files": files}), encoding="utf-8")


def source_of(path: Path, module: str) -> Source:
    """Return statements and imports of a source file, from memory if a file with the same text was
    parsed before.

    Parameters
    ----------
    path : Path
        The file.
    module : str
        Dotted name of its module, empty for a script.

    Returns
    -------
    Source
        Its statements and imports.
    """
    text = path.read_bytes()
    key = hashlib.sha256(module.encode() + b"\0" + text).hexdigest()[:32]
    source = _sources.pop(key, None) or read_source(text, module, path.name == "__init__.py")
    _sources[key] = source
    return source


def _source_of_lists(statements: Iterable[Sequence[Any]], imports: Iterable[Sequence[str]]) -> Source:
    """Build a Source from the lists to which `remember` has turned it in JSON."""
    return Source(
        tuple(
            Statement(tuple(names), code, tuple(uses), _imports(inner), runs, signature, tuple(annotated))
            for names, code, uses, inner, runs, signature, annotated in statements
        ),
        _imports(imports),
    )


def _imports(lists: Iterable[Sequence[str]]) -> tuple[tuple[str, str, str], ...]:
    """Build imports, tuples of bound name, module and name in it, from the lists that stand for them in
    JSON.
    """
    return tuple((bound, module, name) for bound, module, name in lists)


@cache
def _version() -> str:
    """Return a text that changes with Python's version or with the code that parses sources."""
    texts = b"".join(Path(__file__).with_name(name).read_bytes() for name in READERS)
    return f"{sys.version_info[:2]} {hashlib.sha256(texts).hexdigest()}"
