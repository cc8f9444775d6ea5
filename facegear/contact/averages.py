"""Averages over points under hats, and the nodal loads that unit forces spread by them make; compiled."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.contact.bodies.surface import face_functions
from facegear.contact.options import Refinement
from facegear.machine_code.compiler import compiler

compiled = compiler()

ROUNDING = 1e-6
"""Of coordinates on a lattice."""


@dataclass(frozen=True, eq=False)
class Rows:
    """Averages over points: row i takes points `index` by `weight`, from pointer[i] to pointer[i + 1].

    No row is empty, and the weights of a row sum to one.
    """

    pointer: Integers
    index: Integers
    weight: Array

    def __len__(self) -> int:
        return len(self.pointer) - 1

    def mean(self, values: Array) -> Array:
        """Averages (m,) of values (q,)."""
        return np.add.reduceat(self.weight * values[self.index], self.pointer[:-1])

    def heaviest(self) -> Integers:
        """The point (m,) with the largest weight of each row, the first of those alike to rounding."""
        row = np.repeat(np.arange(len(self)), np.diff(self.pointer))
        return self.index[np.lexsort((-np.round(self.weight, 12), row))[self.pointer[:-1]]]

    def only(self, keep: Mask) -> "Rows":
        """The rows marked (m,)."""
        counts = np.diff(self.pointer)
        inside = np.repeat(keep, counts)
        pointer = np.zeros(np.count_nonzero(keep) + 1, self.pointer.dtype)
        np.cumsum(counts[keep], out=pointer[1:])
        return Rows(pointer, self.index[inside], self.weight[inside])


def rows_of(matrix: sp.csr_matrix, keep: Mask) -> sp.csr_matrix:
    """Rows marked (m,), as `matrix[keep]`, which takes ten times longer."""
    rows = Rows(matrix.indptr, matrix.indices, matrix.data).only(keep)
    return sp.csr_matrix((rows.weight, rows.index, rows.pointer), shape=(len(rows), matrix.shape[1]))


def stacked(parts: list[Rows], points: list[int]) -> Rows:
    """Rows below each other, over the points of all parts one after the other, `points` each."""
    rows = np.cumsum([0] + [part.index.size for part in parts])
    starts = np.cumsum([0, *points])
    return Rows(
        np.concatenate([[0]] + [part.pointer[1:] + row for part, row in zip(parts, rows, strict=False)]),
        np.concatenate([part.index + start for part, start in zip(parts, starts, strict=False)]),
        np.concatenate([part.weight for part in parts]),
    )


def hat_averages(
    hats: Integers,
    values: Array,
    area: Array,
    min_area: Array,
) -> tuple[Rows, Integers]:
    """Averages by area over hats, from points (q,) of known area.

    `hats`, `values` (q, h): the hats that a point lies under and their values there; `min_area` (n,): the
    area below which a hat is left out. Returns the rows and their hats (m,).
    """
    pointer, index, weight, chosen = _hat_averages(hats, values, area, min_area)
    return Rows(pointer, index, weight), chosen


@compiled
def _hat_averages(
    hats: Integers, values: Array, area: Array, min_area: Array
) -> tuple[Integers, Integers, Array, Integers]:
    covered, points = np.zeros(min_area.size), np.zeros(min_area.size, np.int64)
    for q in range(hats.shape[0]):
        for h in range(hats.shape[1]):
            covered[hats[q, h]] += values[q, h] * area[q]
            points[hats[q, h]] += 1
    chosen = np.flatnonzero(covered > min_area)
    pointer = np.zeros(chosen.size + 1, np.int64)
    pointer[1:] = np.cumsum(points[chosen])
    slot = np.full(min_area.size, -1)
    slot[chosen] = pointer[:-1]
    index, weight = np.empty(pointer[-1], np.int64), np.empty(pointer[-1])
    for q in range(hats.shape[0]):
        for h in range(hats.shape[1]):
            hat = hats[q, h]
            if slot[hat] >= 0:
                index[slot[hat]] = q
                weight[slot[hat]] = values[q, h] * area[q] / covered[hat]
                slot[hat] += 1
    return pointer, index, weight, chosen


def spread(rows: Rows, coordinates: Array, shape: tuple[int, int], linear: bool = False) -> sp.csr_matrix:
    """The rows times `surface.interpolation(coordinates, shape, linear)`, (m, nu nv), in one pass."""
    nodes, values, _ = face_functions(coordinates, shape, linear)
    count = shape[0] * shape[1]
    spread_to, load, pointer = _averaged(rows.pointer, rows.index, rows.weight, nodes, values, count)
    return sp.csr_matrix((load, spread_to, pointer), shape=(len(rows), count))


@dataclass(frozen=True)
class Lattice:
    """Nodes of a contact surface: their numbers before refinement both ways, and how they are refined.

    `linear` where the body is of elements linear between nodes; `flank_rows`: how many of the rows before
    refinement belong to the flank, None for all; the others lie in the fillet.
    """

    coarse: tuple[int, int]
    refinement: Refinement
    linear: bool = False
    flank_rows: int | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of nodes across the profile and along the width, refined."""
        nu, nv = self.coarse
        return (nu - 1) * self.refinement.profile + 1, (nv - 1) * self.refinement.width + 1

    @property
    def factors(self) -> Integers:
        """Refined nodes a coarse one, both ways."""
        return np.array([self.refinement.profile, self.refinement.width])

    def in_fillet(self, at: Array) -> Mask:
        """Which points at refined coordinates (q, 2) lie beyond the flank."""
        rows = self.coarse[0] if self.flank_rows is None else self.flank_rows
        return at[:, 0] > (rows - 1) * self.refinement.profile + ROUNDING

    def loads(self, rows: Rows, at: Array) -> tuple[sp.csr_matrix, sp.csr_matrix]:
        """Nodal loads of unit forces, spread by `rows` over points at refined coordinates (q, 2).

        On the refined nodes (m, n) and on the coarse ones.
        """
        fine, coarse = ((at, self.shape), (at / self.factors, self.coarse))
        return spread(rows, *fine, self.linear), spread(rows, *coarse, self.linear)


@compiled
def _averaged(
    pointer: Integers, index: Integers, weight: Array, nodes: Integers, values: Array, count: int
) -> tuple[AnyArray, Array, AnyArray]:
    """Columns, values and row ends of averages over points times rows of `values` at the columns `nodes`."""
    width = nodes.shape[1]
    columns, result = np.empty(width * index.size, np.int32), np.empty(width * index.size)
    ends, slot = np.zeros(pointer.size, np.int32), np.full(count, -1)
    filled = 0
    for row in range(pointer.size - 1):
        first = filled
        for k in range(pointer[row], pointer[row + 1]):
            point = index[k]
            for a in range(width):
                node = nodes[point, a]
                if slot[node] < first:
                    slot[node] = filled
                    columns[filled], result[filled] = node, 0.0
                    filled += 1
                result[slot[node]] += weight[k] * values[point, a]
        ends[row + 1] = filled
    return columns[:filled].copy(), result[:filled].copy(), ends
