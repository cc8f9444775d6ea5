"""The refined contact surface: quadratic displacement, piecewise bilinear pressure, loads consistent with
both.

The displacement lives on a lattice of nodes (nu, nv), two nodes an element both ways: the faces of 27-node
hexahedra (`ElementQuad2`). The pressure is a sum of bilinear hats, one a node (`ElementQuad1` between nodes),
so that a hat's nodal loads, its mean gap and its mean displacement follow from one matrix. Lattice
coordinates count nodes: 0..nu-1 across the profile, 0..nv-1 along the width; node (i, j) has the number
i nv + j.
"""

from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementLineP1, ElementQuad1, ElementQuad2, MeshLine, MeshQuad

from facegear.arrays import Array, Integers
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import cube, empty_numbers, empty_table, integer_table, integers

compiled, inlined = compiler(*picked.SOURCES), for_callers(error_model="numpy")

TWO_POINTS = 3
"""Degree that two Gauss points integrate exactly."""

LINEAR_STEPS, QUADRATIC_STEPS = (
    np.rint(size * kind.doflocs).astype(np.int64) for size, kind in ((1, ElementQuad1()), (2, ElementQuad2()))
)
"""Places (a, 2) of an element's nodes in nodes from its corner, in the order of the elements' functions."""


def face_functions(
    coordinates: Array, shape: tuple[int, int], linear: bool = False
) -> tuple[Integers, Array, Array]:
    """Nodes (n, a) of the faces at lattice coordinates (n, 2), values (n, a) and gradients (n, a, 2) there.

    Biquadratic over faces of hexahedra; with `linear` bilinear between neighbouring nodes, as 8-node
    hexahedra on the same nodes are. Gradients are by lattice coordinate.
    """
    steps = LINEAR_STEPS if linear else QUADRATIC_STEPS
    return _faces(np.ascontiguousarray(coordinates), shape[0], shape[1], steps)


@compiled
def _faces(coordinates: Array, rows: int, columns: int, steps: Integers) -> tuple[Integers, Array, Array]:
    """`face_functions` of elements whose nodes stand `steps` (a, 2) from their corner."""
    count, width, size = coordinates.shape[0], steps.shape[0], steps[0, 0]
    for a in range(width):
        size = max(size, steps[a, 0])
    nodes, corner = integer_table(count, width), integers(2, 0)
    values, gradients = empty_table(count, width), cube(count, width, 2)
    value, slope = empty_table(2, size + 1), empty_table(2, size + 1)
    for point in range(count):
        locate(coordinates[point, 0], coordinates[point, 1], (rows, columns), size, corner, value, slope)
        for a in range(width):
            i, j = steps[a, 0], steps[a, 1]
            nodes[point, a] = (corner[0] + i) * columns + corner[1] + j
            values[point, a] = value[0, i] * value[1, j]
            gradients[point, a, 0] = slope[0, i] * value[1, j] / size
            gradients[point, a, 1] = value[0, i] * slope[1, j] / size
    return nodes, values, gradients


@inlined
def locate(
    row: float, column: float, shape: tuple[int, int], size: int, corner: Integers, value: Array, slope: Array
) -> None:
    """Fill in the first node (2,) of the face at lattice coordinates, `size` nodes an element both ways, and
    values and slopes (2, size + 1) of the polynomials across and along it.
    """
    for axis in range(2):
        at = row if axis == 0 else column
        last = (shape[axis] - 1 - size) // size
        corner[axis] = size * min(max(int(np.floor(at / size)), 0), last)
        _interval((at - corner[axis]) / size, size, value[axis], slope[axis])


@inlined
def _interval(x: float, degree: int, value: Array, slope: Array) -> None:
    """Fill in values and slopes of the Lagrange polynomials of an interval at x in 0..1."""
    if degree == 1:
        value[0], value[1] = 1.0 - x, x
        slope[0], slope[1] = -1.0, 1.0
        return
    value[0], value[1], value[2] = (1.0 - x) * (1.0 - 2.0 * x), 4.0 * x * (1.0 - x), x * (2.0 * x - 1.0)
    slope[0], slope[1], slope[2] = 4.0 * x - 3.0, 4.0 - 8.0 * x, 4.0 * x - 1.0


