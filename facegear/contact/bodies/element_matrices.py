"""Stiffness matrices of linear elastic elements from scikit-fem's bases."""

import numpy as np
from skfem import Basis
from skfem.models.elasticity import lame_parameters

from facegear.arrays import Array
from facegear.geometry.design import Material


def element_stiffness(basis: Basis, material: Material) -> Array:
    """Stiffness (m, 3 a, 3 a) of a scalar basis' elements, each of their a functions taken for x, y and z.

    Dof 3 n + i is the displacement of local node n along axis i. Raises ValueError for an element that is
    turned inside out anywhere.
    """
    turned = np.sign(basis.mapping.detDF(basis.X, basis.tind))
    inverted = (turned != turned[:, :1]).any(axis=1)
    if inverted.any():
        raise ValueError(f"{np.count_nonzero(inverted)} elements are inverted")
    gradient = np.stack([function[0].grad for function in basis.basis])
    nodes, axes, elements, points = gradient.shape
    scaled = (gradient * np.sqrt(basis.dx)).transpose(2, 3, 0, 1).reshape(elements, points, nodes * axes)
    outer = (scaled.transpose(0, 2, 1) @ scaled).reshape(elements, nodes, axes, nodes, axes)
    lame, shear = lame_parameters(material.young_modulus, material.poisson_ratio)
    stiffness = lame * outer + shear * outer.transpose(0, 1, 4, 3, 2)
    trace = shear * np.einsum("maibi->mab", outer)
    for axis in range(axes):
        stiffness[:, :, axis, :, axis] += trace
    return stiffness.reshape(elements, nodes * axes, nodes * axes)
