"""The stretch of a branch between two neighbouring points, and zeros of tests along it."""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from facegear.arrays import Array
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import BranchPoint, correct_state, solve_point
from facegear.errors import NotConverged

ALIGNED = 0.3
"""Least cosine between a chord and a tangent of the same branch."""
SMALL = 1e-5
"""Step along the tangent, in length scales, over which slopes are taken."""
EXACT = 1e-13
"""Part of a step down to which a zero is placed."""


def cubic(here: BranchPoint, there: BranchPoint) -> Array:
    """The cubic through two points of a branch along their tangents: coefficients (4, 2 n + 1) of ascending
    powers of the fraction of their chord.
    """
    chord = there.x - here.x
    first, second = (_slope(chord, point.tangent) for point in (here, there))
    return np.array([here.x, first, 3.0 * chord - 2.0 * first - second, first + second - 2.0 * chord])


def _slope(chord: Array, tangent: Array) -> Array:
    """A tangent as long as the chord along it; the chord at a junction, whose tangent is another branch's."""
    along = chord @ tangent
    length = np.linalg.norm(chord)
    return chord if along < ALIGNED * length else length**2 / along * tangent


class Segment:
    """Points of a branch between two neighbours, by their fraction of the chord."""

    def __init__(self, period_map: PeriodMap, here: BranchPoint, there: BranchPoint) -> None:
        self.period_map, self.here, self.there = period_map, here, there
        self.chord = there.x - here.x
        self.length = float(np.linalg.norm(self.chord))
        self.known = {0.0: here, 1.0: there}

    def at(self, fraction: float) -> BranchPoint:
        """The point of the branch at a fraction of the chord."""
        if fraction not in self.known:
            row = self.chord / self.length
            linear = self._near(fraction).linear
            self.known[fraction] = solve_point(self.period_map, self._guess(fraction), row, row, linear)
        return self.known[fraction]

    def extrema(self, fraction: float) -> Array:
        """Extrema of the deflections at a fraction, without the matrix of the map."""
        if fraction in self.known:
            return self.known[fraction].extrema
        row = self.chord / self.length
        x = correct_state(self.period_map, self._guess(fraction), row, self._near(fraction).linear)
        return self.period_map.extrema(x[:-1], x[-1])

    def extremum_slope(self, fraction: float, stretch: float) -> Array:
        """Change of the extrema of a known point with its position on a stretch of the chord, by a small
        step along the tangent.
        """
        point = self.known[fraction]
        along = _slope(stretch * self.chord, point.tangent)
        step = SMALL / float(np.linalg.norm(along))
        x = point.x + step * along
        ahead = self.period_map.extrema(x[:-1], x[-1])
        now, then = point.extrema, np.full(point.extrema.shape, -np.inf)
        count = min(ahead.shape[2], now.shape[2])
        then[:, :, :count] = ahead[:, :, :count]
        known = np.isfinite(now) & np.isfinite(then)
        return np.divide(np.subtract(then, now, where=known, out=np.zeros(now.shape)), step)

    def matrix_slope(self, fraction: float, stretch: float) -> Array:
        """Change of the map's matrix (2 n, 2 n) with the position on a stretch of the chord, at a known
        point.
        """
        point = self.known[fraction]
        along = _slope(stretch * self.chord, point.tangent)
        size = float(np.linalg.norm(along))
        is_tangent = along @ point.tangent > (1.0 - 1e-9) * size
        direction = point.tangent if is_tangent else along / size
        return size * self.period_map.matrix_rate(point.x, direction, point.linear)

    def _near(self, fraction: float) -> BranchPoint:
        return self.known[min(self.known, key=lambda other: abs(other - fraction))]

    def _guess(self, fraction: float) -> Array:
        """Cubic between the nearest known points, with their tangents."""
        low = max(other for other in self.known if other < fraction)
        high = min(other for other in self.known if other > fraction)
        t = (fraction - low) / (high - low)
        return t ** np.arange(4) @ cubic(self.known[low], self.known[high])


def zero(test: Callable[[float], float], low: float, high: float, goal: float) -> float:
    """Where a test of fractions is zero, to `goal` in the test. Raises NotConverged without a sign change."""

    def rounded(fraction: float) -> float:
        value = test(fraction)
        return 0.0 if abs(value) <= goal else value

    try:
        return float(brentq(rounded, low, high, xtol=EXACT))
    except ValueError as error:
        raise NotConverged("branches", f"fractions {low:g} to {high:g} of a step", str(error)) from None


def reversal(
    period_map: PeriodMap, here: BranchPoint, there: BranchPoint
) -> tuple[BranchPoint, BranchPoint] | None:
    """Where a branch of several periods runs into its own image, shifted by half of them: the point shortly
    before, and the orbit of half the period at which another branch doubles.
    """
    if period_map.period % 2:
        return None
    half = period_map.over(period_map.period // 2)
    shift = half.gap(here.z, here.u)
    size = np.linalg.norm(shift)
    if shift @ half.gap(there.z, there.u) > -0.5 * size * np.linalg.norm(half.gap(there.z, there.u)):
        return None
    segment = Segment(period_map, here, there)

    def left(fraction: float) -> float:
        point = segment.at(fraction)
        return float((half.gap(point.z, point.u) @ shift) / size**2)

    fraction = zero(left, 0.0, 1.0, 1e-5)
    return segment.at(0.95 * fraction), segment.at(fraction)
