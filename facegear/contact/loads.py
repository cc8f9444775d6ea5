"""Unit forces by which a pair of teeth can touch, spread over the hats of a flank or along a tip edge.

Off the line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge and
grows by micrometres within a node distance, so that averages over the surface beside it come too late. Edges
therefore carry loads of their own, hats along the edge with gaps taken on it.
"""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact.averages import Rows, hat_averages
from facegear.contact.bodies.surface import edge_hats
from facegear.contact.flanks import FlankPair, PinionSurface
from facegear.contact.options import ContactOptions
from facegear.geometry.opposite import EdgeFeet, GearHits

SMALLEST_COVER = 0.02
"""Part of a hat's area below which it is left out: the tooth opposite ends there."""

BESIDE = 0.1
"""Modules of tip land beside the gear's flank that a pinion's flank may meet."""


@dataclass(frozen=True, eq=False)
class Facing:
    """Points of one tooth that face a tooth of the other gear.

    `index` (q,) numbers them among the points of the surface or edge; gap (q,) m, lever_arm (q,) m, and
    refined lattice coordinates `pinion` and `gear` (q, 2) on both teeth.
    """

    index: Integers
    gap: Array
    lever_arm: Array
    pinion: Array
    gear: Array


def facing(
    gap: Array,
    lever_arm: Array,
    pinion: Array,
    gear: Array,
    index: Integers | None = None,
) -> Facing:
    """Those points (n,) with a finite gap that lie on both surfaces; `index` where not all are given."""
    on = np.flatnonzero(np.isfinite(gap) & np.isfinite(pinion).all(axis=1) & np.isfinite(gear).all(axis=1))
    index = on if index is None else index[on]
    return Facing(index=index, gap=gap[on], lever_arm=lever_arm[on], pinion=pinion[on], gear=gear[on])


@dataclass(frozen=True, eq=False)
class Loads:
    """Unit forces of one tooth pair, each spread over points of the pinion or of an edge by a row of `rows`.

    For m forces: `hats` as in `Candidates`. For q points: `gap` (m), `lever_arm` (m), and
    where they are on both refined lattices, `pinion` and `gear` (q, 2).
    """

    rows: Rows
    hats: Integers
    gap: Array
    lever_arm: Array
    pinion: Array
    gear: Array


def pair_loads(
    pair: FlankPair,
    points: Integers,
    hits: GearHits | None,
    feet: EdgeFeet,
    options: ContactOptions,
) -> list[Loads]:
    """Loads of one pair of teeth on flanks, fillets and edges.

    points (q,) of the pinion's integration points, and `hits` of their normals followed by those of its tip
    edge (None without any point); `feet` (n,) of the gear's tip edge.
    """
    pinion, gear = pair.pinion, pair.gear
    loads = []
    if options.edges:
        on_pinion = pinion.coordinates(feet.flank, feet.fillet, feet.y)
        edge = facing(feet.gap, feet.lever_arm, on_pinion, gear.tip[0])
        loads += edge_loads(pinion, edge, gear.lattice.shape[1])
    if hits is None:
        return loads
    coordinates, tip = pinion.tip
    at, count = pinion.at[points], points.size
    beside = np.where(np.arange(hits.gap.shape[1]) < count, BESIDE * pair.design.module, 0.0)
    gap, on_gear = hits.gap[0], gear.coordinates(hits, options.fillet, beside)[0]
    usable = gap[:count] if options.fillet else np.where(pinion.lattice.in_fillet(at), np.inf, gap[:count])
    loads += flank_loads(pinion, facing(usable, pinion.lever_arm[points], at, on_gear[:count], points))
    if options.edges:
        edge = facing(gap[count:], tip.lever_arm, coordinates, on_gear[count:])
        loads += edge_loads(pinion, edge, pinion.shape[1])
    return loads


def flank_loads(surface: PinionSurface, points: Facing) -> list[Loads]:
    """Loads of the hats over those integration points of the pinion that face the gear."""
    if points.index.size == 0:
        return []
    under, values = surface.hats.indices.reshape(-1, 4), surface.hats.data.reshape(-1, 4)
    rows, hats = hat_averages(
        under[points.index],
        values[points.index],
        surface.area[points.index],
        SMALLEST_COVER * surface.full_area,
    )
    return [_loads(rows, hats, points)]


def edge_loads(surface: PinionSurface, points: Facing, columns: int) -> list[Loads]:
    """Loads along a tip edge of `columns` nodes, over points of `edge_hats`."""
    _, hats_here, values = edge_hats(columns)
    min_cover = np.full(columns, SMALLEST_COVER)
    min_cover[[0, -1]] *= 0.5
    rows, hats = hat_averages(
        hats_here[points.index], values[points.index], np.full(points.index.size, 0.5), min_cover
    )
    if hats.size == 0:
        return []
    nearest = np.rint(points.pinion).astype(np.int64) @ np.array([surface.shape[1], 1])
    return [_loads(rows, nearest[rows.heaviest()], points)]


def _loads(rows: Rows, hats: Integers, points: Facing) -> Loads:
    return Loads(
        rows=rows,
        hats=hats,
        gap=points.gap,
        lever_arm=points.lever_arm,
        pinion=points.pinion,
        gear=points.gear,
    )
