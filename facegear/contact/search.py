"""Where the pairs of teeth can touch at a position."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, pairwise

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.averages import HatPoints
from facegear.contact.candidates import Candidates, candidates_of
from facegear.contact.flanks import FlankPair
from facegear.contact.loads import edge_cover, edge_points, flank_cover, merged
from facegear.contact.options import ContactOptions
from facegear.geometry.opposite import EdgeFeet, located, tip_edge_feet
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
    return find_all(pair, [placement], [teeth], limit, options)[0]


def find_all(
    pair: FlankPair,
    placements: Sequence[tuple[float, float]],
    teeth: Sequence[Integers],
    limit: float,
    options: ContactOptions,
) -> list[list[Candidates]]:
    """`find_candidates` at several placements, each with its own teeth."""
    counts = [len(numbers) for numbers in teeth]
    phi1, phi2 = (np.repeat(part, counts) for part in np.array(placements).T)
    all_pairs = Placements(phi1, phi2, np.concatenate(teeth))
    points = _facing_points(pair, all_pairs, limit * pair.design.pinion_base_radius + SAG, options)
    first, cover = _hats(pair, options)
    candidates = []
    for tooth, part in zip(all_pairs.tooth.tolist(), points, strict=True):
        lattices = pair.pinion.lattice, pair.gear.lattice
        candidates.append(
            candidates_of(*lattices, tooth, part, cover, limit, first) if part is not None else []
        )
    ends = np.cumsum([0, *counts])
    return [list(chain(*candidates[start:end])) for start, end in pairwise(ends)]


def _hats(pair: FlankPair, options: ContactOptions) -> tuple[int, Array]:
    """The number of the flank's first hat, and the area that must be covered of each hat: those of the gear's
    tip edge, the pinion's flank, the pinion's tip edge.
    """
    if not options.edges:
        return 0, flank_cover(pair.pinion)
    gear, pinion = pair.gear.lattice.shape[1], pair.pinion.shape[1]
    return gear, np.concatenate([edge_cover(gear), flank_cover(pair.pinion), edge_cover(pinion)])


def _facing_points(
    pair: FlankPair, placements: Placements, depth: float, options: ContactOptions
) -> list[HatPoints | None]:
    """Points of each pair of teeth near the flank opposite, and those of both tip edges; None without any."""
    design, gear = pair.design, pair.gear
    points, flank_count = pair.pinion.facing, len(pair.pinion.area)
    first = gear.lattice.shape[1] if options.edges else 0
    near = _near(pair, placements, depth)
    # the pinion's tip edge is looked at together with its flank, and only where that comes near
    tip = np.arange(flank_count, points.area.size if options.edges else flank_count)
    numbers = [np.concatenate([part, tip]) if part.size else part for part in near]
    counts, number = np.array([part.size for part in numbers]), np.concatenate(numbers)
    seen = SurfacePoints(points.position[number], points.normal[number])
    each = np.repeat(np.arange(len(near)), counts)
    hits = located(design, separation_each(design, seen, placements.all, each, FARTHEST))
    beside = np.where(number < flank_count, BESIDE * design.module, 0.0)
    on_gear, gap, at = gear.coordinates(hits, options.fillet, beside), hits.gap, points.at[number]
    if not options.fillet:
        gap = np.where(pair.pinion.lattice.in_fillet(at), np.inf, gap)
    on_flank = HatPoints(
        gap,
        points.lever_arm[number],
        at,
        on_gear,
        points.hats[number] + first,
        points.values[number],
        points.area[number],
    )
    feet, feet_at = _feet(pair, placements, options)
    if feet is None:
        every, starts = on_flank, np.cumsum([0, *counts])
    else:
        size = feet.gap.shape[1]
        on_edge = edge_points(gear.lattice.shape[1], feet.gap, feet.lever_arm, feet_at, gear.tip[0])
        starts = np.cumsum([0, *(counts + size)])
        at_edge = (starts[:-1, None] + np.arange(size)).ravel()
        every = merged(on_edge, at_edge, on_flank, np.arange(number.size) + size * (each + 1))
    return [every.part(slice(*ends)) if ends[1] > ends[0] else None for ends in pairwise(starts)]


def _feet(pair: FlankPair, placements: Placements, options: ContactOptions) -> tuple[EdgeFeet | None, Array]:
    """Of the gear's tip edge, (p, n), and where they stand on the pinion's lattice (p, n, 2)."""
    if not options.edges:
        return None, np.zeros((len(placements.tooth), 0, 2))
    curve = pair.pinion.fillet_curve if options.fillet else None
    feet = tip_edge_feet(pair.design, pair.gear.tip[1], placements.all, curve, FARTHEST)
    return feet, pair.pinion.coordinates(feet.flank, feet.fillet, feet.y)


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
    nodes = ~(pinion.between_probes @ np.where(np.isfinite(gaps), gaps, np.nan).T >= depth)
    cells = _beside(nodes.T.reshape(-1, *pinion.shape)).reshape(len(gaps), -1)
    return [
        np.flatnonzero(near[pinion.element] & cell[pinion.cell])
        for near, cell in zip(close, cells, strict=True)
    ]


def _beside(nodes: Mask) -> Mask:
    """Cells (p, m - 1, n - 1) between nodes (p, m, n) that a marked node stands at or beside."""
    for axis in (1, 2):
        padded = np.pad(nodes, [(1, 1) if axis == other else (0, 0) for other in range(3)])
        size = padded.shape[axis] - 3
        nodes = np.any([np.take(padded, range(k, k + size), axis) for k in range(4)], axis=0)
    return nodes
