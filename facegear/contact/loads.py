"""Points by which a pair of teeth can touch, under the hats of a flank or along a tip edge.

Off the line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge and
grows by micrometres within a node distance, so that averages over the surface beside it come too late. Edges
therefore carry loads of their own, hats along the edge with gaps taken on it.
"""

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact.averages import HatPoints
from facegear.contact.bodies.surface import edge_hats
from facegear.contact.flanks import PinionSurface

SMALLEST_COVER = 0.02
"""Part of a hat's area below which it is left out: the tooth opposite ends there."""

OF_AN_EDGE = 0.5
"""Length that one of the two points between neighbouring nodes of an edge stands for, in their distance."""


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


def edge_points(
    columns: int, gap: Array, lever_arm: Array, pinion: Array, gear: Array, first: int = 0
) -> HatPoints:
    """All points (q,) of `edge_hats` of a tip edge of `columns` nodes, whose hats are numbered from `first`
    on.
    """
    _, under, values = edge_hats(columns)
    none = np.zeros_like(values)
    return HatPoints(
        gap,
        lever_arm,
        pinion,
        gear,
        np.concatenate([under + first, under], axis=1),
        np.concatenate([values, none], axis=1),
        np.full(gap.size, OF_AN_EDGE),
    )


def flank_cover(surface: PinionSurface) -> Array:
    """Area (n,) that the teeth opposite must cover of each hat of the flank."""
    return SMALLEST_COVER * surface.full_area


def edge_cover(columns: int) -> Array:
    """The same (columns,) along an edge, in distances of its nodes."""
    cover = np.full(columns, SMALLEST_COVER)
    cover[[0, -1]] *= 0.5
    return cover


def joined(parts: list[HatPoints]) -> HatPoints:
    """Points one after the other."""
    return HatPoints(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))
