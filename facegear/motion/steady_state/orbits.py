"""Periodic orbits by Newton shooting (Parker and Chua 1989), and their Floquet multipliers (Seydel 2010)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array, ComplexArray, Mask
from facegear.motion.between_samples import by_modulus
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.records import RunResult

NEWTON_STEPS, MATRICES = 12, 3
"""Maximum number of Newton steps, and of matrices for them: what needs more is nowhere near an orbit."""
NEUTRAL = 1e-9
"""Directions in which the change over a period moves less than this, relatively, are left alone by Newton."""
UNIT_TOLERANCE = 1e-6
"""A multiplier may exceed one by this: that of a neutral direction is one."""
RETURNS = 3
"""Number of successive returns that must follow an orbit's multipliers."""
ROUNDING = 1e-11
"""Change over a period, over the length scale, that rounding alone may leave."""


@dataclass(frozen=True, eq=False)
class Orbit:
    """A periodic orbit through a state, with its Floquet multipliers.

    Attributes
    ----------
    state : (2, n) array
        Coordinates and their derivatives by phase.
    period : int
        Number of mesh periods.
    residual : float
        Change over the period over the length scale, also an error estimate once Newton's method has
        converged.
    multipliers : (2 n,) array
        Complex Floquet multipliers, largest modulus first: eigenvalues of the monodromy matrix in states
        by phase.
    vectors : (2 n, 2 n) array
        Their eigenvectors, by column.
    liouville : float
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
    def is_off_circle(self) -> Mask:
        """Mask (2 n,) of the multipliers off the unit circle by more than UNIT_TOLERANCE; the others
        count as neutral.
        """
        return np.abs(1.0 - np.abs(self.multipliers)) > UNIT_TOLERANCE

    @property
    def spectral_radius(self) -> float:
        """Largest magnitude among the multipliers, without those of neutral directions."""
        return float(np.abs(self.multipliers[self.is_off_circle]).max(initial=0.0))

    def parts(self, off: Array) -> ComplexArray:
        """Return the components of states off the orbit along its eigenvectors, in the order of the
        multipliers.

        Parameters
        ----------
        off : (..., 2, n) array
            Differences of states from the orbit, m and m/rad.

        Returns
        -------
        (..., 2 n) array
            Components along the eigenvectors, m.
        """
        return np.asarray(off.reshape(*off.shape[:-2], -1) @ self._inverse.T)

    @cached_property
    def _inverse(self) -> ComplexArray:
        """Pseudoinverse (2 n, 2 n) of the matrix of eigenvectors, some of which may be parallel to
        rounding.
        """
        return np.asarray(np.linalg.pinv(self.vectors, rcond=len(self.vectors) * np.finfo(float).eps))

    def distance(self, integrator: Integrator, state: Array, rates: float = 1.0) -> float:
        """Return the distance of a state from the orbit's `state`, as change() measures it.

        Shifts along neutral directions are left out. Other states of the orbit are not considered.

        Parameters
        ----------
        integrator : Integrator
            Integrates the system at one mesh frequency.
        state : (2, n) array
            State by phase, m and m/rad.
        rates : float
            A factor by which velocities are divided.

        Returns
        -------
        float
            Distance over the length scale, dimensionless.
        """
        off = state - self.state
        neutral = ~self.is_off_circle
        if neutral.any():
            neutral_part = self.vectors[:, neutral] @ self.parts(off)[neutral]
            off -= neutral_part.real.reshape(2, -1)
        off[1] /= rates
        return change(integrator, off, 0.0 * off)

    def leading_disturbance(self, integrator: Integrator, off: Array) -> Array:
        """Return a disturbance of size one, as change() measures it, along the eigenvector of the largest
        multiplier.

        Parameters
        ----------
        integrator : Integrator
            Integrates the system at one mesh frequency.
        off : (2, n) array
            Difference of a state from the orbit, m and m/rad; the disturbance is on its side.

        Returns
        -------
        (2, n) array
            Disturbance by phase, m and m/rad.
        """
        side = self.parts(off)[0]
        is_resolved = abs(side) > ROUNDING * integrator.scale
        along = self.vectors[:, 0] * (side / abs(side) if is_resolved else 1.0)
        leading = along.real.reshape(2, -1)
        return leading / change(integrator, leading, 0.0 * leading)


def change(integrator: Integrator, first: Array, second: Array) -> float:
    """Return the largest difference of two states, each coordinate and rate weighted as a mesh
    deflection.

    It is the largest component of abs(first - second) times the integrator's weights, over the length scale.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    first, second : (2, n) array
        States by phase, m and m/rad.

    Returns
    -------
    float
        Difference over the length scale, dimensionless.
    """
    return float(largest(integrator, (first - second)[None])[0])


def largest(integrator: Integrator, gaps: Array) -> Array:
    """Return the largest weighted component of each of several differences of states, see change().

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    gaps : (K, 2, n) array
        Differences by phase, m and m/rad; overwritten.

    Returns
    -------
    (K,) array
        Largest component over the length scale, dimensionless.
    """
    np.abs(gaps, out=gaps)
    gaps *= integrator.weights / integrator.scale
    return np.asarray(gaps.reshape(len(gaps), gaps.shape[1] * gaps.shape[2]).max(axis=1))


def changes(integrator: Integrator, ends: Array, longest: int) -> Array:
    """Return the change() of the last state of a run from each of the states 1 to `longest` periods
    before it.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    ends : (periods, 2, n) array
        States at the ends of mesh periods, m and m/rad.
    longest : int
        Largest number of mesh periods.

    Returns
    -------
    (min(longest, periods - 1),) array
        Change after 1, 2, ... periods over the length scale, dimensionless.
    """
    return largest(integrator, ends[-1] - ends[-2 : -2 - min(longest, len(ends) - 1) : -1])


def monodromy(integrator: Integrator, state: Array, period: int) -> tuple[Array, RunResult]:
    """Compute the monodromy matrix of the map over some mesh periods at a state, and the run.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase, m and m/rad.
    period : int
        Number of mesh periods.

    Returns
    -------
    (2 n, 2 n) array
        Monodromy matrix in coordinates and rates by phase, factors of 1.
    RunResult
        The run with its tangents.

    Raises
    ------
    NotConverged
        If a step fails.
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
    """Linearised map over the period at a state (2 n,): its matrix (2 n, 2 n), eigenvalues and
    eigenvectors, largest first.

    `divergence` is the integral of the trace of the equations' matrix over the period.
    """

    state: Array
    matrix: Array
    multipliers: ComplexArray
    vectors: ComplexArray
    divergence: float

    @property
    def slowness(self) -> float:
        """Distance of the multipliers from the unit circle (at least 1e-3), by which a residual is divided.

        The multiplier of a neutral direction, along which a disturbance stays as it is, does not count.
        """
        off = np.abs(1.0 - np.abs(self.multipliers))
        return max(float(off[off > UNIT_TOLERANCE].min(initial=1.0)), 1e-3)

    def correction(self, gap: Array) -> Array:
        """Return Newton's step (2 n,) of the state for its change `gap` (2 n,), end less start, over the
        period.

        Positions along neutral directions are free: the solution of minimum norm leaves them.
        """
        matrix = np.eye(gap.size) - self.matrix
        if np.abs(1.0 - self.multipliers).min() > UNIT_TOLERANCE:
            return np.asarray(np.linalg.solve(matrix, gap), np.float64)
        return np.asarray(np.linalg.lstsq(matrix, gap, rcond=NEUTRAL)[0], np.float64)


