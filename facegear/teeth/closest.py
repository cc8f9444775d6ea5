"""Gaps between pinion flanks and the gear at many placements, asked for again and again by a search."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from facegear.arrays import AnyArray, Array, Mask
from facegear.teeth import face_gear, pinion
from facegear.teeth.curvature import relative_curvatures
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import RigidMotion, to_left_flank
from facegear.teeth.separation import GearSide
from facegear.teeth.surfaces import flank_points


@dataclass(frozen=True, eq=False)
class FlankGaps:
    """Pairs of teeth of a design, each in a placement of its own: p rigid motions of `to_left_flank`,
    from the pinion's body frame to that of the gear's flank.
    """

    design: PairDesign
    gear: GearSide
    motion: RigidMotion

    @classmethod
    def of_pairs(cls, design: PairDesign, phi1: Array, phi2: Array, tooth: Array) -> Self:
        """Place pairs of teeth at given angles of both gears; no gap is computed yet.

        Parameters
        ----------
        design : PairDesign
            Pair of gears.
        phi1 : (p,) array
            Pinion angle, rad.
        phi2 : (p,) array
            Gear angle, rad.
        tooth : (p,) array
            Numbers of the pairs, dimensionless.

        Returns
        -------
        FlankGaps
            The p placed pairs, whose gaps `at` computes.
        """
        return cls(design, GearSide.of_design(design), to_left_flank(design, phi1, phi2, tooth))

    def only(self, rows: AnyArray) -> Self:
        """Return some of the placed pairs.

        Parameters
        ----------
        rows : (k,) array
            Numbers or mask of the pairs.

        Returns
        -------
        FlankGaps
            Chosen pairs.
        """
        return type(self)(self.design, self.gear, self.motion.only(rows))

    def at(self, roll: Array, y: Array) -> Array:
        """Compute the signed gap of pinion points to the gear along the pinion's normal, see `separation`.

        Parameters
        ----------
        roll : (p, n) array
            Roll angle, rad; (n,) for all pairs.
        y : (p, n) array
            Axial position, m; (n,) for all pairs.

        Returns
        -------
        (p, n) array
            m, negative inside the gear; inf where no surface is within a module.

        Raises
        ------
        NotConverged
            As `separation` does.
        """
        points = flank_points(self.design, roll, y)
        starts, ways = self.motion.points(points.position), self.motion.directions(points.normal)
        gap = self.gear.cut(starts.reshape(-1, 3), ways.reshape(-1, 3), self.design.module)[0]
        return np.asarray(gap.reshape(starts.shape[:-1]))


PAIRS = np.arange(-2, 3)
"""Tooth numbers looked at: at phi1 within half a pitch of zero no other pair can touch."""

_ACROSS, _ALONG = (part.ravel() for part in np.meshgrid(*2 * [np.linspace(-1.0, 1.0, 5)], indexing="ij"))
"""Places (25,) of a grid's points in half widths, across the roll and along y."""
_ON_BORDER = np.stack([np.abs(_ACROSS) == 1.0, np.abs(_ALONG) == 1.0], axis=-1)
"""Mask (25, 2) of the points that are on the border, across the roll and along y."""
_SHRINK, _GROWTH, _MAX_STEPS = 0.55, 1.5, 60
"""Factors on a grid's size where its middle or its border holds the minimum, and the largest number of grids.
Free choices that affect time alone; the minimum is polished after them."""
_GAIN = 1e-13
"""By how much (m) a gap must be less to count as such."""
_STENCIL = np.array([(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1)])
"""Steps of a 3 x 3 grid around its middle."""
_STEP = np.array([2e-4, 1e-4])
"""Distance of the stencil's points, in roll (rad) and y (m)."""
_FIRST, _LEVELS = 5, 10
"""Levels of grids from a coarse one, before Newton's method and in all."""
_WARM, _WARM_LEVELS = np.array([1e-3, 1e-4]), 16
"""First grid around a place that is known, in roll (rad) and y (m), and levels of grids."""
_COARSE = 0.02
"""By how many modules a gap on the coarse grid may be above the smallest."""
_FARTHEST = 20.0
"""Stencils that a step of Newton's method may go."""
_NEWTON_STEPS, _NEAR, _FINER, _SMOOTH = 6, 0.05, 0.125, 0.1
"""Newton's method ends with a stencil FINER times the first, once its step is below NEAR of a stencil. A gap
is smooth where both have the same curvatures to SMOOTH, and minima within half a fine stencil."""


