"""Contact along the tip edges of both teeth.

Off the line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge and
grows by micrometres within a node distance, so that averages over the surface beside it come too late. Edges
therefore carry loads of their own, hats along the edge with gaps taken on it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.contact.averages import hat_averages
from facegear.contact.bodies.surface import edge_hats
from facegear.contact.candidates import SMALLEST_COVER, Loads, PinionSurface
from facegear.contact.teeth import GearLattice
from facegear.geometry import face_gear, pinion
from facegear.geometry.placement import to_pinion_section
from facegear.geometry.relief import removed
from facegear.geometry.separation import separation

FARTHEST = 1e-3
"""Gap or depth (m) beyond which the surfaces of both teeth do not see each other."""


@dataclass(frozen=True, eq=False)
class EdgeGaps:
    """Points of a tip edge against a tooth of the other gear: gap (q,) m, arm (q,) m, where on both lattices.

    `pinion` and `gear` (q, 2) are refined lattice coordinates; points that face nothing are left out, `index`
    (q,) numbers the others along the edge.
    """

    index: NDArray[np.int64]
    gap: NDArray[np.float64]
    arm: NDArray[np.float64]
    pinion: NDArray[np.float64]
    gear: NDArray[np.float64]


def gear_edge_gaps(
    surface: PinionSurface,
    lattice: GearLattice,
    phi1: float,
    phi2: float,
    teeth: NDArray[np.int64],
    fillet: bool,
) -> list[EdgeGaps]:
    """Gaps along pinion normals from the gear's tip edge to the flank (and fillet) of each one of `teeth`."""
    design = surface.design
    gear = design.face_gear
    columns = (lattice.side.shape[1] - 1) * lattice.refinement.width + 1
    along, _, _ = edge_hats(columns)
    radius = gear.inner_radius + along / (columns - 1) * (gear.outer_radius - gear.inner_radius)
    roll, psi = face_gear.roll_and_psi_at_height(design, radius, np.full(radius.shape, design.gear_tip_plane))
    points = face_gear.flank_point(design, roll, psi) * np.array([-1.0, 1.0, 1.0])
    section = to_pinion_section(design, points, np.array([phi1]), np.array([phi2]), np.asarray(teeth))[0]
    found = []
    for tooth in section:
        gap, row, arm = _flank_feet(surface, tooth)
        if fillet:
            beside = ~np.isfinite(gap)
            gap[beside], row[beside], arm[beside] = _fillet_feet(surface, tooth[beside])
        start, width = surface.side.v[0, 0], float(np.ptp(surface.side.v[0]))
        column = (tooth[:, 2] - start) / width * (surface.shape[1] - 1)
        on = np.isfinite(gap) & (column >= 0) & (column <= surface.shape[1] - 1)
        found.append(
            EdgeGaps(
                np.flatnonzero(on),
                gap[on],
                arm[on],
                np.stack([row[on], column[on]], axis=1),
                np.stack([np.zeros(on.sum()), along[on]], axis=1),
            )
        )
    return found


def gear_edge(surface: PinionSurface, lattice: GearLattice, edge: EdgeGaps) -> Loads | None:
    """Loads along the gear's tip edge, or None."""
    columns = (lattice.side.shape[1] - 1) * lattice.refinement.width + 1
    gear = surface.design.face_gear
    spacing = (gear.outer_radius - gear.inner_radius) / (columns - 1)
    return _edge_loads(surface, edge, columns, spacing)


def pinion_edge(
    surface: PinionSurface, lattice: GearLattice, place: tuple[float, float, int], fillet: bool
) -> Loads | None:
    """Loads along the pinion's tip edge, or None."""
    columns = surface.shape[1]
    coordinates, points = surface.tip
    seen = separation(surface.design, points, place[0], place[1], place[2], reach=FARTHEST)
    gear = lattice.coordinates(seen, fillet, 0.0)[0]
    index = np.flatnonzero(np.isfinite(gear).all(axis=1) & np.isfinite(seen.gap[0]))
    x, z = points.position[index, 0], points.position[index, 2]
    arm = x * points.normal[index, 2] - z * points.normal[index, 0]
    edge = EdgeGaps(index, seen.gap[0][index], arm, coordinates[index], gear[index])
    return _edge_loads(surface, edge, columns, float(np.ptp(surface.side.v[0])) / (columns - 1))


