"""27-node hexahedra in tensor order as scikit-fem meshes, whose nodes are vertices, edges, facets, cells."""

from functools import partial

import numpy as np
from skfem import Element, ElementHex2, FacetBasis, MeshHex2

from facegear.arrays import Array, Integers

TENSOR = (2 * ElementHex2.doflocs @ np.array([1, 3, 9])).astype(np.int64)
"""Index i + 3 j + 9 k in tensor order of each local node of scikit-fem's element."""

FOUND = 1e-7
"""Last step of Newton's method, in elements and summed over the points, at which a point counts as found."""


def hex_mesh(nodes: Array, hexes: Integers) -> tuple[MeshHex2, Integers]:
    """Mesh of hexahedra (m, 27) in tensor order on nodes (n, 3), and the number (n,) of each node in it.

    Displacement i of a node with the number k has the dof 3 k + i of `ElementVector(ElementHex2())`. Nodes
    that no element uses have the number -1.
    """
    local = hexes[:, TENSOR].T
    mesh = MeshHex2(np.ascontiguousarray(nodes.T), np.ascontiguousarray(local))
    numbers = np.full(len(nodes), -1, dtype=np.int64)
    numbers[local] = mesh.dofs.element_dofs
    return mesh, numbers


def facet_basis(mesh: MeshHex2, element: Element, facets: Integers, degree: int) -> FacetBasis:
    """Basis of `element` on facets, with a quadrature exact to `degree` in each direction.

    scikit-fem finds the facets' points in the elements by Newton's method to 1e-12 of an element. Rounding of
    coordinates alone is more where elements of 0.1 mm lie 250 mm from the origin, hence the wider tolerance:
    the last step of Newton's method is far smaller.
    """
    mapping = mesh.mapping()
    mapping.invF = partial(mapping.invF, newton_tol=FOUND)
    return FacetBasis(mesh, element, mapping=mapping, facets=facets, intorder=degree)
