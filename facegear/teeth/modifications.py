"""Modifications and measured deviations of flanks.

Modifications and deviations of the face gear's flanks: material taken off along the normal, and the gap that
this opens. Everything is for the flank that meets the pinion's right one: the left flank of tooth 0 in a
mirror, where it stands as the right one does in the gear body frame (see `design`). A place on the flank is
its gear radius and its depth below the tip surface at that radius, along the gear's axis. Beyond the edges of
the flank, on the tip land and in the fillet, the amount at the edge stands.
"""

from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth import face_gear, face_gear_fillet
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_shapes import DeviationGrid, GearModifications, linear, parabola, parabola_curvature

CUBIC = 3
"""Degree of the spline through deviations, where there are enough lines for it."""


def deviation(grid: DeviationGrid | None, face: ArrayLike, profile: ArrayLike) -> Array:
    """Interpolate the measured material along the outward normal at places of a flank, by a bicubic spline.

    The interpolation is of fourth order in the distance of the grid's places; fewer than four of them take
    a lower order.

    Parameters
    ----------
    grid : DeviationGrid, optional
        Deviations; None gives 0.
    face : (...) array_like
        Distance along the face, m, as in `DeviationGrid`.
    profile : (...) array_like
        Distance along the profile, m.

    Returns
    -------
    (...) array
        m.
    """
    along, across = np.broadcast_arrays(np.asarray(face, float), np.asarray(profile, float))
    if grid is None:
        return np.zeros(along.shape)
    inside = (np.clip(part, *_ends(line)) for part, line in ((along, grid.face), (across, grid.profile)))
    values: Array = _spline(grid).ev(*inside)
    return values


def derivative(
    grid: DeviationGrid | None, face: ArrayLike, profile: ArrayLike, orders: tuple[int, int]
) -> Array:
    """Compute a partial derivative of `deviation`; 0 beyond an edge, where the value is constant.

    Parameters
    ----------
    grid : DeviationGrid, optional
        Deviations; None gives 0.
    face : (...) array_like
        Distance along the face, m, as in `DeviationGrid`.
    profile : (...) array_like
        Distance along the profile, m.
    orders : tuple[int, int]
        Orders of the derivative along face and profile.

    Returns
    -------
    (...) array
        m over m to the sum of the orders.
    """
    along, across = np.broadcast_arrays(np.asarray(face, float), np.asarray(profile, float))
    if grid is None:
        return np.zeros(along.shape)
    values: Array = np.zeros(along.shape)
    coordinates = (along, grid.face, orders[0]), (across, grid.profile, orders[1])
    on = np.ones(along.shape, bool)
    for at, line, order in coordinates:
        first, last = _ends(line)
        on &= (at >= first) & (at <= last) | (order == 0)
    inside = (np.clip(at[on], *_ends(line)) for at, line, _ in coordinates)
    values[on] = _spline(grid).ev(*inside, dx=orders[0], dy=orders[1])
    return values


def mean_crowning(grid: DeviationGrid | None) -> float:
    """Compute the curvature along the face of the least-squares parabola through a grid's means over the
    profile.

    Parameters
    ----------
    grid : DeviationGrid, optional
        Deviations; None gives 0.

    Returns
    -------
    float
        1/m, convex positive; 0 where the flank is hollow or has at most two places along the face.
    """
    if grid is None or len(grid.face) <= 2:
        return 0.0
    middle = np.array(grid.face) - np.mean(grid.face)
    curvature: float = np.polynomial.polynomial.polyfit(middle, np.mean(grid.deviation, axis=1), 2)[2]
    return max(-2.0 * curvature, 0.0)


def _ends(line: tuple[float, ...]) -> tuple[float, float]:
    """Return the first and the last of rising places (m)."""
    return line[0], line[-1]


@lru_cache(maxsize=512)
def _spline(grid: DeviationGrid) -> "scipy.interpolate.RectBivariateSpline":
    """Return the bicubic spline of deviation (m) by place along face and profile (m); cached by grid."""
    lines = [np.array(line) for line in (grid.face, grid.profile)]
    orders = [min(CUBIC, line.size - 1) for line in lines]
    values = np.array(grid.deviation)
    if min(orders) < CUBIC:
        # the polynomial through two or three places, at as many as a cubic takes
        few = [np.linspace(line[0], line[-1], CUBIC + 1) for line in lines]
        dense_lines = [line if line.size > CUBIC else even for line, even in zip(lines, few, strict=True)]
        values = scipy.interpolate.RectBivariateSpline(*lines, values, kx=orders[0], ky=orders[1])(
            *dense_lines
        )
        lines = dense_lines
    return scipy.interpolate.RectBivariateSpline(*lines, values)


GRAZING = 0.1
"""Cosine between ray and normal below which the gap along the ray is not extended further."""


@lru_cache(maxsize=16)
def flank_depth(design: PairDesign) -> "scipy.interpolate.CubicSpline":
    """Return the depth below the tip surface of the flank's end at the fillet.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    scipy.interpolate.CubicSpline
        Depth (m) over gear radius (m).
    """
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 65)
    depth = face_gear.tip_height(design, radius) - flank_end(design, radius)[..., 2]
    return scipy.interpolate.CubicSpline(radius, depth)


def depth_below_tip(design: PairDesign, points: Array) -> Array:
    """Compute the depth of points below the gear's tip surface at their radius, along the gear's axis.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    points : (..., 3) array
        Points in the gear's body frame, m.

    Returns
    -------
    (...) array
        m.
    """
    return face_gear.tip_height(design, np.hypot(points[..., 0], points[..., 1])) - points[..., 2]


