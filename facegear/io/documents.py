"""Read and write small nested records (json), and journals of records to which unfinished work appends.

What a kill leaves of a journal is read back up to its last whole line.
"""

import errno
import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from facegear.errors import CorruptFile, FacegearError
from facegear.io.atomic import NO_SPACE, NO_SPACE_HINT, atomic_path, verify


def _plain(value: Any) -> Any:
    """Convert a NumPy scalar or array for json; raise TypeError for any other object."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} is not stored in json")


def write(path: str | Path, record: dict[str, Any]) -> None:
    """Write a record; NumPy scalars and arrays become numbers and lists; NaN is refused.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    record : dict[str, Any]
        The record.
    """
    with atomic_path(path) as temporary:
        text = json.dumps(record, indent=1, default=_plain, allow_nan=False)
        temporary.write_text(text + "\n", encoding="utf-8")


def read(path: str | Path, keys: Sequence[str] = ()) -> dict[str, Any]:
    """Read a record that must hold some keys.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    keys : Sequence[str]
        The keys.

    Returns
    -------
    dict[str, Any]
        The record.

    Raises
    ------
    CorruptFile
        If it is missing, altered or lacks a key.
    """
    verify(path)
    try:
        record = json.loads(Path(path).read_text(encoding="utf-8"))
    except (ValueError, UnicodeDecodeError):
        raise CorruptFile(path, "not a readable json record") from None
    if not isinstance(record, dict):
        raise CorruptFile(path, "not a json record")
    missing_keys = [key for key in keys if key not in record]
    if missing_keys:
        raise CorruptFile(path, f"key {missing_keys[0]!r} is missing")
    return record


def read_journal(path: str | Path, identity: str) -> list[dict[str, Any]]:
    """Read the records of a journal that was begun under the same identity, up to the first damaged line.

    The first line of the file is a digest of the identity, each other line a record with its digest.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    identity : str
        Text that differs whenever the meaning of the records does.

    Returns
    -------
    list[dict[str, Any]]
        The records; empty without a file, or if it has another identity.
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
    """Yield a function that appends one record to a journal at once, so that a kill loses at most the
    last line.

    The journal is begun anew if its identity differs, which drops its records; a damaged end is cut off
    first.

    Parameters
    ----------
    path : str or Path
        Path of the file.
    identity : str
        Text that differs whenever the meaning of the records does.

    Yields
    ------
    Callable[[dict[str, Any]], None]
        Function that takes a record, writes it as a line and returns nothing.

    Raises
    ------
    FacegearError
        With one line if the disk is full.
    """
    path = Path(path)
    sound = "".join([_digest(identity) + "\n", *map(_line, read_journal(path, identity))]).encode()
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
    """Write one record as a line (`_line`) to an unbuffered stream; raise OSError if the disk took only a
    part of it.
    """
    line = _line(record).encode()
    if stream.write(line) != len(line):
        raise OSError(errno.ENOSPC, "the line was not written whole")


def _line(record: dict[str, Any]) -> str:
    """Return a record as a line of its digest and its JSON text."""
    text = json.dumps(record)
    return f"{_digest(text)} {text}\n"


def _digest(text: str) -> str:
    """Return the first 16 hexadecimal digits of the SHA-256 of a text, to tell whether a line is whole."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]
