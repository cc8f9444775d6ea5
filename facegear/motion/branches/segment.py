"""Steps along a branch, the stretch between two neighbouring points, and zeros of tests along it."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from facegear.arrays import Array
from facegear.errors import NotConverged
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import BranchPoint, correct_state, solve_point

ALONG = 1e-9
"""Cosine's distance from 1 up to which a chord counts as the tangent, whose matrix is known already."""
END_WIDTH, BEFORE_END = 1e-5, 0.95
"""Width to which the end of a segment is found, and part of the way to it at which a point is taken."""
NEAR_ONE = 0.6
"""Modulus of a multiplier above which its change shortens a step; smaller ones are far from 1."""
LEAST_ANGLE, LEAST_MISS = 1e-6, 1e-9
"""Angle (rad) and relative miss of the guess below which a branch counts as straight; they are divided by."""
MIN_COSINE = 0.3
"""Least cosine between a chord and a tangent of the same branch."""
SMALL = 1e-5
"""Step along the tangent, in length scales, of the finite differences that give slopes."""
EXACT = 1e-13
"""Accuracy with which a zero is located, as a fraction of the step."""


def cubic(start_point: BranchPoint, end_point: BranchPoint) -> Array:
    """Compute the cubic x(t) through two points of a branch, with the directions of their tangents.

    Parameters
    ----------
    start_point, end_point : BranchPoint
        Neighbours on the branch.

    Returns
    -------
    (4, 2 n + 1) array
        Coefficients of ascending powers of t, which is 0 at the start and 1 at the end, dimensionless.
    """
    chord = end_point.x - start_point.x
    first, second = (_slope(chord, point.tangent) for point in (start_point, end_point))
    return np.array([start_point.x, first, 3.0 * chord - 2.0 * first - second, first + second - 2.0 * chord])


def _slope(chord: Array, tangent: Array) -> Array:
    """Return a tangent scaled to dx/dt of a cubic: so that its component along the chord is the chord's
    length.

    At a junction, where the tangent belongs to another branch, return the chord itself. Both are (2 n +
    1,).
    """
    along = chord @ tangent
    length = np.linalg.norm(chord)
    return chord if along < MIN_COSINE * length else length**2 / along * tangent


