"""Finite elements of a repeating part of a gear, and the stiffness that they are assembled to.

Stiffness of linear elastic bodies: scikit-fem's elements, contracted to element matrices in batches. scikit-
fem's form assembly gives the same matrix to rounding and is the reference in the tests; for the 27-node
element it is many times slower, which would make it the longest part of a compliance job.
"""

from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementHex1, ElementHex2, ElementTetP1, Mesh, MeshHex1, MeshHex2
from skfem.models.elasticity import lame_parameters
from skfem.quadrature import get_quadrature

from facegear.arrays import Array, Integers, Mask
from facegear.contact.options import Element
from facegear.sparse.matrices import Part
from facegear.teeth.design import Material

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
    """Return eight 8-node cubes of each hexahedron with their corners renumbered for the split into
    tetrahedra.

    scikit-fem's tetrahedra stand around the diagonal from corner 3 to corner 4. If it runs from the
    middle to a corner of the hexahedron, all its faces are divided in the same way and neighbours match,
    whatever their orientation.
    """
    bits = ElementHex1.doflocs.astype(np.int64) @ np.array([4, 2, 1])
    corner_order = np.argsort(bits)[bits[:, None] ^ bits[3] ^ bits]
    corners = cubes.t.reshape(8, 8, -1)
    reordered_corners = np.take_along_axis(corners, corner_order[:, :, None], axis=0)
    return replace(cubes, t=np.ascontiguousarray(reordered_corners.reshape(8, -1)))


def hex_values(local: Array) -> Array:
    """Evaluate the 27 triquadratic shape functions of a hexahedron.

    Parameters
    ----------
    local : (n, 3) array
        Positions in the unit cube, each coordinate 0 to 1, dimensionless.

    Returns
    -------
    (n, 27) array
        Values, dimensionless; columns in the order of `ElementHex2`'s local nodes.
    """
    element = ElementHex2()
    return np.stack([element.lbasis(local.T, i)[0] for i in range(len(element.doflocs))], axis=1)


def element_stiffness(basis: Basis, material: Material) -> Array:
    """Compute the stiffness of elements whose d displacement components share one scalar basis of a
    functions.

    Isotropic elasticity, in plane strain for d = 2. Dof d n + i is the displacement of local node n along
    axis i.

    Parameters
    ----------
    basis : Basis
        Scalar basis of scikit-fem with m elements in d = 2 or 3 dimensions.
    material : Material
        Of the elements.

    Returns
    -------
    (m, d a, d a) array
        N/m, in two dimensions per metre of width.

    Raises
    ------
    ValueError
        For an element that is turned inside out anywhere.
    """
    _require_right_side_out(basis.mapping.detDF(basis.X, basis.tind))
    gradient = np.stack([function[0].grad for function in basis.basis])
    nodes, axes, elements, points = gradient.shape
    weighted_gradients = (
        (gradient * np.sqrt(basis.dx)).transpose(3, 2, 1, 0).reshape(points, elements, axes, nodes)
    )
    stiffness = _contract_gradients(weighted_gradients, material)
    return stiffness.transpose(0, 2, 1, 4, 3).reshape(elements, nodes * axes, nodes * axes)


def isoparametric_stiffness(points: Array, element: Element, material: Material) -> Array:
    """Compute the stiffness of isoparametric elements in space, by Gauss quadrature of the degree in
    KINDS.

    Dof a i + n is the displacement of local node n along axis i (all x first, then all y, then all z).

    Parameters
    ----------
    points : (m, a, 3) array
        Positions of the nodes of each element, m.
    element : Kind
        Kind of element, a key of KINDS.
    material : Material
        Of the elements.

    Returns
    -------
    (m, 3 a, 3 a) array
        N/m.

    Raises
    ------
    ValueError
        For an element that is turned inside out anywhere.
    """
    weights, local = _at_quadrature(element)
    # tangents (3, 3, q, m): derivative along local axis j, then component i
    tangents = np.einsum("qja,mai->jiqm", local, points, optimize=True)
    normals = np.stack([np.cross(tangents[j - 2], tangents[j - 1], axis=0) for j in range(3)])
    volume = np.einsum("iqm,iqm->qm", tangents[0], normals[0])
    _require_right_side_out(volume.T)
    normals *= np.sqrt(weights[:, None] * np.abs(volume)) / volume
    weighted_gradients = normals.transpose(2, 3, 1, 0).reshape(len(weights), -1, 3) @ local
    stiffness = _contract_gradients(weighted_gradients.reshape(len(weights), len(points), 3, -1), material)
    return stiffness.reshape(len(points), 3 * points.shape[1], -1)


@cache
def _at_quadrature(element: Element) -> tuple[Array, Array]:
    """Return the weights (q,) of the element's quadrature points in its reference cell, and the gradients
    (q, d, a) of its a shape functions there by local coordinate.
    """
    make, degree = KINDS[element]
    kind = make()
    at, weights = get_quadrature(kind.refdom, degree)
    local = np.stack([kind.lbasis(at, node)[1] for node in range(len(kind.doflocs))])
    return weights, np.ascontiguousarray(local.transpose(2, 1, 0))


