"""The triquadratic 27-node hexahedron and its faces, nodes in tensor order; linear elements on the same
nodes.

Local node a = i + 3 j + 9 k stands at (i, j, k) / 2 of the unit cube, so that index arithmetic replaces
tables.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.contact.options import Element

TETRAHEDRA = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))
"""A cube with corners i + 2 j + 4 k as six tetrahedra around its diagonal; neighbours match."""


def line_shapes(x: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Values and slopes of the three quadratic shapes on the unit interval at `x` (n,); both (n, 3)."""
    x = np.asarray(x, dtype=float)
    values = np.stack([(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)], axis=-1)
    slopes = np.stack([4 * x - 3, 4 - 8 * x, 4 * x - 1], axis=-1)
    return values, slopes


def hex_shapes(xyz: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Shapes (n, 27) and their reference gradients (n, 27, 3) at `xyz` (n, 3) of the unit cube."""
    (x, dx), (y, dy), (z, dz) = (line_shapes(xyz[:, axis]) for axis in range(3))

    def product(
        f: NDArray[np.float64], g: NDArray[np.float64], h: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        return np.einsum("nk,nj,ni->nkji", h, g, f).reshape(len(xyz), 27)

    return product(x, y, z), np.stack([product(dx, y, z), product(x, dy, z), product(x, y, dz)], axis=-1)


def gauss_points(order: int, dimension: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gauss-Legendre points (order^d, d) and weights of the unit square or cube."""
    points, weights = np.polynomial.legendre.leggauss(order)
    grids = np.meshgrid(*[(points + 1) / 2] * dimension, indexing="ij")
    weight = np.ones(())
    for _ in range(dimension):
        weight = np.multiply.outer(weight, weights / 2)
    return np.stack([grid.ravel() for grid in grids[::-1]], axis=-1), weight.ravel()


def block_hexes(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Hexahedra (m, 27) of a lattice of node ids (2a+1, 2b+1, 2c+1), axis 0 the first local direction."""
    ends = [slice(offset, nodes.shape[axis] - 2 + offset, 2) for axis in range(3) for offset in range(3)]
    columns = [
        nodes[ends[i], ends[3 + j], ends[6 + k]].ravel() for k in range(3) for j in range(3) for i in range(3)
    ]
    return np.stack(columns, axis=-1)


def trilinear_shapes(xyz: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Shapes (n, 8) of the 8-node hexahedron, node i + 2 j + 4 k and gradients (n, 8, 3) in the unit cube."""
    value = [np.stack([1 - xyz[:, axis], xyz[:, axis]], axis=-1) for axis in range(3)]
    slope = np.broadcast_to(np.array([-1.0, 1.0]), value[0].shape)

    def product(*parts: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.einsum("nk,nj,ni->nkji", parts[2], parts[1], parts[0]).reshape(len(xyz), 8)

    gradients = [product(*[slope if axis == d else value[axis] for axis in range(3)]) for d in range(3)]
    return product(*value), np.stack(gradients, axis=-1)


def subdivided(hexes: NDArray[np.int64], element: Element) -> NDArray[np.int64]:
    """The 27-node hexahedra (m, 27) as they are, as eight 8-node ones each, or as 48 tetrahedra each."""
    if element == "hex27":
        return hexes
    lattice = hexes.reshape(-1, 3, 3, 3)
    cubes = [
        np.stack([lattice[:, k + c, j + b, i + a] for c in (0, 1) for b in (0, 1) for a in (0, 1)], axis=-1)
        for k in (0, 1)
        for j in (0, 1)
        for i in (0, 1)
    ]
    eight = np.stack(cubes, axis=1).reshape(-1, 8)
    return eight if element == "hex8" else eight[:, np.array(TETRAHEDRA)].reshape(-1, 4)
