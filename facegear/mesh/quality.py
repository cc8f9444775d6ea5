"""Measures of a mesh: scaled Jacobians, volume."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def _shape_1d(x: Array) -> tuple[Array, Array]:
    """Quadratic Lagrange functions at 0, 1/2, 1 and their derivatives, (len(x), 3)."""
    value = np.stack([(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)], axis=-1)
    slope = np.stack([4 * x - 3, 4 - 8 * x, 4 * x - 1], axis=-1)
    return value, slope


@cache
def _gradients(points: tuple[float, ...]) -> Array:
    """Derivatives of the 27 functions at the tensor grid of points, (n^3, 3, 27)."""
    value, slope = _shape_1d(np.array(points))

    def tensor(x, y, z):
        return np.einsum("ai,bj,ck->cbakji", x, y, z).reshape(len(points) ** 3, 27)

    return np.stack(
        [tensor(slope, value, value), tensor(value, slope, value), tensor(value, value, slope)], axis=1
    )


def jacobians(nodes: Array, hexes: NDArray[np.int64], points: tuple[float, ...]) -> Array:
    """Jacobian matrices dx/dxi (elements, points, 3, 3) on the tensor grid of local points in 0..1."""
    return np.einsum("pdn,enx->epxd", _gradients(points), nodes[hexes])


def scaled_jacobians(nodes: Array, hexes: NDArray[np.int64], chunk: int = 2000) -> Array:
    """Smallest scaled Jacobian of each element over its 27 nodes, -1..1, 1 for a box.

    The determinant is divided by the product of the lengths of the three edge directions.
    """
    result = np.empty(len(hexes))
    for first in range(0, len(hexes), chunk):
        matrix = jacobians(nodes, hexes[first : first + chunk], (0.0, 0.5, 1.0))
        lengths = np.prod(np.linalg.norm(matrix, axis=2), axis=-1)
        result[first : first + chunk] = np.min(np.linalg.det(matrix) / lengths, axis=1)
    return result


def volume(nodes: Array, hexes: NDArray[np.int64], chunk: int = 2000) -> float:
    """Volume (m^3) by Gauss quadrature that integrates the 27-node geometry exactly (4 points an axis)."""
    x, w = np.polynomial.legendre.leggauss(4)
    weights = np.einsum("i,j,k->ijk", w, w, w).ravel() / 8
    total = 0.0
    for first in range(0, len(hexes), chunk):
        matrix = jacobians(nodes, hexes[first : first + chunk], tuple((x + 1) / 2))
        total += float(np.sum(np.linalg.det(matrix) @ weights))
    return total
