"""Topology and nodes of a tooth section: quads that coarsen three to one away from the flank.

The half section is a strip along its outer boundary (tip corner, flank, fillet, root land) and a block below.
Coordinates: sigma runs along the boundary in units of coarse columns, t goes inwards, 0 at the surface and 1
on the centre line and on the floor of the strip; from 1 to 2 it crosses the block below, whose columns go on
from those of the floor.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.teeth.curvature import smallest_radius
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.section_outline import Outline


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
    """Right half of a tooth section: sigma and t (nodes,) of unique nodes, and quads (n, 9), sigma
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


THINNED = 2
"""Rows of elements that are thinner below a fillet where stress is read."""
GROWTH = 2.0
"""Ratio of their depths there."""
SHARP = 0.6
"""Deepest first row below a fillet in its smallest radius."""
ROUNDING = 1e-9
"""Part of a column by which a coordinate may be off by rounding, dimensionless."""


@dataclass(frozen=True)
class SectionPlan:
    """Start and end in sigma of each segment of the outline, and the topology in (sigma, t).

    breaks: by segment (`chamfer`, `flank`, `fillet_upper`, `fillet_lower`, `root_land`); half: nodes and
    quads; floor_height: of the strip's floor, m; rows: depth t at which the first rows end, (n,);
    fillet_rows: those below the fillet, (n,).
    """

    breaks: dict[str, tuple[float, float]]
    half: HalfSection
    floor_height: float
    rows: Array
    fillet_rows: Array


def plan_section(outline: Outline, sizes: MeshSizes) -> SectionPlan:
    """Choose columns, refinement levels and rows for the sizes; one plan serves all planes of the width.

    Parameters
    ----------
    outline : Outline
        Outline of half a tooth.
    sizes : MeshSizes
        Element sizes.

    Returns
    -------
    SectionPlan
        Nodes and quads in (sigma, t), ends of the outline's segments and depths of rows.
    """
    scale = outline.tip_height if outline.body == "pinion" else float(np.mean(outline.planes))
    lengths = {name: _length(outline, name, scale) for name in ("flank", "fillet", "root_land")}
    floor = _floor_height(outline)
    depth = scale * float(np.mean(outline.points("flank", np.array([0.5]))[0]))
    levels = coarsening_levels(sizes.profile, sizes.thickness, depth)

    lower = max(1, round(lengths["fillet"] / 2 / (sizes.fillet or sizes.profile)))
    upper = max(1, round(lengths["fillet"] / 2 / sizes.profile))
    chamfer = max(1, round(outline.design.pinion.tip_chamfer / sizes.profile)) if outline.has_chamfer else 0
    fine = 3**levels
    wall = max(2, ceil((round(lengths["flank"] / sizes.profile) + upper + chamfer) / fine))

    land = max(1, round(lengths["root_land"] / sizes.profile))
    floor_columns = max(2, round(outline.half_pitch * scale / (1.5 * sizes.thickness)))
    floor_levels = 0
    while 3**floor_levels * floor_columns < lower + land and floor_levels < levels:
        floor_levels += 1
    floor_columns = max(floor_columns, ceil((lower + land) / 3**floor_levels))
    total = 3**floor_levels * floor_columns
    land_fraction = lengths["root_land"] / (lengths["root_land"] + lengths["fillet"] / 2)
    land = min(max(1, round(total * land_fraction)), total - 1)

    breaks = {
        "chamfer": (0.0, chamfer / fine),
        "flank": (chamfer / fine, wall - upper / fine),
        "fillet_upper": (wall - upper / fine, float(wall)),
        "fillet_lower": (float(wall), wall + floor_columns - land / 3**floor_levels),
        "root_land": (wall + floor_columns - land / 3**floor_levels, float(wall + floor_columns)),
    }
    rows = depth_rows(sizes.profile, sizes.thickness, depth, levels, sizes.second_row)
    below = floor - outline.back_height
    block = max(1, round(below / (1.5 * sizes.thickness)))
    column_levels = [levels] * wall + [floor_levels] * floor_columns
    half = half_section(rows, column_levels, (wall, floor_columns), block)
    thinned = np.array([row.t1 for row in rows[:THINNED] if row.t1 < 1.0])
    return SectionPlan(
        breaks=breaks,
        half=half,
        floor_height=floor,
        rows=thinned,
        fillet_rows=_fillet_rows(thinned, first_row(outline, sizes) / depth),
    )


def first_row(outline: Outline, sizes: MeshSizes) -> float:
    """Return the depth of the first row below the fillet: less below a sharp one, but at least half the given
    depth.

    Parameters
    ----------
    outline : Outline
        Outline of half a tooth.
    sizes : MeshSizes
        Element sizes.

    Returns
    -------
    float
        m; inf if sizes.fillet_depth is None.
    """
    depth_limit = sizes.fillet_depth
    if depth_limit is None:
        return np.inf
    return float(
        np.clip(SHARP * smallest_radius(outline.design, outline.body), 0.5 * depth_limit, depth_limit)
    )


def _fillet_rows(rows: Array, first: float) -> Array:
    """Return depths t (n,) at which rows end: the first is `first` deep, each next GROWTH times as deep
    as the one before, none ends deeper than in `rows` (n,).
    """
    sizes = first * GROWTH ** np.arange(rows.size)
    return np.minimum(rows, np.cumsum(sizes))


def _floor_height(outline: Outline) -> float:
    """Return the height (m, as of the outline) of the strip's floor, below which rows are plain."""
    below = outline.root_height - outline.back_height
    return outline.root_height - min(0.6 * outline.design.module, 0.5 * below)


