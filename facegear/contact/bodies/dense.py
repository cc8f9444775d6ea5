"""Dense symmetric positive definite matrices.

Where `overwrite` is set, the result may take the place of the argument.
"""

import numpy as np
from scipy.linalg import blas, lapack

from facegear.arrays import Array
from facegear.errors import FacegearError

BLOCK = 256
"""Rows and columns that are mirrored together, so that both fit into a cache."""


def cholesky(matrix: Array, overwrite: bool = False) -> Array:
    """Factorise a symmetric positive definite matrix.

    Parameters
    ----------
    matrix : (n, n) array
        Any unit.
    overwrite : bool
        Whether the factor may replace the matrix.

    Returns
    -------
    (n, n) array
        Lower factor, square root of the unit.

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
    """Solve a system given by its lower factor.

    Parameters
    ----------
    factor : (n, n) array
        Lower factor, any unit.
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
    """Multiply by the inverse of a lower factor.

    Parameters
    ----------
    factor : (n, n) array
        Lower factor, any unit.
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
    """Multiply by the inverse of a lower factor's transpose.

    Parameters
    ----------
    factor : (n, n) array
        Lower factor, any unit.
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
