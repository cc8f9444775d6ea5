"""Where the pairs of teeth can touch at a position."""

import numpy as np
from numpy.typing import NDArray

from facegear.contact.candidates import Candidates, Loads, PinionSurface, candidates_of, hat_loads
from facegear.contact.edges import FARTHEST, gear_edge, gear_edge_gaps, pinion_edge
from facegear.contact.options import ContactOptions
from facegear.contact.teeth import GearLattice
from facegear.geometry.pinion_surface import SurfacePoints
from facegear.geometry.separation import separation

SAG = 10e-6
"""By how much (m) a gap between probes may be less than at the nearest of them."""


def find_candidates(
    surface: PinionSurface,
    lattice: GearLattice,
    phi1: float,
    phi2: float,
    teeth: NDArray[np.int64],
    limit: float,
    options: ContactOptions,
) -> list[Candidates]:
    """Hats and edges of the pairs `teeth` that a turn of the pinion by `limit` (rad) would close.

    phi1, phi2 (rad) place the unloaded gears. Pairs without any are left out.
    """
    probes, elements = surface.probes
    fillet = options.fillet
    seen = separation(surface.design, probes, phi1, phi2, teeth, reach=FARTHEST)
    depth = limit * surface.design.pinion_base_radius
    found = []
    edges = gear_edge_gaps(surface, lattice, phi1, phi2, teeth, fillet)
    if not options.edges:
        edges = [None] * len(teeth)
    # a gear's edge may lie between a probe and the points that touch: the flank is taken to go on there
    gaps = np.minimum(seen.gap, seen.continued)
    for tooth, gap, edge in zip(teeth, gaps, edges, strict=True):
        near = (gap[elements] < depth + SAG).any(axis=1)
        points = np.flatnonzero(near[surface.element])
        place = (phi1, phi2, int(tooth))
        parts = [gear_edge(surface, lattice, edge)] if edge is not None else []
        if points.size:
            parts.append(_facing_hats(surface, lattice, place, points, fillet))
            if options.edges:
                parts.append(pinion_edge(surface, lattice, place, fillet))
        pair = candidates_of(
            surface,
            lattice.side.shape,
            lattice.refinement,
            int(tooth),
            [part for part in parts if part is not None],
            limit,
        )
        if pair is not None:
            found.append(pair)
    return found


def _facing_hats(
    surface: PinionSurface,
    lattice: GearLattice,
    place: tuple[float, float, int],
    points: NDArray[np.int64],
    fillet: bool,
) -> Loads | None:
    where = SurfacePoints(surface.points.position[points], surface.points.normal[points])
    seen = separation(surface.design, where, *place[:2], place[2], reach=FARTHEST)
    edge = 0.1 * surface.design.module
    coordinates = lattice.coordinates(seen, fillet, edge)[0]
    usable = np.isfinite(coordinates).all(axis=1) & np.isfinite(seen.gap[0])
    if not fillet:
        usable &= surface.lattice[points, 0] <= (surface.side.flank_rows - 1) * surface.refinement.profile
    if not usable.any():
        return None
    return hat_loads(surface, points[usable], seen.gap[0][usable], coordinates[usable])
