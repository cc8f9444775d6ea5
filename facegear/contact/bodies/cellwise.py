"""A large symmetric matrix as the sum of small ones, each of a cell of a mesh; it is never assembled."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers

AT_ONCE = 128
"""Number of small matrices that are computed together."""


@dataclass(frozen=True, eq=False)
class Part:
    """Part of the large matrix: the sum of transformation[r].T @ s @ transformation[r] over m small matrices
    s.

    Attributes
    ----------
    matrices
        Gives the small matrices (k, a, a) of numbers (k,) below m.
    rows : (m, a) array of int
        Rows r of `transformation` for each small matrix.
    transformation : (q, n) sparse matrix
        Rows and columns of the small matrices by the n rows and columns of the large one.
    cell : (m,) array of int
        Cell of each small matrix.
    """

    matrices: Callable[[Integers], Array]
    rows: Integers
    transformation: sp.csr_matrix
    cell: Integers

    def select(self, members: Integers, weights: Array, cell: Integers) -> "Part":
        """Return some of the small matrices, with weights, in other cells.

        Parameters
        ----------
        members : (k,) array of int
            Numbers of the small matrices.
        weights : (k,) array
            Dimensionless factors.
        cell : (k,) array of int
            New cell of each.

        Returns
        -------
        Part
            Weighted small matrices.
        """

        def weighted_matrices(numbers: Integers) -> Array:
            return weights[numbers][:, None, None] * self.matrices(members[numbers])

        return Part(weighted_matrices, self.rows[members], self.transformation, cell)

    def seen_by(self, turn: sp.csr_matrix) -> "Part":
        """Return the part in other unknowns.

        Parameters
        ----------
        turn : (n, l) sparse matrix
            Unknowns of the large matrix by the l new ones.

        Returns
        -------
        Part
            Part of an (l, l) matrix.
        """
        transformation = (self.transformation @ turn).tocsr()
        transformation.eliminate_zeros()
        return replace(self, transformation=transformation)


def cell_unknowns(parts: Sequence[Part], cells: int) -> sp.csr_matrix:
    """Return a matrix with an entry for each unknown on which a cell depends.

    Parameters
    ----------
    parts : Sequence[Part]
        Parts of a matrix with n unknowns.
    cells : int
        Number of cells.

    Returns
    -------
    (cells, n) sparse matrix
        Only its pattern has a meaning.
    """
    total = sp.csr_matrix((cells, parts[0].transformation.shape[1]))
    for part in parts:
        at = np.repeat(part.cell, part.rows.shape[1]), part.rows.ravel()
        inside = sp.csr_matrix((np.ones(part.rows.size), at), shape=(cells, part.transformation.shape[0]))
        total += inside @ abs(part.transformation)
    return total.tocsr()


def in_turn(part: Part, group: Integers, count: int) -> Iterator[tuple[Array, Integers]]:
    """Yield the small matrices group by group.

    Each small matrix is computed once, AT_ONCE or more together.

    Parameters
    ----------
    part : Part
        Part of a matrix.
    group : (cells,) array of int
        Group of each cell.
    count : int
        Number of groups.

    Yields
    ------
    tuple of arrays
        Small matrices (k, a, a), N/m, and their rows (k, a).
    """
    number = group[part.cell]
    order = np.argsort(number, kind="stable")
    ends = np.searchsorted(number[order], np.arange(count + 1))
    start = stop = 0
    batch = np.zeros((0, 0, 0))
    for first, last in pairwise(ends):
        if last > stop:
            start, stop = first, max(last, ends[np.searchsorted(ends, first + AT_ONCE, side="right") - 1])
            batch = part.matrices(order[start:stop])
        yield batch[first - start : last - start], part.rows[order[first:last]]