def _edge_loads(surface: PinionSurface, edge: EdgeGaps, columns: int, spacing: float) -> Loads | None:
    """Hats along an edge of `columns` nodes, `spacing` (m) apart, over points of `edge_hats`."""
    if edge.index.size == 0:
        return None
    _, hats_here, values = edge_hats(columns)
    least = np.full(columns, SMALLEST_COVER)
    least[[0, -1]] *= 0.5
    rows, hats, length = hat_averages(
        hats_here[edge.index],
        values[edge.index],
        np.full(edge.index.size, 0.5),
        least,
    )
    if hats.size == 0:
        return None
    place = np.rint(edge.pinion).astype(np.int64)
    nodes = place[:, 0] * surface.shape[1] + place[:, 1]
    return Loads(
        rows,
        nodes[rows.heaviest()],
        length * spacing * surface.row_height,
        np.zeros(hats.size, dtype=bool),
        edge.gap,
        edge.arm,
        edge.pinion,
        edge.gear,
    )


def _flank_feet(
    surface: PinionSurface, section: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Gap, lattice row and arm where the involute's normals through points (q, 3) meet it; inf beside the
    flank.

    All normals touch the base circle, so that the distance along them is that of two parallel involutes.
    """
    design = surface.design
    base = design.pinion_base_radius
    ratio = np.hypot(section[:, 0], section[:, 1]) / base
    roll = np.sqrt(np.maximum(ratio**2 - 1, 0.0))
    start = np.arctan2(section[:, 0], section[:, 1]) + roll - np.arctan(roll)
    turn = start - design.pinion_half_base_angle
    foot = roll - turn
    top, bottom = design.pinion_tip_roll, pinion.junction_roll(design)
    on = (ratio > 1) & (foot <= top) & (foot >= bottom) & (np.abs(turn) * base < design.module)
    row = (top**2 - foot**2) / (top**2 - bottom**2) * (surface.side.flank_rows - 1)
    gap = base * turn + removed(design, foot, section[:, 2])
    return (
        np.where(on, gap, np.inf),
        np.where(on, row * surface.refinement.profile, np.nan),
        np.full(on.shape, base),
    )


def _fillet_feet(
    surface: PinionSurface, section: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """The same for the fillet, from its nearest of many points; inf where the nearest is an end of it."""
    gap, row, arm = (np.full(len(section), value) for value in (np.inf, np.nan, 0.0))
    if surface.side.flank_rows == surface.side.shape[0]:
        return gap, row, arm
    curve, normal, rows = surface.fillet
    low, high = curve.min(axis=0) - FARTHEST, curve.max(axis=0) + FARTHEST
    close = np.flatnonzero(((section[:, :2] > low) & (section[:, :2] < high)).all(axis=1))
    here = section[close]
    nearest = np.argmin(np.linalg.norm(here[:, None, :2] - curve, axis=2), axis=1)
    apart = np.sum((here[:, :2] - curve[nearest]) * normal[nearest], axis=1)
    apart += removed(surface.design, pinion.junction_roll(surface.design), here[:, 2])
    on = (nearest > 0) & (nearest < len(curve) - 1) & (np.abs(apart) < FARTHEST)
    close, nearest = close[on], nearest[on]
    gap[close], row[close] = apart[on], rows[nearest] * surface.refinement.profile
    arm[close] = curve[nearest, 1] * normal[nearest, 0] - curve[nearest, 0] * normal[nearest, 1]
    return gap, row, arm
