"""The refined contact surface: quadratic displacement, piecewise bilinear pressure, loads consistent with
both.

The displacement lives on a lattice of nodes (nu, nv), two nodes an element both ways. The pressure is a sum
of bilinear hats, one a node, so that a hat's nodal loads, its mean gap and its mean displacement follow from
one matrix. Lattice coordinates count nodes: 0..nu-1 across the profile, 0..nv-1 along the width.
"""

import numpy as np
import scipy.sparse as sp
from numba import njit
from numpy.typing import NDArray

GAUSS = 0.5 / np.sqrt(3.0)


@njit(cache=True)
def shape_weights(s, count, linear, weights):  # type: ignore[no-untyped-def]
    """Fill `weights` (3,) at lattice coordinate s; returns the first of the three nodes."""
    element = min(max(int(s // 2), 0), (count - 3) // 2)
    x = (s - 2 * element) / 2
    if linear:
        weights[0], weights[2] = max(1 - 2 * x, 0.0), max(2 * x - 1, 0.0)
        weights[1] = 1 - weights[0] - weights[2]
    else:
        weights[0], weights[1], weights[2] = (1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)
    return 2 * element


def interpolation(
    coordinates: NDArray[np.float64], shape: tuple[int, int], linear: bool = False
) -> sp.csr_matrix:
    """Interpolation (n, nu nv) from lattice nodes to lattice coordinates (n, 2), biquadratic over elements.

    `linear` interpolates between neighbouring nodes instead, as 8-node hexahedra on the same nodes do.
    """
    columns, values = _interpolation(np.ascontiguousarray(coordinates), *shape, linear)
    pointer = np.arange(0, columns.size + 1, 9)
    return sp.csr_matrix(
        (values.ravel(), columns.ravel(), pointer), shape=(len(coordinates), shape[0] * shape[1])
    )


@njit(cache=True)
def _interpolation(coordinates, nu, nv, linear):  # type: ignore[no-untyped-def]
    count = coordinates.shape[0]
    columns = np.empty((count, 9), dtype=np.int64)
    values = np.empty((count, 9))
    wu, wv = np.empty(3), np.empty(3)
    for n in range(count):
        i = shape_weights(coordinates[n, 0], nu, linear, wu)
        j = shape_weights(coordinates[n, 1], nv, linear, wv)
        for a in range(3):
            for b in range(3):
                columns[n, 3 * a + b] = (i + a) * nv + j + b
                values[n, 3 * a + b] = wu[a] * wv[b]
    return columns, values


@njit(cache=True)
def averaged_interpolation(pointer, index, weight, coordinates, nu, nv, linear):  # type: ignore[no-untyped-def]
    """Columns, values and row ends of averages over points times `interpolation` at their coordinates.

    pointer, index and weight as in `averages.Rows`. It stands here because numba does not notice a change of
    `shape_weights` in another file.
    """
    count = pointer.size - 1
    columns, values = np.empty(9 * index.size, np.int32), np.empty(9 * index.size)
    ends, slot = np.zeros(count + 1, np.int32), np.full(nu * nv, -1)
    wu, wv = np.empty(3), np.empty(3)
    filled = 0
    for row in range(count):
        first = filled
        for k in range(pointer[row], pointer[row + 1]):
            i = shape_weights(coordinates[index[k], 0], nu, linear, wu)
            j = shape_weights(coordinates[index[k], 1], nv, linear, wv)
            for a in range(3):
                for b in range(3):
                    node = (i + a) * nv + j + b
                    if slot[node] < first:
                        slot[node] = filled
                        columns[filled], values[filled] = node, 0.0
                        filled += 1
                    values[slot[node]] += weight[k] * wu[a] * wv[b]
        ends[row + 1] = filled
    return columns[:filled].copy(), values[:filled].copy(), ends


def cell_points(shape: tuple[int, int]) -> NDArray[np.float64]:
    """Lattice coordinates of 2 x 2 Gauss points in each cell between nodes, ((nu-1) (nv-1) 4, 2)."""
    i, j = np.meshgrid(np.arange(shape[0] - 1), np.arange(shape[1] - 1), indexing="ij")
    middle = np.stack([i.ravel() + 0.5, j.ravel() + 0.5], axis=-1)
    offsets = GAUSS * np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]])
    return (middle[:, None, :] + offsets).reshape(-1, 2)


def line_points(nodes: int) -> NDArray[np.float64]:
    """Two Gauss points in each interval between `nodes` nodes on a line, (2 (nodes - 1),)."""
    middle = np.arange(nodes - 1) + 0.5
    return np.stack([middle - GAUSS, middle + GAUSS], axis=-1).ravel()


def hat_values(points: NDArray[np.float64], shape: tuple[int, int]) -> sp.csr_matrix:
    """Bilinear hats (n, nu nv) at lattice coordinates (n, 2)."""
    base = np.minimum(np.floor(points).astype(np.int64), np.array(shape) - 2)
    x, y = (points - base).T
    columns = (base[:, 0] * shape[1] + base[:, 1])[:, None] + np.array([0, 1, shape[1], shape[1] + 1])
    values = np.stack([(1 - x) * (1 - y), (1 - x) * y, x * (1 - y), x * y], axis=-1)
    return sp.csr_matrix(
        (values.ravel(), columns.ravel(), np.arange(0, columns.size + 1, 4)),
        shape=(len(points), shape[0] * shape[1]),
    )


def cell_areas(surface: NDArray[np.float64]) -> NDArray[np.float64]:
    """Area (m2) that each point of `cell_points` stands for, surface nodes (nu, nv, 3)."""
    shape = surface.shape[:2]
    points = cell_points(shape)
    flat = surface.reshape(-1, 3)
    step = 1e-3
    along = [
        (interpolation(points + shift, shape) - interpolation(points - shift, shape)) @ flat / (2 * step)
        for shift in (np.array([step, 0.0]), np.array([0.0, step]))
    ]
    return 0.25 * np.linalg.norm(np.cross(*along), axis=1)