@dataclass(frozen=True)
class Closest:
    """Smallest separation (m) of the pairs -2..2 and where on the pinion: roll (rad) and y (m), all (p, 5).

    inf where a pair does not face each other; roll and y are then only where the search ended.
    """

    gap: Array
    roll: Array
    y: Array


def closest(
    design: PairDesign, phi1: Array, phi2: Array, near: Closest | None = None, margin: float = np.inf
) -> Closest:
    """Search the flanks of all pairs -2..2 for the point of smallest separation from the gear.

    The search begins with a coarse grid or at a known result; Newton's method or shrinking grids end it.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (p,) array
        Pinion angle, rad.
    phi2 : (p,) array
        Gear angle, rad.
    near : Closest, optional
        Result at a similar placement; None begins with a coarse grid.
    margin : float
        Pairs whose gap, in `near` or after the first grids, exceeds the smallest by more than this keep
        it, m.

    Returns
    -------
    Closest
        Gaps (p, 5) and their positions, in m and rad.
    """
    size, levels = _WARM, _WARM_LEVELS
    if near is None:
        near, size = _coarse(design, phi1, phi2, margin)
        size, levels = size * _SHRINK**_FIRST, _LEVELS - _FIRST
    is_close = (near.gap <= near.gap.min(axis=1, keepdims=True) + margin).ravel()
    pairs = _pairs(design, phi1, phi2).only(is_close)
    parts = [part.ravel().copy() for part in (near.gap, near.roll, near.y)]
    minima = _refine_minima(pairs, parts[1][is_close], parts[2][is_close], size, levels)
    for part, values in zip(parts, minima, strict=True):
        part[is_close] = values
    return Closest(*(part.reshape(near.roll.shape) for part in parts))


def _pairs(design: PairDesign, phi1: Array, phi2: Array) -> FlankGaps:
    """Return the placed pairs -2..2 at angles (p,), rad, of both gears: 5 p motions, the pair counting
    fastest.
    """
    turns = np.repeat(phi1, len(PAIRS)), np.repeat(phi2, len(PAIRS))
    return FlankGaps.of_pairs(design, *turns, np.tile(PAIRS, len(phi1)).astype(float))


def face_ends(design: PairDesign) -> tuple[float, float]:
    """Return the ends of the pinion's face.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    tuple[float, float]
        Smallest and largest y, m.
    """
    half = design.pinion.width / 2
    return design.middle - half, design.middle + half


def _is_inside(design: PairDesign, roll: Array, y: Array) -> Mask:
    """Return whether rolls (rad) and y (m), (...), lie within the ends of the flank."""
    (low, high), (first, last) = pinion.roll_ends(design, y), face_ends(design)
    return (roll > low) & (roll < high) & (y > first) & (y < last)


def _coarse(design: PairDesign, phi1: Array, phi2: Array, margin: float) -> tuple[Closest, Array]:
    """Return the closest points of each pair by a 15 x 15 grid, and the size of its cell (2,): roll
    (rad), y (m).

    Pairs within `margin` (m) and a little more of the smallest gap are followed by finer grids, shrunk
    _FIRST times.
    """
    face, (first, last) = design.face_gear, face_ends(design)
    if design.is_spur:
        first, last = max(first, face.inner_radius - 0.02 * design.module), min(last, face.outer_radius)
    ys = np.linspace(first, last, 15)
    rolls = np.linspace(*pinion.roll_ends(design, ys), num=15)
    roll, y = rolls.ravel(), np.broadcast_to(ys, rolls.shape).ravel()
    pairs = _pairs(design, phi1, phi2)
    gap = pairs.at(roll, y)
    best, size = np.argmin(gap, axis=1), np.array([(rolls[1] - rolls[0]).max(), ys[1] - ys[0]])
    near = [part.reshape(len(phi1), len(PAIRS)) for part in (gap.min(axis=1), roll[best], y[best])]
    beside = margin + _COARSE * design.module
    walking = near[0] <= near[0].min(axis=1, keepdims=True) + beside
    minima = _walk_grids(pairs.only(walking.ravel()), near[1][walking], near[2][walking], size, _FIRST)
    for part, values in zip(near, minima, strict=True):
        part[walking] = values
    return Closest(*near), size


