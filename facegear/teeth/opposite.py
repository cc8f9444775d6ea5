"""Points of the gear's tooth opposite points of the pinion, and the reverse for the gear's tip edge."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import scipy
from scipy.spatial import cKDTree

from facegear.arrays import Array, Integers
from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.design import PairDesign, as_cut
from facegear.teeth.helicoid import pinion_fillet
from facegear.teeth.placement import to_pinion_section
from facegear.teeth.rays import FILLET, FLANK, TIP_LAND
from facegear.teeth.separation import Separation
from facegear.teeth.surfaces import fillet_points

FILLET_SAMPLES = 2000
"""Number of points of the fillet's curve between which it is interpolated."""
STEPS_ON_CIRCLES = 2
"""Steps of a foot on the fillet of a prismatic pinion from a point beside it."""
FOOT_STEPS, CLOSE = 20, 1e-14
"""Newton steps of a foot on the fillet, and the step (m) that ends them."""
ANGLE_STEP, PLACE_STEP = 1e-5, 1e-6
"""Steps in gamma (rad) and y (m) by which the normal's change is taken, which affect convergence alone."""
LARGEST_TURN, FARTHEST_TURN = 0.2, 1.0
"""Largest Newton step in gamma (rad), and the farthest a foot may be from the start of its search."""


END_POINTS = 65
"""Points of the end of a tapered gear's flank, as of its tip edge: its spline is within 3e-10 rad."""


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
    pinion's axis; y (m) of the foot. Either `flank`, 0..1 in the square of the roll angle from tip to fillet,
    or `fillet`, the angle gamma (rad) there, is not nan.
    """

    gap: Array
    lever_arm: Array
    y: Array
    flank: Array
    fillet: Array


@dataclass(frozen=True, eq=False)
class FilletCurve:
    """Points (n, 2) of the pinion's fillet in its middle section (x, -z), outward normals (n, 2) there, gamma
    (n,) rad.

    Of helical teeth the normals' components in the section are shorter than 1.
    """

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
    surface = fillet_points(design, gamma, design.middle)
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
    edge = face_gear.tip_edge_by_radius(design)
    flank, fillet, beyond = np.full((3, *flank_separation.gap.shape), np.nan)
    on_flank, in_fillet, on_land = (flank_separation.part == part for part in (FLANK, FILLET, TIP_LAND))
    tip = edge.roll(flank_separation.radius[on_flank])
    last_roll = _last_roll(design, flank_separation.radius[on_flank])
    flank[on_flank] = (flank_separation.u[on_flank] - tip) / (last_roll - tip)
    fillet[in_fillet] = face_gear_fillet.fillet_fraction(
        design, flank_separation.radius[in_fillet], flank_separation.u[in_fillet]
    )
    radius = flank_separation.radius[on_land]
    beyond[on_land] = radius * (edge.angle(radius) - flank_separation.u[on_land])
    return GearHits(
        gap=flank_separation.gap, radius=flank_separation.radius, flank=flank, fillet=fillet, beyond=beyond
    )


def _last_roll(design: PairDesign, radius: Array) -> Array:
    """Return the roll (rad) at which the gear's flank ends at radii (n,), m; one number without taper."""
    if design.taper_angle == 0.0:
        return np.asarray(design.shaper_tip_roll)
    return _end_roll_by_radius(as_cut(design))(radius)


@lru_cache(maxsize=16)
def _end_roll_by_radius(design: PairDesign) -> "scipy.interpolate.CubicSpline":
    """Return a spline through END_POINTS exact rolls (rad) of the flank's end over the face (m); cached."""
    face = design.face_gear
    radius = np.linspace(face.inner_radius, face.outer_radius, END_POINTS)
    return scipy.interpolate.CubicSpline(radius, face_gear.end_parameters(design, radius)[0])


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
    feet = flank_feet(design, section)
    if fillet is not None:
        beside = ~np.isfinite(feet.gap)
        beside_feet = _fillet_feet(design, section[beside], fillet, search_radius)
        feet.gap[beside], feet.fillet[beside], feet.lever_arm[beside] = beside_feet[:3]
        feet.y[beside] = beside_feet[3]
    return feet


