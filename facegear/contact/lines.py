"""Contact lines: stations where the gap between exact flanks is least in planes across the pinion's axis.

Planes across the axis cut a flank's tangent plane square to the pinion's generators, whatever the base helix:
so a contact line, which lies within some 15 degrees of the generators, has one station in each of them. A
station stands for a piece of the line, longer than the planes' distance by the line's slope and by the lean
of the generators.
Lines do not depend on load: a tooth bends by less than 1 mrad, which moves its line by some 0.01 mm.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array, Integers
from facegear.teeth import face_gear
from facegear.teeth.curvature import opposite_curvatures
from facegear.teeth.design import PairDesign
from facegear.teeth.pinion import junction_roll, tip_roll
from facegear.teeth.placement import conjugate_angle, pinion_angle, to_left_flank
from facegear.teeth.rays import FLANK
from facegear.teeth.separation import separation, separation_each
from facegear.teeth.surfaces import SurfacePoints, flank_points

SAMPLES = 25
"""Points looked at along a profile before the parabola through the minimum and its neighbours."""

EVERY = 4
"""Step between the samples that are always computed."""

BEYOND = 0.1
"""Fraction of the flank's height by which the involute is continued beyond its tip, to see which lines leave
it."""

FINER = (0.1, 0.02)
"""Steps of the next parabolas, in steps of the first."""


@dataclass(frozen=True, eq=False)
class ContactLines:
    """Contact lines of p placements of pairs of teeth, with stations in n planes across the pinion's axis at
    `y` (n,) m.

    All others (p, n): `roll` (rad) on the pinion; `curvature` (1/m) across the line, relative of both
    flanks, positive; `slope` (rad) of the line against the pinion's generator, seen along the common normal;
    how far (m) the line is from the pinion's and the gear's tip edge and from the nearest end of both
    faces, negative beyond the pinion's tip and the ends. What needs the gear's flank is nan where there
    is none. `face` is the width (m) of each plane that both faces cover, planes being as wide as they are
    apart. `cosine`: of the base helix, by which generators lean against the axis.
    """

    y: Array
    roll: Array
    curvature: Array
    slope: Array
    to_pinion_tip: Array
    to_gear_tip: Array
    to_end: Array
    face: Array
    cosine: float = 1.0

    def stretch(self, row: Integers, plane: Integers) -> Array:
        """Compute the length of line per distance along the pinion's axis.

        Parameters
        ----------
        row, plane : (...) array of int
            Numbers of lines and of their planes, dimensionless.

        Returns
        -------
        (...) array
            Ratio, dimensionless; where the slope is not known, that of a generator.
        """
        return 1.0 / (self.cosine * np.cos(np.nan_to_num(self.slope[row, plane])))


def contact_lines(design: PairDesign, phi1: Array, phi2: Array, tooth: ArrayLike, y: Array) -> ContactLines:
    """Compute the contact lines of tooth pairs at unloaded angles.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1, phi2 : (p,) array
        Angles of the gears, rad.
    tooth : (p,) array_like
        Numbers of the pairs.
    y : (n,) array
        Positions of the planes along the pinion's axis, m.

    Returns
    -------
    ContactLines
        Lines (p, n), in SI units (m, rad).

    Raises
    ------
    NotConverged
        As `separation` does.
    """
    tooth = np.asarray(tooth, float)
    roll = _min_gap_roll(design, (phi1, phi2, tooth), y)
    points = flank_points(design, roll, y)
    flank_separation = separation(design, points, phi1, phi2, tooth)
    flank = (flank_separation.part == FLANK) & (roll > first_roll(design, y))
    gear_roll, psi = np.where(flank, flank_separation.u, np.nan), np.where(flank, flank_separation.v, np.nan)
    curvature, slope = (np.full(roll.shape, np.nan) for _ in range(2))
    turns = np.broadcast_to(to_left_flank(design, phi1, phi2, tooth).matrix[:, None], (*roll.shape, 3, 3))
    on_pinion = roll[flank], np.broadcast_to(y, roll.shape)[flank]
    curvature[flank], _, slope[flank] = opposite_curvatures(
        design, on_pinion, gear_roll[flank], psi[flank], turns[flank]
    )
    point = face_gear.flank_point(design, gear_roll, psi)
    radius = _radius(y, np.hypot(point[..., 0], point[..., 1]))
    to_gear_tip = np.full(roll.shape, np.nan)
    edge = face_gear.tip_edge(design, radius[flank])
    to_gear_tip[flank] = np.linalg.norm(point[flank] - edge, axis=1)
    face, half = design.face_gear, design.pinion.width / 2
    ends = np.minimum(radius - face.inner_radius, face.outer_radius - radius)
    return ContactLines(
        y=y,
        roll=roll,
        curvature=curvature,
        slope=slope,
        to_pinion_tip=_arc(design, tip_roll(design, y)) - _arc(design, roll),
        to_gear_tip=to_gear_tip,
        to_end=np.minimum(ends, half - np.abs(y - design.middle)),
        face=_covered_width(design, y, radius),
        cosine=design.family.pinion_flanks[0].cosine,
    )


def contact_gaps(
    design: PairDesign, placement: tuple[Array, Array, Array], y: Array
) -> tuple[Array, Array, Array]:
    """Compute the least gaps of flanks in planes across the pinion's axis, along the pinion's normals.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    placement : tuple of arrays
        Angles phi1, phi2 (rad) and numbers of the pairs, (p,) each.
    y : (n,) array
        Positions of the planes along the pinion's axis, m.

    Returns
    -------
    tuple of arrays
        Roll (p, n) on the pinion, rad; gap (p, n), m, inf where there is none; point (p, n, 3) on the
        gear's flank in its body frame, m, nan where there is none.

    Raises
    ------
    NotConverged
        As `separation` does.
    """
    roll = np.clip(_min_gap_roll(design, placement, y), first_roll(design, y), tip_roll(design, y))
    flank_separation = separation(design, flank_points(design, roll, y), *placement)
    on = flank_separation.part == FLANK
    points = face_gear.flank_point(
        design, np.where(on, flank_separation.u, np.nan), np.where(on, flank_separation.v, np.nan)
    )
    return roll, np.where(on, flank_separation.gap, np.inf), points


def unloaded_lines(
    design: PairDesign, position: Array, tooth: ArrayLike, unloaded_errors: Mapping[float, float], y: Array
) -> ContactLines:
    """Compute the contact lines of tooth pairs at positions of a pitch, with the gears placed as without
    load.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    position : (p,) array
        In pitches.
    tooth : (p,) array_like
        Numbers of the pairs.
    unloaded_errors : Mapping[float, float]
        Transmission error by position, m, positive where the pinion is ahead.
    y : (n,) array
        Positions of the planes along the pinion's axis, m.

    Returns
    -------
    ContactLines
        Lines (p, n), in SI units (m, rad).

    Raises
    ------
    NotConverged
        As `separation` does.
    """
    phi1 = pinion_angle(design, position)
    error = -np.array([unloaded_errors[at] for at in position.tolist()])
    phi2 = conjugate_angle(design, phi1) + error / design.gear_normal_arm
    return contact_lines(design, phi1, phi2, tooth, y)


def first_roll(design: PairDesign, y: Array) -> Array:
    """Compute the smallest roll angle of the involute: at the fillet, not below the base circle.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array
        Places along the pinion's axis, m.

    Returns
    -------
    (...) array
        rad.
    """
    return np.maximum(junction_roll(design, y), 0.0)


def _arc(design: PairDesign, roll: Array | float) -> Array:
    """Return the length (m) of the involute from the base circle to a roll angle (rad): r_b roll^2 / 2."""
    return design.pinion_base_radius * np.square(roll) / 2


def _min_gap_roll(design: PairDesign, placement: tuple[Array, Array, Array], y: Array) -> Array:
    """Return the roll (p, n), rad, of the least gap in each plane; the profile's end if the gap falls up
    to there.

    `placement` holds phi1, phi2 (rad) and pair numbers (p,); `y` (n,), m. The least of SAMPLES samples,
    even in the square of the roll, is refined by parabolas through three gaps. Beyond the tip it ends at
    BEYOND of the profile.
    """
    top, bottom = (np.broadcast_to(end(design, y) ** 2, y.shape) for end in (tip_roll, first_roll))
    roll_squared = np.linspace(bottom, top + BEYOND * (top - bottom), SAMPLES)
    step = roll_squared[1] - roll_squared[0]
    gap = _sampled_gaps(design, placement, roll_squared, y)
    nearest = np.clip(np.argmin(gap, axis=1), 1, SAMPLES - 2)
    square = roll_squared[nearest, np.arange(y.size)] + step * _vertex(
        *(np.take_along_axis(gap, (nearest + side)[:, None], 1)[:, 0] for side in (-1, 0, 1))
    )
    for part in FINER:
        around = square[:, None] + part * step * np.array([-1.0, 0.0, 1.0])[:, None]
        square = square + part * step * _vertex(*np.moveaxis(_gaps(design, placement, around, y), 1, 0))
    return np.sqrt(np.clip(square, bottom, None))


def _sampled_gaps(
    design: PairDesign, placement: tuple[Array, Array, Array], roll_squared: Array, y: Array
) -> Array:
    """Return the gaps (p, k, n) of `_gaps` at squares (k, n) of the roll, as many as show the least in each
    plane.

    Every EVERY-th sample is computed first. Gaps fall towards the least and rise beyond it, so that the
    least lies between the neighbours of the smallest of these samples. In planes without any finite gap
    all samples are computed, except for pairs that have none in any plane. Samples that are not computed
    are inf.
    """
    number = np.arange(len(roll_squared))[:, None]
    gap = np.full((placement[0].size, number.size, y.size), np.inf)
    gap[:, ::EVERY] = _gaps(design, placement, roll_squared[::EVERY], y)
    has_gap = np.isfinite(gap).any(axis=1, keepdims=True)
    near = np.abs(number - np.argmin(gap, axis=1)[:, None]) < EVERY
    is_needed = (number % EVERY > 0) & np.where(has_gap, near, has_gap.any(axis=2, keepdims=True))
    pair, sample, plane = (np.ascontiguousarray(part) for part in np.nonzero(is_needed))
    points = flank_points(design, np.sqrt(np.maximum(roll_squared[sample, plane], 0.0)), y[plane])
    gap[is_needed] = separation_each(design, points, placement, pair, design.module).continued
    return gap


def _gaps(design: PairDesign, placement: tuple[Array, Array, Array], roll_squared: Array, y: Array) -> Array:
    """Return the gaps (p, k, n), m, to the gear's flank, continued beyond its edges, along the pinion's
    normals.

    `roll_squared`: squares (rad2) of the roll angle on the pinion, (k, n) or (p, k, n), in planes y (n,),
    m. A gap is inf where the continued flank is missed, too.
    """
    points = flank_points(design, np.sqrt(np.maximum(roll_squared, 0.0)), y)
    flat = (*roll_squared.shape[:-2], -1, 3)
    flat_points = SurfacePoints(points.position.reshape(flat), points.normal.reshape(flat))
    flank_separation = separation(design, flat_points, *placement)
    gap = np.where(np.isfinite(flank_separation.continued), flank_separation.continued, np.inf)
    return gap.reshape(placement[0].size, *roll_squared.shape[-2:])


def _vertex(before: Array, middle: Array, after: Array) -> Array:
    """Return where a parabola through three values at -1, 0, 1 has its minimum, within -1..1; 0
    without one.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        vertex = 0.5 * (before - after) / (before - 2 * middle + after)
    return np.clip(np.nan_to_num(vertex, nan=0.0, posinf=0.0, neginf=0.0), -1.0, 1.0)


