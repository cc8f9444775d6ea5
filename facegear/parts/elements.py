"""Axisymmetric quadrilaterals of second degree whose displacements go round the axis as waves.

In order n a body moves as `u = Re[z e^(-i n phi) (U, i V, W)]`, with z complex and U, V, W functions of r and
the height. Strains and gradients of (U, V, W) are A0 + n A1 with two operators that do not depend on n, so
that every matrix is a polynomial in n whose coefficients are assembled once. Integrals over the angle give
pi, and 2 pi for n = 0: they are left out here.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers
from facegear.errors import extras_named
from facegear.parts.body_mesh import BodyMesh
from facegear.teeth.design import Material

with extras_named():
    from skfem import Basis, ElementQuad2, MeshQuad

U, V, W = range(3)
"""Numbers of the components U, V, W."""
DEGREE = 6
"""Degree of the polynomials that the quadrature integrates exactly."""
Rows = list[dict[int, Array]]
"""Rows of an operator: contribution of each component's scalar shapes, (shapes, elements, points)."""


@dataclass(frozen=True, eq=False)
class Elements:
    """Quadratic quadrilaterals and their 9 scalar shapes at the quadrature points.

    Attributes
    ----------
    basis
        Basis of scikit-fem for one scalar component.
    value, by_r, by_height : (9, elements, points)
        Shapes, and their derivatives by r and height, 1/m.
    r : (elements, points)
        Distance from the axis, m.
    weight : (elements, points)
        Quadrature weights with the factor r of an axisymmetric body, m3 for each radian.
    dofs : (27, elements)
        Numbers of the degrees of freedom: U, V, W of each scalar shape in turn.
    """

    basis: Basis
    value: Array
    by_r: Array
    by_height: Array
    r: Array
    weight: Array
    dofs: Integers

    @property
    def size(self) -> int:
        """Number of degrees of freedom, those on held edges included: dof 3 s + c is component c of shape
        s.
        """
        return 3 * int(self.basis.N)

    @property
    def shape_points(self) -> Array:
        """r and height (2, shapes) of every scalar shape, at which its own value is 1."""
        return np.asarray(self.basis.doflocs)


def elements_of(mesh: BodyMesh) -> Elements:
    """Return the quadratic elements of a mesh at their quadrature points.

    Parameters
    ----------
    mesh : BodyMesh
        Mesh of quadrilaterals; each gets 9 shapes, with nodes at corners, middles of edges and centre.

    Returns
    -------
    Elements
        Shapes at the quadrature points.
    """
    basis = Basis(MeshQuad(mesh.nodes.T.copy(), mesh.quads.T.copy()), ElementQuad2(), intorder=DEGREE)
    fields = [shape[0] for shape in basis.basis]
    r = np.asarray(basis.global_coordinates())[0]
    dofs = 3 * basis.element_dofs[:, None, :] + np.arange(3)[None, :, None]
    return Elements(
        basis=basis,
        value=np.stack([np.broadcast_to(np.asarray(field), r.shape) for field in fields]),
        by_r=np.stack([field.grad[0] for field in fields]),
        by_height=np.stack([field.grad[1] for field in fields]),
        r=r,
        weight=basis.dx * r,
        dofs=dofs.reshape(-1, dofs.shape[-1]),
    )


def strains(elements: Elements) -> tuple[Array, Array]:
    """Return the strains of the shapes in order n as A0 + n A1.

    The rows are rr, pp (round the axis), zz (along it), and the engineering shears rz, rp, zp. Factors of
    the wave round the axis are left out.

    Parameters
    ----------
    elements : Elements
        The elements.

    Returns
    -------
    pair of (6, 27, elements, points) arrays
        Operators A0 and A1, 1/m; columns as `Elements.dofs`.
    """
    v, by_r, by_height = elements.value, elements.by_r, elements.by_height
    over_r = v / elements.r
    plain: Rows = [
        {U: by_r},
        {U: over_r},
        {W: by_height},
        {U: by_height, W: by_r},
        {V: by_r - over_r},
        {V: by_height},
    ]
    by_order: Rows = [{}, {V: over_r}, {}, {}, {U: -over_r}, {W: -over_r}]
    return operator(plain), operator(by_order)