def interpolation(coordinates: Array, shape: tuple[int, int], linear: bool = False) -> sp.csr_matrix:
    """Interpolation (n, nu nv) from lattice nodes to lattice coordinates (n, 2), see `face_functions`."""
    nodes, values, _ = face_functions(coordinates, shape, linear)
    return _rows(nodes, values, shape[0] * shape[1])


@lru_cache(maxsize=8)
def pressure_basis(shape: tuple[int, int]) -> Basis:
    """Bilinear hats in lattice coordinates with 2 x 2 Gauss points in each cell between nodes: shared."""
    mesh = MeshQuad.init_tensor(*(np.arange(float(count)) for count in shape))
    return Basis(mesh, ElementQuad1(), intorder=TWO_POINTS)


def cell_points(basis: Basis) -> Array:
    """Lattice coordinates (q, 2) of a pressure basis' Gauss points, cell by cell."""
    return np.asarray(basis.global_coordinates()).reshape(2, -1).T.copy()


def hat_values(basis: Basis) -> sp.csr_matrix:
    """Bilinear hats (q, nu nv) of a pressure basis at its Gauss points, four a point."""
    return _rows(*_by_point(basis), basis.N)


@lru_cache(maxsize=16)
def edge_hats(nodes: int) -> tuple[Array, Integers, Array]:
    """Two Gauss points (q,) in each interval between `nodes` nodes on a line, and the two hats there.

    Hats (q, 2) by their nodes, and their values (q, 2).
    """
    basis = Basis(MeshLine(np.arange(float(nodes))), ElementLineP1(), intorder=TWO_POINTS)
    return np.asarray(basis.global_coordinates()).ravel(), *_by_point(basis)


def cell_areas(surface: Array) -> Array:
    """Area (m2) that each Gauss point of the pressure basis stands for, surface nodes (nu, nv, 3)."""
    rows, columns, _ = surface.shape
    positions = np.ascontiguousarray(surface.reshape(-1, 3))
    return np.asarray(areas_at(positions, *_at_cell_points((rows, columns))))


@compiled
def areas_at(positions: Array, nodes: Integers, gradients: Array, weights: Array) -> Array:
    """Areas (q,) that q points stand for by weights (q,), of a surface through `positions` (n, 3) of its
    nodes, by its `face_functions`.
    """
    areas = empty_numbers(weights.size)
    for point in range(weights.size):
        ux, uy, uz, vx, vy, vz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for a in range(nodes.shape[1]):
            node, u, v = nodes[point, a], gradients[point, a, 0], gradients[point, a, 1]
            x, y, z = positions[node, 0], positions[node, 1], positions[node, 2]
            ux, uy, uz = ux + u * x, uy + u * y, uz + u * z
            vx, vy, vz = vx + v * x, vy + v * y, vz + v * z
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        areas[point] = weights[point] * np.sqrt(x * x + y * y + z * z)
    return areas


@lru_cache(maxsize=8)
def _at_cell_points(shape: tuple[int, int]) -> tuple[Integers, Array, Array]:
    """Nodes and gradients of `face_functions` at a pressure basis' Gauss points, and their weights (q,)."""
    basis = pressure_basis(shape)
    nodes, _, gradients = face_functions(cell_points(basis), shape)
    return nodes, gradients, basis.dx.ravel()


def _by_point(basis: Basis) -> tuple[Integers, Array]:
    """Nodes (q, a) and values (q, a) of a scalar basis' functions at all its quadrature points."""
    values = np.stack([np.asarray(function[0]).ravel() for function in basis.basis], axis=1)
    return np.repeat(basis.element_dofs.T, basis.X.shape[1], axis=0).astype(np.int64), values


def _rows(nodes: Integers, values: Array, count: int) -> sp.csr_matrix:
    pointer = np.arange(0, nodes.size + 1, nodes.shape[1])
    return sp.csr_matrix((values.ravel(), nodes.ravel(), pointer), shape=(len(nodes), count))
