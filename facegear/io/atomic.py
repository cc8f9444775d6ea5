"""Files appear whole or not at all, and checksums tell when a stored one has changed."""

import errno
import hashlib
import json
import os
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from facegear.errors import CorruptFile, FacegearError

NO_SPACE = (errno.ENOSPC, errno.EDQUOT)
"""Numbers of the system's errors for a full disk or quota."""
NO_SPACE_HINT = "no space left on the disk; free some and run again"
"""Advice for a full disk."""


@contextmanager
def atomic_path(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path to write to, and rename it to `path` at the end, so that a file is whole or
    absent.

    It is in the same folder, which is made, has the same suffix, and is removed on any error.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Yields
    ------
    Path
        The temporary path.

    Raises
    ------
    FacegearError
        With one line if the disk is full or the path cannot be written.
    """
    path = Path(path)
    _make(path.parent)
    temporary = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        yield temporary
        with open(temporary, "rb") as stream:
            os.fsync(stream.fileno())
        os.replace(temporary, path)
    except OSError as error:
        if error.errno in NO_SPACE:
            raise FacegearError(f"{path}: {NO_SPACE_HINT}") from None
        if error.filename is not None and Path(os.fsdecode(error.filename)) == temporary:
            raise FacegearError(f"{path}: {_cannot_be_written(error)}") from None
        raise
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def require_writable(folder: str | Path) -> None:
    """Make a folder and check that files can be made in it, before work is done whose result goes there.

    Parameters
    ----------
    folder : str or Path
        The folder.

    Raises
    ------
    FacegearError
        With one line where that is not possible.
    """
    folder = Path(folder)
    _make(folder)
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise FacegearError(f"{folder}: {_cannot_be_written(error)}") from None


def require_writable_file(path: str | Path) -> None:
    """Check before work is done that its result can become a file.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Raises
    ------
    FacegearError
        With one line where that is not possible.
    """
    path = Path(path)
    require_writable(path.parent)
    if path.is_dir():
        raise FacegearError(f"{path}: is a folder, not a file; give another name")


def _make(folder: Path) -> None:
    """Make a folder and those above it; raise FacegearError with one line where that is not possible."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        file = next((above for above in (folder, *folder.parents) if above.is_file()), folder)
        raise FacegearError(f"{file}: is a file, not a folder; move it, or choose another folder") from None
    except OSError as error:
        raise FacegearError(f"{folder}: {_cannot_be_written(error)}") from None


def _cannot_be_written(error: OSError) -> str:
    """Return the words "cannot be written (reason)" for an error of the system."""
    reason = NO_SPACE_HINT if error.errno in NO_SPACE else (error.strerror or str(error)).lower()
    return f"cannot be written ({reason})"


MANIFEST_SUFFIX = ".provenance.json"
"""End of the name of a manifest's file."""


def sha256(path: str | Path) -> str:
    """Return the SHA-256 of a file's bytes.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Returns
    -------
    str
        Hexadecimal digits.
    """
    with open(path, "rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def require_manifest(path: str | Path) -> None:
    """Refuse a stage's output without the manifest beside it that says what it should hold.

    Without it there is no telling whether the file is whole.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Raises
    ------
    CorruptFile
        Where there is no manifest.
    """
    path = Path(path)
    if path.is_file() and not any(
        path.name in _files(manifest) for manifest in path.parent.glob(f"*{MANIFEST_SUFFIX}")
    ):
        raise CorruptFile(path, "no manifest beside it says what its stage wrote")


def _files(manifest: Path) -> Mapping[str, Any]:
    """Return the records (bytes, sha256) of the files that a manifest lists, by file name.

    CorruptFile is raised if the manifest is not readable.
    """
    try:
        files = json.loads(manifest.read_text(encoding="utf-8"))["files"]
    except (ValueError, KeyError, TypeError):
        raise CorruptFile(manifest, "the manifest is not readable") from None
    return files if isinstance(files, dict) else {}


def verify(path: str | Path) -> None:
    """Compare a file's size and SHA-256 with the manifest beside it that lists it, if there is one.

    Manifests are the files `*.provenance.json` of the stages in the same folder.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Raises
    ------
    CorruptFile
        Where size or checksum differ, the file is missing or cannot be read, or a manifest is not readable.
    """
    path = Path(path)
    try:
        with open(path, "rb"):
            pass
    except (FileNotFoundError, NotADirectoryError, IsADirectoryError):
        raise CorruptFile(path, "the file is missing") from None
    except OSError as error:
        raise CorruptFile(
            path, f"the file cannot be read ({(error.strerror or str(error)).lower()})"
        ) from None
    for manifest in sorted(path.parent.glob(f"*{MANIFEST_SUFFIX}")):
        try:
            document = json.loads(manifest.read_text(encoding="utf-8"))
            recorded_checksum = document["files"].get(path.name)
            rebuild = document["rebuild"]
        except (ValueError, KeyError, TypeError, AttributeError):
            raise CorruptFile(manifest, "the manifest is not readable") from None
        if recorded_checksum is None:
            continue
        if path.stat().st_size != recorded_checksum["bytes"] or sha256(path) != recorded_checksum["sha256"]:
            raise CorruptFile(path, "the content differs from what its stage wrote", f"{rebuild}{path.name}")
