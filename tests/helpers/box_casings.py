"""Hollow boxes of 20-node bricks as whole casings: independent of gmsh and CalculiX, in mm, t and s."""

import itertools

import numpy as np
from scipy import sparse

from facegear.casing.reduction import Interface
from facegear.casing.whole import whole_casing
from facegear.io.matrices.labelled_matrix import LabelledMatrix

CORNERS = np.array(list(itertools.product((-1, 1), repeat=3)))
EDGES = np.array([place for place in itertools.product((-1, 0, 1), repeat=3) if place.count(0) == 1])
NODES = np.concatenate([CORNERS, EDGES])
"""Nodes of a brick (20, 3), local coordinates."""


def shape_gradients(at):
    """Gradients (20, 3) of the serendipity functions at a local point."""
    gradients = np.empty((20, 3))
    for k, node in enumerate(NODES):
        one = 1.0 + node * at
        if k < 8:
            rest = node @ at - 2.0
            for axis in range(3):
                others = np.prod(np.delete(one, axis))
                gradients[k, axis] = 0.125 * node[axis] * others * (rest + one[axis])
            continue
        middle = int(np.flatnonzero(node == 0)[0])
        for axis in range(3):
            if axis == middle:
                gradients[k, axis] = 0.25 * -2.0 * at[axis] * np.prod(np.delete(one, axis))
            else:
                other = 3 - middle - axis
                gradients[k, axis] = 0.25 * (1.0 - at[middle] ** 2) * node[axis] * one[other]
    return gradients


def shapes(at):
    """Serendipity functions (20,) at a local point."""
    values = np.empty(20)
    for k, node in enumerate(NODES):
        one = 1.0 + node * at
        if k < 8:
            values[k] = 0.125 * np.prod(one) * (node @ at - 2.0)
        else:
            middle = int(np.flatnonzero(node == 0)[0])
            values[k] = 0.25 * (1.0 - at[middle] ** 2) * np.prod(np.delete(one, middle))
    return values


def brick(size, young, poisson, density):
    """Stiffness and mass (60, 60) of a cube by 27 Gauss points."""
    points, weights = np.polynomial.legendre.leggauss(3)
    lame = young * poisson / (1 + poisson) / (1 - 2 * poisson)
    shear = young / 2 / (1 + poisson)
    elastic = np.zeros((6, 6))
    elastic[:3, :3] = lame
    elastic += np.diag([2 * shear] * 3 + [shear] * 3)
    stiffness, mass = np.zeros((2, 60, 60))
    half = 0.5 * size
    for (x, wx), (y, wy), (z, wz) in itertools.product(zip(points, weights, strict=True), repeat=3):
        at = np.array([x, y, z])
        volume = wx * wy * wz * half**3
        gradients = shape_gradients(at) / half
        strain = np.zeros((6, 60))
        for axis in range(3):
            strain[axis, axis::3] = gradients[:, axis]
        for row, (first, second) in enumerate(((0, 1), (1, 2), (0, 2)), start=3):
            strain[row, first::3], strain[row, second::3] = gradients[:, second], gradients[:, first]
        stiffness += volume * strain.T @ elastic @ strain
        mass += volume * density * np.kron(np.outer(shapes(at), shapes(at)), np.eye(3))
    return stiffness, mass


def box_matrices(cubes, size=20.0, young=70e3, poisson=0.33, density=2.7e-9):
    """LabelledMatrix K and M of a box of cubes with walls one cube thick, and its nodes: numbers, (n, 3) mm
    about its middle.
    """
    elements = [
        place
        for place in itertools.product(*(range(count) for count in cubes))
        if any(at in (0, count - 1) for at, count in zip(place, cubes, strict=True))
    ]
    keys = (2 * np.array(elements)[:, None, :] + 1 + NODES).reshape(-1, 3)
    unique, number = np.unique(keys, axis=0, return_inverse=True)
    of_element = number.reshape(-1, 20)
    rows = (3 * of_element[:, :, None] + np.arange(3)).reshape(-1, 60)
    row, column = np.repeat(rows, 60, axis=1).ravel(), np.tile(rows, (1, 60)).ravel()
    n = 3 * len(unique)
    matrices = [
        sparse.coo_array((np.tile(matrix.ravel(), len(elements)), (row, column)), shape=(n, n)).tocsc()
        for matrix in brick(size, young, poisson, density)
    ]
    numbers = np.arange(1, len(unique) + 1)
    node, direction = np.repeat(numbers, 3), np.tile([1, 2, 3], len(unique))
    places = 0.5 * size * (unique - np.array(cubes))
    return *(LabelledMatrix(node, direction, matrix) for matrix in matrices), (numbers, places)


def nodes_in(places, low, high):
    """Numbers of nodes within a block, mm."""
    inside = ((places >= np.array(low) - 1e-6) & (places <= np.array(high) + 1e-6)).all(axis=1)
    return tuple((np.flatnonzero(inside) + 1).tolist())


def box_casing(cubes, size=20.0, **material):
    """Whole casing of a box."""
    stiffness, mass, (numbers, places) = box_matrices(cubes, size, **material)
    nodes = (numbers, places, [""] * numbers.size)
    return whole_casing(stiffness, mass, None, nodes, "mm_t_s"), places


def wall_seats(cubes, places, size=20.0, half_width=40.0, depth=None):
    """Patches through the walls +X, +Y, -X, -Z, +Z and a base under four corners, as the public case has
    them.
    """
    half, wall = 0.5 * size * np.array(cubes), size if depth is None else depth
    seats = []
    for name, axis, sign in (
        ("p0", 0, 1),
        ("p1", 1, 1),
        ("p2", 0, -1),
        ("lower gear", 2, -1),
        ("upper gear", 2, 1),
    ):
        low, high = np.full(3, -half_width), np.full(3, half_width)
        low[axis], high[axis] = sorted((sign * half[axis], sign * (half[axis] - wall)))
        middle = np.zeros(3)
        middle[axis] = sign * (half[axis] - 0.5 * wall)
        seats.append(Interface(name, nodes_in(places, low, high), 1e-3 * middle))
    corner = min(2.0 * size, 0.5 * half[0])
    base = []
    for x, y in itertools.product((-1, 1), repeat=2):
        low = [min(x * half[0], x * (half[0] - corner)), min(y * half[1], y * (half[1] - corner)), -half[2]]
        high = [max(x * half[0], x * (half[0] - corner)), max(y * half[1], y * (half[1] - corner)), -half[2]]
        base += nodes_in(places, low, high)
    return seats, Interface("base", tuple(base), np.array([0.0, 0.0, -1e-3 * half[2]]))
