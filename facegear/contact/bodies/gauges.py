"""Strain gauges on a free surface: stress from the displacements of the surface alone.

Where nothing touches, the surface is in plane stress, and its stress follows from the displacement's
derivatives along it. They are taken at the 2 x 2 Gauss points of each facet, where derivatives of quadratic
elements converge one order faster than elsewhere.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers
from facegear.contact.bodies.surface import face_functions
from facegear.geometry.design import Material

GAUSS = 1.0 / np.sqrt(3.0)


@dataclass(frozen=True, eq=False)
class Gauges:
    """Gauges (a, b) on a surface: a across it, b along its lines, two a facet both ways.

    `position` and unit vectors `across` the lines and `along` them, (a, b, 3). The stress (Pa) at gauge
    (i, j), number i b + j, is a row times the displacements (m) of the body's nodes, dof 3 k + i: normal
    stress `normal` across the lines, `axial` along them, and `shear`, each (a b, 3 n).
    """

    position: Array
    across: Array
    along: Array
    normal: sp.csr_matrix
    axial: sp.csr_matrix
    shear: sp.csr_matrix


def gauge_coordinates(nodes: int) -> Array:
    """Return the coordinates of the gauges along a line of nodes, two an element.

    Parameters
    ----------
    nodes : int
        Number of nodes.

    Returns
    -------
    (gauges,) array
        Lattice coordinates, dimensionless.
    """
    middle = np.arange(1.0, nodes, 2.0)
    return np.stack([middle - GAUSS, middle + GAUSS], axis=1).ravel()


def gauges_on(points: Array, nodes: Integers, material: Material) -> Gauges:
    """Place gauges on the faces of 27-node hexahedra.

    The lines that gauges stand across are those of constant first index.

    Parameters
    ----------
    points : (n, 3) array
        Positions of the body's nodes, m.
    nodes : (nu, nv) array of int
        Nodes of the faces.
    material : Material
        Of the body.

    Returns
    -------
    Gauges
        Gauges (a, b), in m and Pa/m.
    """
    shape = nodes.shape
    coordinates = np.meshgrid(*map(gauge_coordinates, shape), indexing="ij")
    at = np.stack(coordinates, axis=-1).reshape(-1, 2)
    local, values, gradients = face_functions(at, shape)
    corner = points[nodes.ravel()[local]]
    base = np.einsum("qad,qai->qdi", gradients, corner)
    along = base[:, 1] / np.linalg.norm(base[:, 1], axis=1)[:, None]
    across = base[:, 0] - along * np.sum(base[:, 0] * along, axis=1)[:, None]
    across /= np.linalg.norm(across, axis=1)[:, None]
    metric = np.linalg.inv(base @ base.transpose(0, 2, 1)) @ base
    # derivatives of each node's function along the two unit vectors
    slopes = np.einsum("qsi,qdi,qad->qsa", np.stack([across, along], axis=1), metric, gradients)
    strain_across = slopes[:, 0, :, None] * across[:, None]
    strain_along = slopes[:, 1, :, None] * along[:, None]
    shear = slopes[:, 1, :, None] * across[:, None] + slopes[:, 0, :, None] * along[:, None]
    young, ratio = material.young_modulus, material.poisson_ratio
    plane = young / (1.0 - ratio**2)
    parts = (
        plane * (strain_across + ratio * strain_along),
        plane * (strain_along + ratio * strain_across),
        young / (2.0 * (1.0 + ratio)) * shear,
    )
    normal, axial, shear = (_rows(nodes.ravel()[local], part, len(points)) for part in parts)
    grid = coordinates[0].shape
    return Gauges(
        position=np.einsum("qa,qai->qi", values, corner).reshape(*grid, 3),
        across=across.reshape(*grid, 3),
        along=along.reshape(*grid, 3),
        normal=normal,
        axial=axial,
        shear=shear,
    )


def _rows(nodes: Integers, values: Array, count: int) -> sp.csr_matrix:
    """Return a matrix (q, 3 count) with values (q, a, 3) at the dof of nodes (q, a)."""
    dof = 3 * nodes[:, :, None] + np.arange(3)
    pointer = np.arange(0, values.size + 1, values[0].size)
    return sp.csr_matrix((values.ravel(), dof.ravel(), pointer), shape=(len(nodes), 3 * count))