def flank_feet(design: PairDesign, section: Array) -> EdgeFeet:
    """Find the feet on the pinion's involute of its normals through points.

    All normals touch the base cylinder under the base helix, so that the distance along them is that of the
    flank from a parallel one, which is the flank turned about the axis.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    section : (..., 3) array
        Points x, -z, y of the pinion's body frame, m.

    Returns
    -------
    EdgeFeet
        Feet (...), in m and rad.
    """
    helicoid = design.family.pinion_flanks[0]
    base, eta, cosine = helicoid.base_radius, helicoid.sine, helicoid.cosine
    across, up, y = (section[..., axis] for axis in range(3))
    ratio = np.hypot(across, up) / base
    roll = np.sqrt(np.maximum(ratio**2 - 1, 0.0))
    start = np.arctan2(across, up) + roll - np.arctan(roll)
    turn = start - helicoid.half_base_angle
    if eta != 0.0:
        turn = turn + helicoid.lead * (y - helicoid.middle) / base
    apart = base * cosine * turn
    foot = roll - cosine * cosine * turn
    foot_y = y - eta * apart
    top, bottom = pinion.tip_roll(design, foot_y), pinion.junction_roll(design, foot_y)
    on = (ratio > 1) & (foot <= top) & (foot >= bottom) & (np.abs(apart) < design.module)
    gap = apart + pinion.removed_depth(design, foot, foot_y)
    return EdgeFeet(
        gap=np.where(on, gap, np.inf),
        lever_arm=np.full(on.shape, base * cosine),
        y=foot_y,
        flank=np.where(on, (top**2 - foot**2) / (top**2 - bottom**2), np.nan),
        fillet=np.full(on.shape, np.nan),
    )


def _fillet_feet(
    design: PairDesign, section: Array, fillet: FilletCurve, search_radius: float
) -> tuple[Array, Array, Array, Array]:
    """Return gap (m, inf without foot), gamma (rad), lever arm (m) and y (m), (n,) each, of points (n, 3), x,
    -z, y in m.

    The foot is searched from the nearest of the curve's points, its ends left out; where sections differ by
    Newton's method.
    """
    curve = fillet.points
    gap, gamma, lever_arm = (np.full(len(section), value) for value in (np.inf, np.nan, 0.0))
    all_y = section[:, 2].copy()
    turned_back = section[:, :2] if is_prismatic(design) else to_middle_section(design, section)
    low, high = curve.min(axis=0) - search_radius, curve.max(axis=0) + search_radius
    close = np.flatnonzero(((turned_back > low) & (turned_back < high)).all(axis=1))
    nearest = fillet.tree.query(turned_back[close])[1]
    if is_prismatic(design):
        on = (nearest > 0) & (nearest < len(curve) - 1)
        close, nearest = close[on], nearest[on]
        apart, foot, arm = _prismatic_feet(design, section[close], fillet, nearest)
        on = np.abs(apart) < search_radius
        close = close[on]
        gap[close], gamma[close], lever_arm[close] = apart[on], foot[on], arm[on]
        return gap, gamma, lever_arm, all_y
    points = section[close][:, [0, 2, 1]] * [1.0, 1.0, -1.0]
    apart, foot, foot_y = fillet_feet(design, points, fillet.gamma[nearest])
    ends = fillet.gamma[[0, -1]]
    on = (foot > ends.min()) & (foot < ends.max()) & (np.abs(apart) < search_radius)
    close, foot, foot_y, apart = close[on], foot[on], foot_y[on], apart[on]
    gap[close] = apart + pinion.removed_depth(design, pinion.junction_roll(design, foot_y), foot_y)
    gamma[close], all_y[close] = foot, foot_y
    lever_arm[close] = fillet_points(design, foot, foot_y).lever_arm
    return gap, gamma, lever_arm, all_y


