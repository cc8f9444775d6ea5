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
    """Lower factor (n, n) of a symmetric matrix. Raises FacegearError if it is not positive definite."""
    lower, failed = lapack.dpotrf(matrix, lower=1, clean=1, overwrite_a=overwrite)
    if failed:
        raise FacegearError("a condensed stiffness is not positive definite: the body is not held")
    return lower


def inverse(factor: Array) -> Array:
    """Inverse (n, n) from a lower factor, zeros above, at half the cost of solving for the unit matrix."""
    lower, _ = lapack.dpotri(factor, lower=1)
    return mirrored(lower)


def solved(factor: Array, rhs: Array, overwrite: bool = False) -> Array:
    """Solution (n, m) of a system given by its lower factor."""
    return lapack.dpotrs(factor, rhs, lower=1, overwrite_b=overwrite)[0]


def forward(factor: Array, rhs: Array, overwrite: bool = False) -> Array:
    """Inverse of a lower factor times (n, m)."""
    return blas.dtrsm(1.0, factor, rhs, lower=1, overwrite_b=overwrite)


def backward(factor: Array, rhs: Array, overwrite: bool = False) -> Array:
    """Inverse of a lower factor's transpose times (n, m)."""
    return blas.dtrsm(1.0, factor, rhs, lower=1, trans_a=1, overwrite_b=overwrite)


def plus_square(matrix: Array, half: Array, sign: float = 1.0, overwrite: bool = False) -> Array:
    """Symmetric (n, n), of which the lower triangle is read, plus `sign` times half.T @ half (m, n)."""
    return mirrored(blas.dsyrk(sign, half, beta=1.0, c=matrix, trans=1, lower=1, overwrite_c=overwrite))


def mirrored(square: Array) -> Array:
    """The same array with its lower triangle copied to its upper one."""
    for start in range(0, len(square), BLOCK):
        block = slice(start, start + BLOCK)
        square[block, start + BLOCK :] = square[start + BLOCK :, block].T
        diagonal = np.tril(square[block, block])
        square[block, block] = diagonal + np.tril(diagonal, -1).T
    return square
