"""Points at which a pair of teeth can touch, under the basis functions of a flank or along a tip edge.

Off the line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge
and grows by micrometres within a node distance, so that averages over the surface beside it come too late.
Edges therefore carry loads of their own: basis functions along the edge with gaps taken on it.
"""

from typing import NamedTuple

import numpy as np

from facegear.arrays import AnyArray, Array, Integers
from facegear.contact.basis_functions import FacingPoints
from facegear.contact.flanks import OF_AN_EDGE, PinionPoints, PinionSurface

SMALLEST_COVER = 0.02
"""Fraction of a basis function's area below which it is left out: the opposite tooth ends there."""


def flank_points(
    surface: PinionSurface, points: Integers, gap: Array, lever_arm: Array, gear: Array, first: int = 0
) -> FacingPoints:
    """Return integration points of the pinion with the basis functions over them.

    Parameters
    ----------
    surface : PinionSurface
        Contact surface of the pinion.
    points : (q,) array of int
        Numbers of the points.
    gap : (q,) array
        m.
    lever_arm : (q,) array
        m.
    gear : (q, 2) array
        Refined lattice coordinates on the gear, dimensionless.
    first : int
        Number of the first basis function of the pinion.

    Returns
    -------
    FacingPoints
        Points (q,), in SI units.
    """
    under, values = surface.under
    return FacingPoints(
        gap, lever_arm, surface.at[points], gear, under[points] + first, values[points], surface.area[points]
    )


class EdgePoints(NamedTuple):
    """Points (e,) of the gear's tip edge in p placements.

    gap, lever_arm (p, e) m; refined lattice coordinates `pinion` (p, e, 2) and `gear` (e, 2); `hats` and
    `values` (e, 2) as returned by `edge_hats`.
    """

    gap: Array
    lever_arm: Array
    pinion: Array
    gear: Array
    hats: Integers
    values: Array


def gather_points(
    points: PinionPoints, first: int, hits: tuple[Integers, Integers, Array, Array], edge: EdgePoints
) -> tuple[FacingPoints, Integers]:
    """Join the points of p pairs of teeth: for each pair those of the gear's tip edge, then those of the
    pinion.

    Parameters
    ----------
    points : PinionPoints
        Points of the pinion.
    first : int
        Number of the first basis function of the pinion.
    hits : tuple of arrays
        Numbers (q,) of points of the pinion, ends of each pair's points (p + 1,) with 0 first, gaps (q,)
        in m, and refined lattice coordinates (q, 2) on the gear.
    edge : EdgePoints
        Points of the gear's tip edge.

    Returns
    -------
    tuple[FacingPoints, Integers]
        Points of all pairs, and the start of each pair's points (p + 1,).
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
    """Return the area that the opposite teeth must cover of each basis function of the flank.

    Parameters
    ----------
    surface : PinionSurface
        Contact surface of the pinion.

    Returns
    -------
    (n,) array
        m2.
    """
    return SMALLEST_COVER * surface.full_area


def edge_cover(columns: int) -> Array:
    """Smallest covered length of each edge basis function.

    Parameters
    ----------
    columns : int
        Number of nodes along the edge.

    Returns
    -------
    (columns,) array
        Length as a fraction of the node spacing.
    """
    cover = np.full(columns, SMALLEST_COVER)
    cover[[0, -1]] *= 0.5
    return cover