class Segment:
    """Points of a branch between two neighbours, by their position as a fraction of the chord from the
    first.

    The point at a fraction is the orbit in the plane across the chord there. Points that were solved for
    are stored.

    Parameters
    ----------
    period_map : PeriodMap
        Map whose fixed points they are.
    start_point, end_point : BranchPoint
        Neighbours on the branch, at fractions 0 and 1.
    """

    def __init__(self, period_map: PeriodMap, start_point: BranchPoint, end_point: BranchPoint) -> None:
        self.period_map, self.start_point, self.end_point = period_map, start_point, end_point
        self.chord = end_point.x - start_point.x
        self.length = float(np.linalg.norm(self.chord))
        self.points_by_fraction = {0.0: start_point, 1.0: end_point}

    def at(self, fraction: float) -> BranchPoint:
        """Return the point of the branch at a fraction of the chord; it is solved for once.

        Parameters
        ----------
        fraction : float
            Position as a fraction of the chord.

        Returns
        -------
        BranchPoint
            Point in the plane across the chord.
        """
        if fraction not in self.points_by_fraction:
            row = self.chord / self.length
            linear = self._near(fraction).linear
            self.points_by_fraction[fraction] = solve_point(
                self.period_map, self._guess(fraction), row, row, linear
            )
        return self.points_by_fraction[fraction]

    def extrema(self, fraction: float) -> Array:
        """Return the extrema of the deflections of the orbit at a fraction of the chord, without a new
        matrix of the map.

        Parameters
        ----------
        fraction : float
            Position as a fraction of the chord.

        Returns
        -------
        (m, 2, most) array
            See PeriodMap.extrema(), dimensionless.
        """
        if fraction in self.points_by_fraction:
            return self.points_by_fraction[fraction].extrema
        row = self.chord / self.length
        x = correct_state(self.period_map, self._guess(fraction), row, self._near(fraction).linear)
        return self.period_map.extrema(x[:-1], x[-1])

    def extremum_slope(self, fraction: float, stretch: float) -> Array:
        """Derivative of the extrema by the position on a part of the chord, from a small step along the
        tangent.

        Parameters
        ----------
        fraction : float
            Position as a fraction of the chord; its point must have been computed by at().
        stretch : float
            Length of the part, as a fraction of the chord.

        Returns
        -------
        (m, 2, most) array
            Change of each extremum over the part, dimensionless; 0 where there is no such extremum.
        """
        point = self.points_by_fraction[fraction]
        along = _slope(stretch * self.chord, point.tangent)
        step = SMALL / float(np.linalg.norm(along))
        x = point.x + step * along
        ahead = self.period_map.extrema(x[:-1], x[-1])
        now, then = point.extrema, np.full(point.extrema.shape, -np.inf)
        count = min(ahead.shape[2], now.shape[2])
        then[:, :, :count] = ahead[:, :, :count]
        is_finite = np.isfinite(now) & np.isfinite(then)
        return np.divide(np.subtract(then, now, where=is_finite, out=np.zeros(now.shape)), step)

    def matrix_slope(self, fraction: float, stretch: float) -> Array:
        """Derivative of the map's matrix by the position on a part of the chord.

        Parameters
        ----------
        fraction : float
            Position as a fraction of the chord; its point must have been computed by at().
        stretch : float
            Length of the part, as a fraction of the chord.

        Returns
        -------
        (2 n, 2 n) array
            Change of the matrix over the part, dimensionless.
        """
        point = self.points_by_fraction[fraction]
        along = _slope(stretch * self.chord, point.tangent)
        size = float(np.linalg.norm(along))
        is_tangent = along @ point.tangent > (1.0 - ALONG) * size
        direction = point.tangent if is_tangent else along / size
        return size * self.period_map.matrix_rate(point.x, direction, point.linear)

    def _near(self, fraction: float) -> BranchPoint:
        """Return the point, among those already solved for, whose fraction of the chord is nearest."""
        return self.points_by_fraction[
            min(self.points_by_fraction, key=lambda candidate: abs(candidate - fraction))
        ]

    def _guess(self, fraction: float) -> Array:
        """Interpolate x (2 n + 1,) at a fraction of the chord by a cubic between the solved points on
        both sides.
        """
        low = max(candidate for candidate in self.points_by_fraction if candidate < fraction)
        high = min(candidate for candidate in self.points_by_fraction if candidate > fraction)
        t = (fraction - low) / (high - low)
        return t ** np.arange(4) @ cubic(self.points_by_fraction[low], self.points_by_fraction[high])


def zero(test: Callable[[float], float], low: float, high: float, goal: float) -> float:
    """Find the zero of a test function of the fraction by Brent's method.

    Parameters
    ----------
    test : callable
        Function of the fraction.
    low, high : float
        Two fractions of the chord between which the test changes its sign.
    goal : float
        Magnitude of the test, in the test's unit, that counts as zero.

    Returns
    -------
    float
        Zero of the test, as a fraction of the chord.

    Raises
    ------
    NotConverged
        If the test has the same sign at both ends.
    """

    def rounded_test(fraction: float) -> float:
        value = test(fraction)
        return 0.0 if abs(value) <= goal else value

    try:
        return float(brentq(rounded_test, low, high, xtol=EXACT))
    except ValueError as error:
        raise NotConverged("branches", f"fractions {low:g} to {high:g} of a step", str(error)) from None


