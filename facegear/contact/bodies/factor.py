"""Solutions of sparse symmetric positive definite systems.

PARDISO (MKL through pypardiso, matrix type 2, upper triangle) where it has a wheel, SciPy's SuperLU
elsewhere.
"""

import os
from functools import cache
from importlib.metadata import PackageNotFoundError, files
from typing import TYPE_CHECKING

import scipy.sparse as sp
from scipy.sparse.linalg import splu

from facegear.arrays import Array
from facegear.errors import FacegearError

if TYPE_CHECKING:
    from pypardiso import PyPardisoSolver

POSITIVE_DEFINITE = 2


def solve_sparse(matrix: sp.csr_matrix, rhs: Array) -> Array:
    """Solve a symmetric positive definite system for right-hand sides (n, m).

    Raises FacegearError if the factorisation fails.
    """
    solver = _pardiso()
    if solver is None:
        return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(rhs)
    from pypardiso.pardiso_wrapper import PyPardisoError

    upper = sp.triu(matrix, format="csr")
    upper.sort_indices()
    try:
        return solver.solve(upper, rhs)
    except PyPardisoError as error:
        raise FacegearError(f"factorisation of {matrix.shape[0]} dof failed: {error}") from None
    finally:
        solver.free_memory(everything=True)


def _pardiso() -> "PyPardisoSolver | None":
    """A solver that knows where MKL is, without which its import takes half a second to look for it.

    None where MKL has no wheel.
    """
    library = _mkl()
    if library:
        os.environ.setdefault("PYPARDISO_MKL_RT", library)
    try:
        from pypardiso import PyPardisoSolver
    except ImportError:
        return None
    return PyPardisoSolver(mtype=POSITIVE_DEFINITE)


@cache
def _mkl() -> str | None:
    try:
        paths = [str(file.locate()) for file in files("mkl") or () if "mkl_rt" in file.name]
    except PackageNotFoundError:
        return None
    return min((path for path in paths if os.path.exists(path)), key=len, default=None)
