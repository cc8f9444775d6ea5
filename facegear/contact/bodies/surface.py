"""The refined contact surface: quadratic displacement, piecewise bilinear pressure, loads consistent with
both.

The displacement lives on a lattice of nodes (nu, nv), two nodes an element both ways: the faces of 27-node
hexahedra (`ElementQuad2`). The pressure is a sum of bilinear basis functions (hats), one a node
(`ElementQuad1` between nodes), so that the nodal loads, the mean gap and the mean displacement of a basis
function follow from one matrix. Lattice coordinates count nodes: 0..nu-1 across the profile, 0..nv-1 along
the width; node (i, j) has the number i nv + j.

Strain gauges on a free surface: stress from the displacements of the surface alone. Where nothing touches,
the surface is in plane stress, and its stress follows from the displacement's derivatives along it. They are
taken at the 2 x 2 Gauss points of each facet, where derivatives of quadratic elements converge one order
faster than elsewhere.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementLineP1, ElementQuad1, ElementQuad2, MeshLine, MeshQuad

from facegear.arrays import Array, Integers
from facegear.teeth.design import Material

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
    """Return values and slopes (..., a) of the Lagrange polynomials of an interval at x (...) in 0..1.

    Nodes are 0 and 1 if `linear` (a = 2), else 0, 1/2 and 1 (a = 3). Slopes are derivatives by x.
    """
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
    """Return two Gauss points in each interval between nodes on a line, and the two linear functions
    there.

    The arrays are shared by all callers.

    Parameters
    ----------
    nodes : int
        Number of nodes.

    Returns
    -------
    tuple of arrays
        Points (q,), q = 2 (nodes - 1), in node spacings from the first node; nodes of both functions (q,
        2);
        and their values (q, 2); dimensionless.
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
    """Return derivatives at the q Gauss points of the pressure basis, and the points' weights (q,) in
    lattice units.

    The two matrices (q, nu nv) give the derivatives across and along the lattice, per lattice coordinate,
    of the biquadratic function with given values at the nodes.
    """
    basis = pressure_basis(shape)
    nodes, _, gradients = face_functions(cell_points(basis), shape)
    across, along = (_rows(nodes, gradients[:, :, axis], shape[0] * shape[1]) for axis in range(2))
    return across, along, basis.dx.ravel()


def _by_point(basis: Basis) -> tuple[Integers, Array]:
    """Return nodes (q, a) and values (q, a) of the a functions of a scalar basis that are not zero at
    each point.

    The q quadrature points come element by element.
    """
    values = np.stack([np.asarray(function[0]).ravel() for function in basis.basis], axis=1)
    return np.repeat(basis.element_dofs.T, basis.X.shape[1], axis=0).astype(np.int64), values


def _rows(nodes: Integers, values: Array, count: int) -> sp.csr_matrix:
    """Build a sparse matrix (q, count) whose row p has `values` (q, a) at the columns `nodes` (q, a)."""
    pointer = np.arange(0, nodes.size + 1, nodes.shape[1])
    return sp.csr_matrix((values.ravel(), nodes.ravel(), pointer), shape=(len(nodes), count))


GAUSS = 1.0 / np.sqrt(3.0)
"""Coordinate of the points of the two-point Gauss rule on [-1, 1], dimensionless."""


@dataclass(frozen=True, eq=False)
class Gauges:
    """Gauges (a, b) on a surface: a across it, b along its lines, two a facet both ways.

    `position` (m) and unit vectors `across` the lines and `along` them, (a, b, 3). The stress (Pa,
    tension positive) at gauge (i, j), number i b + j, is a row times the displacements (m) of the body's
    nodes, dof 3 k + i: normal stress `normal` across the lines, `axial` along them, and `shear`, each (a
    b, 3 n), Pa/m.
    """

    position: Array
    across: Array
    along: Array
    normal: sp.csr_matrix
    axial: sp.csr_matrix
    shear: sp.csr_matrix


def gauge_coordinates(nodes: int) -> Array:
    """Return the coordinates of the gauges along a line of nodes, two an element.

    Parameters
    ----------
    nodes : int
        Number of nodes.

    Returns
    -------
    (gauges,) array
        Lattice coordinates, dimensionless.
    """
    middle = np.arange(1.0, nodes, 2.0)
    return np.stack([middle - GAUSS, middle + GAUSS], axis=1).ravel()


def gauges_on(points: Array, nodes: Integers, material: Material) -> Gauges:
    """Place gauges on the faces of 27-node hexahedra.

    The lines that gauges stand across are those of constant first index.

    Parameters
    ----------
    points : (n, 3) array
        Positions of the body's nodes, m.
    nodes : (nu, nv) array of int
        Nodes of the faces.
    material : Material
        Of the body.

    Returns
    -------
    Gauges
        Gauges (a, b), in m and Pa/m.
    """
    shape = nodes.shape
    coordinates = np.meshgrid(*map(gauge_coordinates, shape), indexing="ij")
    at = np.stack(coordinates, axis=-1).reshape(-1, 2)
    local, values, gradients = face_functions(at, shape)
    corner = points[nodes.ravel()[local]]
    base = np.einsum("qad,qai->qdi", gradients, corner)
    along = base[:, 1] / np.linalg.norm(base[:, 1], axis=1)[:, None]
    across = base[:, 0] - along * np.sum(base[:, 0] * along, axis=1)[:, None]
    across /= np.linalg.norm(across, axis=1)[:, None]
    metric = np.linalg.inv(base @ base.transpose(0, 2, 1)) @ base
    # derivatives of each node's function along the two unit vectors
    slopes = np.einsum("qsi,qdi,qad->qsa", np.stack([across, along], axis=1), metric, gradients)
    strain_across = slopes[:, 0, :, None] * across[:, None]
    strain_along = slopes[:, 1, :, None] * along[:, None]
    shear = slopes[:, 1, :, None] * across[:, None] + slopes[:, 0, :, None] * along[:, None]
    young, ratio = material.young_modulus, material.poisson_ratio
    plane = young / (1.0 - ratio**2)
    parts = (
        plane * (strain_across + ratio * strain_along),
        plane * (strain_along + ratio * strain_across),
        young / (2.0 * (1.0 + ratio)) * shear,
    )
    normal, axial, shear = (_gauges_rows(nodes.ravel()[local], part, len(points)) for part in parts)
    grid = coordinates[0].shape
    return Gauges(
        position=np.einsum("qa,qai->qi", values, corner).reshape(*grid, 3),
        across=across.reshape(*grid, 3),
        along=along.reshape(*grid, 3),
        normal=normal,
        axial=axial,
        shear=shear,
    )


def _gauges_rows(nodes: Integers, values: Array, count: int) -> sp.csr_matrix:
    """Return a matrix (q, 3 count) with values (q, a, 3) at the dof 3 k + i of nodes k (q, a), axes i."""
    dof = 3 * nodes[:, :, None] + np.arange(3)
    pointer = np.arange(0, values.size + 1, values[0].size)
    return sp.csr_matrix((values.ravel(), dof.ravel(), pointer), shape=(len(nodes), 3 * count))
