"""Nested dissection of a finite element system by planes (George 1973).

The cells of a mesh are cut in two again and again. What both halves share is eliminated after them, so that
each half is condensed for itself onto its boundary.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers, Mask

LEAF = 300
"""Dof to be eliminated at once, below which a part is not cut further."""
SMALLEST = 0.02
"""Part of the dof that the smaller half has at least."""
BALANCE = 0.5
"""Power of that part over which the dof on a plane are weighed."""
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
    alike = _Alike(cells, kept)
    groups = _Cells(alike, centres)
    taken = np.zeros(len(alike.size), dtype=bool)
    fronts: list[Front] = []
    _dissect(groups, np.arange(cells.shape[0]), taken, fronts)
    return [replace(front, dof=alike.members(front.dof)) for front in fronts]


class _Alike:
    """Groups of dof that belong to the same cells, as the three of a node do, but for those that are kept.

    `cells` (m, g) are the cells by groups, `size` (g,) says how many dof a group has.
    """

    def __init__(self, cells: sp.csr_matrix, kept: Integers) -> None:
        names = np.random.default_rng(0).integers(2**62, size=cells.shape[0])
        of_dof = sp.csr_matrix((np.ones(cells.nnz, np.int64), cells.indices, cells.indptr), cells.shape).T
        free = np.ones(cells.shape[1], dtype=bool)
        free[kept] = False
        dof = np.flatnonzero(free)
        _, first, group, self.size = np.unique(
            (of_dof @ names)[dof], return_index=True, return_inverse=True, return_counts=True
        )
        self._dof = dof[np.argsort(group, kind="stable")]
        self._ends = np.cumsum(self.size)
        self.cells = cells[:, dof[first]]

    def members(self, groups: Integers) -> Integers:
        """The dof of some groups, ascending."""
        return np.sort(self._dof[_runs(self._ends[groups] - self.size[groups], self.size[groups])])


class _Cells:
    """Cells by groups of dof, with room to note where each group first and last occurs."""

    def __init__(self, alike: _Alike, centres: Array) -> None:
        self.along = centres @ DIRECTIONS.T
        self.size = alike.size
        self.start, self.indices = alike.cells.indptr[:-1].astype(np.int64), alike.cells.indices
        self.count = np.diff(alike.cells.indptr)
        self.first, self.last = (np.empty(len(self.size), dtype=np.int64) for _ in range(2))

    def entries(self, members: Integers, taken: Mask) -> tuple[Integers, Integers]:
        """Groups of all members one after the other but for those taken, and the member of each."""
        groups = self.indices[_runs(self.start[members], self.count[members])]
        free = ~taken[groups]
        return groups[free], np.repeat(np.arange(len(members)), self.count[members])[free]

    def ends(self, groups: Integers, position: Integers) -> tuple[Integers, Integers, Integers]:
        """The groups, each once, with the smallest and the largest of their ascending positions."""
        self.first[groups[::-1]] = position[::-1]
        self.last[groups] = position
        once = groups[self.first[groups] == position]
        return once, self.first[once], self.last[once]


def _runs(start: Integers, size: Integers) -> Integers:
    """Numbers from each start on, as many as `size` says, one run after the other."""
    ends = np.cumsum(size)
    return np.arange(size.sum()) + np.repeat(start - ends + size, size)


def _dissect(cells: _Cells, members: Integers, taken: Mask, fronts: list[Front]) -> int:
    """Append the fronts of some cells, and return the number of the last one."""
    inside = np.unique(cells.entries(members, taken)[0])
    large = cells.size[inside].sum() > LEAF and members.size > 1
    halves = _halves(cells, members, taken) if large else None
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
    """Two halves and the groups they share, by the plane with fewest dof for how evenly it cuts.

    None if all are one.
    """
    best: tuple[float, Integers, int] | None = None
    for along in cells.along.T:
        order = members[np.argsort(along[members], kind="stable")]
        once, low, high = cells.ends(*cells.entries(order, taken))
        # dof that begin, and that end, with each cell in this order
        begun, ended = (np.cumsum(np.bincount(end, cells.size[once], len(order)))[:-1] for end in (low, high))
        whole = cells.size[once].sum()
        smaller = np.minimum(ended, whole - begun) / (ended + whole - begun)
        even = smaller >= SMALLEST
        cost = np.full(len(even), np.inf)
        cost[even] = (begun - ended)[even] / smaller[even] ** BALANCE
        at = int(np.argmin(cost))
        if np.isfinite(cost[at]) and (best is None or cost[at] < best[0]):
            best = float(cost[at]), order, at + 1
    if best is None:
        return None
    _, order, cut = best
    once, low, high = cells.ends(*cells.entries(order, taken))
    return order[:cut], order[cut:], np.sort(once[(low < cut) & (high >= cut)])
