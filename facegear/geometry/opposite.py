"""What of the gear's tooth stands opposite points of the pinion, and the reverse for the gear's tip edge."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from facegear.arrays import Array, Integers
from facegear.geometry import closed_forms, face_gear, pinion, ray_surfaces
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import fillet_points
from facegear.geometry.placement import to_pinion_section
from facegear.geometry.ray_surfaces import psi_at
from facegear.geometry.separation import FILLET, FLANK, TIP_LAND, Separation
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import integers, numbers

SOURCES = Path(ray_surfaces.__file__), Path(closed_forms.__file__), *picked.SOURCES
compiled, inlined = compiler(*SOURCES), for_callers()

FILLET_SAMPLES = 2000


@dataclass(frozen=True)
class GearHits:
    """Where the normals of n pinion points meet a gear tooth at p placements, all (p, n), nan where not; or
    (n,) of points in one placement each.

    gap (m); radius: gear radius (m). One of three says how far from the flank's tip edge: on the flank
    `flank`, 0..1 of its roll angles there, on the fillet `fillet`, 0..1 of its normal's turn from flank to
    root, on the tip land `beyond` (m) the edge, around the gear.
    """

    gap: Array
    radius: Array
    flank: Array
    fillet: Array
    beyond: Array


@dataclass(frozen=True)
class EdgeFeet:
    """Where pinion normals through n points of the gear's tip edge stand on p pinion teeth, all (p, n).

    gap (m), inf where there is none; lever_arm (m) of the normal about the pinion's axis; y (m). Either
    `flank`, 0..1 in the square of the roll angle from tip to fillet, or `fillet`, the angle gamma (rad)
    there, is not nan.
    """

    gap: Array
    lever_arm: Array
    y: Array
    flank: Array
    fillet: Array


@dataclass(frozen=True, eq=False)
class FilletCurve:
    """Points (n, 2) of the pinion's fillet in its section (x, -z), outward normals (n, 2), gamma (n,) rad."""

    points: Array
    normals: Array
    gamma: Array


def fillet_curve(design: PairDesign, first: float, last: float) -> FilletCurve:
    """Many points of the pinion's fillet between two angles gamma (rad)."""
    gamma = np.linspace(first, last, FILLET_SAMPLES)
    surface = fillet_points(design, gamma, design.mean_radius)
    points, normals = (part[:, [0, 2]] * np.array([1.0, -1.0]) for part in (surface.position, surface.normal))
    return FilletCurve(points, normals, gamma)


def located(design: PairDesign, seen: Separation) -> GearHits:
    """Where on the gear's tooth a separation ends."""
    edge, shape = face_gear.tip_edge_by_radius(design), seen.gap.shape
    cubics = edge.roll.x, np.ascontiguousarray(edge.roll.c), np.ascontiguousarray(edge.angle.c)
    base, ratio, _, _ = face_gear.shaper_numbers(design)
    hit = seen.part.ravel(), seen.u.ravel(), seen.radius.ravel()
    flank, fillet, beyond = (
        part.reshape(shape) for part in by_tip_edge(*hit, base, ratio, design.shaper_tip_roll, *cubics)
    )
    return GearHits(gap=seen.gap, radius=seen.radius, flank=flank, fillet=fillet, beyond=beyond)


@compiled
def by_tip_edge(
    part: NDArray[np.int8],
    u: Array,
    radius: Array,
    base: float,
    ratio: float,
    last_roll: float,
    radii: Array,
    rolls: Array,
    angles: Array,
) -> tuple[Array, Array, Array]:
    """`flank`, `fillet` and `beyond` (n,) of `GearHits` by what is hit and where on it, (n,) of `Separation`.

    base, ratio: of the shaper; last_roll (rad): where the flank ends at the fillet. Cubics (4, r) of the tip
    edge's roll and gear angle (rad) begin at gear radii (r + 1,) m, evenly spaced.
    """
    flank, fillet, beyond = numbers(part.size, np.nan), numbers(part.size, np.nan), numbers(part.size, np.nan)
    for i in range(part.size):
        if part[i] == FLANK:
            tip = _cubic(radii, rolls, radius[i])
            flank[i] = (u[i] - tip) / (last_roll - tip)
        elif part[i] == FILLET:
            start = psi_at(base, ratio, radius[i], last_roll)
            fillet[i] = (u[i] - start) / (0.5 * np.pi - start)
        elif part[i] == TIP_LAND:
            beyond[i] = radius[i] * (_cubic(radii, angles, radius[i]) - u[i])
    return flank, fillet, beyond


