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
from numpy.typing import NDArray
from skfem import Basis, ElementLineP1, ElementQuad1, ElementQuad2, MeshLine, MeshQuad

TWO_POINTS = 3
"""Degree that two Gauss points integrate exactly."""


def face_functions(
    coordinates: NDArray[np.float64], shape: tuple[int, int], linear: bool = False
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Nodes (n, a) of the faces at lattice coordinates (n, 2), values (n, a) and gradients (n, a, 2) there.

    Biquadratic over faces of hexahedra; with `linear` bilinear between neighbouring nodes, as 8-node
    hexahedra on the same nodes are. Gradients are by lattice coordinate.
    """
    element, size = (ElementQuad1(), 1) if linear else (ElementQuad2(), 2)
    last = np.array(shape) - 1 - size
    corner = size * np.clip(coordinates // size, 0, last // size)
    local = ((coordinates - corner) / size).T
    functions = [element.lbasis(local, i) for i in range(len(element.doflocs))]
    steps = np.rint(size * element.doflocs)
    nodes = ((corner[:, None] + steps) @ np.array([shape[1], 1])).astype(np.int64)
    values = np.stack([value for value, _ in functions], axis=1)
    return nodes, values, np.stack([gradient.T for _, gradient in functions], axis=1) / size


def interpolation(
    coordinates: NDArray[np.float64], shape: tuple[int, int], linear: bool = False
) -> sp.csr_matrix:
    """Interpolation (n, nu nv) from lattice nodes to lattice coordinates (n, 2), see `face_functions`."""
    nodes, values, _ = face_functions(coordinates, shape, linear)
    return _rows(nodes, values, shape[0] * shape[1])


def pressure_basis(shape: tuple[int, int]) -> Basis:
    """Bilinear hats in lattice coordinates with 2 x 2 Gauss points in each cell between nodes."""
    mesh = MeshQuad.init_tensor(*(np.arange(float(count)) for count in shape))
    return Basis(mesh, ElementQuad1(), intorder=TWO_POINTS)


def cell_points(basis: Basis) -> NDArray[np.float64]:
    """Lattice coordinates (q, 2) of a pressure basis' Gauss points, cell by cell."""
    return np.asarray(basis.global_coordinates()).reshape(2, -1).T.copy()


def hat_values(basis: Basis) -> sp.csr_matrix:
    """Bilinear hats (q, nu nv) of a pressure basis at its Gauss points, four a point."""
    return _rows(*_by_point(basis), basis.N)


@lru_cache(maxsize=16)
def edge_hats(nodes: int) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    """Two Gauss points (q,) in each interval between `nodes` nodes on a line, and the two hats there.

    Hats (q, 2) by their nodes, and their values (q, 2).
    """
    basis = Basis(MeshLine(np.arange(float(nodes))), ElementLineP1(), intorder=TWO_POINTS)
    return np.asarray(basis.global_coordinates()).ravel(), *_by_point(basis)


def cell_areas(surface: NDArray[np.float64], basis: Basis) -> NDArray[np.float64]:
    """Area (m2) that each Gauss point of the pressure basis stands for, surface nodes (nu, nv, 3)."""
    nodes, _, gradients = face_functions(cell_points(basis), surface.shape[:2])
    tangents = np.einsum("qad,qai->dqi", gradients, surface.reshape(-1, 3)[nodes])
    return np.linalg.norm(np.cross(*tangents), axis=1) * basis.dx.ravel()


def _by_point(basis: Basis) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Nodes (q, a) and values (q, a) of a scalar basis' functions at all its quadrature points."""
    values = np.stack([np.asarray(function[0]).ravel() for function in basis.basis], axis=1)
    return np.repeat(basis.element_dofs.T, basis.X.shape[1], axis=0).astype(np.int64), values


def _rows(nodes: NDArray[np.int64], values: NDArray[np.float64], count: int) -> sp.csr_matrix:
    pointer = np.arange(0, nodes.size + 1, nodes.shape[1])
    return sp.csr_matrix((values.ravel(), nodes.ravel(), pointer), shape=(len(nodes), count))
