"""Factors of the sparse symmetric matrices of a section."""

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from facegear.arrays import Array

Solve = Callable[[Array], Array]
"""Function from right-hand sides (n,) or (n, m) to solutions of the same shape."""


def solver(matrix: sp.spmatrix) -> Solve:
    """Factorise a symmetric positive definite matrix.

    Parameters
    ----------
    matrix : sp.spmatrix
        The matrix (n, n).

    Returns
    -------
    Solve
        Function that solves for right-hand sides (n,) or (n, m).
    """
    factor = splu(
        matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    return lambda loads: np.asarray(factor.solve(np.ascontiguousarray(loads)))
