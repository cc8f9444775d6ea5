"""Read and write small nested records (json)."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from facegear.errors import CorruptFile
from facegear.io.atomic import atomic_path, verify


def _plain(value: Any) -> Any:
    """Return NumPy values as plain ones; refuse any other object."""
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