def gradients(elements: Elements) -> tuple[Array, Array]:
    """Return the derivatives of the displacement vector by r, height and round the axis as A0 + n A1.

    The rows are three components by r, three by height, three round the axis.

    Parameters
    ----------
    elements : Elements
        The elements.

    Returns
    -------
    pair of (9, 27, elements, points) arrays
        Operators A0 and A1, 1/m; columns as `Elements.dofs`.
    """
    over_r = elements.value / elements.r
    plain: Rows = [{part: elements.by_r} for part in (U, V, W)]
    plain += [{part: elements.by_height} for part in (U, V, W)]
    plain += [{V: over_r}, {U: over_r}, {}]
    by_order: Rows = [{}] * 6 + [{part: over_r} for part in (U, V, W)]
    return operator(plain), operator(by_order)


def displacements(elements: Elements) -> Array:
    """Return the displacements U (radial), V (round the axis) and W (axial) of the shapes at the
    quadrature points.

    Parameters
    ----------
    elements : Elements
        The elements.

    Returns
    -------
    (3, 27, elements, points) array
        m/m; columns as `Elements.dofs`.
    """
    return operator([{part: elements.value} for part in (U, V, W)])


def operator(rows: Rows) -> Array:
    """Return the rows of an operator on the 27 shapes of each element: columns U, V, W of shape 0, of
    shape 1, ...

    Parameters
    ----------
    rows : Rows
        For each row, by number of the component (U, V, W), the factors (9, elements, points) on its
        scalar shapes; components left out are zero.

    Returns
    -------
    (rows, 27, elements, points) array
        In the unit of the contributions, 1 or 1/m.
    """
    shapes, elements, points = next(values for row in rows for values in row.values()).shape
    result = np.zeros((len(rows), 3 * shapes, elements, points))
    for number, row in enumerate(rows):
        for part, values in row.items():
            result[number, part::3] = values
    return result


def form(elements: Elements, left: Array, tensor: Array, right: Array) -> sp.csr_matrix:
    """Assemble the integral of left^T tensor right over the section of an axisymmetric body.

    The weights hold the factor r. The integral over the angle is left out: the caller multiplies by pi, or by
    2 pi for order 0.

    Parameters
    ----------
    elements : Elements
        Elements whose weights and numbers of degrees of freedom are used.
    left : (i, 27, elements, points) array
        Operator on U, V, W of the 9 shapes of a quadrilateral at the quadrature points, any unit.
    tensor : (i, j, elements, points or 1) array
        Material between the rows of both operators, any unit.
    right : (j, 27, elements, points) array
        Operator as `left`, any unit.

    Returns
    -------
    (dofs, dofs) sparse matrix
        For each radian, in the product of these units times m3.
    """
    weighted_terms = np.einsum("ijeq,jbeq->eiqb", tensor * elements.weight, right, optimize=True)
    count, rows, points, shapes = weighted_terms.shape
    flat = left.transpose(2, 1, 0, 3).reshape(count, shapes, rows * points)
    blocks = flat @ weighted_terms.reshape(count, rows * points, shapes)
    row = np.repeat(elements.dofs.T[:, :, None], shapes, axis=2)
    column = np.repeat(elements.dofs.T[:, None, :], shapes, axis=1)
    size = elements.size
    return sp.coo_matrix((blocks.ravel(), (row.ravel(), column.ravel())), (size, size)).tocsr()


def isotropic(material: Material) -> Array:
    """Return the elasticity matrix, stress by strain, of an isotropic material.

    Parameters
    ----------
    material : Material
        The material.

    Returns
    -------
    (6, 6) array
        Pa, rows and columns in the order of `strains`.
    """
    modulus, ratio = material.young_modulus, material.poisson_ratio
    return orthotropic(np.full(3, modulus), ratio, np.full(3, 0.5 * modulus / (1.0 + ratio)))


def orthotropic(moduli: Array, ratio: float, shear: Array) -> Array:
    """Return the elasticity of an orthotropic material.

    Poisson's ratio of each pair of directions is `ratio` times the root of the ratio of their moduli, so that
    the compliance is symmetric and positive for every choice of moduli.

    Parameters
    ----------
    moduli : (3,) array
        Young's moduli along r, round the axis and along it, Pa.
    ratio : float
        Poisson's ratio for equal moduli, dimensionless.
    shear : (3,) array
        Shear moduli in rz, rp and zp, Pa.

    Returns
    -------
    (6, 6) array
        Pa, for strains in the order of `strains`.
    """
    roots = np.sqrt(moduli)
    compliance = ((1.0 + ratio) * np.eye(3) - ratio) / np.outer(roots, roots)
    result = np.zeros((6, 6))
    result[:3, :3] = np.linalg.inv(compliance)
    result[3:, 3:] = np.diag(shear)
    return result
