"""Append-only records of unfinished work: what a kill leaves behind is read back up to its last line."""

import errno
import hashlib
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

from facegear.errors import FacegearError
from facegear.io.atomic import NO_SPACE, NO_SPACE_HINT, atomic_path


def read(path: str | Path, identity: str) -> list[dict[str, Any]]:
    """Read the records of a journal begun under the same identity; those after a damaged line are not read.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    identity : str
        Text that differs whenever the meaning of the records does.

    Returns
    -------
    list[dict[str, Any]]
        The records.
    """
    path = Path(path)
    if not path.is_file():
        return []
    lines = path.read_bytes().split(b"\n")[:-1]
    if not lines or lines[0].decode(errors="replace") != _digest(identity):
        return []
    records = []
    for line in lines[1:]:
        try:
            digest, text = line.decode().split(" ", 1)
        except ValueError:
            break
        if digest != _digest(text):
            break
        records.append(json.loads(text))
    return records


@contextmanager
def appending(path: str | Path, identity: str) -> Iterator[Callable[[dict[str, Any]], None]]:
    """Yield a function that appends one record; the journal is begun anew unless its identity is the same.

    A damaged end is cut off first.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    identity : str
        Text that differs whenever the meaning of the records does.

    Yields
    ------
    Callable[[dict[str, Any]], None]
        The function.

    Raises
    ------
    FacegearError
        With one line if the disk is full.
    """
    path = Path(path)
    sound = "".join([_digest(identity) + "\n", *map(_line, read(path, identity))]).encode()
    if not path.is_file() or path.read_bytes() != sound:
        with atomic_path(path) as temporary:
            temporary.write_bytes(sound)
    try:
        with open(path, "ab", buffering=0) as stream:
            yield lambda record: _append(stream, record)
    except OSError as error:
        if error.errno in NO_SPACE:
            raise FacegearError(f"{path}: {NO_SPACE_HINT}") from None
        raise


def _append(stream: BinaryIO, record: dict[str, Any]) -> None:
    """Write one record as a line; raise OSError if the disk took only a part of it."""
    line = _line(record).encode()
    if stream.write(line) != len(line):
        raise OSError(errno.ENOSPC, "the line was not written whole")


def _line(record: dict[str, Any]) -> str:
    """Return a record as a line of its digest and its JSON text."""
    text = json.dumps(record)
    return f"{_digest(text)} {text}\n"


def _digest(text: str) -> str:
    """Return the first 16 digits of a text's SHA-256."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]
