"""Solution of sparse symmetric positive definite systems by SciPy's SuperLU."""

import scipy.sparse as sp
from scipy.sparse.linalg import splu

from facegear.arrays import Array
from facegear.errors import FacegearError


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