def flank_end(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the points where the unmodified right flank ends at the fillet, in the gear's body frame.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.

    Returns
    -------
    (..., 3) array
        m.
    """
    return face_gear.flank_point(design, *face_gear.end_parameters(design, radius))


def removed_depth(design: PairDesign, radius: ArrayLike, depth: ArrayLike) -> Array:
    """Compute the depth of material that modifications and deviations take off the gear along the normal.

    Tip relief is measured from the tip surface, root relief from where the flank ends, end relief from
    either end of the face, crownings from the middle of the face and from the datum surface.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    depth : (...) array_like
        Depth below the tip surface along the gear's axis, m.

    Returns
    -------
    (...) array
        m; negative where slopes, bias or deviations add material.
    """
    gear, modifications = design.face_gear, design.face_gear.modifications
    at: Array = np.clip(np.asarray(radius, float), gear.inner_radius, gear.outer_radius)
    deepest: Array = flank_depth(design)(at)
    below: Array = np.clip(np.asarray(depth, float), 0.0, deepest)
    along = (at - design.mean_radius) / (0.5 * (gear.outer_radius - gear.inner_radius))
    pitch_depth = face_gear.pitch_depth(design)
    across = 1.0 - below / pitch_depth
    depth_removed: Array = (
        linear(modifications.tip_relief, below)
        + linear(modifications.root_relief, deepest - below)
        + linear(modifications.end_relief, np.minimum(at - gear.inner_radius, gear.outer_radius - at))
        + parabola(modifications.lead_crowning, np.abs(at - design.mean_radius))
        + parabola(modifications.profile_crowning, np.abs(below - pitch_depth))
        + modifications.lead_slope * along
        + modifications.profile_slope * across
        + modifications.bias * along * across
    )
    return (
        depth_removed if gear.flanks.left is None else depth_removed - deviation(gear.flanks.left, at, below)
    )


def as_generated(design: PairDesign) -> bool:
    """Whether the gear's drive (left) flank is as the shaper generates it, with nothing taken off or added.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    bool
        True without modifications and deviations.
    """
    gear = design.face_gear
    return gear.modifications == GearModifications() and gear.flanks.left is None


def flank_as_made(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> Array:
    """Compute points of the flank, see `face_gear.flank_point`, less the material taken off.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Roll angle th, rad.
    psi : (...) array_like
        Slope of the normal, rad.

    Returns
    -------
    (..., 3) array
        m.
    """
    points = face_gear.flank_point(design, roll, psi)
    if as_generated(design):
        return points
    radius = np.hypot(points[..., 0], points[..., 1])
    depth_removed = removed_depth(design, radius, depth_below_tip(design, points))
    return points - depth_removed[..., None] * face_gear.flank_normal(design, roll, psi)


def tip_edge_as_made(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute points of the flank's tip edge, less the material taken off.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius on the unmodified gear, m.

    Returns
    -------
    (..., 3) array
        m.
    """
    return flank_as_made(design, *face_gear.tip_parameters(design, radius))


def fillet_as_made(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Compute points of the fillet, see `face_gear_fillet.fillet_section`, less the material taken off at the
    end of the flank.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    psi : (...) array_like
        Slope of the fillet's normal, rad.

    Returns
    -------
    (..., 3) array
        m.
    """
    points = face_gear.cylindrical(radius, *face_gear_fillet.fillet_section(design, radius, psi))
    if as_generated(design):
        return points
    depth_removed = removed_depth(design, radius, flank_depth(design)(radius))
    return points - depth_removed[..., None] * face_gear_fillet.fillet_normal(design, radius, psi)


def added_curvatures(design: PairDesign, points: Array) -> tuple[Array, Array, Array]:
    """Compute the curvatures that crownings and deviations add to the gear's flank, convex positive.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    points : (..., 3) array
        Points of the flank in the gear's body frame, m.

    Returns
    -------
    tuple of (...) arrays
        Along the depth below the tip surface, along the gear radius, and their twist, 1/m.
    """
    modifications, grid = design.face_gear.modifications, design.face_gear.flanks.left
    radius, depth = np.hypot(points[..., 0], points[..., 1]), depth_below_tip(design, points)
    return (
        parabola_curvature(modifications.profile_crowning, np.abs(depth - face_gear.pitch_depth(design)))
        - derivative(grid, radius, depth, (0, 2)),
        parabola_curvature(modifications.lead_crowning, np.abs(radius - design.mean_radius))
        - derivative(grid, radius, depth, (2, 0)),
        -derivative(grid, radius, depth, (1, 1)),
    )


def gap_opening(design: PairDesign, points: Array, directions: Array) -> Array:
    """Compute how much longer rays from the pinion become by the gear's modifications and deviations.

    It is of first order in the removed depth: 0.1 um off at 50 um compared with the exactly displaced
    flank.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    points : (n, 3) array
        Ends of the rays on the unmodified gear, m; those that are not finite give 0.
    directions : (n, 3) array
        Unit vectors, dimensionless.

    Returns
    -------
    (n,) array
        m.
    """
    opening = np.zeros(len(points))
    ends = np.flatnonzero(np.isfinite(points).all(axis=-1))
    gear, points = design.face_gear, points[ends]
    radius = np.clip(np.hypot(points[:, 0], points[:, 1]), gear.inner_radius, gear.outer_radius)
    tip = face_gear.tip_height(design, radius)
    depth = np.clip(tip - points[:, 2], 0.0, flank_depth(design)(radius))
    roll, psi = face_gear.roll_and_psi_at_height(design, radius, tip - depth)
    normal = face_gear.flank_normal(design, roll, psi)
    cosine = np.maximum(-np.einsum("ij,ij->i", normal, directions[ends]), GRAZING)
    opening[ends] = removed_depth(design, radius, depth) / cosine
    return opening
