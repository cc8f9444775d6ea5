"""Hertz's contact by Kratos: a cylinder on a block in plane strain, compared with the formula.

Both are linear hexahedra whose nodes do not meet. Lengths in mm, forces in N.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.arrays import Array, Integers
from facegear.teeth.design import Material
from validation.contact.kratos import VERSION, TwoBodies, solve

RADIUS, YOUNG, POISSON = 10.0, 210_000.0, 0.3
"""Radius of the cylinder, mm, Young's modulus, N/mm2, and Poisson's ratio of both bodies."""
APPROACH = 0.026
"""Approach of the far sides of both bodies, mm."""
REACH, FINE, GROWTH = 12.0, 0.4, 1.4
"""Half width and depth of a body; width on each side with even cells; growth of the cells beyond."""
SLAVE, MASTER = 2, 3
"""Layers of cells along the axis of both bodies."""
UNEVEN = 1.23
"""Cells of the block over those of the cylinder."""


def hertz_peer(folder: Path, cells: Sequence[float], threads: int) -> pd.DataFrame:
    """Compare the largest pressure with Hertz's at Kratos' own load.

    Parameters
    ----------
    folder : Path
        Folder of the runs.
    cells : Sequence[float]
        Lengths of the cylinder's cells, mm.
    threads : int
        Number of threads.

    Returns
    -------
    DataFrame
        One row for each length.

    Raises
    ------
    FacegearError
        If Kratos cannot be run or does not converge.
    """
    rows = []
    for cell in cells:
        bodies, fixed_nodes = cylinder_on_block(cell)
        run = solve(folder / f"hertz_{round(1e3 * cell):03d}", bodies, (1.0,), threads)
        load = run.reaction[fixed_nodes, 1].sum() / thickness(cell)
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
    """Return largest pressure and half width of the contact.

    Parameters
    ----------
    load : float
        Line load, N/mm.

    Returns
    -------
    float, float
        Pressure, N/mm2, and half width, mm.
    """
    stiffness = YOUNG / (2.0 * (1.0 - POISSON**2))
    return np.sqrt(load * stiffness / (np.pi * RADIUS)), np.sqrt(4.0 * load * RADIUS / (np.pi * stiffness))


def thickness(cell: float) -> float:
    """Return the length of both bodies along the axis.

    Parameters
    ----------
    cell : float
        Length of the cylinder's cells, mm.

    Returns
    -------
    float
        Length, mm.
    """
    return 6.0 * cell


def cylinder_on_block(cell: float) -> tuple[TwoBodies, Integers]:
    """Mesh the cylinder, then the block.

    Parameters
    ----------
    cell : float
        Length of the cylinder's cells, mm.

    Returns
    -------
    TwoBodies, (n,) array of int
        Bodies, and indices of the nodes that hold the block.
    """
    depth = thickness(cell)
    upper, lower = _grid(cell, 1.0, depth, SLAVE), _grid(UNEVEN * cell, -1.0, depth, MASTER)
    upper[..., 1] += upper[..., 0] ** 2 / (2.0 * RADIUS) * (1.0 - upper[..., 1] / upper[..., 1].max())
    numbers = [np.arange(upper[..., 0].size).reshape(upper.shape[:-1])]
    numbers.append(numbers[0].size + np.arange(lower[..., 0].size).reshape(lower.shape[:-1]))
    nodes = np.concatenate([upper.reshape(-1, 3), lower.reshape(-1, 3)])
    support_displacement = np.full(nodes.shape, np.nan)
    support_displacement[:, 2] = 0.0
    fixed_nodes = numbers[1][:, -1].ravel()
    support_displacement[fixed_nodes, :2] = 0.0
    support_displacement[numbers[0][:, -1].ravel(), :2] = 0.0, -APPROACH
    cubes = _cubes(numbers[0]), _cubes(numbers[1])[:, [4, 5, 6, 7, 0, 1, 2, 3]]
    faces = _faces(numbers[0]), _faces(numbers[1])[:, ::-1]
    steel = Material(1e6 * YOUNG, POISSON)
    return TwoBodies(nodes, cubes, faces, support_displacement, (steel, steel)), fixed_nodes


def _grid(cell: float, side: float, depth: float, layers: int) -> Array:
    """Points (along, down, axis, 3) of a block whose contact face is y = 0, above (side 1) or below it."""
    down = _graded_distances(cell)
    along = np.concatenate([-down[:0:-1], down])
    x, y, z = np.meshgrid(along, down, np.linspace(0.0, depth, layers + 1), indexing="ij")
    return np.stack([x, side * y, z], axis=-1)


def _graded_distances(cell: float) -> Array:
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
