"""How the matrices of coordinates that are coupled beside the meshes are stored.

Modes of a body that bends are felt by that body's flanks alone, and couple with those of their own order
only, of which there are two or four as a rule. So the derivatives of the deflections are a few dense blocks,
and the coupling is blocks of LANES coordinates on its diagonal and short strips beside them.
"""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.machine_code.memory import LANES, aligned
from facegear.machine_code.records import Record

ROUNDING = 1e-15
"""Entries below this fraction of a matrix' largest are zeros that rounding has left."""
ZEROS = 8
"""A block is continued by the next vector of coordinates if that brings no more vectors of zeros into it."""


@Record.register
class Blocks(NamedTuple):
    """B dense blocks of the mesh Jacobian: coordinates next to each other, and the rows that touch them.

    The rows of block b are rows[starts[b]:starts[b + 1]], its coordinates those from first[b] to last[b],
    whole vectors. Seen from the rows, those from LANES k on touch the coordinates in vectors that begin at
    columns[tiles[k]:tiles[k + 1]].
    """

    starts: Integers
    rows: Integers
    first: Integers
    last: Integers
    tiles: Integers
    columns: Integers


@Record.register
class Strips(NamedTuple):
    """A matrix in strips of LANES rows and one column.

    Those of the rows from LANES k on are starts[k] to starts[k + 1], an even number; values (strips, LANES).
    """

    starts: Integers
    columns: Integers
    values: Array


@Record.register
class Coupled(NamedTuple):
    """What the kernels take of a system whose coordinates are coupled beside the meshes.

    own (n / LANES, 2 LANES, LANES): of LANES coordinates among themselves, by velocity, then by displacement:
    what lane i of k comes from lane i ^ j stands in own[k, j, i]. strips: what is left of the (n, 2 n)
    matrix that couples coordinates by velocity, then by displacement.
    """

    blocks: Blocks
    own: Array
    strips: Strips


def nonzero(matrix: Array) -> Mask:
    """Where a matrix is more than rounding."""
    return np.asarray(np.abs(matrix) > ROUNDING * np.abs(matrix).max(initial=0.0))


def blocks_of(rows: Array) -> Blocks:
    """Blocks of a matrix (m, n), both multiples of LANES; fewest where coordinates that the same rows touch
    stand together.
    """
    kept = np.asarray(nonzero(rows).reshape(len(rows), -1, LANES).any(axis=2))
    by_lanes = np.asarray(kept.reshape(-1, LANES, kept.shape[1]).any(axis=1))
    ends: list[int] = []
    begin = 0
    for k in range(1, kept.shape[1] + 1):
        if k == kept.shape[1] or _zeros(kept[:, begin : k + 1]) - _zeros(kept[:, begin:k]) > ZEROS:
            ends.append(k)
            begin = k
    first = np.array([0, *ends[:-1]], dtype=np.int64)
    touched = [np.flatnonzero(kept[:, i:j].any(axis=1)) for i, j in zip(first, ends, strict=True)]
    return Blocks(
        starts=np.append(0, np.cumsum([part.size for part in touched], dtype=np.int64)),
        rows=np.concatenate(touched),
        first=LANES * first,
        last=LANES * np.array(ends, dtype=np.int64),
        tiles=np.append(0, np.cumsum(by_lanes.sum(axis=1))),
        columns=LANES * np.nonzero(by_lanes)[1],
    )


def _zeros(kept: Mask) -> int:
    """Vectors of zeros in the rows that are touched at all."""
    return int((~kept[kept.any(axis=1)]).sum())


def coupled_of(blocks: Blocks, velocity: Array, displacement: Array) -> Coupled:
    """Coupling by velocity and by displacement, each (n, n), n a multiple of LANES."""
    lane = np.arange(LANES)
    own = aligned(len(velocity) // LANES, 2 * LANES, LANES)
    left = np.hstack([velocity, displacement])
    left[~nonzero(left)] = 0.0
    parts = left.reshape(len(own), LANES, 2, len(own), LANES)
    block = np.arange(len(own))
    for kind in range(2):
        for j in range(LANES):
            own[:, LANES * kind + j] = parts[block[:, None], lane, kind, block[:, None], lane ^ j]
        parts[block, :, kind, block] = 0.0
    return Coupled(blocks, own, strips_of(left))


def strips_of(matrix: Array) -> Strips:
    """A matrix (n, columns), n a multiple of LANES, without strips that are zero."""
    by_lanes = matrix.reshape(-1, LANES, matrix.shape[1]).swapaxes(1, 2)
    kept = np.asarray(by_lanes.any(axis=2))
    # A strip of zeros makes an odd number even.
    odd = np.flatnonzero(kept.sum(axis=1) % 2)
    kept[odd, (~kept[odd]).argmax(axis=1)] = True
    starts = np.append(0, np.cumsum(kept.sum(axis=1)))
    values = aligned(int(starts[-1]), LANES)
    values[:] = by_lanes[kept]
    return Strips(starts, np.ascontiguousarray(np.nonzero(kept)[1]), values)
