"""Hertz's contact by Kratos: a cylinder on a block in plane strain, held against the formula.

Both are linear hexahedra whose nodes do not meet. Lengths in mm, forces in N.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.geometry.design import Material
from validation.contact.kratos import VERSION, TwoBodies, solve

RADIUS, YOUNG, POISSON = 10.0, 210_000.0, 0.3
APPROACH = 0.026
"""By how much the far sides of both bodies come closer."""
REACH, FINE, GROWTH = 12.0, 0.4, 1.4
"""Half width and depth of a body; width on each side with even cells; growth of the cells beyond."""
SLAVE, MASTER = 2, 3
"""Layers of cells along the axis of both bodies."""
UNEVEN = 1.23
"""Cells of the block over those of the cylinder."""


def hertz_peer(folder: Path, cells: Sequence[float], threads: int) -> pd.DataFrame:
    """A row for each length of the cylinder's cells (mm): largest pressure against Hertz at Kratos' own load.

    Raises FacegearError if Kratos cannot be run or does not converge.
    """
    rows = []
    for cell in cells:
        bodies, held = cylinder_on_block(cell)
        run = solve(folder / f"hertz_{round(1e3 * cell):03d}", bodies, (1.0,), threads)
        load = run.reaction[held, 1].sum() / thickness(cell)
        pressure, half_width = hertz(load)
        rows.append(
            {
                "cells_in_half_width": half_width / cell,
                "dof": bodies.nodes.size,
                "load_n_mm": load,
                "pressure_mpa": run.pressure.max(),
                "hertz_mpa": pressure,
                "error_percent": 100.0 * (run.pressure.max() / pressure - 1.0),
                "kratos_seconds": run.seconds,
                "kratos_gigabytes": run.gigabytes,
                "kratos_version": VERSION,
            }
        )
    return pd.DataFrame(rows)


def hertz(load: float) -> tuple[float, float]:
    """Largest pressure (N/mm2) and half width (mm) of the contact under a line load (N/mm)."""
    stiffness = YOUNG / (2.0 * (1.0 - POISSON**2))
    return np.sqrt(load * stiffness / (np.pi * RADIUS)), np.sqrt(4.0 * load * RADIUS / (np.pi * stiffness))


def thickness(cell: float) -> float:
    """Length of both bodies along the axis, mm."""
    return 6.0 * cell


def cylinder_on_block(cell: float) -> tuple[TwoBodies, Integers]:
    """The cylinder, then the block, and which of the nodes hold the block."""
    depth = thickness(cell)
    upper, lower = _grid(cell, 1.0, depth, SLAVE), _grid(UNEVEN * cell, -1.0, depth, MASTER)
    upper[..., 1] += upper[..., 0] ** 2 / (2.0 * RADIUS) * (1.0 - upper[..., 1] / upper[..., 1].max())
    numbers = [np.arange(upper[..., 0].size).reshape(upper.shape[:-1])]
    numbers.append(numbers[0].size + np.arange(lower[..., 0].size).reshape(lower.shape[:-1]))
    nodes = np.concatenate([upper.reshape(-1, 3), lower.reshape(-1, 3)])
    moved = np.full(nodes.shape, np.nan)
    moved[:, 2] = 0.0
    held = numbers[1][:, -1].ravel()
    moved[held, :2] = 0.0
    moved[numbers[0][:, -1].ravel(), :2] = 0.0, -APPROACH
    cubes = _cubes(numbers[0]), _cubes(numbers[1])[:, [4, 5, 6, 7, 0, 1, 2, 3]]
    faces = _faces(numbers[0]), _faces(numbers[1])[:, ::-1]
    steel = Material(1e6 * YOUNG, POISSON)
    return TwoBodies(nodes, cubes, faces, moved, (steel, steel)), held


def _grid(cell: float, side: float, depth: float, layers: int) -> Array:
    """Points (along, down, axis, 3) of a block whose contact face is y = 0, above (side 1) or below it."""
    down = _graded(cell)
    along = np.concatenate([-down[:0:-1], down])
    x, y, z = np.meshgrid(along, down, np.linspace(0.0, depth, layers + 1), indexing="ij")
    return np.stack([x, side * y, z], axis=-1)


def _graded(cell: float) -> Array:
    """Distances from the first point of contact to REACH, even up to FINE."""
    ends, step = [0.0], cell
    while ends[-1] < REACH:
        step *= GROWTH if ends[-1] > FINE else 1.0
        ends.append(ends[-1] + step)
    return np.array(ends)


def _cubes(numbers: Integers) -> Integers:
    """Nodes (cells, 8) of the hexahedra of a grid."""
    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    n = tuple(size - 1 for size in numbers.shape)
    corners = [numbers[i : i + n[0], j : j + n[1], k : k + n[2]] for k in (0, 1) for i, j in ring]
    return np.stack(corners, axis=-1).reshape(-1, 8)


def _faces(numbers: Integers) -> Integers:
    """Nodes (faces, 4) of the contact face of a grid."""
    face = numbers[:, 0]
    return np.stack([face[:-1, :-1], face[1:, :-1], face[1:, 1:], face[:-1, 1:]], axis=-1).reshape(-1, 4)
