"""The elements of the bodies in scikit-fem: 27-node hexahedra, or linear elements on the same nodes."""

from dataclasses import replace

import numpy as np
from skfem import ElementHex1, ElementHex2, ElementTetP1, Mesh, MeshHex1, MeshHex2

from facegear.arrays import Array
from facegear.contact.options import Element

KINDS = {"hex27": (ElementHex2, 5), "hex8": (ElementHex1, 3), "tet4": (ElementTetP1, 1)}
"""Element and the degree that its quadrature integrates exactly in each direction."""


def mesh_of(mesh: MeshHex2, element: Element) -> Mesh:
    """The mesh as it is, its hexahedra cut into eight 8-node ones each, or those into six tetrahedra each.

    Nodes keep their numbers. Part c of hexahedron e of m is element e + c m.
    """
    if element == "hex27":
        return mesh
    cubes = replace(MeshHex1.from_mesh(mesh).refined(), doflocs=mesh.doflocs)
    return cubes if element == "hex8" else _from_the_middle(cubes).to_meshtet()


def _from_the_middle(cubes: MeshHex1) -> MeshHex1:
    """The eight cubes of each hexahedron mirrored, so that their tetrahedra meet in its middle.

    scikit-fem's tetrahedra stand around the diagonal from corner 3 to corner 4. If it runs from the middle to
    a corner of the hexahedron, all its faces are divided alike and neighbours match, however they are turned.
    """
    bits = ElementHex1.doflocs.astype(np.int64) @ np.array([4, 2, 1])
    mirrored = np.argsort(bits)[bits[:, None] ^ bits[3] ^ bits]
    corners = cubes.t.reshape(8, 8, -1)
    turned = np.take_along_axis(corners, mirrored[:, :, None], axis=0)
    return replace(cubes, t=np.ascontiguousarray(turned.reshape(8, -1)))


def hex_values(local: Array) -> Array:
    """Values (n, 27) of the triquadratic functions at local positions (n, 3) in the unit cube."""
    element = ElementHex2()
    return np.stack([element.lbasis(local.T, i)[0] for i in range(len(element.doflocs))], axis=1)
