"""Where the pairs of teeth can touch at a position."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, pairwise

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.basis_functions import Cover, FacingPairs, FacingPoints
from facegear.contact.bodies.surface import edge_hats
from facegear.contact.candidates import Candidates, candidates_of
from facegear.contact.flanks import FlankPair
from facegear.contact.loads import EdgePoints, edge_cover, flank_cover, gathered
from facegear.contact.options import ContactOptions
from facegear.geometry.opposite import located, tip_edge_feet
from facegear.geometry.pinion_surface import SurfacePoints
from facegear.geometry.separation import separation, separation_each

SAG = 10e-6
"""By how much (m) a gap between probes may be less than at the nearest of them."""

FARTHEST = 1e-3
"""Gap or depth (m) beyond which the surfaces of both teeth do not see each other."""

BESIDE = 0.1
"""Modules of tip land beside the gear's flank that a pinion's flank may meet."""


@dataclass(frozen=True, eq=False)
class Placements:
    """Pairs of teeth (p,) and the angles phi1, phi2 (p,) rad that the unloaded gears stand at."""

    phi1: Array
    phi2: Array
    tooth: Integers

    @property
    def all(self) -> tuple[Array, Array, Array]:
        """Angles and numbers as the geometry takes them."""
        return self.phi1, self.phi2, self.tooth.astype(float)


def find_candidates(
    pair: FlankPair,
    placement: tuple[float, float],
    teeth: Integers,
    limit: float,
    options: ContactOptions,
) -> list[Candidates]:
    """Hats and edges of the pairs `teeth` that a turn of the pinion by `limit` (rad) would close.

    placement: angles phi1, phi2 (rad) of the unloaded gears. Pairs without any are left out.
    """
    cover, lattices = cover_of(pair, options), (pair.pinion.lattice, pair.gear.lattice)
    facing_pairs = facing_points(pair, [placement], [teeth], limit, options)[0]
    parts = [facing_pairs.points.part(slice(*ends)) for ends in pairwise(facing_pairs.starts.tolist())]
    return list(
        chain(
            *(
                candidates_of(*lattices, tooth, part, cover.min_area, limit, cover.first)
                for tooth, part in zip(teeth.tolist(), parts, strict=True)
            )
        )
    )


def cover_of(pair: FlankPair, options: ContactOptions) -> Cover:
    """The hats of the gear's tip edge, the pinion's flank, and the pinion's tip edge."""
    pinion, gear = pair.pinion, pair.gear.lattice
    area, first = flank_cover(pinion), gear.shape[1] if options.edges else 0
    if options.edges:
        area = np.concatenate([edge_cover(first), area, edge_cover(pinion.shape[1])])
    return Cover(area, first, pinion.shape, (pinion.lattice.flank_end, gear.flank_end))


def facing_points(
    pair: FlankPair,
    placements: Sequence[tuple[float, float]],
    teeth: Sequence[Integers],
    limit: float,
    options: ContactOptions,
) -> list[FacingPairs]:
    """Points near the flank opposite, and those of both tip edges, at several placements, each with its own
    teeth: those under all hats that a turn by `limit` (rad) would close.

    placements: angles phi1, phi2 (rad) of the unloaded gears.
    """
    counts = [len(numbers) for numbers in teeth]
    phi1, phi2 = (np.repeat(part, counts) for part in np.array(placements).T)
    all_pairs = Placements(phi1, phi2, np.concatenate(teeth))
    points, starts = _facing(pair, all_pairs, limit * pair.design.pinion_base_radius + SAG, options)
    parts = []
    for (begin, end), numbers in zip(pairwise(np.cumsum([0, *counts])), teeth, strict=True):
        begun = starts[begin : end + 1]
        parts.append(FacingPairs(points.part(slice(begun[0], begun[-1])), begun - begun[0], numbers))
    return parts


