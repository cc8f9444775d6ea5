"""Matrices of a gear body in every order n, with the stress of its own rotation.

    body's frame:   M z'' + D z' - 2 i g W z' + [K + W^2 (S - P)] z = f

with W the body's speed: g = int 2 rho U V from the Coriolis force, P = int rho (U^2 + V^2) from the
centrifugal force, and S the work of the centrifugal stress on the second-order strains.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers
from facegear.parts.body_mesh import BodyMesh
from facegear.parts.elements import (
    Elements,
    U,
    V,
    W,
    displacements,
    elements_of,
    form,
    gradients,
    isotropic,
    orthotropic,
    strains,
)
from facegear.parts.section import GAUSS, Section
from facegear.sparse.matrices import solver

ON_EDGE = 1e-8
"""Distance (m) from a line below which a point lies on it."""
STRESSES = ((0, 0, 0), (1, 1, 2), (2, 2, 1), (0, 1, 3), (1, 0, 3))
"""Directions (r, height, round the axis) of the stress tensor, and where the stress stands in `strains`."""
MEANS = ("<W>", "<V>", "<W / r>", "<U>", "slope")
"""Motions below the teeth, uniform in r: means along the axis, round it, of W / r and along the radius, and
the slope dW/dr of the straight line that fits W best."""


@dataclass(frozen=True, eq=False)
class Polynomial:
    """A matrix A0 + n A1 + n^2 A2 of the order n; `parts` are A0, A1, A2 over all degrees of freedom.

    The parts are integrals over the section for each radian. `at` multiplies by the integral round the
    axis.
    """

    parts: tuple[sp.csr_matrix, sp.csr_matrix, sp.csr_matrix]

    def at(self, order: int) -> sp.csr_matrix:
        """Return the matrix of one circumferential order, with the factor `around` of the integral round
        the axis.

        Parameters
        ----------
        order : int
            Circumferential order n, number of nodal diameters.

        Returns
        -------
        sparse matrix
            (dofs, dofs), in the unit of the parts.
        """
        constant, linear, square = self.parts
        return around(order) * (constant + order * linear + order**2 * square)


@dataclass(frozen=True, eq=False)
class BodyMatrices:
    """Matrices over all degrees of freedom, held ones included; SI units.

    Attributes
    ----------
    section, elements
        Section and elements from which they were assembled.
    free : (f,)
        Degrees of freedom that are not held.
    stiffness, stress
        K and S of every order.
    mass, coriolis, centrifugal
        M, g and P without the factor of the integral round the axis, the same in every order.
    """

    section: Section
    elements: Elements
    free: Integers
    stiffness: Polynomial
    stress: Polynomial
    mass: sp.csr_matrix
    coriolis: sp.csr_matrix
    centrifugal: sp.csr_matrix

    @cached_property
    def on_teeth(self) -> Array:
        """Weights (5, dofs) whose products with displacements are MEANS along the teeth on height 0."""
        return teeth_means(self.section, self.elements)


def around(order: int) -> float:
    """Return the integral of the square of a wave's cosine round the axis.

    Parameters
    ----------
    order : int
        The order n.

    Returns
    -------
    float
        rad: 2 pi for order 0, else pi.
    """
    return 2.0 * np.pi if order == 0 else np.pi


def body_matrices(section: Section, mesh: BodyMesh) -> BodyMatrices:
    """Assemble all matrices of a section.

    Parameters
    ----------
    section : Section
        The section.
    mesh : BodyMesh
        Its mesh.

    Returns
    -------
    BodyMatrices
        SI units.
    """
    elements = elements_of(mesh)
    elasticity, density = _materials(section, mesh, elements)
    plain, by_order = strains(elements)
    stiffness = _polynomial(elements, plain, by_order, elasticity)
    motion = displacements(elements)
    inertia = density * np.eye(3)[:, :, None, None]
    plane = density * np.diag([1.0, 1.0, 0.0])[:, :, None, None]
    swap = density * np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])[:, :, None, None]
    free = _free(section, elements)
    stresses = _centrifugal_stresses(elements, stiffness, elasticity, plain, density, free)
    stressed = np.asarray(np.kron(stresses, np.eye(3)[:, :, None, None]), float)
    return BodyMatrices(
        section=section,
        elements=elements,
        free=free,
        stiffness=stiffness,
        stress=_polynomial(elements, *gradients(elements), stressed),
        mass=form(elements, motion, inertia, motion),
        coriolis=form(elements, motion, swap, motion),
        centrifugal=form(elements, motion, plane, motion),
    )


def elastic_stiffness(section: Section, mesh: BodyMesh, elements: Elements) -> Polynomial:
    """Assemble the elastic stiffness K of every order, without mass, rotation and supports.

    Parameters
    ----------
    section : Section
        The section.
    mesh : BodyMesh
        Its mesh.
    elements : Elements
        Elements of the mesh.

    Returns
    -------
    Polynomial
        N/m.
    """
    return _polynomial(elements, *strains(elements), _materials(section, mesh, elements)[0])


def _polynomial(elements: Elements, plain: Array, by_order: Array, tensor: Array) -> Polynomial:
    """Assemble the integral of B^T tensor B, B = A0 + n A1, as a polynomial in the order n.

    plain, by_order: A0 and A1, (i, 27, elements, points); tensor (i, i, elements, points or 1).
    """
    cross_terms = form(elements, plain, tensor, by_order)
    parts = (
        form(elements, plain, tensor, plain),
        cross_terms + cross_terms.T,
        form(elements, by_order, tensor, by_order),
    )
    return Polynomial(parts)


def _materials(section: Section, mesh: BodyMesh, elements: Elements) -> tuple[Array, Array]:
    """Return elasticity (6, 6, elements, 1), Pa, and density (elements, points), kg/m^3, of every
    element.

    Elements of the layer of teeth are orthotropic, with the layer's fractions of the body's moduli and
    density.
    """
    body = isotropic(section.material)
    elasticity = np.repeat(body[:, :, None], len(mesh.quads), axis=2)
    density = np.full(elements.r.shape, section.density)
    if (layer := section.layer) is not None:
        modulus, shear = section.material.young_modulus, body[3, 3]
        fraction = layer.density
        moduli = modulus * np.array([fraction, layer.hoop, fraction])
        shears = shear * np.array([fraction, layer.shear, layer.shear])
        elasticity[:, :, mesh.in_layer] = orthotropic(moduli, section.material.poisson_ratio, shears)[
            ..., None
        ]
        r, height = np.asarray(elements.basis.global_coordinates())[:, mesh.in_layer]
        density[mesh.in_layer] *= layer.density_at(r, height)
    return elasticity[..., None], density


def _free(section: Section, elements: Elements) -> Integers:
    """Return the degrees of freedom (f,) of all shapes whose point is not on a held edge of the section."""
    is_held = np.zeros(elements.shape_points.shape[1], bool)
    points = elements.shape_points.T
    for (first, last), is_fixed in zip(section.edges, section.is_edge_held, strict=True):
        if is_fixed:
            way = last - first
            fraction = np.clip((points - first) @ way / (way @ way), 0.0, 1.0)
            is_held |= np.linalg.norm(points - first - fraction[:, None] * way, axis=1) < ON_EDGE
    return np.flatnonzero(np.repeat(~is_held, 3))


def _centrifugal_stresses(
    elements: Elements,
    stiffness: Polynomial,
    elasticity: Array,
    strain: Array,
    density: Array,
    free: Integers,
) -> Array:
    """Return the stress tensor (3, 3, elements, points) by the body's own rotation at 1 rad/s; Pa s2.

    Its axes are r, height and round the axis. The displacement is that of order 0 under the load rho r.
    stiffness: K; elasticity (6, 6, elements, 1), Pa; strain: operator A0 of `strains`; density (elements,
    points), kg/m3; free (f,): degrees of freedom that are not held.
    """
    outward = np.zeros(elements.size)
    loads = (elements.value * density * elements.r * elements.weight).sum(axis=2)
    np.add.at(outward, elements.dofs[U::3].ravel(), loads.ravel())
    active_dofs = free[free % 3 != V]
    if free.size == elements.size:
        active_dofs = active_dofs[active_dofs != W]  # it floats: one point keeps its height
    motion = np.zeros(elements.size)
    motion[active_dofs] = solver(stiffness.parts[0][active_dofs][:, active_dofs])(outward[active_dofs])
    strained = np.einsum("ibeq,be->ieq", strain, motion[elements.dofs])
    stress = np.einsum("ijeq,jeq->ieq", np.broadcast_to(elasticity, (6, 6, *strained.shape[1:])), strained)
    tensor = np.zeros((3, 3, *stress.shape[1:]))
    for first, second, number in STRESSES:
        tensor[first, second] = stress[number]
    return tensor


def rigid_motions(elements: Elements, order: int) -> Array:
    """Return the motions of the body as a rigid whole, each by 1 m or 1 rad.

    Parameters
    ----------
    elements : Elements
        The elements.
    order : int
        0: along and round the axis; 1: sideways and tilting about a diameter at height 0.

    Returns
    -------
    (dofs, 2) array
        m.

    Raises
    ------
    ValueError
        For an order above 1.
    """
    r, height = elements.shape_points
    motions = np.zeros((elements.size, 2))
    if order == 0:
        motions[W::3, 0] = 1.0
        motions[V::3, 1] = r
    elif order == 1:
        motions[U::3, 0], motions[V::3, 0] = 1.0, -1.0
        motions[U::3, 1], motions[V::3, 1], motions[W::3, 1] = -height, height, r
    else:
        raise ValueError(f"order {order} has no rigid motion")
    return motions


def teeth_means(section: Section, elements: Elements) -> Array:
    """Return MEANS of the shapes along height 0 between the radii of the teeth.

    Parameters
    ----------
    section : Section
        The section.
    elements : Elements
        The elements.

    Returns
    -------
    (5, dofs) array
        <W>, <V> and <U>, m/m, <W / r> and the slope, 1/m, in the order of MEANS.
    """
    inner, outer = section.teeth
    middle, width = 0.5 * (inner + outer), outer - inner
    plain = along_teeth(section, elements, lambda parts, r: parts)
    means = np.zeros((len(MEANS), elements.size))
    means[0, W::3], means[1, V::3], means[3, U::3] = plain, plain, plain
    means[2, W::3] = along_teeth(section, elements, np.divide)
    means[4, W::3] = along_teeth(section, elements, lambda parts, r: parts * 12.0 * (r - middle) / width**2)
    return means


def along_teeth(
    section: Section, elements: Elements, convert_weights: Callable[[Array, Array], Array]
) -> Array:
    """Return weights of all scalar shapes whose product with shape values is a mean along the teeth.

    The mean runs along height 0 between the radii of the teeth. Along a straight edge of an element the
    shapes are the quadratic ones of its two ends and its middle.

    Parameters
    ----------
    section : Section
        The section.
    elements : Elements
        The elements.
    convert_weights : Callable[[Array, Array], Array]
        Function that maps the weights of a plain mean (points, edges), and the r (m) of the points, to
        the weights of this mean.

    Returns
    -------
    (shapes,) array
        In the unit of these weights: 1 for the plain mean.
    """
    mesh, dofs, (inner, outer) = elements.basis.mesh, elements.basis.dofs, section.teeth
    ends = mesh.p[:, mesh.facets]
    below = (np.abs(ends[1]) < ON_EDGE) & (ends[0] > inner - ON_EDGE) & (ends[0] < outer + ON_EDGE)
    edges = np.flatnonzero(below.all(axis=0))
    numbers = np.concatenate([dofs.nodal_dofs[0, mesh.facets[:, edges]], dofs.facet_dofs[:1, edges]])
    first, last = ends[0][:, edges]
    at = GAUSS[0][:, None]
    shapes = np.stack([0.5 * at * (at - 1.0), 0.5 * at * (at + 1.0), 1.0 - at**2])
    weights = 0.5 * GAUSS[1][:, None] * np.abs(last - first) / (outer - inner)
    r = 0.5 * (first + last) + 0.5 * at * (last - first)
    mean = np.zeros(elements.shape_points.shape[1])
    np.add.at(mean, numbers, (shapes * convert_weights(weights, r)).sum(axis=1))
    return mean
