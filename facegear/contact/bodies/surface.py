"""The refined contact surface: quadratic displacement, piecewise bilinear pressure, loads consistent with
both.

The displacement lives on a lattice of nodes (nu, nv), two nodes an element both ways: the faces of 27-node
hexahedra (`ElementQuad2`). The pressure is a sum of bilinear basis functions (hats), one a node
(`ElementQuad1` between nodes), so that the nodal loads, the mean gap and the mean displacement of a basis
function follow from one matrix. Lattice coordinates count nodes: 0..nu-1 across the profile, 0..nv-1 along
the width; node (i, j) has the number i nv + j.
"""

from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementLineP1, ElementQuad1, ElementQuad2, MeshLine, MeshQuad

from facegear.arrays import Array, Integers

TWO_POINTS = 3
"""Polynomial degree that two Gauss points integrate exactly."""

LINEAR_STEPS, QUADRATIC_STEPS = (
    np.rint(size * kind.doflocs).astype(np.int64) for size, kind in ((1, ElementQuad1()), (2, ElementQuad2()))
)
"""Places (a, 2) of an element's nodes in nodes from its corner, in the order of the elements' functions."""


def face_functions(
    coordinates: Array, shape: tuple[int, int], linear: bool = False
) -> tuple[Integers, Array, Array]:
    """Evaluate the functions of element faces at lattice coordinates.

    They are biquadratic over faces of hexahedra; with `linear` bilinear between neighbouring nodes, as
    those of 8-node hexahedra on the same nodes.

    Parameters
    ----------
    coordinates : (n, 2) array
        Lattice coordinates, dimensionless.
    shape : tuple[int, int]
        Of the lattice.
    linear : bool
        Whether the functions are bilinear.

    Returns
    -------
    tuple of arrays
        Nodes (n, a) of the faces, values (n, a), and gradients (n, a, 2) by lattice coordinate;
        dimensionless.
    """
    size, steps = (1, LINEAR_STEPS) if linear else (2, QUADRATIC_STEPS)
    last = (np.array(shape) - 1 - size) // size
    corner = size * np.clip(np.floor(coordinates / size).astype(np.int64), 0, last)
    value, slope = _interval_functions((coordinates - corner) / size, linear)
    row, column = steps.T
    across, along, slope_across, slope_along = (
        part[:, axis, step] for part in (value, slope) for axis, step in enumerate((row, column))
    )
    nodes = (corner[:, :1] + row) * shape[1] + corner[:, 1:] + column
    gradients = np.stack([slope_across * along, across * slope_along], axis=-1) / size
    return nodes, across * along, gradients


def _interval_functions(x: Array, linear: bool) -> tuple[Array, Array]:
    """Return values and slopes (..., a) of the Lagrange polynomials of an interval at x (...) in 0..1."""
    value: tuple[Array, ...] = (1.0 - x, x)
    slope: tuple[Array, ...] = (np.full_like(x, -1.0), np.ones_like(x))
    if not linear:
        value = (1.0 - x) * (1.0 - 2.0 * x), 4.0 * x * (1.0 - x), x * (2.0 * x - 1.0)
        slope = 4.0 * x - 3.0, 4.0 - 8.0 * x, 4.0 * x - 1.0
    return np.stack(value, axis=-1), np.stack(slope, axis=-1)


def interpolation(coordinates: Array, shape: tuple[int, int], linear: bool = False) -> sp.csr_matrix:
    """Return the interpolation from lattice nodes to lattice coordinates, see `face_functions`.

    Parameters
    ----------
    coordinates : (n, 2) array
        Lattice coordinates, dimensionless.
    shape : tuple[int, int]
        Of the lattice.
    linear : bool
        Whether the functions are bilinear.

    Returns
    -------
    (n, nu nv) sparse matrix
        Dimensionless weights.
    """
    nodes, values, _ = face_functions(coordinates, shape, linear)
    return _rows(nodes, values, shape[0] * shape[1])


@lru_cache(maxsize=8)
def pressure_basis(shape: tuple[int, int]) -> Basis:
    """Return bilinear functions in lattice coordinates with 2 x 2 Gauss points in each cell between nodes.

    The object is shared by all callers.

    Parameters
    ----------
    shape : tuple[int, int]
        Of the lattice.

    Returns
    -------
    Basis
        Basis of scikit-fem.
    """
    mesh = MeshQuad.init_tensor(*(np.arange(float(count)) for count in shape))
    return Basis(mesh, ElementQuad1(), intorder=TWO_POINTS)


def cell_points(basis: Basis) -> Array:
    """Return the Gauss points of a pressure basis, cell by cell.

    Parameters
    ----------
    basis : Basis
        Result of `pressure_basis`.

    Returns
    -------
    (q, 2) array
        Lattice coordinates, dimensionless.
    """
    return np.asarray(basis.global_coordinates()).reshape(2, -1).T.copy()


def hat_values(basis: Basis) -> sp.csr_matrix:
    """Return the values of a pressure basis' functions at its Gauss points, four a point.

    Parameters
    ----------
    basis : Basis
        Result of `pressure_basis`.

    Returns
    -------
    (q, nu nv) sparse matrix
        Dimensionless values.
    """
    return _rows(*_by_point(basis), basis.N)


@lru_cache(maxsize=16)
def edge_hats(nodes: int) -> tuple[Array, Integers, Array]:
    """Return two Gauss points in each interval between nodes on a line, and the two linear functions there.

    Parameters
    ----------
    nodes : int
        Number of nodes.

    Returns
    -------
    tuple of arrays
        Points (q,) in node spacings, nodes of both functions (q, 2), and their values (q, 2);
        dimensionless.
    """
    basis = Basis(MeshLine(np.arange(float(nodes))), ElementLineP1(), intorder=TWO_POINTS)
    return np.asarray(basis.global_coordinates()).ravel(), *_by_point(basis)


def cell_areas(surface: Array) -> Array:
    """Compute the area that each Gauss point of the pressure basis stands for.

    Parameters
    ----------
    surface : (nu, nv, 3) array
        Positions of the surface nodes, m.

    Returns
    -------
    (q,) array
        m2.
    """
    rows, columns, _ = surface.shape
    across, along, weights = _slopes_at_cell_points((rows, columns))
    positions = surface.reshape(-1, 3)
    normals = np.cross(across @ positions, along @ positions)
    return np.asarray(weights * np.linalg.norm(normals, axis=1))


@lru_cache(maxsize=8)
def _slopes_at_cell_points(shape: tuple[int, int]) -> tuple[sp.csr_matrix, sp.csr_matrix, Array]:
    """Return slopes (q, n) across and along a surface by its nodes at a pressure basis' Gauss points, and the
    points' weights (q,).
    """
    basis = pressure_basis(shape)
    nodes, _, gradients = face_functions(cell_points(basis), shape)
    across, along = (_rows(nodes, gradients[:, :, axis], shape[0] * shape[1]) for axis in range(2))
    return across, along, basis.dx.ravel()


def _by_point(basis: Basis) -> tuple[Integers, Array]:
    """Return nodes (q, a) and values (q, a) of a scalar basis' functions at all its quadrature points."""
    values = np.stack([np.asarray(function[0]).ravel() for function in basis.basis], axis=1)
    return np.repeat(basis.element_dofs.T, basis.X.shape[1], axis=0).astype(np.int64), values


def _rows(nodes: Integers, values: Array, count: int) -> sp.csr_matrix:
    pointer = np.arange(0, nodes.size + 1, nodes.shape[1])
    return sp.csr_matrix((values.ravel(), nodes.ravel(), pointer), shape=(len(nodes), count))