def _contract_gradients(weighted_gradients: Array, material: Material) -> Array:
    """Return isotropic element stiffnesses (m, d, a, d, a), N/m: axis and node of the force, then of the
    displacement.

    `weighted_gradients` (q, m, d, a): gradients of a shape functions by position at q quadrature points
    of m elements, 1/m, times the square root of the volume that each point stands for.
    """
    points, elements, axes, nodes = weighted_gradients.shape
    flat = weighted_gradients.reshape(points, elements, axes * nodes).transpose(1, 0, 2)
    outer = (flat.transpose(0, 2, 1) @ flat).reshape(elements, axes, nodes, axes, nodes)
    lame, shear = lame_parameters(material.young_modulus, material.poisson_ratio)
    stiffness = lame * outer
    outer *= shear
    trace = sum(outer[:, axis, :, axis] for axis in range(axes))
    for axis in range(axes):
        stiffness[:, axis, :, axis] += trace
        for second_axis in range(axes):
            stiffness[:, axis, :, second_axis] += outer[:, second_axis, :, axis]
    return stiffness


def _require_right_side_out(volume: Array) -> None:
    """Raise ValueError if an element's Jacobian determinants `volume` (m, q) at its q points differ in
    sign.
    """
    orientation = np.sign(volume)
    is_inverted = (orientation != orientation[:, :1]).any(axis=1)
    if is_inverted.any():
        raise ValueError(f"{np.count_nonzero(is_inverted)} elements are inverted")


def elements_of(
    mesh: MeshHex2,
    elements: Integers,
    cell: Integers,
    transformation: sp.csr_matrix,
    material: Material,
    element: Element = "hex27",
) -> Part:
    """Return the stiffness of some elements of a mesh as a part of a large matrix.

    Parameters
    ----------
    mesh : MeshHex2
        Mesh with q nodes.
    elements : (m,) array of int
        Numbers of the elements.
    cell : (m,) array of int
        Cell of each element.
    transformation : (3 q, n) sparse matrix
        Displacements of the mesh's nodes by the unknowns; dof 3 k + i is the displacement of node k along
        axis i.
    material : Material
        Of the elements.
    element : Element
        Other elements than hex27 are linear elements on the same nodes, for comparison.

    Returns
    -------
    Part
        Stiffness, N/m.
    """
    finer = mesh_of(mesh, element)
    copies, whole = finer.nelements // mesh.nelements, mesh.nelements
    elements = (elements + whole * np.arange(copies)[:, None]).ravel()
    nodes = finer.dofs.element_dofs[:, elements].T.astype(np.int64)

    def matrices(members: Integers) -> Array:
        """Return the stiffness (k, 3 a, 3 a), N/m, of k of the elements, by their numbers."""
        return isoparametric_stiffness(finer.doflocs.T[nodes[members]], element, material)

    rows = (3 * nodes[:, None, :] + np.arange(3)[:, None]).reshape(len(nodes), -1)
    return Part(matrices, rows, transformation, np.tile(cell, copies))


ROUNDING = 1e-12
"""Rounding error of positions over the largest, and of unit vectors."""


@dataclass(frozen=True, eq=False)
class ElasticBody:
    """Mesh of 27-node hexahedra with its contact surface, supports and cut faces.

    Nodes are those of the mesh in scikit-fem's numbering: displacement i of node k is dof 3 k + i of
    `ElementVector(ElementHex2())`.

    Attributes
    ----------
    mesh, material
        Elements and their elasticity.
    flank : (2 a + 1, 2 b + 1)
        Nodes of the contact surface, axis 0 across the profile and axis 1 along the width.
    normals : (2 a + 1, 2 b + 1, 3)
        Out of the body there.
    is_held : (n, 3)
        Marks dof kept at zero.
    left, right : (s,)
        Nodes of the two cut faces, in corresponding order; both empty for a body that does not repeat.
    turn : (3, 3)
        Rotation by one pitch about the gear's axis, which takes the left nodes to the right ones.
    mirror : (n,)
        Node behind the middle plane across the y axis of each node; empty for a body that is not its own
        mirror image.
    """

    mesh: MeshHex2
    material: Material
    flank: Integers
    normals: Array
    is_held: Mask
    left: Integers = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    right: Integers = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    turn: Array = field(default_factory=lambda: np.eye(3))
    mirror: Integers = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    def __post_init__(self) -> None:
        """Raise ValueError if the flank grid is even, the cut faces do not match by `turn`, or the mirror
        is wrong.
        """
        if self.flank.shape[0] % 2 == 0 or self.flank.shape[1] % 2 == 0:
            raise ValueError("the flank grid of quadratic elements has an odd number of nodes both ways")
        if self.left.size:
            gap = np.abs(self.points[self.left] @ self.turn.T - self.points[self.right]).max()
            if gap > 1e-9 * np.abs(self.points).max():
                raise ValueError(f"the cut faces do not match after one pitch: {gap:.1e} m apart")
        if self.mirror.size and not self._is_symmetric():
            raise ValueError("the body is not its own mirror image")

    def _is_symmetric(self) -> bool:
        """Whether positions, held dof, flank nodes and normals equal their images, with y mirrored at the
        mid-width plane.
        """
        image = self.points * np.array([1.0, -1.0, 1.0])
        image[:, 1] += self.points[:, 1].min() + self.points[:, 1].max()
        apart = np.abs(self.points[self.mirror] - image).max()
        return bool(
            apart <= ROUNDING * np.abs(self.points).max()
            and (self.is_held[self.mirror] == self.is_held).all()
            and (self.mirror[self.flank] == self.flank[:, ::-1]).all()
            and np.abs(self.normals[:, ::-1] * np.array([1.0, -1.0, 1.0]) - self.normals).max() <= ROUNDING
        )

    @property
    def points(self) -> Array:
        """Positions (n, 3) of the nodes, m."""
        return self.mesh.doflocs.T
