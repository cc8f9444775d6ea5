"""A large symmetric matrix as the sum of small ones, each of a cell of a mesh: it is never put together."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers

AT_ONCE = 128
"""Small matrices that are made together."""


@dataclass(frozen=True, eq=False)
class Part:
    """Of the large matrix: the sum of moved[r].T @ s @ moved[r] over m small matrices s.

    Attributes
    ----------
    matrices
        Gives the small matrices (k, a, a) of numbers (k,) below m.
    rows : (m, a)
        Rows r of `moved` for each small matrix.
    moved : (q, n)
        What its rows and columns stand for by the n rows and columns of the large one.
    cell : (m,)
        To which cell each belongs.
    """

    matrices: Callable[[Integers], Array]
    rows: Integers
    moved: sp.csr_matrix
    cell: Integers

    def chosen(self, members: Integers, weights: Array, cell: Integers) -> "Part":
        """Some of the small matrices, with weights (k,), in other cells (k,)."""

        def weighted(numbers: Integers) -> Array:
            return weights[numbers][:, None, None] * self.matrices(members[numbers])

        return Part(weighted, self.rows[members], self.moved, cell)

    def seen_by(self, turn: sp.csr_matrix) -> "Part":
        """The same, with the unknowns of the large matrix given by `turn` (n, l) times l others."""
        moved = (self.moved @ turn).tocsr()
        moved.eliminate_zeros()
        return replace(self, moved=moved)


def coupled(parts: Sequence[Part], cells: int) -> sp.csr_matrix:
    """Matrix (cells, n) with an entry for each unknown on which a cell depends."""
    total = sp.csr_matrix((cells, parts[0].moved.shape[1]))
    for part in parts:
        at = np.repeat(part.cell, part.rows.shape[1]), part.rows.ravel()
        inside = sp.csr_matrix((np.ones(part.rows.size), at), shape=(cells, part.moved.shape[0]))
        total += inside @ abs(part.moved)
    return total.tocsr()


def in_turn(part: Part, group: Integers, count: int) -> Iterator[tuple[Array, Integers]]:
    """Small matrices (k, a, a) and their rows (k, a), of group 0, then 1, to `count` of them.

    group: which of them each cell is in. Each small matrix is made once, AT_ONCE or more together.
    """
    number = group[part.cell]
    order = np.argsort(number, kind="stable")
    ends = np.searchsorted(number[order], np.arange(count + 1))
    start = stop = 0
    made = np.zeros((0, 0, 0))
    for first, last in pairwise(ends):
        if last > stop:
            start, stop = first, max(last, ends[np.searchsorted(ends, first + AT_ONCE, side="right") - 1])
            made = part.matrices(order[start:stop])
        yield made[first - start : last - start], part.rows[order[first:last]]
