"""Simple bodies for the contact tests: mapped blocks of 27-node hexahedra."""

import numpy as np

from facegear.contact.body import Piece
from facegear.contact.elements import block_hexes
from facegear.geometry.design import Material

STEEL = Material(206e9, 0.3)


def stations(ends):
    """Node positions of quadratic elements with the given ends."""
    ends = np.asarray(ends, dtype=float)
    full = np.empty(2 * len(ends) - 1)
    full[::2], full[1::2] = ends, 0.5 * (ends[1:] + ends[:-1])
    return full


def graded(first, total, ratio):
    """Element ends 0..total, sizes growing by about `ratio` from about `first`."""
    sizes = [first]
    while sum(sizes) < total:
        sizes.append(sizes[-1] * ratio)
    return np.concatenate([[0.0], np.cumsum(sizes)]) * total / sum(sizes)


def block(x, y, z, mapping=None, held=None, normal=(0.0, 1.0, 0.0)):
    """Block with element ends x, y, z; the contact surface is the face of largest y, profile along x, width z."""
    grid = np.stack(np.meshgrid(stations(x), stations(y), stations(z), indexing="ij"), axis=-1)
    nodes = np.arange(grid[..., 0].size).reshape(grid.shape[:3])
    reference = grid.reshape(-1, 3)
    points = reference if mapping is None else mapping(reference)
    flank = nodes[:, -1, :]
    normals = np.broadcast_to(np.array(normal), (*flank.shape, 3)).copy()
    return Piece(points, block_hexes(nodes), STEEL, flank, normals, held(reference))


def half_disc(radius, elements_x, elements_y):
    """Upper half of a disc in plane strain, one element thick (1 m), resting on its plane of symmetry."""

    def mapping(p):
        x, y, z = p.T
        return np.stack([radius * x * np.sqrt(1 - y**2 / 2), radius * y * np.sqrt(1 - x**2 / 2), z], axis=1)

    def held(p):
        fixed = np.zeros(p.shape, dtype=bool)
        fixed[:, 1] = p[:, 1] < 1e-12
        fixed[:, 0] = fixed[:, 1] & (np.abs(p[:, 0]) < 1e-12)
        fixed[:, 2] = True
        return fixed

    x = elements_x[elements_x > 0]
    return block(np.concatenate([-x[::-1], [0.0], x]), elements_y, [0.0, 1.0], mapping, held)
