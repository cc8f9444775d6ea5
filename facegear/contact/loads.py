"""Points by which a pair of teeth can touch, under the hats of a flank or along a tip edge.

Off the line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge and
grows by micrometres within a node distance, so that averages over the surface beside it come too late. Edges
therefore carry loads of their own, hats along the edge with gaps taken on it.
"""

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact.averages import HatPoints
from facegear.contact.bodies.surface import edge_hats
from facegear.contact.flanks import OF_AN_EDGE, PinionSurface

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


def edge_points(columns: int, gap: Array, lever_arm: Array, pinion: Array, gear: Array) -> HatPoints:
    """All points (q,) of `edge_hats` of the gear's tip edge of `columns` nodes in p placements: (p q,).

    gap, lever_arm (p, q) m; refined lattice coordinates `pinion` (p, q, 2) and `gear` (q, 2).
    """
    _, under, values = edge_hats(columns)
    times = len(gap)
    return HatPoints(
        gap.ravel(),
        lever_arm.ravel(),
        pinion.reshape(-1, 2),
        np.tile(gear, (times, 1)),
        np.tile(under, (times, 2)),
        np.tile(np.pad(values, ((0, 0), (0, 2))), (times, 1)),
        np.full(gap.size, OF_AN_EDGE),
    )


def merged(first: HatPoints, at: Integers, second: HatPoints, beside: Integers) -> HatPoints:
    """Points of both, those of the first at rows `at` and those of the second at rows `beside`."""
    columns = []
    for upper, lower in zip(first, second, strict=True):
        column = np.empty((len(upper) + len(lower), *upper.shape[1:]), upper.dtype)
        column[at], column[beside] = upper, lower
        columns.append(column)
    return HatPoints(*columns)


def flank_cover(surface: PinionSurface) -> Array:
    """Area (n,) that the teeth opposite must cover of each hat of the flank."""
    return SMALLEST_COVER * surface.full_area


def edge_cover(columns: int) -> Array:
    """The same (columns,) along an edge, in distances of its nodes."""
    cover = np.full(columns, SMALLEST_COVER)
    cover[[0, -1]] *= 0.5
    return cover