def _refine_minima(
    pairs: FlankGaps, roll: Array, y: Array, size: Array, levels: int
) -> tuple[Array, Array, Array]:
    """Return gap (m), roll (rad) and y (m), (n,) each, of minima near given roll and y.

    Newton's method is used where the gap is smooth, elsewhere grids of first half width `size` (2,), so many
    times smaller at last as `levels` says.
    """
    *minimum, smooth = _smooth_minimum(pairs, roll, y)
    rest = np.flatnonzero(~smooth)
    if rest.size:
        rough_pairs = pairs.only(rest)
        grid_minima = _walk_grids(rough_pairs, roll[rest], y[rest], size, levels)
        for part, values in zip(minimum, _polished(rough_pairs, *grid_minima), strict=True):
            part[rest] = values
    return minimum[0], minimum[1], minimum[2]


def _walk_grids(
    pairs: FlankGaps, roll: Array, y: Array, size: Array, levels: int
) -> tuple[Array, Array, Array]:
    """Walk 5 x 5 grids to the minimum, shrinking them when their middle part holds it: gap, roll and y (n,).

    The grids lean along the contact line where the walk begins, as the gap is a narrow and flat valley in its
    direction. `size` (2,) is the first half width in roll (rad) and y (m); the last is _SHRINK^levels of it.
    """
    face = face_ends(pairs.design)
    width = np.tile(size, (len(roll), 1))
    gap, roll, y = np.full(len(roll), np.inf), roll.copy(), y.copy()
    lean, active = _contact_line(pairs.design, roll, y), np.arange(len(roll))
    for _ in range(_MAX_STEPS):
        across, along = (part * width[active, axis, None] for axis, part in enumerate((_ACROSS, _ALONG)))
        ys = np.clip(y[active, None] + along, *face)
        rolls = roll[active, None] + across + lean[active, None] * along
        rolls = np.clip(rolls, *pinion.roll_ends(pairs.design, ys))
        gaps, rows = pairs.only(active).at(rolls, ys), np.arange(len(active))
        best = np.argmin(gaps, axis=1)
        new = gaps[rows, best]
        # a width grows where a lesser gap lies on the grid's border
        gains = (new < gap[active] - _GAIN) & (new < np.inf)
        border = gains[:, None] & _ON_BORDER[best]
        gap[active], roll[active], y[active] = new, rolls[rows, best], ys[rows, best]
        width[active] *= np.where(border, _GROWTH, _SHRINK)
        active = active[(width[active] > size * _SHRINK**levels).any(axis=1)]
        if len(active) == 0:
            break
    return gap, roll, y


def _smooth_minimum(pairs: FlankGaps, roll: Array, y: Array) -> tuple[Array, Array, Array, Mask]:
    """Return gap (m), roll (rad), y (m) by Newton's method on 3 x 3 stencils, and whether each is a
    minimum of a smooth gap, (n,) each.

    Where a modification begins within a stencil, or the flank ends, a finer one has its minimum elsewhere.
    """
    minimum, smooth = (np.full(len(roll), np.inf), roll.copy(), y.copy()), np.zeros(len(roll), bool)
    active, fine, bends = np.arange(len(roll)), np.zeros(len(roll), bool), np.zeros((len(roll), 2))
    for _ in range(_NEWTON_STEPS):
        part = np.where(fine, _FINER, 1.0)
        last = minimum[1][active], minimum[2][active]
        bowl = _bowl(pairs.only(active), *last, part[:, None] * _STEP)
        new = last[0] + part * bowl.across * _STEP[0], last[1] + part * bowl.along * _STEP[1]
        size, bend = np.hypot(bowl.across, bowl.along), bowl.bend / part[:, None] ** 2
        inside = _is_inside(pairs.design, *new)
        has_equal_curvature = (np.abs(bend - bends[active]) < _SMOOTH * bend).all(axis=1)
        continues = (
            bowl.convex & inside & np.where(fine, has_equal_curvature & (size < 0.5), size < _FARTHEST)
        )
        for target, values in zip(minimum, (bowl.value, *new), strict=True):
            target[active[continues]] = values[continues]
        smooth[active[continues & fine]], bends[active] = True, bend
        continues &= ~fine
        active, fine = active[continues], size[continues] < _NEAR
        if active.size == 0:
            break
    return *minimum, smooth


