"""Detect stored files that changed since the stage that made them wrote them."""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from facegear.errors import CorruptFile

MANIFEST_SUFFIX = ".provenance.json"


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
    try:
        files = json.loads(manifest.read_text(encoding="utf-8"))["files"]
    except (ValueError, KeyError, TypeError):
        raise CorruptFile(manifest, "the manifest is not readable") from None
    return files if isinstance(files, dict) else {}


def verify(path: str | Path) -> None:
    """Compare a file with the manifest of the stage that wrote it, if one lies beside it.

    Parameters
    ----------
    path : str or Path
        Path of the file.

    Raises
    ------
    CorruptFile
        Where size or checksum differ, or the file is missing.
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
