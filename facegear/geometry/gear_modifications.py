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
    """Depth (m) below the tip plane of the flank's end at the fillet, by gear radius (m)."""
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 65)
    return scipy.interpolate.CubicSpline(radius, design.gear_tip_plane - flank_end(design, radius)[..., 2])


def flank_end(design: PairDesign, radius: ArrayLike) -> Array:
    """Points (..., 3) where the flank ends at the fillet, at gear radii (m)."""
    roll = design.shaper_tip_roll
    return face_gear.flank_point(design, roll, face_gear.psi_at(design, radius, roll))


def removed(design: PairDesign, radius: ArrayLike, depth: ArrayLike) -> Array:
    """Material (m) taken off along the normal at gear radius and depth below the tip plane (m).

    Negative where slopes, bias or deviations add material. Tip relief is measured from the tip plane, root
    relief from where the flank ends, end relief from either end of the face, crownings from the middle of the
    face and from the pitch plane.
    """
    gear, made = design.face_gear, design.face_gear.modifications
    at: Array = np.clip(np.asarray(radius, float), gear.inner_radius, gear.outer_radius)
    deepest: Array = flank_depth(design)(at)
    below: Array = np.clip(np.asarray(depth, float), 0.0, deepest)
    along = (at - design.mean_radius) / (0.5 * (gear.outer_radius - gear.inner_radius))
    across = 1.0 - below / gear.addendum
    taken: Array = (
        linear(made.tip_relief, below)
        + linear(made.root_relief, deepest - below)
        + linear(made.end_relief, np.minimum(at - gear.inner_radius, gear.outer_radius - at))
        + parabola(made.lead_crowning, np.abs(at - design.mean_radius))
        + parabola(made.profile_crowning, np.abs(below - gear.addendum))
        + made.lead_slope * along
        + made.profile_slope * across
        + made.bias * along * across
    )
    return taken if gear.flanks.left is None else taken - deviation(gear.flanks.left, at, below)


def as_generated(design: PairDesign) -> bool:
    """Whether that flank is the one that the shaper generates, with nothing taken off or added."""
    gear = design.face_gear
    return gear.modifications == GearModifications() and gear.flanks.left is None


def flank_as_made(design: PairDesign, roll: ArrayLike, psi: ArrayLike) -> Array:
    """Points (..., 3) of the flank, see `face_gear.flank_point`, less what is taken off there."""
    points = face_gear.flank_point(design, roll, psi)
    if as_generated(design):
        return points
    taken = removed(design, np.hypot(points[..., 0], points[..., 1]), design.gear_tip_plane - points[..., 2])
    return points - taken[..., None] * face_gear.flank_normal(design, roll, psi)


def tip_edge_as_made(design: PairDesign, radius: ArrayLike) -> Array:
    """Points (..., 3) of the flank's tip edge at gear radii (m) of the unmodified gear."""
    return flank_as_made(design, *face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane))


def fillet_as_made(design: PairDesign, radius: ArrayLike, psi: ArrayLike) -> Array:
    """Points (..., 3) of the fillet, see `face_gear.fillet_section`, less what the end of the flank loses."""
    points = face_gear.cylindrical(radius, *face_gear.fillet_section(design, radius, psi))
    if as_generated(design):
        return points
    taken = removed(design, radius, flank_depth(design)(radius))
    return points - taken[..., None] * face_gear.fillet_normal(design, radius, psi)


def crowned(design: PairDesign, points: Array) -> tuple[Array, Array, Array]:
    """Curvatures (1/m) that crownings and deviations add at points (..., 3) of the flank, convex positive:
    along the depth below the tip plane, along the gear radius, and their twist.
    """
    made, grid = design.face_gear.modifications, design.face_gear.flanks.left
    radius, depth = np.hypot(points[..., 0], points[..., 1]), design.gear_tip_plane - points[..., 2]
    return (
        parabola_curvature(made.profile_crowning, np.abs(depth - design.face_gear.addendum))
        - derivative(grid, radius, depth, (0, 2)),
        parabola_curvature(made.lead_crowning, np.abs(radius - design.mean_radius))
        - derivative(grid, radius, depth, (2, 0)),
        -derivative(grid, radius, depth, (1, 1)),
    )


def opened(design: PairDesign, points: Array, directions: Array) -> Array:
    """How much longer (n,) m rays become that end at `points` (n, 3) of the unmodified gear.

    directions (n, 3): of unit length, from the pinion. First order in what is removed: against the exactly
    displaced flank 0.1 um at 50 um. Points that are not finite open nothing.
    """
    opening = np.zeros(len(points))
    ends = np.flatnonzero(np.isfinite(points).all(axis=-1))
    gear, points = design.face_gear, points[ends]
    radius = np.clip(np.hypot(points[:, 0], points[:, 1]), gear.inner_radius, gear.outer_radius)
    depth = np.clip(design.gear_tip_plane - points[:, 2], 0.0, flank_depth(design)(radius))
    roll, psi = face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane - depth)
    normal = face_gear.flank_normal(design, roll, psi)
    cosine = np.maximum(-np.einsum("ij,ij->i", normal, directions[ends]), GRAZING)
    opening[ends] = removed(design, radius, depth) / cosine
    return opening
