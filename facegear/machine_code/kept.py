"""Files of machine code in a folder of the user's, which all clones, environments and notebooks share.

A file's name is a hash of all that its code follows from: it is right or absent, never stale. The file that
was used least lately is removed once the folder holds more than LIMIT.
"""

import hashlib
import os
from contextlib import suppress
from pathlib import Path

import platformdirs

from facegear.errors import FacegearError
from facegear.io.atomic import atomic_path

LIMIT = 256 * 2**20
"""Bytes. The code of one machine's time integration takes 2 million."""
VARIABLE = "FACEGEAR_CACHE"
"""Environment variable that names another folder, for instance where the home folder cannot be written."""
_DIGEST = hashlib.sha256().digest_size


def folder() -> Path:
    """Where machine code is kept: nothing is made here yet. Raises OSError for a user without a home."""
    if named := os.environ.get(VARIABLE):
        return Path(named) / "machine_code"
    try:
        return platformdirs.user_cache_path("facegear") / "machine_code"
    except RuntimeError as error:
        raise OSError(str(error)) from None


def read(name: str) -> bytes | None:
    """The content of a file as it was written; None if it is absent or damaged."""
    try:
        path = folder() / name
        stored = path.read_bytes()
        os.utime(path)
    except OSError:
        return None
    return checked(stored)


def checked(stored: bytes) -> bytes | None:
    """The content of what write() wrote; None if it is damaged."""
    digest, content = stored[:_DIGEST], stored[_DIGEST:]
    return content if hashlib.sha256(content).digest() == digest else None


def write(name: str, content: bytes) -> None:
    """Keep a content; where the folder cannot be written or the disk is full nothing is kept."""
    with suppress(OSError, FacegearError), atomic_path(folder() / name) as path:
        path.write_bytes(hashlib.sha256(content).digest() + content)
    trim(LIMIT)


def trim(limit: int) -> None:
    """Remove the files that were used least lately until the others hold `limit` bytes at most.

    A folder that may not be entered or listed is left as it is.
    """
    files, entries = [], []
    with suppress(OSError):
        entries = list(folder().iterdir())
    for path in entries:
        with suppress(OSError):
            stat = path.stat()
            files.append((stat.st_mtime_ns, stat.st_size, path))
    size = sum(bytes_of for _, bytes_of, _ in files)
    for _, bytes_of, path in sorted(files):
        if size <= limit:
            return
        with suppress(OSError):
            path.unlink()
            size -= bytes_of
