"""Where the pairs of teeth can touch at a position."""

import numpy as np

from facegear.arrays import Integers
from facegear.contact.candidates import Candidates, candidates_of
from facegear.contact.flanks import FlankPair
from facegear.contact.loads import pair_loads
from facegear.contact.options import ContactOptions
from facegear.geometry.opposite import gear_hits, tip_edge_feet
from facegear.geometry.pinion_surface import joined
from facegear.geometry.separation import separation

SAG = 10e-6
"""By how much (m) a gap between probes may be less than at the nearest of them."""

FARTHEST = 1e-3
"""Gap or depth (m) beyond which the surfaces of both teeth do not see each other."""


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
    design, pinion, gear = pair.design, pair.pinion, pair.gear
    near = _near(pair, placement, teeth, limit * design.pinion_base_radius + SAG)
    curve = pinion.fillet_curve if options.fillet else None
    feet = tip_edge_feet(design, gear.tip[1], placement, teeth, curve, FARTHEST)
    # the pinion's tip edge is looked at together with its flank, and only where that comes near
    hits = [
        gear_hits(design, joined(pinion.points.only(points), pinion.tip[1]), *placement, int(tooth), FARTHEST)
        if points.size
        else None
        for points, tooth in zip(near, teeth, strict=True)
    ]
    candidates = []
    for row, tooth in enumerate(teeth.tolist()):
        loads = pair_loads(pair, near[row], hits[row], feet[row], options)
        candidates += candidates_of(pinion.lattice, gear.lattice, tooth, loads, limit)
    return candidates


def _near(pair: FlankPair, placement: tuple[float, float], teeth: Integers, depth: float) -> list[Integers]:
    """Integration points in those elements of each pinion tooth that a probe finds within `depth` (m)."""
    probes, elements = pair.pinion.probes
    seen = separation(pair.design, probes, *placement, teeth, FARTHEST)
    # a gear's edge may lie between a probe and the points that touch: the flank is taken to go on there
    gaps = np.minimum(seen.gap, seen.continued)
    close = np.any(gaps[:, elements] < depth, axis=2)
    return [np.flatnonzero(row[pair.pinion.element]) for row in close]
