"""27-node hexahedra in tensor order as scikit-fem meshes, whose nodes are vertices, edges, facets, cells."""

import numpy as np
from skfem import ElementHex2, MeshHex2

from facegear.arrays import Array, Integers

TENSOR = (2 * ElementHex2.doflocs @ np.array([1, 3, 9])).astype(np.int64)
"""Index i + 3 j + 9 k in tensor order of each local node of scikit-fem's element."""


def hex_mesh(nodes: Array, hexes: Integers) -> tuple[MeshHex2, Integers]:
    """Build a mesh of hexahedra.

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
