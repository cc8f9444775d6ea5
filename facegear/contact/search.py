"""Search for the points where pairs of teeth can touch at a position."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, pairwise

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.basis_functions import Cover, FacingPairs, FacingPoints
from facegear.contact.bodies.surface import edge_hats
from facegear.contact.candidates import (
    Candidates,
    EdgePoints,
    candidates_of,
    edge_cover,
    flank_cover,
    gather_points,
)
from facegear.contact.flanks import FlankPair
from facegear.contact.options import ContactOptions
from facegear.teeth.opposite import locate_hits, tip_edge_feet
from facegear.teeth.separation import separation, separation_each
from facegear.teeth.surfaces import SurfacePoints

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
    def angles_and_teeth(self) -> tuple[Array, Array, Array]:
        """Angles phi1, phi2 (rad) and pair numbers as floats, each (p,), as `facegear.teeth.separation`
        takes them.
        """
        return self.phi1, self.phi2, self.tooth.astype(float)


def find_candidates(
    pair: FlankPair,
    placement: tuple[float, float],
    teeth: Integers,
    limit: float,
    options: ContactOptions,
) -> list[Candidates]:
    """Find the basis functions of flanks and edges whose gap a rotation of the pinion would close.

    Parameters
    ----------
    pair : FlankPair
        Flanks that touch.
    placement : tuple[float, float]
        Angles phi1, phi2 of the unloaded gears, rad.
    teeth : (p,) array of int
        Numbers of the tooth pairs.
    limit : float
        Rotation, rad.
    options : ContactOptions
        Surfaces that take part.

    Returns
    -------
    list[Candidates]
        Candidates of each pair; pairs without any are left out.
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
    """Return the area that must be covered of every basis function of a pair, in the order in which they
    are numbered.

    The order is the gear's tip edge, the pinion's flank and the pinion's tip edge; without
    `options.edges` it is the pinion's flank alone.

    Parameters
    ----------
    pair : FlankPair
        Flanks that touch.
    options : ContactOptions
        Surfaces that take part.

    Returns
    -------
    Cover
        Areas that must be covered, and the numbering of the basis functions.
    """
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
    """Find the points under all basis functions that a rotation would close, at several placements.

    They are points near the opposite flank and those of both tip edges. Each placement has its own teeth.

    Parameters
    ----------
    pair : FlankPair
        Flanks that touch.
    placements : Sequence[tuple[float, float]]
        Angles phi1, phi2 of the unloaded gears, rad.
    teeth : sequence of arrays (p,) of int
        Numbers of the tooth pairs at each placement.
    limit : float
        Rotation, rad.
    options : ContactOptions
        Surfaces that take part.

    Returns
    -------
    list[FacingPairs]
        Points of each placement, pair by pair.
    """
    counts = [len(numbers) for numbers in teeth]
    phi1, phi2 = (np.repeat(part, counts) for part in np.array(placements).T)
    all_pairs = Placements(phi1, phi2, np.concatenate(teeth))
    points, starts = _find_facing_points(pair, all_pairs, limit * pair.design.normal_arm + SAG, options)
    parts = []
    for (begin, end), numbers in zip(pairwise(np.cumsum([0, *counts])), teeth, strict=True):
        pair_starts = starts[begin : end + 1]
        parts.append(
            FacingPairs(
                points.part(slice(pair_starts[0], pair_starts[-1])), pair_starts - pair_starts[0], numbers
            )
        )
    return parts


