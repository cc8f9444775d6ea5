"""Chunks of a sweep as named arrays and back; numbers that do not exist (NaN) go into a mask."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.sweeps.sweep import Piece

NAMES = tuple(Piece.__dataclass_fields__)
DIMENSIONS = {
    "speeds": 1,
    "labels": 1,
    "deflection": 3,
    "force": 3,
    "shares": 3,
    "translation": 4,
    "facts": 2,
    "spectrum": 3,
    "modal": 2,
    "modal_order": 1,
    "displacement": 2,
    "velocity": 2,
}
SHAPES: dict[str, tuple[int | None, ...]] = {
    f"{part}_{name}": (None,) * DIMENSIONS[name] for part in ("before", "own") for name in NAMES
}


def to_arrays(before: Piece, own: Piece) -> dict[str, NDArray]:
    """Arrays of a chunk's overlap and own speeds."""
    arrays: dict[str, NDArray] = {}
    for part, piece in (("before", before), ("own", own)):
        for name in NAMES:
            arrays[f"{part}_{name}"] = getattr(piece, name)
        arrays[f"{part}_facts_known"] = ~np.isnan(piece.facts)
        arrays[f"{part}_facts"] = np.nan_to_num(piece.facts)
    return arrays


def from_arrays(arrays: Mapping[str, NDArray]) -> tuple[Piece, Piece]:
    """Overlap and own speeds of a stored chunk."""
    pieces = []
    for part in ("before", "own"):
        values = {name: arrays[f"{part}_{name}"] for name in NAMES}
        values["facts"] = np.where(arrays[f"{part}_facts_known"], values["facts"], np.nan)
        pieces.append(Piece(**values))
    return pieces[0], pieces[1]
