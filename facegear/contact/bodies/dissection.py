"""Nested dissection of a finite element system by planes (George 1973).

The cells of a mesh are cut in two again and again. What both halves share is eliminated after them, so that
each half is condensed for itself onto its boundary.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers, Mask

LEAF = 300
"""Dof to be eliminated at once, below which a part is not cut further."""
SMALLEST = 0.25
"""Part of the dof that the smaller half has at least."""
DIRECTIONS = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 0, -1)]) / np.sqrt(
    [[1], [1], [1], [2], [2]]
)
"""Normals of the planes that are tried."""


@dataclass(frozen=True, eq=False)
class Front:
    """Dof (p,) that are eliminated together, after the fronts `before`, numbers of a list in this order.

    `cells` (m,) are those of a part that is not cut further; none come with a front that joins others.
    """

    dof: Integers
    before: tuple[int, ...]
    cells: Integers


def dissection(cells: sp.csr_matrix, centres: Array, kept: Integers) -> list[Front]:
    """Fronts that eliminate all dof but `kept`, each after those it needs; the last one may be empty.

    Row i of `cells` (m, n) has an entry for each dof of a cell around `centres` (m, 3). Dof that share no
    cell are not coupled.
    """
    taken = np.zeros(cells.shape[1], dtype=bool)
    taken[kept] = True
    fronts: list[Front] = []
    _dissect(_Cells(cells, centres), np.arange(cells.shape[0]), taken, fronts)
    return fronts


class _Cells:
    """Cells with room to note where each dof first and last occurs."""

    def __init__(self, cells: sp.csr_matrix, centres: Array) -> None:
        self.along = centres @ DIRECTIONS.T
        self.indptr, self.indices = cells.indptr.astype(np.int64), cells.indices
        self.first, self.last = (np.empty(cells.shape[1], dtype=np.int64) for _ in range(2))

    def entries(self, members: Integers) -> tuple[Integers, Integers]:
        """Dof of all members one after the other, and which of the members each belongs to."""
        start, size = self.indptr[members], np.diff(self.indptr)[members]
        ends = np.cumsum(size)
        offset = np.repeat(start - ends + size, size)
        return self.indices[np.arange(ends[-1]) + offset], np.repeat(np.arange(len(members)), size)

    def ends(self, dof: Integers, position: Integers) -> tuple[Integers, Integers, Integers]:
        """The dof, each once, with the smallest and the largest of their ascending positions."""
        self.first[dof[::-1]] = position[::-1]
        self.last[dof] = position
        once = dof[self.first[dof] == position]
        return once, self.first[once], self.last[once]


def _dissect(cells: _Cells, members: Integers, taken: Mask, fronts: list[Front]) -> int:
    """Append the fronts of some cells, and return the number of the last one."""
    dof, _ = cells.entries(members)
    inside = np.unique(dof[~taken[dof]])
    halves = _halves(cells, members, taken) if inside.size > LEAF and members.size > 1 else None
    if halves is None:
        taken[inside] = True
        fronts.append(Front(inside, (), members))
        return len(fronts) - 1
    first, second, shared = halves
    taken[shared] = True
    before = tuple(_dissect(cells, half, taken, fronts) for half in (first, second))
    fronts.append(Front(shared, before, members[:0]))
    return len(fronts) - 1


def _halves(cells: _Cells, members: Integers, taken: Mask) -> tuple[Integers, Integers, Integers] | None:
    """Two halves and the dof they share, by the plane that fewest dof lie on; None if all are one."""
    best: tuple[float, Integers, int] | None = None
    for along in cells.along.T:
        order = members[np.argsort(along[members], kind="stable")]
        dof, position = cells.entries(order)
        free = ~taken[dof]
        once, low, high = cells.ends(dof[free], position[free])
        size = len(order) + 1
        crossing = np.cumsum(np.bincount(low + 1, minlength=size) - np.bincount(high + 1, minlength=size))
        before = np.cumsum(np.bincount(high + 1, minlength=size)) / len(once)
        after = 1.0 - np.cumsum(np.bincount(low, minlength=size)) / len(once)
        cuts = slice(1, len(order))
        smaller = np.minimum(before[cuts], after[cuts])
        cost = np.where(smaller >= SMALLEST * (before + after)[cuts], crossing[cuts], np.inf)
        at = int(np.argmin(cost))
        if np.isfinite(cost[at]) and (best is None or cost[at] < best[0]):
            best = float(cost[at]), order, at + 1
    if best is None:
        return None
    _, order, cut = best
    dof, position = cells.entries(order)
    free = ~taken[dof]
    once, low, high = cells.ends(dof[free], position[free])
    return order[:cut], order[cut:], np.sort(once[(low < cut) & (high >= cut)])