def _facing(
    pair: FlankPair, placements: Placements, depth: float, options: ContactOptions
) -> tuple[FacingPoints, Integers]:
    """Points of all pairs of teeth, and where those of each begin (p + 1,)."""
    design, gear = pair.design, pair.gear
    points, flank_count = pair.pinion.facing, len(pair.pinion.area)
    first = gear.lattice.shape[1] if options.edges else 0
    near = _near(pair, placements, depth)
    # the pinion's tip edge is looked at together with its flank, and only where that comes near
    tip = np.arange(flank_count, points.area.size if options.edges else flank_count)
    numbers = [np.concatenate([part, tip]) if part.size else part for part in near]
    counts, number = np.array([part.size for part in numbers]), np.concatenate(numbers)
    surface = SurfacePoints(points.position, points.normal)
    each = np.repeat(np.arange(len(near)), counts)
    hits = located(design, separation_each(design, surface, placements.all, each, FARTHEST, number))
    beside = np.where(number < flank_count, BESIDE * design.module, 0.0)
    on_gear, gap = gear.coordinates(hits, options.fillet, beside), hits.gap
    if not options.fillet:
        gap = np.where(pair.pinion.lattice.in_fillet(points.at[number]), np.inf, gap)
    feet = _feet(pair, placements, options)
    return gathered(points, first, (number, np.cumsum([0, *counts]), gap, on_gear), feet)


def _feet(pair: FlankPair, placements: Placements, options: ContactOptions) -> EdgePoints:
    """Points (e,) of the gear's tip edge in p placements; none without edges."""
    columns = pair.gear.lattice.shape[1]
    _, under, values = edge_hats(columns)
    if not options.edges:
        nothing = np.zeros((len(placements.tooth), 0))
        at = np.zeros((*nothing.shape, 2))
        return EdgePoints(nothing, nothing, at, np.zeros((0, 2)), under[:0], values[:0])
    curve = pair.pinion.fillet_curve if options.fillet else None
    on_gear, points = pair.gear.tip
    feet = tip_edge_feet(pair.design, points, placements.all, curve, FARTHEST)
    at = pair.pinion.coordinates(feet.flank, feet.fillet, feet.y)
    return EdgePoints(feet.gap, feet.lever_arm, at, on_gear, under, values)


def _near(pair: FlankPair, placements: Placements, depth: float) -> list[Integers]:
    """Integration points near nodes of each pinion tooth whose gap is less than `depth` (m), by what probes
    find in their elements.
    """
    pinion = pair.pinion
    probes, elements = pinion.probes
    seen = separation(pair.design, probes, *placements.all, FARTHEST)
    # a gear's edge may lie between a probe and the points that touch: the flank is taken to go on there
    gaps = np.minimum(seen.gap, seen.continued)
    close = np.any((gaps < depth)[:, elements], axis=2)
    near = [np.zeros(0, np.int64)] * len(gaps)
    rows = np.flatnonzero(close.any(axis=1))
    known = np.where(np.isfinite(gaps[rows]), gaps[rows], np.nan)
    nodes = ~(pinion.between_probes @ known.T >= depth)
    cells = _beside(nodes.T.reshape(-1, *pinion.shape)).reshape(rows.size, pinion.element.size)
    for row, marked in zip(rows.tolist(), cells & close[rows][:, pinion.element], strict=True):
        near[row] = np.flatnonzero(marked[pinion.cell])
    return near


def _beside(nodes: Mask) -> Mask:
    """Cells (p, m - 1, n - 1) between nodes (p, m, n) that a marked node stands at or beside."""
    for axis in (1, 2):
        around = [(1, 1) if axis == other else (0, 0) for other in range(3)]
        padded = np.moveaxis(np.pad(nodes, around), axis, 0)
        size = len(padded) - 3
        beside = padded[:size] | padded[1 : size + 1] | padded[2 : size + 2] | padded[3:]
        nodes = np.moveaxis(beside, 0, axis)
    return nodes
