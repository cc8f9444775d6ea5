"""Where the pairs of teeth can touch at a position."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, pairwise

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact.averages import HatPoints
from facegear.contact.candidates import Candidates, candidates_of
from facegear.contact.flanks import FlankPair
from facegear.contact.loads import edge_cover, edge_points, flank_cover, flank_points, joined
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
    design, pinion, gear = pair.design, pair.pinion, pair.gear
    near = _near(pair, placements, depth)
    # the pinion's tip edge is looked at together with its flank, and only where that comes near
    along, tip = pinion.tip
    counts = [points.size + (tip.position.shape[0] if points.size else 0) for points in near]
    normals = [part for points in near if points.size for part in (pinion.points.only(points), tip)]
    hits = located(
        design,
        separation_each(
            design,
            SurfacePoints(
                np.concatenate([np.zeros((0, 3)), *(part.position for part in normals)]),
                np.concatenate([np.zeros((0, 3)), *(part.normal for part in normals)]),
            ),
            placements.all,
            np.repeat(np.arange(len(near)), counts),
            FARTHEST,
        ),
    )
    starts = np.cumsum([0, *counts])
    beside = np.zeros(starts[-1])
    for start, points in zip(starts[:-1], near, strict=True):
        beside[start : start + points.size] = BESIDE * design.module
    on_gear = gear.coordinates(hits, options.fillet, beside)
    feet, feet_at = _feet(pair, placements, options)
    first = gear.lattice.shape[1] if options.edges else 0
    result = []
    for row, points in enumerate(near):
        parts = []
        if feet is not None:
            own = feet.gap[row], feet.lever_arm[row], feet_at[row]
            parts.append(edge_points(first, *own, gear.tip[0]))
        if points.size:
            flank = slice(starts[row], starts[row] + points.size)
            edge = slice(flank.stop, starts[row + 1])
            gap = hits.gap[flank]
            if not options.fillet:
                gap = np.where(pinion.lattice.in_fillet(pinion.at[points]), np.inf, gap)
            parts.append(flank_points(pinion, points, gap, pinion.lever_arm[points], on_gear[flank], first))
            if options.edges:
                hats = first + pinion.shape[0] * pinion.shape[1]
                own = hits.gap[edge], tip.lever_arm, along
                parts.append(edge_points(pinion.shape[1], *own, on_gear[edge], hats))
        result.append(joined(parts) if parts else None)
    return result


def _feet(pair: FlankPair, placements: Placements, options: ContactOptions) -> tuple[EdgeFeet | None, Array]:
    """Of the gear's tip edge, (p, n), and where they stand on the pinion's lattice (p, n, 2)."""
    if not options.edges:
        return None, np.zeros((len(placements.tooth), 0, 2))
    curve = pair.pinion.fillet_curve if options.fillet else None
    feet = tip_edge_feet(pair.design, pair.gear.tip[1], placements.all, curve, FARTHEST)
    return feet, pair.pinion.coordinates(feet.flank, feet.fillet, feet.y)


def _near(pair: FlankPair, placements: Placements, depth: float) -> list[Integers]:
    """Integration points in those elements of each pinion tooth that a probe finds within `depth` (m)."""
    probes, elements = pair.pinion.probes
    seen = separation(pair.design, probes, *placements.all, FARTHEST)
    # a gear's edge may lie between a probe and the points that touch: the flank is taken to go on there
    gaps = np.minimum(seen.gap, seen.continued)
    close = np.any((gaps < depth)[:, elements], axis=2)
    return [np.flatnonzero(row[pair.pinion.element]) for row in close]
