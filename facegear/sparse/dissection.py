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
"""Fraction of the dof that the smaller half has at least."""
BALANCE = 0.5
"""Power of that fraction by which the number of dof on a plane is divided."""
DIRECTIONS = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 0, -1)]) / np.sqrt(
    [[1], [1], [1], [2], [2]]
)
"""Normals of the planes that are tried."""


@dataclass(frozen=True, eq=False)
class Front:
    """Dof (p,) that are eliminated together.

    `before` are the fronts that must be eliminated first, as numbers in the list of all fronts. `cells`
    (m,) are numbers of the cells of a part that is not cut further; a front of dof that two halves share
    has none.
    """

    dof: Integers
    before: tuple[int, ...]
    cells: Integers


def dissection(cells: sp.csr_matrix, centres: Array, kept_dof: Integers) -> list[Front]:
    """Return the fronts that eliminate all dof but the kept ones, each after those it needs (nested
    dissection).

    Dof that share no cell are not coupled. The last front may be empty.

    Parameters
    ----------
    cells : (m, n) sparse matrix
        Entries in row i for each dof of cell i.
    centres : (m, 3) array
        Positions of the cells, m.
    kept_dof : (k,) array of int
        Numbers of the dof that are not eliminated.

    Returns
    -------
    list[Front]
        Fronts in the order of elimination.
    """
    dof_groups = _DofGroups(cells, kept_dof)
    groups = _Cells(dof_groups, centres)
    is_eliminated = np.zeros(len(dof_groups.size), dtype=bool)
    fronts: list[Front] = []
    _dissect(groups, np.arange(cells.shape[0]), is_eliminated, fronts)
    return [replace(front, dof=dof_groups.members(front.dof)) for front in fronts]


class _DofGroups:
    """Groups of dof that belong to the same cells, as the three of a node do, without the kept dof.

    `cells` (m, g) are the cells by groups, `size` (g,) is the number of dof of each group.
    """

    def __init__(self, cells: sp.csr_matrix, kept_dof: Integers) -> None:
        """Group the free dof of `cells` (m, n) by the set of cells they belong to, told apart by random
        sums of names.
        """
        names = np.random.default_rng(0).integers(2**62, size=cells.shape[0])
        of_dof = sp.csr_matrix((np.ones(cells.nnz, np.int64), cells.indices, cells.indptr), cells.shape).T
        free = np.ones(cells.shape[1], dtype=bool)
        free[kept_dof] = False
        dof = np.flatnonzero(free)
        _, first, group, self.size = np.unique(
            (of_dof @ names)[dof], return_index=True, return_inverse=True, return_counts=True
        )
        self._dof = dof[np.argsort(group, kind="stable")]
        self._ends = np.cumsum(self.size)
        self.cells = cells[:, dof[first]]

    def members(self, groups: Integers) -> Integers:
        """Return the dof of some groups, by the groups' numbers, as ascending dof numbers of the whole
        matrix.
        """
        return np.sort(self._dof[_runs(self._ends[groups] - self.size[groups], self.size[groups])])


