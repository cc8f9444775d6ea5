"""Hexahedra of 27 nodes as scikit-fem meshes, and measures of their quality."""

from collections.abc import Iterator
from functools import cache

import numpy as np
from skfem import ElementHex2, MeshHex2
from skfem.quadrature import get_quadrature

from facegear.arrays import Array, Integers
from facegear.errors import InvalidInput
from facegear.teeth.tooth_mesh import FeTooth

TENSOR = (2 * ElementHex2.doflocs @ np.array([1, 3, 9])).astype(np.int64)
"""Index i + 3 j + 9 k in tensor order of each local node of scikit-fem's element."""


def hex_mesh(nodes: Array, hexes: Integers) -> tuple[MeshHex2, Integers]:
    """Build scikit-fem's mesh of 27-node hexahedra.

    Displacement i of a node with the number k has the dof 3 k + i of `ElementVector(ElementHex2())`.

    Parameters
    ----------
    nodes : (n, 3) array
        Positions, m.
    hexes : (m, 27) array of int
        Nodes of each hexahedron in tensor order.

    Returns
    -------
    tuple[MeshHex2, Integers]
        Mesh, and number (n,) of each node in it; -1 for nodes that no element uses.
    """
    local = hexes[:, TENSOR].T
    mesh = MeshHex2(np.ascontiguousarray(nodes.T), np.ascontiguousarray(local))
    numbers = np.full(len(nodes), -1, dtype=np.int64)
    numbers[local] = mesh.dofs.element_dofs
    return mesh, numbers


ELEMENTS_AT_ONCE = 2000
"""Number of elements judged together, which bounds memory; results do not depend on it."""
DEGREE = 5
"""Degree of the quadrature of volumes: the determinant of the 27-node geometry has at most the degree 5 each
way."""


def scaled_jacobians(nodes: Array, hexes: Integers) -> Array:
    """Compute the smallest scaled Jacobian of each element over its 27 nodes.

    The determinant is divided by the product of the lengths of the three edge directions.

    Parameters
    ----------
    nodes : (n, 3) array
        m.
    hexes : (m, 27) array of int
        Nodes of each element.

    Returns
    -------
    (m,) array
        Dimensionless number, -1..1, 1 for a box.
    """
    points = nodes[hexes[:, TENSOR]]
    edges = np.einsum("qja,mai->jiqm", _slopes_at_nodes(), points, optimize=True)
    lengths = np.prod(np.linalg.norm(edges, axis=1), axis=0)
    volumes = np.einsum("iqm,iqm->qm", edges[0], np.cross(edges[1], edges[2], axis=0))
    return np.min(volumes / lengths, axis=0)


@cache
def _slopes_at_nodes() -> Array:
    """Gradients (nodes, 3, functions) of the 27 shape functions of a hexahedron at its 27 nodes, both in
    the order of scikit-fem, by the local coordinates x, y, z (axis 1) from 0 to 1.
    """
    element = ElementHex2()
    count = len(element.doflocs)
    slopes = np.stack([element.lbasis(element.doflocs.T, i)[1] for i in range(count)])
    return np.ascontiguousarray(slopes.transpose(2, 1, 0))


def require_right_side_out(tooth: FeTooth) -> None:
    """Refuse a mesh with an element turned inside out, which no stiffness may come from.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of a tooth.

    Raises
    ------
    InvalidInput
        Names the number of such elements.
    """
    orientation = np.count_nonzero(scaled_jacobians(tooth.nodes, tooth.hexes) <= 0.0)
    if orientation:
        elements = f"{orientation} elements of the {tooth.body.replace('_', ' ')} turned inside out"
        raise InvalidInput(
            "element size",
            elements,
            "a finer or coarser one (or another `element depth below the fillets`) with which no "
            "element turns",
        )


def volume(nodes: Array, hexes: Integers) -> float:
    """Compute the volume of all elements by Gauss quadrature, exact for the 27-node geometry.

    Parameters
    ----------
    nodes : (n, 3) array
        m.
    hexes : (m, 27) array of int
        Nodes of each element.

    Returns
    -------
    float
        m^3.
    """
    mesh, _ = hex_mesh(nodes, hexes)
    points, weights = get_quadrature(ElementHex2, DEGREE)
    return sum(float(np.sum(mesh.mapping().detDF(points, tind=batch) @ weights)) for batch in _batches(mesh))


def _batches(mesh: MeshHex2) -> Iterator[Integers]:
    """Yield the indices of the mesh's elements in batches of at most ELEMENTS_AT_ONCE."""
    for start in range(0, mesh.nelements, ELEMENTS_AT_ONCE):
        yield np.arange(start, min(start + ELEMENTS_AT_ONCE, mesh.nelements))