@inlined
def _cubic(begin: Array, cubics: Array, at: float) -> float:
    last = cubics.shape[1] - 1
    number = int(min(max((at - begin[0]) / (begin[1] - begin[0]), 0.0), last))
    x = at - begin[number]
    return float(
        ((cubics[0, number] * x + cubics[1, number]) * x + cubics[2, number]) * x + cubics[3, number]
    )


def tip_edge_feet(
    design: PairDesign,
    points: Array,
    placement: tuple[Array, Array, Array],
    fillet: FilletCurve | None,
    search_radius: float,
) -> EdgeFeet:
    """Points (n, 3) of the gear's left tip edge (tooth 0, body frame) against the flanks of pinion teeth.

    placement: phi1, phi2 (rad) and tooth, (p,) each: all (p, n). Beside the flank the fillet is looked at,
    unless that is None.
    """
    phi1, phi2, tooth = (np.asarray(part) for part in placement)
    section = to_pinion_section(design, phi1, phi2, tooth[:, None]).points(points)[:, 0]
    feet = _flank_feet(design, section)
    if fillet is not None:
        beside = ~np.isfinite(feet.gap)
        there = _fillet_feet(design, section[beside], fillet, search_radius)
        feet.gap[beside], feet.fillet[beside], feet.lever_arm[beside] = there
    return feet


def _flank_feet(design: PairDesign, section: Array) -> EdgeFeet:
    """Where the involute's normals through points (..., 3) meet it.

    All normals touch the base circle, so that the distance along them is that of two parallel involutes.
    """
    base = design.pinion_base_radius
    across, up, y = (section[..., axis] for axis in range(3))
    ratio = np.hypot(across, up) / base
    roll = np.sqrt(np.maximum(ratio**2 - 1, 0.0))
    start = np.arctan2(across, up) + roll - np.arctan(roll)
    turn = start - design.pinion_half_base_angle
    foot = roll - turn
    top, bottom = design.pinion_tip_roll, pinion.junction_roll(design)
    on = (ratio > 1) & (foot <= top) & (foot >= bottom) & (np.abs(turn) * base < design.module)
    gap = base * turn + pinion.removed(design, foot, y)
    return EdgeFeet(
        gap=np.where(on, gap, np.inf),
        lever_arm=np.full(on.shape, base),
        y=y,
        flank=np.where(on, (top**2 - foot**2) / (top**2 - bottom**2), np.nan),
        fillet=np.full(on.shape, np.nan),
    )


def _fillet_feet(
    design: PairDesign, section: Array, fillet: FilletCurve, search_radius: float
) -> tuple[Array, Array, Array]:
    """Gap (inf: none), gamma and lever arm at the nearest of many points of the fillet, its ends left out."""
    curve, normal = fillet.points, fillet.normals
    gap, gamma, lever_arm = (np.full(len(section), value) for value in (np.inf, np.nan, 0.0))
    low, high = curve.min(axis=0) - search_radius, curve.max(axis=0) + search_radius
    close = np.flatnonzero(((section[:, :2] > low) & (section[:, :2] < high)).all(axis=1))
    here = section[close]
    nearest = nearest_of(np.ascontiguousarray(here), curve)
    apart = np.sum((here[:, :2] - curve[nearest]) * normal[nearest], axis=1)
    apart += pinion.removed(design, pinion.junction_roll(design), here[:, 2])
    on = (nearest > 0) & (nearest < len(curve) - 1) & (np.abs(apart) < search_radius)
    close, nearest = close[on], nearest[on]
    gap[close], gamma[close] = apart[on], fillet.gamma[nearest]
    lever_arm[close] = curve[nearest, 1] * normal[nearest, 0] - curve[nearest, 0] * normal[nearest, 1]
    return gap, gamma, lever_arm


@compiled
def nearest_of(points: Array, curve: Array) -> Integers:
    """The point (n,) of a curve (m, 2) nearest to each of points (n, 3) in their first two coordinates."""
    nearest = integers(points.shape[0], 0)
    for i in range(points.shape[0]):
        min_square = np.inf
        for j in range(curve.shape[0]):
            x, y = points[i, 0] - curve[j, 0], points[i, 1] - curve[j, 1]
            square = x * x + y * y
            if square < min_square:
                min_square, nearest[i] = square, j
    return nearest
