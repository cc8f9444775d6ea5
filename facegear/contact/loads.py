"""Points by which a pair of teeth can touch, under the hats of a flank or along a tip edge.

Off the line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge and
grows by micrometres within a node distance, so that averages over the surface beside it come too late. Edges
therefore carry loads of their own, hats along the edge with gaps taken on it.
"""

from typing import NamedTuple

import numpy as np

from facegear.arrays import AnyArray, Array, Integers
from facegear.contact.basis_functions import FacingPoints
from facegear.contact.flanks import OF_AN_EDGE, PinionPoints, PinionSurface

SMALLEST_COVER = 0.02
"""Part of a hat's area below which it is left out: the tooth opposite ends there."""


def flank_points(
    surface: PinionSurface, points: Integers, gap: Array, lever_arm: Array, gear: Array, first: int = 0
) -> FacingPoints:
    """Integration points (q,) of the pinion, numbered `points` (q,), whose hats are numbered from `first` on.

    gap, lever_arm (q,) m; gear (q, 2): refined lattice coordinates opposite.
    """
    under, values = surface.under
    return FacingPoints(
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


def gathered(
    points: PinionPoints, first: int, hits: tuple[Integers, Integers, Array, Array], edge: EdgePoints
) -> tuple[FacingPoints, Integers]:
    """Points of p pairs of teeth, and where those of each begin (p + 1,): those of the gear's tip edge, then
    those of the pinion, whose hats are numbered from `first` on.

    hits: numbers (q,) of points of the pinion, where those of each pair end (p + 1,), 0 first, their gaps
    (q,) m and refined lattice coordinates (q, 2) opposite.
    """
    number, ends, gap, gear = hits
    pairs, beside = edge.gap.shape

    starts = ends + beside * np.arange(pairs + 1)
    bounds = list(zip(starts.tolist(), ends.tolist(), ends[1:].tolist(), strict=False))

    def join_points(on_edge: AnyArray, on_pinion: AnyArray, numbers: Integers | None = None) -> AnyArray:
        """Return values of the edge's points (p, e, ...) and the pinion's (q, ...) as one array.

        With numbers (q,) the pinion's values stand in these rows, which are copied once.
        """
        values = np.empty((starts[-1], *on_pinion.shape[1:]), on_pinion.dtype)
        for (start, begin, end), edge_values in zip(bounds, on_edge, strict=True):
            values[start : start + beside] = edge_values
            rows = values[start + beside : start + beside + end - begin]
            if numbers is None:
                rows[:] = on_pinion[begin:end]
            else:
                np.take(on_pinion, numbers[begin:end], axis=0, out=rows, mode="clip")
        return values

    def at_each_pair(values: AnyArray, columns: int) -> AnyArray:
        """Return values (e, c) at the edge's points of each pair (p, e, columns), 0 in further columns."""
        padded_values = np.pad(values, ((0, 0), (0, columns - values.shape[1])))
        return np.broadcast_to(padded_values, (pairs, *padded_values.shape))

    gathered_points = FacingPoints(
        gap=join_points(edge.gap, gap),
        lever_arm=join_points(edge.lever_arm, points.lever_arm, number),
        pinion=join_points(edge.pinion, points.at, number),
        gear=join_points(at_each_pair(edge.gear, 2), gear),
        functions=join_points(at_each_pair(edge.hats, 4), points.hats + first, number),
        values=join_points(at_each_pair(edge.values, 4), points.values, number),
        area=join_points(np.full((pairs, beside), OF_AN_EDGE), points.area, number),
    )
    return gathered_points, starts


def flank_cover(surface: PinionSurface) -> Array:
    """Area (n,) that the teeth opposite must cover of each hat of the flank."""
    return SMALLEST_COVER * surface.full_area


def edge_cover(columns: int) -> Array:
    """The same (columns,) along an edge, in distances of its nodes."""
    cover = np.full(columns, SMALLEST_COVER)
    cover[[0, -1]] *= 0.5
    return cover
