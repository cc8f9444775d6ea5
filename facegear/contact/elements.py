"""The triquadratic 27-node hexahedron and its faces, nodes in tensor order.

Local node a = i + 3 j + 9 k stands at (i, j, k) / 2 of the unit cube, so that index arithmetic replaces
tables.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def line_shapes(x: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Values and slopes of the three quadratic shapes on the unit interval at `x` (n,); both (n, 3)."""
    x = np.asarray(x, dtype=float)
    values = np.stack([(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)], axis=-1)
    slopes = np.stack([4 * x - 3, 4 - 8 * x, 4 * x - 1], axis=-1)
    return values, slopes


def face_shapes(uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """Nine biquadratic shapes (n, 9) at `uv` (n, 2) of the unit square, node a = i + 3 j."""
    (u, _), (v, _) = line_shapes(uv[:, 0]), line_shapes(uv[:, 1])
    return np.einsum("nj,ni->nji", v, u).reshape(len(uv), 9)


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
    """Hexahedra (m, 27) of a lattice of node ids (2a+1, 2b+1, 2c+1), axis 0 being the first local direction."""
    ends = [slice(offset, nodes.shape[axis] - 2 + offset, 2) for axis in range(3) for offset in range(3)]
    columns = [
        nodes[ends[i], ends[3 + j], ends[6 + k]].ravel() for k in range(3) for j in range(3) for i in range(3)
    ]
    return np.stack(columns, axis=-1)