def _find_facing_points(
    pair: FlankPair, placements: Placements, depth: float, options: ContactOptions
) -> tuple[FacingPoints, Integers]:
    """Return the points of all p pairs of teeth whose gap may be below `depth` (m), and each pair's start
    (p + 1,).

    They are integration points of the pinion's flank near the gear, points of the pinion's tip edge where
    its flank comes near, and points of the gear's tip edge.
    """
    design, gear = pair.design, pair.gear
    points, flank_count = pair.pinion.facing_points, len(pair.pinion.area)
    first = gear.lattice.shape[1] if options.edges else 0
    near = _near(pair, placements, depth)
    # the pinion's tip edge is looked at together with its flank, and only where that comes near
    tip = np.arange(flank_count, points.area.size if options.edges else flank_count)
    numbers = [np.concatenate([part, tip]) if part.size else part for part in near]
    counts, number = np.array([part.size for part in numbers]), np.concatenate(numbers)
    surface = SurfacePoints(points.position, points.normal)
    pair_of_point = np.repeat(np.arange(len(near)), counts)
    hits = locate_hits(
        design, separation_each(design, surface, placements.angles_and_teeth, pair_of_point, FARTHEST, number)
    )
    beside = np.where(number < flank_count, BESIDE * design.module, 0.0)
    on_gear, gap = gear.coordinates(hits, options.fillet, beside), hits.gap
    # A fillet that takes no part must not close at any rotation.
    if not options.fillet:
        gap = np.where(pair.pinion.lattice.in_fillet(points.at[number]), np.inf, gap)
    feet = _feet(pair, placements, options)
    return gather_points(points, first, (number, np.cumsum([0, *counts]), gap, on_gear), feet)


def _feet(pair: FlankPair, placements: Placements, options: ContactOptions) -> EdgePoints:
    """Return the feet on the pinion of the e points of the gear's tip edge, in p placements; none without
    edges.
    """
    columns = pair.gear.lattice.shape[1]
    _, under, values = edge_hats(columns)
    if not options.edges:
        no_points = np.zeros((len(placements.tooth), 0))
        at = np.zeros((*no_points.shape, 2))
        return EdgePoints(no_points, no_points, at, np.zeros((0, 2)), under[:0], values[:0])
    curve = pair.pinion.fillet_curve if options.fillet else None
    on_gear, points = pair.gear.tip
    feet = tip_edge_feet(pair.design, points, placements.angles_and_teeth, curve, FARTHEST)
    at = pair.pinion.coordinates(feet.flank, feet.fillet, feet.y)
    return EdgePoints(feet.gap, feet.lever_arm, at, on_gear, under, values)


def _near(pair: FlankPair, placements: Placements, depth: float) -> list[Integers]:
    """Return, for each placement, the numbers of the integration points near nodes with a gap less than
    `depth` (m).

    Gaps along the pinion's normals are computed at probes, the nodes before refinement, and interpolated
    to the refined nodes.
    """
    pinion = pair.pinion
    probes, elements = pinion.probes
    probe_gaps = separation(pair.design, probes, *placements.angles_and_teeth, FARTHEST)
    # a gear's edge may lie between a probe and the points that touch: the flank is taken to go on there
    gaps = np.minimum(probe_gaps.gap, probe_gaps.continued)
    close = np.any((gaps < depth)[:, elements], axis=2)
    near = [np.zeros(0, np.int64)] * len(gaps)
    rows = np.flatnonzero(close.any(axis=1))
    finite_gaps = np.where(np.isfinite(gaps[rows]), gaps[rows], np.nan)
    # Exact separations are dear, interpolated ones are not: only elements that probes found close are looked
    # at node by node. A node without a finite gap counts as near, as its neighbours may touch.
    nodes = ~(pinion.between_probes @ finite_gaps.T >= depth)
    cells = _beside(nodes.T.reshape(-1, *pinion.shape)).reshape(rows.size, pinion.element.size)
    for row, is_near in zip(rows.tolist(), cells & close[rows][:, pinion.element], strict=True):
        near[row] = np.flatnonzero(is_near[pinion.cell])
    return near


def _beside(nodes: Mask) -> Mask:
    """Return the cells (p, m - 1, n - 1) between nodes (p, m, n) that have a marked node at most one node
    away.

    The corners of a cell and the nodes next to them count.
    """
    for axis in (1, 2):
        around = [(1, 1) if axis == dimension else (0, 0) for dimension in range(3)]
        padded_nodes = np.moveaxis(np.pad(nodes, around), axis, 0)
        size = len(padded_nodes) - 3
        beside = (
            padded_nodes[:size] | padded_nodes[1 : size + 1] | padded_nodes[2 : size + 2] | padded_nodes[3:]
        )
        nodes = np.moveaxis(beside, 0, axis)
    return nodes