@dataclass(frozen=True)
class _Bowl:
    """Paraboloids through stencils (n,): the smallest value and how far it lies from the middle, in steps
    `across` the roll and `along` y; second differences (n, 2) both ways; whether it is a minimum.
    """

    value: Array
    across: Array
    along: Array
    bend: Array
    convex: Mask


def _polished(pairs: FlankGaps, gap: Array, roll: Array, y: Array) -> tuple[Array, Array, Array]:
    """Return minima (gap, m, roll, rad, y, m) after one Newton step from a 3 x 3 stencil.

    A minimum stays as it is where the step leaves the flank or does not make the gap less.
    """
    bowl = _bowl(pairs, roll, y, np.tile(_STEP, (len(roll), 1)))
    new_roll, new_y = roll + bowl.across * _STEP[0], y + bowl.along * _STEP[1]
    good = bowl.convex & (np.hypot(bowl.across, bowl.along) < _FARTHEST)
    good &= _is_inside(pairs.design, new_roll, new_y)
    new_roll, new_y = np.where(good, new_roll, roll), np.where(good, new_y, y)
    new = pairs.at(new_roll[:, None], new_y[:, None])[:, 0]
    better = good & (new < gap)
    return np.where(better, new, gap), np.where(better, new_roll, roll), np.where(better, new_y, y)


def _bowl(pairs: FlankGaps, roll: Array, y: Array, step: Array) -> _Bowl:
    """Return paraboloids through gaps on 3 x 3 stencils about roll (rad) and y (m), (n,); `step` (n, 2)
    is the distance of their points in roll and y.
    """
    rolls, ys = (
        at[:, None] + _STENCIL[:, axis] * step[:, axis : axis + 1] for axis, at in ((0, roll), (1, y))
    )
    g = pairs.at(rolls, ys).reshape(-1, 3, 3)
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = (g[:, 2, 1] - g[:, 0, 1]) / 2, (g[:, 1, 2] - g[:, 1, 0]) / 2
        bend = g[:, 2, 1] - 2 * g[:, 1, 1] + g[:, 0, 1], g[:, 1, 2] - 2 * g[:, 1, 1] + g[:, 1, 0]
        twist = (g[:, 2, 2] - g[:, 2, 0] - g[:, 0, 2] + g[:, 0, 0]) / 4
        det = bend[0] * bend[1] - twist**2
        across = (twist * slope[1] - bend[1] * slope[0]) / det
        along = (twist * slope[0] - bend[0] * slope[1]) / det
        value = g[:, 1, 1] + 0.5 * (slope[0] * across + slope[1] * along)
        return _Bowl(value, across, along, np.stack(bend, axis=-1), (det > 0) & (bend[0] > 0))


def _contact_line(design: PairDesign, roll: Array, y: Array) -> Array:
    """Return the slope d roll / d y (rad/m) of the contact line of the nominal pair at roll (rad) and y
    (m).
    """
    helicoid, length = design.family.pinion_flanks[0], design.pinion_base_radius * roll
    is_straight = helicoid.sine == 0.0 and design.family.motion.cosine == 0.0
    nearest = 1.001 * design.gear_base_radius if is_straight else -np.inf
    psi = face_gear.slope_at_place(design, np.maximum(y, nearest), length / design.shaper_base_radius)
    s = (length + design.shaper_lift * np.sin(psi)) / helicoid.cosine
    _, _, slope = relative_curvatures(design, s / design.shaper_base_radius, psi)
    # across the generator the length of roll grows by r_b / roll, along it it falls by the base helix's sine
    roll_slope = np.tan(slope) / np.maximum(length, 1e-2 * design.module)
    return (roll_slope - helicoid.sine / helicoid.base_radius) / helicoid.cosine