def shoot(
    integrator: Integrator, state: Array, period: int, goal: float, matrices: int = MATRICES
) -> Orbit | None:
    """Solve for an orbit by Newton's method on the change over the period.

    A matrix is used as long as each step with it gains a digit. It is the orbit's own if the orbit lies
    within ten steps' errors of where it was computed. An orbit is accepted when the change is so small that
    the orbit is known to the goal.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        Guess by phase, m and m/rad.
    period : int
        Number of mesh periods.
    goal : float
        Error of the orbit over the length scale, dimensionless.
    matrices : int
        Largest number of matrices computed on the way.

    Returns
    -------
    Orbit or None
        Orbit, of the shortest period that it repeats after; None if the method does not converge near the
        start.
    """
    current_state, tolerance = state.copy(), integrator.tolerance
    best, gain = np.inf, 0.0
    tangent: _Tangent | None = None
    for _ in range(NEWTON_STEPS):
        if gain < 0.1 and tangent is not None:
            result = integrator.run(current_state, period, fine=True)
        elif matrices > 0:
            result, tangent = _linearised(integrator, current_state, period)
            matrices -= 1
        else:
            return None
        residual = change(integrator, current_state, result.state)
        if not residual < 4.0 * best:
            return None
        shortest = shortest_period(integrator, current_state, result.ends, max(residual, goal))
        if residual <= goal and shortest < period:
            return shoot(integrator, current_state, shortest, goal)
        # Newton's method cannot do better than the steps and their rounding.
        has_stalled = residual > 0.5 * best and residual <= max(tolerance * tangent.slowness, ROUNDING)
        if residual <= goal * min(1.0, tangent.slowness) or has_stalled:
            if change(integrator, current_state, tangent.state) > 10.0 * tolerance:
                _, tangent = _linearised(integrator, current_state, period)
            return _orbit(current_state, period, residual, tangent)
        gain = residual / best if np.isfinite(best) else 0.0
        best = min(best, residual)
        correction = tangent.correction((result.state - current_state).ravel())
        current_state = current_state + correction.reshape(2, -1)
    return None