def _length(outline: Outline, segment: str, scale: float) -> float:
    """Return the largest length (m) of a segment over the planes; angles become lengths at the radius
    `scale` (m).
    """
    angle, height = outline.points(segment, np.linspace(0, 1, 65))
    return float(np.max(np.hypot(scale * np.diff(angle, axis=0), np.diff(height, axis=0)).sum(axis=0)))


def segment_fractions(plan: SectionPlan, sigma: Array) -> dict[str, tuple[Mask, Array]]:
    """Assign positions sigma to the segments of the outline.

    Parameters
    ----------
    plan : SectionPlan
        Topology of the section.
    sigma : (n,) array
        Positions along the boundary in coarse columns, dimensionless; they must hold the segments' ends,
        which may differ by rounding.

    Returns
    -------
    dict of tuples
        For each segment the mask (n,) of the sigma on it (ends included), and their fractions (k,), 0..1.
    """
    result = {}
    breaks = {name: [_nearest(sigma, end) for end in ends] for name, ends in plan.breaks.items()}
    for name in ("chamfer", "flank", "root_land"):
        low, high = breaks[name]
        on = (sigma >= low) & (sigma <= high) if high > low else np.zeros(len(sigma), bool)
        result[name] = (on, (sigma[on] - low) / (high - low) if high > low else sigma[on])
    (start, corner), (_, end) = breaks["fillet_upper"], breaks["fillet_lower"]
    on = (sigma >= start) & (sigma <= end)
    at = sigma[on]
    result["fillet"] = (on, np.interp(at, [start, corner, end], [0.0, 0.5, 1.0]))
    return result


def _nearest(values: Array, value: float) -> float:
    """Return the element of `values` (n,) that is nearest to `value`."""
    return float(values[np.argmin(np.abs(values - value))])


def section_nodes(outline: Outline, plan: SectionPlan) -> tuple[Array, Array]:
    """Compute where the plan's nodes stand in every plane: the right half of the tooth section.

    Parameters
    ----------
    outline : Outline
        Outline of half a tooth.
    plan : SectionPlan
        Topology of the section.

    Returns
    -------
    tuple of (nodes, planes) arrays
        Angle from the tooth's centre line, rad, and height as of `Outline`, m.
    """
    half = plan.half
    sigma, index = np.unique(half.sigma, return_inverse=True)
    shape = (len(sigma), len(outline.planes))
    outer_angle, outer_height = np.empty(shape), np.empty(shape)
    for name, (on, fraction) in segment_fractions(plan, sigma).items():
        if on.any():
            outer_angle[on], outer_height[on] = outline.points(name, fraction)
    inner_angle, inner_height = _inner_line(outline, plan, sigma)

    inward = _depth(plan, sigma[index])[:, None]
    angle = (1 - inward) * outer_angle[index] + inward * inner_angle[index][:, None]
    height = (1 - inward) * outer_height[index] + inward * inner_height[index]
    below = half.t > 1
    height[below] = plan.floor_height + (half.t[below, None] - 1) * (outline.back_height - plan.floor_height)
    for values in (angle, height):
        _straighten(half, values)
    return angle, height


def _depth(plan: SectionPlan, sigma: Array) -> Array:
    """Return the depth t (nodes,) of nodes at sigma (nodes,), the first rows thinner below the fillet.

    They become so over the last whole column of the flank: rows that coarsen stay in shape within a column.
    """
    t = np.minimum(plan.half.t, 1.0)
    start, end = np.floor(plan.breaks["fillet_upper"][0] + ROUNDING), plan.breaks["fillet_lower"][1]
    below = np.interp(sigma, [start - 1.0, start, end, end + 1.0], [0.0, 1.0, 1.0, 0.0])
    plain, thin = (np.concatenate([[0.0], rows, [1.0]]) for rows in (plan.rows, plan.fillet_rows))
    return (1.0 - below) * t + below * np.interp(t, plain, thin)


def _straighten(half: HalfSection, values: Array) -> None:
    """Put mid nodes off the surface halfway between their ends, whatever the outline does; in place in
    `values` (nodes, planes).
    """
    quads = half.quads
    for middle, first, last in ((1, 0, 2), (3, 0, 6), (5, 2, 8), (7, 6, 8)):
        edges = quads[half.t[quads[:, middle]] > 0]
        values[edges[:, middle]] = (values[edges[:, first]] + values[edges[:, last]]) / 2
    sides, corners = (values[quads[:, members]].sum(axis=1) for members in ([1, 3, 5, 7], [0, 2, 6, 8]))
    values[quads[:, 4]] = sides / 2 - corners / 4


def _inner_line(outline: Outline, plan: SectionPlan, sigma: Array) -> tuple[Array, Array]:
    """Return angle (n,), rad, and height (n, planes), m, of the strip's inner edge at sigma (n,): down
    the centre line, then along the floor to the cut.
    """
    wall, floor_columns = plan.half.columns
    junction = plan.breaks["flank"][1]
    _, end_of_flank = outline.points("flank", np.ones(1))
    under = end_of_flank[0] - 0.3 * (end_of_flank[0] - plan.floor_height)
    # straight between coarse columns, so that mid nodes stand in the middle
    columns = np.arange(wall + 1.0)
    height = np.empty((len(sigma), len(under)))
    for plane, middle in enumerate(under):
        steps = [outline.tip_height, middle, plan.floor_height]
        height[:, plane] = np.interp(sigma, columns, np.interp(columns, [0.0, junction, wall], steps))
    return np.maximum(sigma - wall, 0.0) / floor_columns * outline.half_pitch, height
