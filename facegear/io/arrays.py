"""Read and write named arrays (npz, never pickle)."""

import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from facegear.errors import CorruptFile
from facegear.io.atomic import atomic_path, verify


def write(path: str | Path, **arrays: np.ndarray) -> None:
    """Write arrays under their names, uncompressed.

    Parameters
    ----------
    path : str or Path
        File to write (npz).
    **arrays : ndarray
        Arrays of any shape by name.

    Raises
    ------
    TypeError
        For an array of Python objects.
    """
    if any(np.asarray(array).dtype.hasobject for array in arrays.values()):
        raise TypeError("arrays of Python objects are not stored")
    with atomic_path(path) as temporary, open(temporary, "wb") as stream:
        np.savez(stream, allow_pickle=False, **arrays)


def read(path: str | Path, shapes: Mapping[str, tuple[int | None, ...]]) -> dict[str, np.ndarray]:
    """Read all arrays of an npz file, after it is checked against its manifest.

    Parameters
    ----------
    path : str or Path
        File to read (npz).
    shapes : mapping of str to tuple
        Shape of each array that must exist; None stands for any length. Other arrays are read as well.

    Returns
    -------
    dict of str to ndarray
        Arrays of any shape by name.

    Raises
    ------
    CorruptFile
        If the file is missing, altered or truncated, lacks an array, has one of another shape, or holds a
        number that is not finite.
    """
    verify(path)
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (ValueError, OSError, EOFError, zipfile.BadZipFile, KeyError):
        raise CorruptFile(path, "not a readable array file") from None
    for name, shape in shapes.items():
        if name not in arrays:
            raise CorruptFile(path, f"array {name!r} is missing")
        stored_shape = arrays[name].shape
        if len(stored_shape) != len(shape) or any(
            n not in (None, m) for n, m in zip(shape, stored_shape, strict=True)
        ):
            raise CorruptFile(path, f"array {name!r} has shape {stored_shape}, expected {shape}")
    for name, array in arrays.items():
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            raise CorruptFile(path, f"array {name!r} holds a value that is not finite")
    return arrays
