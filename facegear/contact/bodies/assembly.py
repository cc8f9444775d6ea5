"""Stiffness of linear elastic hexahedra, assembled in batches.

scikit-fem's form assembly gives the same matrix to rounding and is the reference in the tests; for the
27-node element it is about ten times slower, which would make it the longest part of a compliance job.
"""

import numpy as np
import scipy.sparse as sp
from numba import njit
from numpy.typing import NDArray

from facegear.contact.bodies.elements import gauss_points, hex_shapes, subdivided, trilinear_shapes
from facegear.contact.options import Element
from facegear.geometry.design import Material

ELEMENTS_AT_ONCE = 256


def lame_constants(material: Material) -> tuple[float, float]:
    """First Lame constant and shear modulus, Pa."""
    shear = material.young_modulus / (2 * (1 + material.poisson_ratio))
    return 2 * shear * material.poisson_ratio / (1 - 2 * material.poisson_ratio), shear


def element_stiffness(
    corners: NDArray[np.float64], material: Material, element: Element = "hex27"
) -> NDArray[np.float64]:
    """Stiffness (m, 3 a, 3 a) of elements with node positions (m, a, 3), fully integrated.

    Dof 3 n + i is the displacement of local node n along axis i. Raises ValueError for an inverted element.
    """
    reference, weight = _integration(element)
    jacobian = np.einsum("qad,mai->mqid", reference, corners)
    volume = np.linalg.det(jacobian)
    if (volume <= 0).any():
        raise ValueError(f"{int((volume <= 0).any(axis=1).sum())} elements are inverted")
    gradient = np.einsum("qad,mqdi->mqai", reference, np.linalg.inv(jacobian), optimize=True)
    scaled = gradient * np.sqrt(weight * volume)[:, :, None, None]
    nodes = corners.shape[1]
    flat = scaled.reshape(len(corners), len(weight), 3 * nodes)
    outer = (flat.transpose(0, 2, 1) @ flat).reshape(-1, nodes, 3, nodes, 3)
    lame, shear = lame_constants(material)
    stiffness = lame * outer + shear * outer.transpose(0, 1, 4, 3, 2)
    trace = shear * np.einsum("maibi->mab", outer)
    for axis in range(3):
        stiffness[:, :, axis, :, axis] += trace
    return stiffness.reshape(-1, 3 * nodes, 3 * nodes)


def _integration(element: Element) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Reference gradients (q, a, 3) and weights (q,)."""
    if element == "tet4":
        corner = np.array([[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        return corner[None], np.array([1 / 6])
    where, weight = gauss_points(3 if element == "hex27" else 2, 3)
    shapes = hex_shapes if element == "hex27" else trilinear_shapes
    return shapes(where)[1], weight


@njit(cache=True)
def _scatter(elements, blocks, indptr, indices, data):  # type: ignore[no-untyped-def]
    nodes = elements.shape[1]
    for element in range(elements.shape[0]):
        for a in range(nodes):
            row = elements[element, a]
            first, last = indptr[row], indptr[row + 1]
            for b in range(nodes):
                slot = first + np.searchsorted(indices[first:last], elements[element, b])
                for i in range(3):
                    for j in range(3):
                        data[slot, i, j] += blocks[element, 3 * a + i, 3 * b + j]


def stiffness_matrix(
    points: NDArray[np.float64], hexes: NDArray[np.int64], material: Material, element: Element = "hex27"
) -> sp.bsr_matrix:
    """Stiffness (3n, 3n) in N/m of a mesh with points (n, 3) in m; dof 3 p + i is point p along axis i.

    `hexes` (m, 27) are cut into the smaller hexahedra or tetrahedra of `element` on the same nodes.
    """
    hexes = subdivided(hexes, element)
    count, nodes = len(points), hexes.shape[1]
    touches = sp.csr_matrix(
        (np.ones(hexes.size, dtype=np.int32), (np.repeat(np.arange(len(hexes)), nodes), hexes.ravel())),
        shape=(len(hexes), count),
    )
    pattern = (touches.T @ touches).tocsr()
    pattern.sort_indices()
    data = np.zeros((pattern.nnz, 3, 3))
    for start in range(0, len(hexes), ELEMENTS_AT_ONCE):
        batch = hexes[start : start + ELEMENTS_AT_ONCE]
        blocks = element_stiffness(points[batch], material, element)
        _scatter(batch, blocks, pattern.indptr, pattern.indices, data)
    return sp.bsr_matrix((data, pattern.indices, pattern.indptr), shape=(3 * count, 3 * count))
