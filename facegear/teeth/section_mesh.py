"""Nodes of a tooth section: columns and rows for the element sizes, and where their nodes stand.

Both halves of a section have the same topology (`section_topology`), also where their flanks are no mirror
images of each other, and share the nodes between them.
"""

from dataclasses import dataclass
from math import ceil

import numpy as np

from facegear.arrays import Array, Mask
from facegear.teeth.curvature import smallest_radius
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.section_outline import BOTTOM, TOP, Outline
from facegear.teeth.section_topology import HalfSection, coarsening_levels, depth_rows, half_section

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
    quads; floor_height: of the strip's floor in every plane, (planes,), m; rows: depth t at which the first
    rows end, (n,); fillet_rows: those below the fillet, (n,).
    """

    breaks: dict[str, tuple[float, float]]
    half: HalfSection
    floor_height: Array
    rows: Array
    fillet_rows: Array


def plan_section(outline: Outline, sizes: MeshSizes) -> SectionPlan:
    """Choose columns, refinement levels and rows for the sizes; one plan serves all planes of the width.

    Parameters
    ----------
    outline : Outline
        Outline of a tooth.
    sizes : MeshSizes
        Element sizes.

    Returns
    -------
    SectionPlan
        Nodes and quads in (sigma, t), ends of the outline's segments and depths of rows.
    """
    is_pinion = outline.body == "pinion"
    scale = outline.design.pinion_tip_radius if is_pinion else float(np.mean(outline.planes))
    lengths = {name: _length(outline, name, scale) for name in ("flank", "fillet", "root_land")}
    floor = _floor_height(outline)
    sides = outline.different_sides
    halfway = [outline.points(side, "flank", np.array([0.5]))[0] for side in sides]
    depth = scale * float(np.mean(halfway))
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
    below = float(np.max(floor)) - outline.back_height
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
        Outline of a tooth.
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


def _floor_height(outline: Outline) -> Array:
    """Return the heights (planes,), m, of the strip's floor, below which rows are plain."""
    below = outline.root_height - outline.back_height
    return outline.root_height - np.minimum(0.6 * outline.design.module, 0.5 * below)


def _length(outline: Outline, segment: str, scale: float) -> float:
    """Return the largest length (m) of a segment over both sides and all planes; angles become lengths at
    the radius `scale` (m).
    """
    lengths = []
    for side in outline.different_sides:
        angle, height = outline.points(side, segment, np.linspace(0, 1, 65))
        steps = np.hypot(scale * np.diff(angle, axis=0), np.diff(height, axis=0))
        lengths.append(float(np.max(steps.sum(axis=0))))
    return max(lengths)


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


def section_nodes(outline: Outline, plan: SectionPlan, side: int) -> tuple[Array, Array]:
    """Compute where the plan's nodes stand in every plane, on one side of the tooth section.

    Parameters
    ----------
    outline : Outline
        Outline of a tooth.
    plan : SectionPlan
        Topology of half a section.
    side : int
        Number of the side, RIGHT or LEFT.

    Returns
    -------
    tuple of (nodes, planes) arrays
        Angle, rad, in the frame in which the side stands on the right, and height as of `Outline`, m.
    """
    half = plan.half
    sigma, index = np.unique(half.sigma, return_inverse=True)
    shape = (len(sigma), len(outline.planes))
    outer_angle, outer_height = np.empty(shape), np.empty(shape)
    for name, (on, fraction) in segment_fractions(plan, sigma).items():
        if on.any():
            outer_angle[on], outer_height[on] = outline.points(side, name, fraction)
    inner_angle, inner_height = _inner_line(outline, plan, sigma, side)

    inward = _depth(plan, sigma[index])[:, None]
    angle = (1 - inward) * outer_angle[index] + inward * inner_angle[index]
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


def _inner_line(outline: Outline, plan: SectionPlan, sigma: Array, side: int) -> tuple[Array, Array]:
    """Return angle, rad, and height, m, (n, planes), of a half strip's inner edge at sigma (n,): halfway
    between both sides down to the floor, then along the floor to the cut.
    """
    wall, floor_columns = plan.half.columns
    steps = np.array([0.0, plan.breaks["flank"][1], float(wall)])
    ends = [outline.points(number, "flank", BOTTOM)[1][0] for number in outline.different_sides]
    under = np.mean(ends, axis=0)
    heights = outline.tip_height, under - 0.3 * (under - plan.floor_height), plan.floor_height
    tip_segment = "chamfer" if outline.has_chamfer else "flank"
    breaks = (tip_segment, TOP), ("flank", BOTTOM), ("fillet", BOTTOM)
    angles = [outline.middle(side, *segment_end)[0] for segment_end in breaks]
    # straight between coarse columns, so that mid nodes stand in the middle
    columns = np.arange(wall + 1.0)
    angle, height = np.empty((2, len(sigma), len(under)))
    for plane in range(len(under)):
        for values, at_steps in ((angle, angles), (height, heights)):
            corners = np.interp(columns, steps, [at_step[plane] for at_step in at_steps])
            values[:, plane] = np.interp(sigma, columns, corners)
    along_floor = np.maximum(sigma - wall, 0.0) / floor_columns * outline.half_pitch
    return angle + along_floor[:, None], height