class _Cells:
    """Cells by groups of dof, with buffers for the positions where each group first and last occurs.

    `along` (m, directions): positions of the cells along DIRECTIONS, m; `size` (g,): dof of each group;
    `start`, `count` (m,): each cell's range in `indices`, the numbers of its groups.
    """

    def __init__(self, dof_groups: _DofGroups, centres: Array) -> None:
        """Prepare positions, groups and buffers of cells at `centres` (m, 3), m."""
        self.along = centres @ DIRECTIONS.T
        self.size = dof_groups.size
        self.start, self.indices = dof_groups.cells.indptr[:-1].astype(np.int64), dof_groups.cells.indices
        self.count = np.diff(dof_groups.cells.indptr)
        self.first, self.last = (np.empty(len(self.size), dtype=np.int64) for _ in range(2))

    def entries(self, members: Integers, is_eliminated: Mask) -> tuple[Integers, Integers]:
        """List the groups of dof of some cells that are not eliminated yet, cell by cell.

        Return the group of each entry, and the position in `members` of its cell. A group is listed once
        for each cell that it belongs to.
        """
        groups = self.indices[_runs(self.start[members], self.count[members])]
        free = ~is_eliminated[groups]
        return groups[free], np.repeat(np.arange(len(members)), self.count[members])[free]

    def ends(self, groups: Integers, position: Integers) -> tuple[Integers, Integers, Integers]:
        """Return the groups, each once, with the smallest and the largest position at which each occurs.

        Parameters
        ----------
        groups : Integers
            Number (n,) of the group at each place, an index.
        position : Integers
            Position (n,) of each place, an index, in ascending order.

        Returns
        -------
        tuple of Integers
            Groups (g,), first and last position (g,) of each.
        """
        self.first[groups[::-1]] = position[::-1]
        self.last[groups] = position
        once = groups[self.first[groups] == position]
        return once, self.first[once], self.last[once]


def _runs(start: Integers, size: Integers) -> Integers:
    """Concatenate the ranges start[i], ..., start[i] + size[i] - 1; `start` and `size` (n,)."""
    ends = np.cumsum(size)
    return np.arange(size.sum()) + np.repeat(start - ends + size, size)


def _dissect(cells: _Cells, members: Integers, is_eliminated: Mask, fronts: list[Front]) -> int:
    """Append the fronts of the cells `members`, halves first, and return the number of the last one.

    Dof in these fronts are marked in `is_eliminated`. A part with at most LEAF free dof, with one cell,
    or that no plane divides becomes one front.
    """
    inside = np.unique(cells.entries(members, is_eliminated)[0])
    large = cells.size[inside].sum() > LEAF and members.size > 1
    halves = _halves(cells, members, is_eliminated) if large else None
    if halves is None:
        is_eliminated[inside] = True
        fronts.append(Front(inside, (), members))
        return len(fronts) - 1
    first, second, separator = halves
    is_eliminated[separator] = True
    before = tuple(_dissect(cells, half, is_eliminated, fronts) for half in (first, second))
    fronts.append(Front(separator, before, members[:0]))
    return len(fronts) - 1


def _halves(
    cells: _Cells, members: Integers, is_eliminated: Mask
) -> tuple[Integers, Integers, Integers] | None:
    """Cut the cells `members` by the plane with the lowest ratio of shared dof to balance.

    The cost is the number of dof on the plane over (share of dof in the smaller half) ** BALANCE, for
    planes normal to DIRECTIONS between any two cells. Return the cells of both halves and the groups of
    dof they share; None if no plane leaves at least SMALLEST in the smaller half.
    """
    best: tuple[float, Integers, int] | None = None
    for along in cells.along.T:
        order = members[np.argsort(along[members], kind="stable")]
        once, low, high = cells.ends(*cells.entries(order, is_eliminated))
        # dof that begin, and that end, with each cell in this order
        dof_begun, dof_ended = (
            np.cumsum(np.bincount(end, cells.size[once], len(order)))[:-1] for end in (low, high)
        )
        whole = cells.size[once].sum()
        smaller = np.minimum(dof_ended, whole - dof_begun) / (dof_ended + whole - dof_begun)
        even = smaller >= SMALLEST
        cost = np.full(len(even), np.inf)
        cost[even] = (dof_begun - dof_ended)[even] / smaller[even] ** BALANCE
        at = int(np.argmin(cost))
        if np.isfinite(cost[at]) and (best is None or cost[at] < best[0]):
            best = float(cost[at]), order, at + 1
    if best is None:
        return None
    _, order, cut = best
    once, low, high = cells.ends(*cells.entries(order, is_eliminated))
    return order[:cut], order[cut:], np.sort(once[(low < cut) & (high >= cut)])
