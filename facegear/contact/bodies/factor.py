"""Sparse symmetric positive definite systems: solves and Schur complements.

PARDISO (MKL through pypardiso, matrix type 2, upper triangle) where it has a wheel, SciPy's SuperLU
elsewhere.
"""

import os
from functools import cache
from importlib.metadata import PackageNotFoundError, files

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from facegear.arrays import Array, Integers
from facegear.errors import FacegearError

try:
    from pypardiso import PyPardisoSolver
    from pypardiso.pardiso_wrapper import PyPardisoError
except ImportError:  # MKL has no wheel for this platform
    PyPardisoSolver = None

POSITIVE_DEFINITE = 2
COLUMNS_AT_ONCE = 128


def schur_complement(matrix: sp.csr_matrix, kept: Integers) -> Array:
    """Dense A_kk - A_kr A_rr^-1 A_rk with k the `kept` dof and r the others, shape (k, k), ordered as `kept`.

    `matrix` (n, n) is symmetric and positive definite on r. Raises FacegearError if the factorisation fails,
    which means that the body is not held or its mesh is broken.
    """
    rest = np.setdiff1d(np.arange(matrix.shape[0]), kept)
    if rest.size == 0:
        return matrix[kept][:, kept].toarray()
    order = np.concatenate([rest, kept])
    ordered = matrix[order][:, order].tocsr()
    ordered.sort_indices()
    solve = _schur_scipy if PyPardisoSolver is None else _schur_pardiso
    schur = solve(ordered, rest.size)
    if not np.isfinite(schur).all():
        raise FacegearError("the stiffness matrix is singular: the body is not held or its mesh is broken")
    schur += schur.T.copy()
    schur *= 0.5
    return schur


def solve_sparse(matrix: sp.csr_matrix, rhs: Array) -> Array:
    """Solve a symmetric positive definite system for right-hand sides (n, m).

    Raises FacegearError if the factorisation fails.
    """
    if PyPardisoSolver is None:
        return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(rhs)
    upper = sp.triu(matrix, format="csr")
    upper.sort_indices()
    solver = _pardiso()
    try:
        return solver.solve(upper, rhs)
    except PyPardisoError as error:
        raise FacegearError(f"factorisation of {matrix.shape[0]} dof failed: {error}") from None
    finally:
        solver.free_memory(everything=True)


def _pardiso() -> "PyPardisoSolver":
    """A solver that knows where MKL is. Without it, each takes a second to look for it."""
    library = _mkl()
    if library:
        os.environ.setdefault("PYPARDISO_MKL_RT", library)
    return PyPardisoSolver(mtype=POSITIVE_DEFINITE)


@cache
def _mkl() -> str | None:
    try:
        paths = [str(file.locate()) for file in files("mkl") or () if "mkl_rt" in file.name]
    except PackageNotFoundError:
        return None
    return min((path for path in paths if os.path.exists(path)), key=len, default=None)


def _schur_pardiso(matrix: sp.csr_matrix, eliminated: int) -> Array:
    upper = sp.triu(matrix, format="csr")
    size = matrix.shape[0] - eliminated
    solver = _pardiso()
    solver.set_iparm(1, 1)
    solver.set_iparm(2, 2)
    solver.set_iparm(36, 1)
    solver.perm = np.zeros(matrix.shape[0], dtype=np.int32)
    solver.perm[eliminated:] = 1
    solver.set_phase(12)
    try:
        # pypardiso has no public call for iparm(36): PARDISO writes the complement into the solution array.
        return solver._call_pardiso(upper, np.zeros((size, size), order="F"))
    except PyPardisoError as error:
        raise FacegearError(f"factorisation of {eliminated} dof failed: {error}") from None
    finally:
        solver.set_phase(-1)
        solver._call_pardiso(upper, np.zeros((matrix.shape[0], 1)))


def _schur_scipy(matrix: sp.csr_matrix, eliminated: int) -> Array:
    inner = matrix[:eliminated, :eliminated].tocsc()
    coupling = matrix[:eliminated, eliminated:].tocsc()
    schur = matrix[eliminated:, eliminated:].toarray()
    try:
        factor = splu(
            inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
    except RuntimeError as error:
        raise FacegearError(f"factorisation of {eliminated} dof failed: {error}") from None
    for start in range(0, schur.shape[0], COLUMNS_AT_ONCE):
        columns = slice(start, start + COLUMNS_AT_ONCE)
        schur[:, columns] -= coupling.T @ factor.solve(coupling[:, columns].toarray())
    return schur