def _prismatic_feet(
    design: PairDesign, section: Array, fillet: FilletCurve, nearest: Integers
) -> tuple[Array, Array, Array]:
    """Return distance along the normal (m), gamma (rad) and lever arm (m), (n,) each, of the feet of points
    (n, 3), x, -z, y in m, near the curve's points `nearest` (n,), none of which is an end.

    Each step finds the foot on a circle that touches the curve.
    """
    before, after, y = nearest - 1, nearest + 1, section[:, 2]
    chord, turn = (part[after] - part[before] for part in (fillet.points, fillet.normals))
    length, gamma = np.linalg.norm(chord, axis=1), fillet.gamma[nearest]
    bend = np.sum(turn * chord, axis=1) / length**2
    change = (fillet.gamma[after] - fillet.gamma[before]) / length
    for step in range(STEPS_ON_CIRCLES + 1):
        surface = fillet_points(design, gamma, y)
        curve_point, normal = (part[:, [0, 2]] * [1.0, -1.0] for part in (surface.position, surface.normal))
        away, tangent = section[:, :2] - curve_point, normal[:, ::-1] * [1.0, -1.0]
        apart = np.sum(away * normal, axis=1)
        if step < STEPS_ON_CIRCLES:
            along = np.sum(away * tangent, axis=1) * np.sign(np.sum(chord * tangent, axis=1))
            gamma = gamma + change * along / (1.0 + bend * apart)
    return apart, gamma, surface.lever_arm


def is_prismatic(design: PairDesign) -> bool:
    """Whether all sections of the pinion are alike.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    bool
        True without helix and taper.
    """
    return design.helix_angle == 0.0 and design.taper_angle == 0.0


def to_middle_section(design: PairDesign, section: Array) -> Array:
    """Turn points of the pinion back along its drive flank's helix to the section in the middle of its face.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    section : (..., 3) array
        Points x, -z, y of the pinion's body frame, m.

    Returns
    -------
    (..., 2) array
        x and -z, m, where the flank of the middle section stands to them as the flank to the points.
    """
    helicoid = design.family.pinion_flanks[0]
    turn = helicoid.lead * (section[..., 2] - helicoid.middle) / helicoid.base_radius
    c, s = np.cos(turn), np.sin(turn)
    x, up = section[..., 0], section[..., 1]
    return np.stack([x * c + up * s, up * c - x * s], axis=-1)


def fillet_feet(design: PairDesign, points: Array, gamma: Array) -> tuple[Array, Array, Array]:
    """Find the feet of normals of the unmodified root fillet through points, by Newton's method.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    points : (n, 3) array
        Points of the pinion's body frame, m.
    gamma : (n,) array
        Where on the fillet the search begins, rad.

    Returns
    -------
    tuple of (n,) arrays
        Distance along the normal, m, negative inside the pinion, inf where no foot is found; gamma, rad, and
        y, m, of the foot.
    """
    root, y = pinion_fillet(design.family, 1), points[:, 1].copy()
    start, low = gamma, 0.2 * design.transverse_pressure_angle
    gap = np.sum((points - root.point(gamma, y)) * root.normal(gamma, y), axis=-1)
    step = np.full(len(points), np.inf)
    for _ in range(FOOT_STEPS):
        normal, away = root.normal(gamma, y), points - root.point(gamma, y)
        by_gamma, by_y = root.tangents(gamma, y)
        turns = (root.normal(gamma + ANGLE_STEP, y) - root.normal(gamma - ANGLE_STEP, y)) / (2 * ANGLE_STEP)
        bends = (root.normal(gamma, y + PLACE_STEP) - root.normal(gamma, y - PLACE_STEP)) / (2 * PLACE_STEP)
        change = _solve_parts(by_gamma + gap[:, None] * turns, by_y + gap[:, None] * bends, normal, away)
        change[:, 2] -= gap
        change[:, 0] = np.clip(change[:, 0], -LARGEST_TURN, LARGEST_TURN)
        change[:, 1] = np.clip(change[:, 1], -design.module, design.module)
        step = np.abs(change[:, 0]) * design.module + np.abs(change[:, 1])
        gamma = np.clip(gamma + change[:, 0], low, np.pi - low)
        y, gap = y + change[:, 1], gap + change[:, 2]
        if step.max(initial=0.0) < CLOSE:
            break
    is_found = (step < 1e3 * CLOSE) & (np.abs(gamma - start) < FARTHEST_TURN)
    return np.where(is_found, gap, np.inf), gamma, y


def _solve_parts(first: Array, second: Array, third: Array, sums: Array) -> Array:
    """Return the parts (n, 3) of three vectors (n, 3) each that add up to `sums` (n, 3), by Cramer's rule; 0
    where the three lie in a plane.
    """
    across = np.cross(second, third), np.cross(third, first), np.cross(first, second)
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = np.stack([np.sum(part * sums, axis=-1) for part in across], axis=-1)
        parts /= np.sum(first * across[0], axis=-1)[:, None]
    return np.where(np.isfinite(parts), parts, 0.0)
