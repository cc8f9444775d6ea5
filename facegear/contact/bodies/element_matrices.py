"""Stiffness matrices of linear elastic elements, contracted in batches from gradients of their functions."""

from functools import cache

import numpy as np
from skfem import Basis
from skfem.models.elasticity import lame_parameters
from skfem.quadrature import get_quadrature

from facegear.arrays import Array
from facegear.contact.bodies.elements import KINDS
from facegear.contact.options import Element as Kind
from facegear.geometry.design import Material


def element_stiffness(basis: Basis, material: Material) -> Array:
    """Compute the stiffness of a scalar basis' elements, each of their a functions taken for x, y and z.

    Dof 3 n + i is the displacement of local node n along axis i.

    Parameters
    ----------
    basis : Basis
        Basis of scikit-fem with m elements.
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
    _require_right_side_out(basis.mapping.detDF(basis.X, basis.tind))
    gradient = np.stack([function[0].grad for function in basis.basis])
    nodes, axes, elements, points = gradient.shape
    weighted_gradients = (
        (gradient * np.sqrt(basis.dx)).transpose(3, 2, 1, 0).reshape(points, elements, axes, nodes)
    )
    stiffness = _contract_gradients(weighted_gradients, material)
    return stiffness.transpose(0, 2, 1, 4, 3).reshape(elements, nodes * axes, nodes * axes)


def isoparametric_stiffness(points: Array, element: Kind, material: Material) -> Array:
    """Compute the stiffness of isoparametric elements in space.

    Dof a i + n is the displacement of local node n along axis i.

    Parameters
    ----------
    points : (m, a, 3) array
        Positions of the nodes of each element, m.
    element : Kind
        Kind of element.
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
def _at_quadrature(element: Kind) -> tuple[Array, Array]:
    """Return weights (q,) of the element's quadrature and gradients (q, d, a) of its functions at
    the points.
    """
    make, degree = KINDS[element]
    kind = make()
    at, weights = get_quadrature(kind.refdom, degree)
    local = np.stack([kind.lbasis(at, node)[1] for node in range(len(kind.doflocs))])
    return weights, np.ascontiguousarray(local.transpose(2, 1, 0))


def _contract_gradients(weighted_gradients: Array, material: Material) -> Array:
    """Return the stiffness (m, d, a, d, a) from gradients (q, m, d, a) times the root of the volume of each
    point.
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
    """Raise ValueError for elements of which the volume (m, q) of a point has another sign than the first."""
    orientation = np.sign(volume)
    is_inverted = (orientation != orientation[:, :1]).any(axis=1)
    if is_inverted.any():
        raise ValueError(f"{np.count_nonzero(is_inverted)} elements are inverted")
