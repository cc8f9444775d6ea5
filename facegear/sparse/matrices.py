"""Symmetric matrices as sums over cells, dense ones, and factors of sparse ones.

Dense symmetric positive definite matrices. Where `overwrite` is set, the result may take the place of the
argument.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.linalg import blas, lapack
from scipy.sparse.linalg import splu

from facegear.arrays import Array, Integers
from facegear.errors import FacegearError

AT_ONCE = 128
"""Number of small matrices that are computed together."""


@dataclass(frozen=True, eq=False)
class Part:
    """Part of a large symmetric matrix: sum of transformation[r].T @ s @ transformation[r] over m small
    matrices s.

    Small matrices are computed only when they are asked for. A cell is the smallest unit that nested
    dissection divides: a group of small matrices, such as a finite element and the ones it was cut into.

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
            """Return the weighted small matrices (k, a, a) of `numbers` (k,), which count within the
            selection.
            """
            return weights[numbers][:, None, None] * self.matrices(members[numbers])

        return Part(weighted_matrices, self.rows[members], self.transformation, cell)

    def seen_by(self, turn: sp.csr_matrix) -> "Part":
        """Return the part of the matrix in other unknowns, of which its own are linear combinations.

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
    """Return a matrix with an entry for each unknown on which a cell's small matrices depend.

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
    """Yield the small matrices of a part group by group, from group 0 to `count` - 1; a group may have
    none.

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
        Small matrices (k, a, a), N/m, of one group, and their rows (k, a) of part.transformation.
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


BLOCK = 256
"""Rows and columns that are mirrored together, so that both fit into a cache."""


def cholesky(matrix: Array, overwrite: bool = False) -> Array:
    """Factorise a symmetric positive definite matrix as L @ L.T (LAPACK dpotrf); its lower triangle is
    read.

    Parameters
    ----------
    matrix : (n, n) array
        Any unit.
    overwrite : bool
        Whether the factor may replace the matrix.

    Returns
    -------
    (n, n) array
        Lower factor L with zeros above, square root of the unit.

    Raises
    ------
    FacegearError
        If the matrix is not positive definite.
    """
    lower, error_code = lapack.dpotrf(matrix, lower=1, clean=1, overwrite_a=overwrite)
    if error_code:
        raise FacegearError("a condensed stiffness is not positive definite: the body is not held")
    return lower


def inverse(factor: Array) -> Array:
    """Invert a matrix from its lower factor, at half the cost of solving for the unit matrix.

    Parameters
    ----------
    factor : (n, n) array
        Lower factor, zeros above; any unit.

    Returns
    -------
    (n, n) array
        Inverse, one over the matrix's unit.
    """
    lower, _ = lapack.dpotri(factor, lower=1)
    return fill_upper_triangle(lower)


def solve_factored(factor: Array, rhs: Array, overwrite: bool = False) -> Array:
    """Solve L @ L.T @ x = rhs with the lower factor L of `cholesky`.

    Parameters
    ----------
    factor : (n, n) array
        Lower factor L, any unit.
    rhs : (n, m) array
        Right-hand sides, any unit.
    overwrite : bool
        Whether the solution may replace the right-hand sides.

    Returns
    -------
    (n, m) array
        Solution, in the unit of the right-hand sides over the matrix's unit.
    """
    return lapack.dpotrs(factor, rhs, lower=1, overwrite_b=overwrite)[0]


def forward(factor: Array, rhs: Array, overwrite: bool = False) -> Array:
    """Multiply by the inverse of a lower factor L: solve L @ x = rhs by forward substitution.

    Parameters
    ----------
    factor : (n, n) array
        Lower factor L, any unit.
    rhs : (n, m) array
        Right-hand sides, any unit.
    overwrite : bool
        Whether the result may replace the right-hand sides.

    Returns
    -------
    (n, m) array
        Unit of the right-hand sides over the factor's unit.
    """
    return blas.dtrsm(1.0, factor, rhs, lower=1, overwrite_b=overwrite)


def backward(factor: Array, rhs: Array, overwrite: bool = False) -> Array:
    """Multiply by the inverse of a lower factor's transpose: solve L.T @ x = rhs by backward
    substitution.

    Parameters
    ----------
    factor : (n, n) array
        Lower factor L, any unit.
    rhs : (n, m) array
        Right-hand sides, any unit.
    overwrite : bool
        Whether the result may replace the right-hand sides.

    Returns
    -------
    (n, m) array
        Unit of the right-hand sides over the factor's unit.
    """
    return blas.dtrsm(1.0, factor, rhs, lower=1, trans_a=1, overwrite_b=overwrite)


def plus_square(matrix: Array, half: Array, sign: float = 1.0, overwrite: bool = False) -> Array:
    """Add `sign` times half.T @ half to a symmetric matrix.

    Parameters
    ----------
    matrix : (n, n) array
        Matrix of which the lower triangle is read, any unit.
    half : (m, n) array
        Square root of the unit.
    sign : float
        Dimensionless factor.
    overwrite : bool
        Whether the result may replace the matrix.

    Returns
    -------
    (n, n) array
        Unit of the matrix.
    """
    return fill_upper_triangle(
        blas.dsyrk(sign, half, beta=1.0, c=matrix, trans=1, lower=1, overwrite_c=overwrite)
    )


def fill_upper_triangle(square: Array) -> Array:
    """Copy the lower triangle of an array to its upper one, in place.

    Parameters
    ----------
    square : (n, n) array
        Any unit; changed in place.

    Returns
    -------
    (n, n) array
        The argument, same unit.
    """
    for start in range(0, len(square), BLOCK):
        block = slice(start, start + BLOCK)
        square[block, start + BLOCK :] = square[start + BLOCK :, block].T
        diagonal = np.tril(square[block, block])
        square[block, block] = diagonal + np.tril(diagonal, -1).T
    return square


def solve_sparse(matrix: sp.csr_matrix, rhs: Array) -> Array:
    """Solve a sparse symmetric positive definite system for several right-hand sides.

    Parameters
    ----------
    matrix
        Symmetric positive definite matrix (n, n).
    rhs
        Right-hand sides (n, m).

    Returns
    -------
    Array
        The solutions (n, m).

    Raises
    ------
    FacegearError
        If the matrix is singular.
    """
    try:
        # Minimum degree on A + A^T, and pivots from the diagonal, keep the fill of a symmetric matrix small.
        factor = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    except RuntimeError as error:
        raise FacegearError(f"factorisation of {matrix.shape[0]} dof failed: {error}") from None
    return factor.solve(rhs)


Solve = Callable[[Array], Array]
"""Function from right-hand sides (n,) or (n, m) to solutions of the same shape."""


def solver(matrix: sp.spmatrix) -> Solve:
    """Factorise a sparse symmetric positive definite matrix once (SuperLU), to solve for many right-hand
    sides.

    Parameters
    ----------
    matrix : sp.spmatrix
        The matrix (n, n).

    Returns
    -------
    Solve
        Function that returns the solutions for right-hand sides (n,) or (n, m), in their shape.
    """
    factor = splu(
        matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    return lambda loads: np.asarray(factor.solve(np.ascontiguousarray(loads)))
