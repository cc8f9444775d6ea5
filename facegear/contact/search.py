"""Where the pairs of teeth can touch at a position."""

import numpy as np
from numpy.typing import NDArray

from facegear.contact.candidates import Candidates, PinionSurface, hats_over, merged
from facegear.contact.edges import gear_edge, gear_edge_gaps, pinion_edge
from facegear.contact.options import ContactOptions
from facegear.contact.teeth import GearLattice
from facegear.geometry.pinion_surface import SurfacePoints
from facegear.geometry.separation import separation


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
    seen = separation(surface.design, probes, phi1, phi2, teeth)
    depth = limit * surface.design.pinion_base_radius
    reach = 3.0 * depth + 20e-6
    found = []
    edges = gear_edge_gaps(surface, lattice, phi1, phi2, teeth, fillet)
    if not options.edges:
        edges = [None] * len(teeth)
    for tooth, gap, edge in zip(teeth, seen.gap, edges, strict=True):
        near = (gap[elements] < depth + 10e-6).any(axis=1) & (np.abs(gap[elements]) < 1e-3).any(axis=1)
        points = np.flatnonzero(near[surface.element])
        place = (phi1, phi2, int(tooth))
        parts = [gear_edge(surface, lattice, edge, int(tooth), limit)] if edge is not None else []
        if points.size:
            parts.append(_pair_candidates(surface, lattice, place, points, limit, reach, fillet))
            if options.edges:
                parts.append(pinion_edge(surface, lattice, place, limit, fillet))
        parts = [part for part in parts if part is not None]
        if parts:
            found.append(merged(parts))
    return found


def _pair_candidates(
    surface: PinionSurface,
    lattice: GearLattice,
    place: tuple[float, float, int],
    points: NDArray[np.int64],
    limit: float,
    reach: float,
    fillet: bool,
) -> Candidates | None:
    where = SurfacePoints(surface.points.position[points], surface.points.normal[points])
    seen = separation(surface.design, where, *place[:2], place[2], reach=max(reach, 1e-4))
    edge = 0.1 * surface.design.module
    coordinates = lattice.coordinates(seen, fillet, edge)[0]
    usable = np.isfinite(coordinates).all(axis=1) & np.isfinite(seen.gap[0])
    if not fillet:
        usable &= surface.lattice[points, 0] <= (surface.side.flank_rows - 1) * surface.refinement.profile
    return hats_over(
        surface,
        lattice.side.shape,
        lattice.refinement,
        place[2],
        points[usable],
        seen.gap[0][usable],
        coordinates[usable],
        limit,
    )
