"""Contact along the tip edges of both teeth.

Off the line of action an edge meets the opposite flank at an angle: the gap is least exactly on the edge and
grows by micrometres within a node distance, so that averages over the surface beside it come too late. Edges
therefore carry loads of their own, hats along the edge with gaps taken on it.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from facegear.contact.candidates import (
    SMALLEST_COVER,
    Candidates,
    PinionSurface,
    gear_loads,
    spread_loads,
)
from facegear.contact.surface import GAUSS, interpolation
from facegear.contact.teeth import GearLattice, pinion_points
from facegear.geometry import face_gear, pinion
from facegear.geometry.pinion_surface import fillet_points
from facegear.geometry.placement import to_pinion_section
from facegear.geometry.relief import removed
from facegear.geometry.separation import separation

FILLET_SAMPLES = 2000


@dataclass(frozen=True, eq=False)
class EdgeGaps:
    """Points of the gear's tip edge against one pinion tooth: gap (q,) m, arm (q,) m, where on both lattices.

    `pinion` and `gear` (q, 2) are refined lattice coordinates; points that face nothing are left out, `index`
    (q,) numbers the others along the edge.
    """

    index: NDArray[np.int64]
    gap: NDArray[np.float64]
    arm: NDArray[np.float64]
    pinion: NDArray[np.float64]
    gear: NDArray[np.float64]


def line_points(nodes: int) -> NDArray[np.float64]:
    """Two Gauss points in each interval between `nodes` nodes on a line, (2 (nodes - 1),)."""
    middle = np.arange(nodes - 1) + 0.5
    return np.stack([middle - GAUSS, middle + GAUSS], axis=-1).ravel()


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
    along = line_points(columns)
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


def gear_edge(
    surface: PinionSurface, lattice: GearLattice, edge: EdgeGaps, tooth: int, limit: float
) -> Candidates | None:
    """Loads along the gear's tip edge that a turn by `limit` (rad) would close, or None."""
    columns = (lattice.side.shape[1] - 1) * lattice.refinement.width + 1
    factors = np.array([surface.refinement.profile, surface.refinement.width])
    on_pinion = (
        interpolation(edge.pinion, surface.shape),
        interpolation(edge.pinion / factors, surface.side.shape),
    )
    on_gear = gear_loads(edge.gear, lattice.side.shape, lattice.refinement)
    gear = surface.design.face_gear
    spacing = (gear.outer_radius - gear.inner_radius) / (columns - 1)
    place = np.rint(edge.pinion).astype(np.int64)
    nodes = place[:, 0] * surface.shape[1] + place[:, 1]
    return _edge_loads(
        surface, edge.index, nodes, columns, spacing, (tooth, edge.gap, edge.arm, on_pinion, on_gear, limit)
    )


def pinion_edge(
    surface: PinionSurface, lattice: GearLattice, place: tuple[float, float, int], limit: float, fillet: bool
) -> Candidates | None:
    """Loads along the pinion's tip edge that a turn by `limit` (rad) would close, or None."""
    columns = surface.shape[1]
    along = line_points(columns)
    coordinates = np.stack([np.zeros(along.size), along], axis=1)
    points = pinion_points(surface.design, surface.side, surface.refinement, coordinates)
    seen = separation(surface.design, points, place[0], place[1], place[2], reach=1e-4)
    gear = lattice.coordinates(seen, fillet, 0.0)[0]
    index = np.flatnonzero(np.isfinite(gear).all(axis=1) & np.isfinite(seen.gap[0]))
    coordinates, gear, gap = coordinates[index], gear[index], seen.gap[0][index]
    factors = np.array([surface.refinement.profile, surface.refinement.width])
    x, z = points.position[index, 0], points.position[index, 2]
    arm = x * points.normal[index, 2] - z * points.normal[index, 0]
    on_pinion = (
        interpolation(coordinates, surface.shape),
        interpolation(coordinates / factors, surface.side.shape),
    )
    on_gear = gear_loads(gear, lattice.side.shape, lattice.refinement)
    spacing = float(np.ptp(surface.side.v[0])) / (columns - 1)
    nodes = np.rint(coordinates[:, 1]).astype(np.int64)
    return _edge_loads(
        surface, index, nodes, columns, spacing, (place[2], gap, arm, on_pinion, on_gear, limit)
    )


def _edge_loads(surface, index, nodes, columns, spacing, loads):  # type: ignore[no-untyped-def]
    """Hats along an edge of `columns` nodes over the points `index` of `line_points`."""
    tooth, gap, arm, on_pinion, on_gear, limit = loads
    if index.size == 0:
        return None
    along = line_points(columns)[index]
    base = np.floor(along).astype(np.int64)
    share = along - base
    weight = sp.coo_matrix(
        (
            np.concatenate([1 - share, share]),
            (np.concatenate([base, base + 1]), np.tile(np.arange(index.size), 2)),
        ),
        shape=(columns, index.size),
    ).tocsr()
    length = 0.5 * np.asarray(weight.sum(axis=1)).ravel()
    whole = np.ones(columns)
    whole[[0, -1]] = 0.5
    hats = np.flatnonzero(length > SMALLEST_COVER * whole)
    weight = (sp.diags_array(0.5 / length[hats]) @ weight[hats]).tocsr()
    found = spread_loads(tooth, weight, gap, arm, on_pinion, on_gear, limit)
    if found is None:
        return None
    candidates, near = found
    nearest = np.asarray(weight.argmax(axis=1)).ravel()
    return replace(
        candidates,
        hats=nodes[nearest][near],
        area=length[hats][near] * spacing * surface.row_height,
        whole=np.zeros(near.sum(), dtype=bool),
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
    design, side = surface.design, surface.side
    gammas = np.concatenate([side.junction[:1], side.u[side.flank_rows :, 0]])
    if gammas.size == 1 or len(section) == 0:
        return np.full(len(section), np.inf), np.full(len(section), np.nan), np.zeros(len(section))
    gamma = np.linspace(gammas[0], gammas[-1], FILLET_SAMPLES)
    points = fillet_points(design, gamma, design.mean_radius)
    curve = points.position[:, [0, 2]] * np.array([1.0, -1.0])
    normal = points.normal[:, [0, 2]] * np.array([1.0, -1.0])
    nearest = np.argmin(np.linalg.norm(section[:, None, :2] - curve, axis=2), axis=1)
    gap = np.sum((section[:, :2] - curve[nearest]) * normal[nearest], axis=1)
    gap += removed(design, pinion.junction_roll(design), section[:, 2])
    on = (nearest > 0) & (nearest < FILLET_SAMPLES - 1) & (np.abs(gap) < design.module)
    row = side.flank_rows - 1 + np.interp(gamma[nearest], gammas, np.arange(gammas.size))
    x, h = curve[nearest].T
    arm = h * normal[nearest, 0] - x * normal[nearest, 1]
    return (
        np.where(on, gap, np.inf),
        np.where(on, row * surface.refinement.profile, np.nan),
        arm,
    )
