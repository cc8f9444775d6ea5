"""Modifications and deviations of the face gear's flanks: material taken off along the normal, and the gap
that this opens.

Everything is for the flank that meets the pinion's right one: the left flank of tooth 0 in a mirror, where it
stands as the right one does in the gear body frame (see `design`). A place on the flank is its gear radius
and its depth below the tip plane. Beyond the edges of the flank, on the tip land and in the fillet, the
amount at the edge stands.
"""

from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.geometry import face_gear
from facegear.geometry.design import GearModifications, PairDesign
from facegear.geometry.deviations import derivative, deviation
from facegear.geometry.reliefs import linear, parabola, parabola_curvature

GRAZING = 0.1
"""Cosine between ray and normal below which the gap along the ray is not extended further."""


@lru_cache(maxsize=16)
def flank_depth(design: PairDesign) -> "scipy.interpolate.CubicSpline":
    """Return the depth below the tip plane of the flank's end at the fillet.

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
    return scipy.interpolate.CubicSpline(radius, design.gear_tip_plane - flank_end(design, radius)[..., 2])


def flank_end(design: PairDesign, radius: ArrayLike) -> Array:
    """Compute the points where the flank ends at the fillet.

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
    roll = design.shaper_tip_roll
    return face_gear.flank_point(design, roll, face_gear.psi_at(design, radius, roll))


def removed_depth(design: PairDesign, radius: ArrayLike, depth: ArrayLike) -> Array:
    """Compute the material that modifications and deviations take off along the normal.

    Tip relief is measured from the tip plane, root relief from where the flank ends, end relief from
    either end of the face, crownings from the middle of the face and from the pitch plane.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    radius : (...) array_like
        Gear radius, m.
    depth : (...) array_like
        Depth below the tip plane, m.

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
    across = 1.0 - below / gear.addendum
    depth_removed: Array = (
        linear(modifications.tip_relief, below)
        + linear(modifications.root_relief, deepest - below)
        + linear(modifications.end_relief, np.minimum(at - gear.inner_radius, gear.outer_radius - at))
        + parabola(modifications.lead_crowning, np.abs(at - design.mean_radius))
        + parabola(modifications.profile_crowning, np.abs(below - gear.addendum))
        + modifications.lead_slope * along
        + modifications.profile_slope * across
        + modifications.bias * along * across
    )
    return (
        depth_removed if gear.flanks.left is None else depth_removed - deviation(gear.flanks.left, at, below)
    )


def as_generated(design: PairDesign) -> bool:
    """Whether the flank is the one that the shaper generates, with nothing taken off or added.

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
    depth_removed = removed_depth(
        design, np.hypot(points[..., 0], points[..., 1]), design.gear_tip_plane - points[..., 2]
    )
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
    return flank_as_made(design, *face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane))


def fillet_as_made(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Compute points of the fillet, see `face_gear.fillet_section`, less the material taken off at the end of
    the flank.

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
    points = face_gear.cylindrical(radius, *face_gear.fillet_section(design, radius, psi))
    if as_generated(design):
        return points
    depth_removed = removed_depth(design, radius, flank_depth(design)(radius))
    return points - depth_removed[..., None] * face_gear.fillet_normal(design, radius, psi)


def added_curvatures(design: PairDesign, points: Array) -> tuple[Array, Array, Array]:
    """Compute the curvatures that crownings and deviations add to the flank, convex positive.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    points : (..., 3) array
        Points of the flank, m.

    Returns
    -------
    tuple of (...) arrays
        Along the depth below the tip plane, along the gear radius, and their twist, 1/m.
    """
    modifications, grid = design.face_gear.modifications, design.face_gear.flanks.left
    radius, depth = np.hypot(points[..., 0], points[..., 1]), design.gear_tip_plane - points[..., 2]
    return (
        parabola_curvature(modifications.profile_crowning, np.abs(depth - design.face_gear.addendum))
        - derivative(grid, radius, depth, (0, 2)),
        parabola_curvature(modifications.lead_crowning, np.abs(radius - design.mean_radius))
        - derivative(grid, radius, depth, (2, 0)),
        -derivative(grid, radius, depth, (1, 1)),
    )


def gap_opening(design: PairDesign, points: Array, directions: Array) -> Array:
    """Compute how much longer rays from the pinion become by modifications and deviations.

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
    depth = np.clip(design.gear_tip_plane - points[:, 2], 0.0, flank_depth(design)(radius))
    roll, psi = face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane - depth)
    normal = face_gear.flank_normal(design, roll, psi)
    cosine = np.maximum(-np.einsum("ij,ij->i", normal, directions[ends]), GRAZING)
    opening[ends] = removed_depth(design, radius, depth) / cosine
    return opening
