"""Topology of half a tooth section: quads that coarsen three to one away from the flank.

Half a section is a strip along its outer boundary (tip corner, flank, fillet, root land) and a block below.
Coordinates: sigma runs along the boundary in units of coarse columns, t goes inwards, 0 at the surface and 1
on the centre line and on the floor of the strip; from 1 to 2 it crosses the block below, whose columns go on
from those of the floor. No geometry enters here.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from facegear.arrays import Array, Integers


@dataclass(frozen=True)
class ElementRow:
    """A row of the strip between depths t0 and t1 (0 at the surface, 1 at the centre line).

    level: its outer side has 3^level elements a coarse column; coarsens: its inner side has a third of them.
    """

    t0: float
    t1: float
    level: int
    coarsens: bool


@dataclass(frozen=True)
class HalfSection:
    """Half of a tooth section: sigma and t (nodes,) of unique nodes, and quads (n, 9), sigma
    fastest.
    """

    sigma: Array
    t: Array
    quads: Integers
    columns: tuple[int, int]
    """Coarse columns against the centre line, and against the floor."""


def depth_rows(
    profile: float, thickness: float, depth: float, levels: int, second: float | None = None
) -> list[ElementRow]:
    """Return the rows from the surface to the centre line for a tooth whose half is `depth` deep.

    A plain row and a coarsening row per level, or one plain row where nothing coarsens, then plain coarse
    rows over what is left. So a smaller `thickness` never makes the first row deeper. A row `second` deep
    follows the first of the finest level, if given.

    Parameters
    ----------
    profile : float
        Element size at the surface, any unit.
    thickness : float
        Largest size inside, same unit.
    depth : float
        Depth of the centre line, same unit.
    levels : int
        Number of coarsening levels.
    second : float, optional
        Depth of a second fine row, same unit; None without.

    Returns
    -------
    list[ElementRow]
        Rows from the surface inwards.
    """
    heights: list[tuple[float, int, bool]] = []
    if levels == 0 and profile < thickness and profile <= 0.75 * depth:
        heights = [(profile, 0, False)]
    for level in range(levels, 0, -1):
        size = profile * 3.0 ** (levels - level)
        plain = [0.8 * size] if level < levels else [size] if second is None else [size, second]
        heights += [*((height, level, False) for height in plain), (1.5 * size, level, True)]
    left = depth - sum(height for height, _, _ in heights)
    count = max(1, round(left / thickness))
    heights += [(left / count, 0, False)] * count
    ends = np.concatenate([[0.0], np.cumsum([height for height, _, _ in heights])]) / depth
    ends[-1] = 1.0
    return [
        ElementRow(float(ends[i]), float(ends[i + 1]), level, coarsens)
        for i, (_, level, coarsens) in enumerate(heights)
    ]


def coarsening_levels(profile: float, thickness: float, depth: float) -> int:
    """Return as many three-to-one coarsening steps as reach the inner size and fit three quarters of the
    depth.

    Parameters
    ----------
    profile : float
        Element size at the surface, any unit.
    thickness : float
        Largest size inside, same unit.
    depth : float
        Depth of the centre line, same unit.

    Returns
    -------
    int
        Number of steps.
    """
    levels = 0
    while (
        3.0 ** (levels + 1) * profile <= 1.2 * thickness
        and _coarsening_depth(profile, levels + 1) <= 0.75 * depth
    ):
        levels += 1
    return levels


def _coarsening_depth(profile: float, levels: int) -> float:
    """Return the depth that so many three-to-one levels take, in the unit of `profile`."""
    return sum(2.5 * profile * 3.0**step for step in range(levels))


def half_section(
    rows: list[ElementRow], column_levels: list[int], columns: tuple[int, int], block: int
) -> HalfSection:
    """Build nodes and quads of half a section in (sigma, t) from rows and columns; no geometry enters.

    Columns of different levels conform, as no row's sides are divided.

    Parameters
    ----------
    rows : list[ElementRow]
        Rows of the strip.
    column_levels : list[int]
        Refinement of each coarse column at the surface.
    columns : tuple[int, int]
        Numbers of columns against the centre line and against the floor.
    block : int
        Number of rows below the strip.

    Returns
    -------
    HalfSection
        Nodes in (sigma, t) and quads.
    """
    corners: list[Array] = []
    for column, finest in enumerate(column_levels):
        for row in rows:
            corners.extend(_row_quads(column, min(row.level, finest), row, row.level <= finest))
    block_ends = np.linspace(1.0, 2.0, block + 1)
    for column in range(columns[0], sum(columns)):
        for t0, t1 in pairwise(block_ends):
            corners.append(_rectangle(column, column + 1, t0, t1))
    return _nine_nodes(np.array(corners), columns)


def _rectangle(s0: float, s1: float, t0: float, t1: float) -> Array:
    """Return the corners (4, 2) of a rectangle in (sigma, t), sigma fastest."""
    return np.array([[s0, t0], [s1, t0], [s0, t1], [s1, t1]])


def _row_quads(column: int, level: int, row: ElementRow, active: bool) -> list[Array]:
    """Return the corners of one row's quadrilaterals in a column of the section mesh.

    They are (4, 2) arrays in local coordinates (sigma, t), ordered (0,0), (1,0), (0,1), (1,1) in each
    quadrilateral. There are 3**level of them across the column; in an `active` column a row that coarsens
    joins three to one.
    """
    divisions = 3**level
    if not (row.coarsens and active):
        edges = column + np.arange(divisions + 1) / divisions
        return [_rectangle(a, b, row.t0, row.t1) for a, b in pairwise(edges)]
    quads = []
    middle = (row.t0 + row.t1) / 2
    for group in range(divisions // 3):
        a, b, c, d = (column + (3 * group + step) / divisions for step in range(4))
        quads += [
            np.array([[a, row.t0], [b, row.t0], [a, row.t1], [b, middle]]),
            _rectangle(b, c, row.t0, middle),
            np.array([[c, row.t0], [d, row.t0], [c, middle], [d, row.t1]]),
            np.array([[b, middle], [c, middle], [a, row.t1], [d, row.t1]]),
        ]
    return quads


def _nine_nodes(corners: Array, columns: tuple[int, int]) -> HalfSection:
    """Return nine-node quads of corners (n, 4, 2) in (sigma, t): mid nodes added, equal nodes merged."""
    c00, c10, c01, c11 = (corners[:, i] for i in range(4))
    nine = np.stack(
        [
            c00,
            (c00 + c10) / 2,
            c10,
            (c00 + c01) / 2,
            (c00 + c10 + c01 + c11) / 4,
            (c10 + c11) / 2,
            c01,
            (c01 + c11) / 2,
            c11,
        ],
        axis=1,
    )
    keys = np.round(nine.reshape(-1, 2) * 1e9).astype(np.int64)
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    points = nine.reshape(-1, 2)[first]
    return HalfSection(points[:, 0], points[:, 1], inverse.reshape(-1, 9), columns)
