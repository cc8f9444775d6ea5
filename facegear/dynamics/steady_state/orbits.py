"""Periodic orbits by Newton shooting (Parker and Chua 1989), and their Floquet multipliers (Seydel 2010)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array, ComplexArray, Mask
from facegear.dynamics.integrator.integrator import Integrator, RunResult
from facegear.dynamics.multiplier_order import by_modulus

NEWTON_STEPS, MATRICES = 12, 3
"""Steps that Newton's method may take, and matrices for them: what needs more is nowhere near an orbit."""
NEUTRAL = 1e-9
"""Directions in which the change over a period moves less than this, relatively, are left alone by Newton."""
UNIT_TOLERANCE = 1e-6
"""A multiplier may exceed one by this: that of a neutral direction is one."""
RETURNS = 3
"""Returns in succession that must follow an orbit's multipliers."""
ROUNDING = 1e-11
"""Change over a period, over the length scale, that rounding alone may leave."""


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic orbit through a state, with its Floquet multipliers.

    Attributes
    ----------
    state : (2, n)
        By phase.
    period
        In mesh periods.
    residual
        Change over the period over the length scale, also an error estimate once Newton has settled.
    multipliers : (2 n,)
        Complex, largest first.
    vectors : (2 n, 2 n)
        Their directions, by column.
    liouville
        Log det of the monodromy matrix less the integral of the divergence, which is zero for an exact
        solution (NaN where the matrix is singular to rounding).
    """

    state: Array
    period: int
    residual: float
    multipliers: ComplexArray
    vectors: ComplexArray
    liouville: float

    @property
    def moving(self) -> Mask:
        """Which multipliers (2 n,) lie off the unit circle: all but those of neutral directions."""
        return np.abs(1.0 - np.abs(self.multipliers)) > UNIT_TOLERANCE

    @property
    def holding(self) -> float:
        """By which factor a period brings the slowest disturbance back, neutral directions left out."""
        return float(np.abs(self.multipliers[self.moving]).max(initial=0.0))

    def parts(self, off: Array) -> ComplexArray:
        """Components (..., 2 n) of states (..., 2, n) off the orbit along its own directions."""
        return np.asarray(off.reshape(*off.shape[:-2], -1) @ self._inverse.T)

    @cached_property
    def _inverse(self) -> ComplexArray:
        """Pseudoinverse (2 n, 2 n) of the directions, some of which may be parallel to rounding."""
        return np.asarray(np.linalg.pinv(self.vectors, rcond=len(self.vectors) * np.finfo(float).eps))

    def distance(self, integrator: Integrator, state: Array, rates: float = 1.0) -> float:
        """How far a state (2, n) is off, as a change(), whatever its neutral directions.

        rates: by which velocities are divided.
        """
        off = state - self.state
        neutral = ~self.moving
        if neutral.any():
            shifted = self.vectors[:, neutral] @ self.parts(off)[neutral]
            off -= shifted.real.reshape(2, -1)
        off[1] /= rates
        return change(integrator, off, 0.0 * off)

    def leaving(self, integrator: Integrator, off: Array) -> Array:
        """A state (2, n) of change() one along the leading direction, to the side of `off`."""
        side = self.parts(off)[0]
        known = abs(side) > ROUNDING * integrator.scale
        along = self.vectors[:, 0] * (side / abs(side) if known else 1.0)
        leading = along.real.reshape(2, -1)
        return leading / change(integrator, leading, 0.0 * leading)


def change(integrator: Integrator, first: Array, second: Array) -> float:
    """Largest difference of two states (2, n) as mesh deflections and their rates, over the length scale."""
    return float(largest(integrator, (first - second)[None])[0])


def largest(integrator: Integrator, gaps: Array) -> Array:
    """Largest component of each of some differences of states (K, 2, n), counted as in change()."""
    np.abs(gaps, out=gaps)
    gaps *= integrator.weights / integrator.scale
    return np.asarray(gaps.reshape(len(gaps), gaps.shape[1] * gaps.shape[2]).max(axis=1))


def changes(integrator: Integrator, ends: Array, longest: int) -> Array:
    """change() of the last of `ends` (periods, 2, n) from those 1 .. longest periods before it."""
    return largest(integrator, ends[-1] - ends[-2 : -2 - min(longest, len(ends) - 1) : -1])


def monodromy(integrator: Integrator, state: Array, period: int) -> tuple[Array, RunResult]:
    """The matrix (2 n, 2 n) of the map over `period` mesh periods at a state (2, n), and the run.

    Raises NotConverged where a step fails.
    """
    n = integrator.size
    tangents = np.zeros((2 * n, 2, n))
    rows = np.arange(n)
    tangents[rows, 0, rows] = 1.0
    tangents[n + rows, 1, rows] = 1.0
    result = integrator.run(state, period, tangents)
    return result.tangents.reshape(2 * n, 2 * n).T, result


@dataclass(frozen=True, eq=False)
class _Tangent:
    """The map over the period near a state: matrix, its eigenvalues and vectors, largest first."""

    state: Array
    matrix: Array
    multipliers: ComplexArray
    vectors: ComplexArray
    divergence: float

    @property
    def slowness(self) -> float:
        """How far the multipliers stay from the unit circle (at least 1e-3), by which a residual is divided.

        That of a neutral direction, along which a disturbance stays as it is, does not count.
        """
        off = np.abs(1.0 - np.abs(self.multipliers))
        return max(float(off[off > UNIT_TOLERANCE].min(initial=1.0)), 1e-3)

    def correction(self, gap: Array) -> Array:
        """Newton's step for a change (2 n,) over the period.

        Positions along neutral directions are free: the solution of minimum norm keeps them.
        """
        matrix = np.eye(gap.size) - self.matrix
        if np.abs(1.0 - self.multipliers).min() > UNIT_TOLERANCE:
            return np.asarray(np.linalg.solve(matrix, gap), np.float64)
        return np.asarray(np.linalg.lstsq(matrix, gap, rcond=NEUTRAL)[0], np.float64)


def shoot(
    integrator: Integrator, state: Array, period: int, goal: float, matrices: int = MATRICES
) -> Orbit | None:
    """Newton's method on the change over `period` mesh periods; None if it does not settle near the start.

    A matrix serves as long as each step with it gains a digit, and is the orbit's own if that lies within ten
    steps' errors of where it was taken; there may be `matrices` of them on the way. An orbit is accepted when
    the change is so small that the orbit is known to the goal.
    """
    here, tolerance = state.copy(), integrator.tolerance
    best, gained = np.inf, 0.0
    tangent: _Tangent | None = None
    for _ in range(NEWTON_STEPS):
        if gained < 0.1 and tangent is not None:
            result = integrator.run(here, period, fine=True)
        elif matrices > 0:
            result, tangent = _linearised(integrator, here, period)
            matrices -= 1
        else:
            return None
        residual = change(integrator, here, result.state)
        if not residual < 4.0 * best:
            return None
        shortest = shortest_period(integrator, here, result.ends, max(residual, goal))
        if residual <= goal and shortest < period:
            return shoot(integrator, here, shortest, goal)
        # Newton's method cannot do better than the steps and their rounding.
        stalled = residual > 0.5 * best and residual <= max(tolerance * tangent.slowness, ROUNDING)
        if residual <= goal * min(1.0, tangent.slowness) or stalled:
            if change(integrator, here, tangent.state) > 10.0 * tolerance:
                _, tangent = _linearised(integrator, here, period)
            return _orbit(here, period, residual, tangent)
        gained = residual / best if np.isfinite(best) else 0.0
        best = min(best, residual)
        correction = tangent.correction((result.state - here).ravel())
        here = here + correction.reshape(2, -1)
    return None


def _linearised(integrator: Integrator, state: Array, period: int) -> tuple[RunResult, _Tangent]:
    """The run from a state (2, n) over the period, and the map near it."""
    matrix, result = monodromy(integrator, state, period)
    multipliers, vectors = np.linalg.eig(matrix)
    order = by_modulus(multipliers)
    return result, _Tangent(state, matrix, multipliers[order], vectors[:, order], result.divergence)


def shortest_period(integrator: Integrator, start: Array, ends: Array, residual: float) -> int:
    """Smallest number of mesh periods after which an orbit has closed already, to ten times its residual."""
    for period in range(1, len(ends)):
        if len(ends) % period == 0 and change(integrator, start, ends[period - 1]) <= 10.0 * residual:
            return period
    return len(ends)


def _orbit(state: Array, period: int, residual: float, tangent: _Tangent) -> Orbit:
    multipliers = tangent.multipliers
    sign, volume = np.linalg.slogdet(tangent.matrix)
    condition_lost = np.log(np.finfo(float).eps) * 0.9 > np.log(
        max(abs(multipliers[-1]), 1e-300) / max(abs(multipliers[0]), 1e-300)
    )
    liouville = np.nan if condition_lost or sign <= 0 else float(volume - tangent.divergence)
    return Orbit(
        state=state,
        period=period,
        residual=residual,
        multipliers=multipliers,
        vectors=tangent.vectors,
        liouville=liouville,
    )


def near_for_ever(integrator: Integrator, orbit: Orbit, distance: float) -> bool:
    """Whether a run so far off a stable orbit stays there: within the error of the steps, and where the
    slowest disturbance is held.
    """
    slow = 1.0 - orbit.holding
    return distance <= min(10.0 * integrator.tolerance / slow, 0.1 * slow)


def drawn_in(integrator: Integrator, orbit: Orbit, ends: Array, since: int) -> bool:
    """Whether nothing can lead a run away from a stable orbit any more.

    ends (periods, 2, n) of the run, the last of them `since` periods after one that belongs to the orbit's
    state. Each return must be what the multipliers make of the one before, but for less than half of what
    they take away; then the distance, measured along the orbit's own directions, falls for ever, as what the
    multipliers leave out falls faster still. Within the error of the steps there is no more to ask.
    """
    back = ends[len(ends) - 1 - since :: -orbit.period][: RETURNS + 1][::-1]
    if len(back) < RETURNS + 1:
        return False
    off = back - orbit.state
    moving, slow = orbit.moving, 1.0 - orbit.holding
    distance = (integrator.weights * np.abs(off[-1])).max() / integrator.scale
    if near_for_ever(integrator, orbit, distance):
        return True
    parts = orbit.parts(off)[:, moving]
    missed = np.linalg.norm(parts[1:] - orbit.multipliers[moving] * parts[:-1], axis=1)
    return bool((missed < 0.5 * slow * np.linalg.norm(parts[:-1], axis=1)).all())
