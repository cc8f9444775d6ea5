"""Store chunks of a sweep as named arrays: the one writer and reader of their files.

Files hold finite numbers. Where a number may not exist (NaN) an array `..._known` says where it does.
"""

import numpy as np

from facegear.arrays import AnyArray, Arrays
from facegear.dynamics.sweeps.sweep import Piece

NAMES = tuple(Piece.__dataclass_fields__)
MAY_LACK = (
    "leading_multiplier",
    "exponent_per_period",
    "exponent_interval",
    "first_look_period",
    "second_look_period",
)
"""Fields of a piece that may be NaN."""
PER_SPEED = (
    "speeds",
    "motion",
    "period",
    "residual",
    "periods_run",
    "symmetry_broken",
    "modal_order",
    *MAY_LACK,
)
"""Fields of a piece with one value for each speed."""
DIMENSIONS = {
    **dict.fromkeys(NAMES, 2),
    **{name: 3 for name in NAMES if name.startswith("translation_")},
    **dict.fromkeys(PER_SPEED, 1),
    "spectrum": 3,
}
"""Number of dimensions of each field."""
_PER_PART: dict[str, tuple[int | None, ...]] = {
    **{name: (None,) * DIMENSIONS[name] for name in NAMES},
    **{f"{name}_known": (None,) for name in MAY_LACK},
}
SHAPES = {f"{part}_{name}": shape for part in ("before", "own") for name, shape in _PER_PART.items()}
"""Arrays of a file with their shapes; None is any length."""


def to_arrays(before: Piece, own_piece: Piece) -> dict[str, AnyArray]:
    """Return a chunk as arrays.

    Parameters
    ----------
    before, own_piece : Piece
        Results at the overlap and at the own speeds.

    Returns
    -------
    dict
        Arrays with the names and shapes of SHAPES, such as (speeds, meshes).
    """
    arrays: dict[str, AnyArray] = {}
    for part, piece in (("before", before), ("own", own_piece)):
        arrays |= {f"{part}_{name}": getattr(piece, name) for name in NAMES}
        for name in MAY_LACK:
            values = getattr(piece, name)
            arrays[f"{part}_{name}_known"] = ~np.isnan(values)
            arrays[f"{part}_{name}"] = np.nan_to_num(values)
    return arrays


def from_arrays(arrays: Arrays) -> tuple[Piece, Piece]:
    """Return the chunk that to_arrays() has stored.

    Parameters
    ----------
    arrays : Arrays
        Arrays of SHAPES.

    Returns
    -------
    tuple of Piece
        Results at the overlap and at the own speeds.
    """
    pieces = []
    for part in ("before", "own"):
        values = {name: arrays[f"{part}_{name}"] for name in NAMES}
        for name in MAY_LACK:
            values[name] = np.where(arrays[f"{part}_{name}_known"], values[name], np.nan)
        pieces.append(Piece(**values))
    return pieces[0], pieces[1]
