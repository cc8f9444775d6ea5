"""Points by which a pair of teeth can touch, under the hats of a flank or along a tip edge.

Off the line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge and
grows by micrometres within a node distance, so that averages over the surface beside it come too late. Edges
therefore carry loads of their own, hats along the edge with gaps taken on it.
"""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact.averages import HatPoints
from facegear.contact.flanks import OF_AN_EDGE, PinionPoints, PinionSurface
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler
from facegear.machine_code.picked import empty_numbers, empty_table, integer_table, integers, table

compiled = compiler(*picked.SOURCES)

SMALLEST_COVER = 0.02
"""Part of a hat's area below which it is left out: the tooth opposite ends there."""


def flank_points(
    surface: PinionSurface, points: Integers, gap: Array, lever_arm: Array, gear: Array, first: int = 0
) -> HatPoints:
    """Integration points (q,) of the pinion, numbered `points` (q,), whose hats are numbered from `first` on.

    gap, lever_arm (q,) m; gear (q, 2): refined lattice coordinates opposite.
    """
    under, values = surface.under
    return HatPoints(
        gap, lever_arm, surface.at[points], gear, under[points] + first, values[points], surface.area[points]
    )


class EdgePoints(NamedTuple):
    """Points (e,) of the gear's tip edge in p placements.

    gap, lever_arm (p, e) m; refined lattice coordinates `pinion` (p, e, 2) and `gear` (e, 2); `hats` and
    `values` (e, 2): those of `edge_hats`.
    """

    gap: Array
    lever_arm: Array
    pinion: Array
    gear: Array
    hats: Integers
    values: Array


@compiled
def gathered(
    points: PinionPoints, first: int, hits: tuple[Integers, Integers, Array, Array], edge: EdgePoints
) -> tuple[HatPoints, Integers]:
    """Points of p pairs of teeth, and where those of each begin (p + 1,): those of the gear's tip edge, then
    those of the pinion, whose hats are numbered from `first` on.

    hits: numbers (q,) of points of the pinion, where those of each pair end (p + 1,), 0 first, their gaps
    (q,) m and refined lattice coordinates (q, 2) opposite.
    """
    number, ends, gap, gear = hits
    pairs, beside = edge.gap.shape
    size = number.size + pairs * beside
    lever_arm, area = empty_numbers(size), empty_numbers(size)
    gaps, at_pinion, at_gear = empty_numbers(size), empty_table(size, 2), empty_table(size, 2)
    hats, values = integer_table(size, 4), table(size, 4)
    starts, row = integers(pairs + 1, 0), 0
    for pair in range(pairs):
        for e in range(beside):
            gaps[row], lever_arm[row], area[row] = edge.gap[pair, e], edge.lever_arm[pair, e], OF_AN_EDGE
            for i in range(2):
                at_pinion[row, i], at_gear[row, i] = edge.pinion[pair, e, i], edge.gear[e, i]
                hats[row, i], values[row, i] = edge.hats[e, i], edge.values[e, i]
            row += 1
        for q in range(ends[pair], ends[pair + 1]):
            point = number[q]
            gaps[row], lever_arm[row], area[row] = gap[q], points.lever_arm[point], points.area[point]
            for i in range(2):
                at_pinion[row, i], at_gear[row, i] = points.at[point, i], gear[q, i]
            for h in range(4):
                hats[row, h], values[row, h] = points.hats[point, h] + first, points.values[point, h]
            row += 1
        starts[pair + 1] = row
    return HatPoints(gaps, lever_arm, at_pinion, at_gear, hats, values, area), starts


def flank_cover(surface: PinionSurface) -> Array:
    """Area (n,) that the teeth opposite must cover of each hat of the flank."""
    return SMALLEST_COVER * surface.full_area


def edge_cover(columns: int) -> Array:
    """The same (columns,) along an edge, in distances of its nodes."""
    cover = np.full(columns, SMALLEST_COVER)
    cover[[0, -1]] *= 0.5
    return cover
