"""Dense symmetric positive definite matrices."""

import numpy as np
from scipy.linalg import lapack

from facegear.arrays import Array
from facegear.errors import FacegearError


def cholesky(matrix: Array) -> Array:
    """Lower factor (n, n) of a symmetric matrix. Raises FacegearError if it is not positive definite."""
    lower, failed = lapack.dpotrf(matrix, lower=1, clean=1)
    if failed:
        raise FacegearError("a condensed stiffness is not positive definite: the body is not held")
    return lower


def inverse(factor: Array) -> Array:
    """Inverse (n, n) from a lower factor, zeros above, at half the cost of solving for the unit matrix."""
    lower, _ = lapack.dpotri(factor, lower=1)
    result = lower + lower.T
    np.fill_diagonal(result, lower.diagonal())
    return result


def solved(factor: Array, rhs: Array) -> Array:
    """Solution (n, m) of a system given by its lower factor."""
    return lapack.dpotrs(factor, rhs, lower=1)[0]
