"""The elements of the bodies in scikit-fem: 27-node hexahedra, or linear elements on the same nodes."""

from dataclasses import replace

import numpy as np
from skfem import ElementHex1, ElementHex2, ElementTetP1, Mesh, MeshHex1, MeshHex2

from facegear.arrays import Array
from facegear.contact.options import Element

KINDS = {"hex27": (ElementHex2, 5), "hex8": (ElementHex1, 3), "tet4": (ElementTetP1, 1)}
"""Element and the degree that its quadrature integrates exactly in each direction."""


def mesh_of(mesh: MeshHex2, element: Element) -> Mesh:
    """Return the mesh with other elements: hexahedra, eight 8-node ones for each, or six tetrahedra for each
    of those.

    Nodes keep their numbers. Part c of hexahedron e of m is element e + c m.

    Parameters
    ----------
    mesh : MeshHex2
        Mesh of m 27-node hexahedra.
    element : Element
        Kind of element.

    Returns
    -------
    Mesh
        Mesh on the same nodes.
    """
    if element == "hex27":
        return mesh
    cubes = replace(MeshHex1.from_mesh(mesh).refined(), doflocs=mesh.doflocs)
    return cubes if element == "hex8" else _from_the_middle(cubes).to_meshtet()


def _from_the_middle(cubes: MeshHex1) -> MeshHex1:
    """Return the eight cubes of each hexahedron mirrored, so that their tetrahedra meet in its middle.

    scikit-fem's tetrahedra stand around the diagonal from corner 3 to corner 4. If it runs from the middle
    to a corner of the hexahedron, all its faces are divided in the same way and neighbours match, whatever
    their orientation.
    """
    bits = ElementHex1.doflocs.astype(np.int64) @ np.array([4, 2, 1])
    corner_order = np.argsort(bits)[bits[:, None] ^ bits[3] ^ bits]
    corners = cubes.t.reshape(8, 8, -1)
    reordered_corners = np.take_along_axis(corners, corner_order[:, :, None], axis=0)
    return replace(cubes, t=np.ascontiguousarray(reordered_corners.reshape(8, -1)))


def hex_values(local: Array) -> Array:
    """Evaluate the triquadratic functions of the unit cube.

    Parameters
    ----------
    local : (n, 3) array
        Positions in the unit cube, dimensionless.

    Returns
    -------
    (n, 27) array
        Values, dimensionless.
    """
    element = ElementHex2()
    return np.stack([element.lbasis(local.T, i)[0] for i in range(len(element.doflocs))], axis=1)