def _radius(y: Array, gear_radius: Array) -> Array:
    """Return the gear radius (p, n), m, of contact lines in planes y (n,), with its gaps filled.

    Where `gear_radius` (p, n) is nan, its difference from y is interpolated over the planes; 0 without
    any value.
    """
    difference = gear_radius - y
    for row in difference:
        on = np.flatnonzero(np.isfinite(row))
        row[:] = np.interp(np.arange(row.size), on, row[on]) if on.size else 0.0
    return y + difference


def _covered_width(design: PairDesign, y: Array, radius: Array) -> Array:
    """Return the width (p, n), m, that the gear's face covers under the linear basis function of each
    plane.

    y (n,), m: planes; radius (p, n): gear radius (m) of the contact line in them. An end of the face cuts
    at the y where the line's radius is that of the end.
    """
    face = design.face_gear
    rows = np.arange(len(radius))
    inner, outer = (
        limit - (radius - y)[rows, np.argmin(np.abs(radius - limit), axis=1)]
        for limit in (face.inner_radius, face.outer_radius)
    )
    return _hat_integral(y, outer[:, None]) - _hat_integral(y, inner[:, None])


def _hat_integral(y: Array, end: Array) -> Array:
    """Return the integrals (..., n), m, of linear basis functions of evenly spaced planes from the first
    to `end`.

    y (n,), m: the planes; `end` (..., 1), m, is clipped to them.
    """
    step = y[1] - y[0]
    at = np.clip((np.clip(end, y[0], y[-1]) - y) / step, -1.0, 1.0)
    whole = 0.5 * (1.0 + at) ** 2 - np.where(at > 0, at**2, 0.0)
    whole[..., 0] -= 0.5
    return step * np.maximum(whole, 0.0)