def reversal(
    period_map: PeriodMap, start_point: BranchPoint, end_point: BranchPoint
) -> tuple[BranchPoint, BranchPoint] | None:
    """Find where a branch of an even number of periods runs into its own image, shifted by half of them.

    There the change of the state over half the periods vanishes: the orbit has half the period, and the
    branch continues as its own image.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    start_point, end_point : BranchPoint
        Neighbours on the branch.

    Returns
    -------
    tuple of BranchPoint or None
        Point shortly before, and the orbit of half the period at which another branch doubles its period.
        None if the branch does not meet its image between the points.
    """
    if period_map.period % 2:
        return None
    half = period_map.over(period_map.period // 2)
    shift = half.gap(start_point.z, start_point.u)
    size = np.linalg.norm(shift)
    if shift @ half.gap(end_point.z, end_point.u) > -0.5 * size * np.linalg.norm(
        half.gap(end_point.z, end_point.u)
    ):
        return None
    segment = Segment(period_map, start_point, end_point)

    def left(fraction: float) -> float:
        point = segment.at(fraction)
        return float((half.gap(point.z, point.u) @ shift) / size**2)

    fraction = zero(left, 0.0, 1.0, END_WIDTH)
    return segment.at(BEFORE_END * fraction), segment.at(fraction)


STRAIGHT = 0.9
"""Least cosine between neighbouring tangents."""
CORRECTION = 0.2
"""Largest correction, as a fraction of the step."""
TURN, AIM, FASTEST = 0.3, 0.15, 2.5
"""Angle between tangents, rad, and ratio of correction to step for which a step is chosen; largest
growth of steps.
"""
DRIFT = 0.3
"""Largest change of the multipliers' moduli near the unit circle over a step."""
SURE = 1e-3
"""A change of parity over a longer step is tried again: the other leg of a fold may have been met."""


def step_along(
    period_map: PeriodMap, current_point: BranchPoint, before: BranchPoint | None, step: float
) -> BranchPoint:
    """Take one step along the tangent, bent as over the step before.

    Parameters
    ----------
    period_map : PeriodMap
        Map over whole mesh periods.
    current_point : BranchPoint
        Point from which to step.
    before : BranchPoint or None
        Point before it.
    step : float
        Length of the step, dimensionless.

    Returns
    -------
    BranchPoint
        The next point.

    Raises
    ------
    NotConverged
        If the step is refused, with the reason.
    """
    guess = _ahead(current_point, before, step)
    next_point = solve_point(
        period_map,
        guess,
        current_point.tangent,
        current_point.tangent,
        current_point.linear,
        CORRECTION * step,
    )
    reason = _refusal(current_point, next_point, step)
    if reason:
        raise NotConverged("branches", f"{period_map.family.name} = {next_point.value:.9g}", reason)
    return next_point


def _ahead(current_point: BranchPoint, before: BranchPoint | None, step: float) -> Array:
    """Predict x (2 n + 1,) one step ahead, along the tangent and bent as between the point `before` and
    this one.
    """
    guess = current_point.x + step * current_point.tangent
    if before is None:
        return guess
    bend = (current_point.tangent - before.tangent) / np.linalg.norm(current_point.x - before.x)
    return guess + 0.5 * step**2 * bend if np.linalg.norm(bend) * step < 0.5 else guess


def _refusal(current_point: BranchPoint, next_point: BranchPoint, step: float) -> str:
    """Return why a step is not accepted, or an empty string.

    Refused are steps of length `step` between whose ends the tangent turns too far, the parity changes,
    or multipliers near the unit circle move too far. Short steps at which bodies come loose are accepted.
    """
    chord = (next_point.x - current_point.x) / np.linalg.norm(next_point.x - current_point.x)
    straight = min(
        current_point.tangent @ next_point.tangent, chord @ current_point.tangent, chord @ next_point.tangent
    )
    if current_point.linear.neutral.shape != next_point.linear.neutral.shape and step <= SURE:
        return ""
    if straight < STRAIGHT:
        return "the branch turns too sharply"
    if current_point.parity != next_point.parity and step > SURE:
        return "the branch may have been left"
    if step > SURE and _drift(current_point, next_point) > DRIFT:
        return "multipliers move too far"
    return ""


def _drift(current_point: BranchPoint, next_point: BranchPoint) -> float:
    """Return the largest relative change of a multiplier's modulus between two points, in sorted order.

    Only moduli above NEAR_ONE count. The result is 0 where the numbers of multipliers differ.
    """
    first, second = np.abs(current_point.multipliers), np.abs(next_point.multipliers)
    if first.size != second.size:
        return 0.0
    near = (first > NEAR_ONE) | (second > NEAR_ONE)
    scale = np.maximum(np.maximum(first, second), 1.0)
    return float((np.abs(first - second) / scale)[near].max(initial=0.0))


def next_length(
    step: float, before: BranchPoint | None, current_point: BranchPoint, next_point: BranchPoint
) -> float:
    """Choose the length of the next step so that the tangent turns by TURN and the correction is AIM
    times the step.

    Both are extrapolated from the last step. The length changes by a factor of 0.5 to FASTEST.

    Parameters
    ----------
    step : float
        Length of the last step, dimensionless.
    before : BranchPoint or None
        Point before the last step's start.
    current_point, next_point : BranchPoint
        Start and end of the last step.

    Returns
    -------
    float
        Length of the next step, dimensionless.
    """
    angle = float(np.arccos(np.clip(current_point.tangent @ next_point.tangent, -1.0, 1.0)))
    off = float(np.linalg.norm(next_point.x - _ahead(current_point, before, step))) / step
    growth = min(TURN / max(angle, LEAST_ANGLE), np.sqrt(AIM / max(off, LEAST_MISS)))
    return step * float(np.clip(growth, 0.5, FASTEST))
