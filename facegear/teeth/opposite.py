"""Points of the gear's tooth opposite points of the pinion, and the reverse for the gear's tip edge."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from facegear.arrays import Array
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import to_pinion_section
from facegear.teeth.rays import FILLET, FLANK, TIP_LAND
from facegear.teeth.separation import Separation
from facegear.teeth.surfaces import fillet_points

FILLET_SAMPLES = 2000
"""Number of points of the fillet's curve between which it is interpolated."""


@dataclass(frozen=True)
class GearHits:
    """Hits of the normals of n pinion points on a gear tooth at p placements, all (p, n), nan where none; or
    (n,) for points in one placement each.

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
    """Feet, on p pinion teeth, of the pinion normals through n points of the gear's tip edge, all (p, n).

    gap (m), negative inside the pinion, inf where there is none; lever_arm (m) of the normal about the
    pinion's axis; y (m). Either `flank`, 0..1 in the square of the roll angle from tip to fillet, or
    `fillet`, the angle gamma (rad) there, is not nan.
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

    @cached_property
    def tree(self) -> cKDTree:
        """k-d tree of `points` for searches of the nearest one."""
        return cKDTree(self.points)


def fillet_curve(design: PairDesign, first: float, last: float) -> FilletCurve:
    """Return FILLET_SAMPLES points of the pinion's fillet, evenly between two angles gamma.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    first : float
        Angle gamma, rad.
    last : float
        Angle gamma, rad.

    Returns
    -------
    FilletCurve
        Points in m.
    """
    gamma = np.linspace(first, last, FILLET_SAMPLES)
    surface = fillet_points(design, gamma, design.mean_radius)
    points, normals = (part[:, [0, 2]] * np.array([1.0, -1.0]) for part in (surface.position, surface.normal))
    return FilletCurve(points, normals, gamma)


def locate_hits(design: PairDesign, flank_separation: Separation) -> GearHits:
    """Express where normals of pinion points hit the gear's tooth as distances from the flank's tip edge.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    flank_separation : Separation
        Separation of pinion points.

    Returns
    -------
    GearHits
        Coordinates on the gear's tooth, in the shape of the separation.
    """
    edge, last_roll = face_gear.tip_edge_by_radius(design), design.shaper_tip_roll
    flank, fillet, beyond = np.full((3, *flank_separation.gap.shape), np.nan)
    on_flank, in_fillet, on_land = (flank_separation.part == part for part in (FLANK, FILLET, TIP_LAND))
    tip = edge.roll(flank_separation.radius[on_flank])
    flank[on_flank] = (flank_separation.u[on_flank] - tip) / (last_roll - tip)
    fillet[in_fillet] = face_gear_fillet.fillet_fraction(
        design, flank_separation.radius[in_fillet], flank_separation.u[in_fillet]
    )
    radius = flank_separation.radius[on_land]
    beyond[on_land] = radius * (edge.angle(radius) - flank_separation.u[on_land])
    return GearHits(
        gap=flank_separation.gap, radius=flank_separation.radius, flank=flank, fillet=fillet, beyond=beyond
    )


def tip_edge_feet(
    design: PairDesign,
    points: Array,
    placement: tuple[Array, Array, Array],
    fillet: FilletCurve | None,
    search_radius: float,
) -> EdgeFeet:
    """Find the feet of pinion normals through points of the gear's left tip edge.

    Beside the flank the fillet is searched, unless it is None.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    points : (n, 3) array
        Points of tooth 0 in the body frame, m.
    placement : tuple of (p,) arrays
        phi1, phi2 (rad) and tooth.
    fillet : FilletCurve, optional
        Fillet of the pinion in its section; None leaves it out.
    search_radius : float
        Distance up to which the fillet is searched, m.

    Returns
    -------
    EdgeFeet
        Feet (p, n), in m and rad.
    """
    phi1, phi2, tooth = (np.asarray(part) for part in placement)
    section = to_pinion_section(design, phi1, phi2, tooth[:, None]).points(points)[:, 0]
    feet = _flank_feet(design, section)
    if fillet is not None:
        beside = ~np.isfinite(feet.gap)
        fillet_feet = _fillet_feet(design, section[beside], fillet, search_radius)
        feet.gap[beside], feet.fillet[beside], feet.lever_arm[beside] = fillet_feet
    return feet


def _flank_feet(design: PairDesign, section: Array) -> EdgeFeet:
    """Find the feet on the pinion's involute of its normals through points (..., 3), m: x, -z, y of its
    section.

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
    gap = base * turn + pinion.removed_depth(design, foot, y)
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
    """Return gap (m, inf without foot), gamma (rad) and lever arm (m), (n,) each, of points (n, 3), x,
    -z, y in m.

    The foot is the nearest of the curve's points, its ends left out; the gap is taken along the normal there.
    """
    curve, normal = fillet.points, fillet.normals
    gap, gamma, lever_arm = (np.full(len(section), value) for value in (np.inf, np.nan, 0.0))
    low, high = curve.min(axis=0) - search_radius, curve.max(axis=0) + search_radius
    close = np.flatnonzero(((section[:, :2] > low) & (section[:, :2] < high)).all(axis=1))
    near_points = section[close]
    nearest = fillet.tree.query(near_points[:, :2])[1]
    apart = np.sum((near_points[:, :2] - curve[nearest]) * normal[nearest], axis=1)
    apart += pinion.removed_depth(design, pinion.junction_roll(design), near_points[:, 2])
    on = (nearest > 0) & (nearest < len(curve) - 1) & (np.abs(apart) < search_radius)
    close, nearest = close[on], nearest[on]
    gap[close], gamma[close] = apart[on], fillet.gamma[nearest]
    lever_arm[close] = curve[nearest, 1] * normal[nearest, 0] - curve[nearest, 0] * normal[nearest, 1]
    return gap, gamma, lever_arm