def _linearised(integrator: Integrator, state: Array, period: int) -> tuple[RunResult, _Tangent]:
    """Run from a state (2, n) over the period, and return the run and the map linearised there."""
    matrix, result = monodromy(integrator, state, period)
    multipliers, vectors = np.linalg.eig(matrix)
    order = by_modulus(multipliers)
    return result, _Tangent(state, matrix, multipliers[order], vectors[:, order], result.divergence)


def shortest_period(integrator: Integrator, start: Array, ends: Array, residual: float) -> int:
    """Find the smallest number of mesh periods after which an orbit has closed, to ten times its residual.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    start : (2, n) array
        State by phase at the start, m and m/rad.
    ends : (periods, 2, n) array
        States at the ends of the mesh periods, m and m/rad.
    residual : float
        Change over all periods over the length scale, dimensionless.

    Returns
    -------
    int
        Number of mesh periods.
    """
    for period in range(1, len(ends)):
        if len(ends) % period == 0 and change(integrator, start, ends[period - 1]) <= 10.0 * residual:
            return period
    return len(ends)


def _orbit(state: Array, period: int, residual: float, tangent: _Tangent) -> Orbit:
    """Build an orbit from a converged state, with the multipliers of `tangent` and their check by
    Liouville's formula.
    """
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
    """Whether a run at some distance from a stable orbit can never leave it again.

    It does if the distance is within the error of the steps, and small beside what the slowest disturbance
    loses in a period.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    orbit : Orbit
        Stable orbit.
    distance : float
        Distance of the run over the length scale, dimensionless.

    Returns
    -------
    bool
        True if no further check is needed.
    """
    slow = 1.0 - orbit.spectral_radius
    return distance <= min(10.0 * integrator.tolerance / slow, 0.1 * slow)


def drawn_in(integrator: Integrator, orbit: Orbit, ends: Array, since: int) -> bool:
    """Whether nothing can lead a run away from a stable orbit any more.

    Each return must be what the multipliers make of the one before, but for less than half of what they take
    away. Then the distance, measured along the orbit's own eigenvectors, falls for ever, because what the
    multipliers leave out falls faster still. Within the error of the steps nothing more is required.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    orbit : Orbit
        Stable orbit.
    ends : (periods, 2, n) array
        States of the run at the ends of mesh periods, m and m/rad.
    since : int
        Number of mesh periods between the last end and the last one at which the orbit is at its `state`.

    Returns
    -------
    bool
        True if the orbit attracts the run.
    """
    back = ends[len(ends) - 1 - since :: -orbit.period][: RETURNS + 1][::-1]
    if len(back) < RETURNS + 1:
        return False
    off = back - orbit.state
    is_off_circle, slow = orbit.is_off_circle, 1.0 - orbit.spectral_radius
    distance = (integrator.weights * np.abs(off[-1])).max() / integrator.scale
    if near_for_ever(integrator, orbit, distance):
        return True
    parts = orbit.parts(off)[:, is_off_circle]
    deviations = np.linalg.norm(parts[1:] - orbit.multipliers[is_off_circle] * parts[:-1], axis=1)
    return bool((deviations < 0.5 * slow * np.linalg.norm(parts[:-1], axis=1)).all())
