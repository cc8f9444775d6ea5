"""Run from any start to the periodic motion to which the run itself comes, if it does."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array, Mask
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.requests import RunPlan, RunRequest, alone
from facegear.motion.steady_state.orbits import (
    MATRICES,
    UNIT_TOLERANCE,
    Orbit,
    changes,
    drawn_in,
    largest,
    shoot,
)
from facegear.motion.steady_state.periodicity import (
    SMALL,
    TREND,
    VERY_SMALL,
    BestReturn,
    KnownOrbit,
    StateHistory,
    best_return,
    closed_period,
)

NEWTON_COST = 20
"""Number of mesh periods that take as much time as one with all tangents."""
NEWTON_STEPS = 2
"""Usual number of mesh periods with tangents that Newton's method needs."""
SHORT = 8
"""Longest period, in mesh periods, that Newton's method tries before the change over it is very small."""
BLOCK, LONG_BLOCK = 16, 128
"""Smallest and largest number of periods in a block, which is else half of what was run before.

Each call of the kernels has a price.
"""
KICK = 0.01
"""Size, as by change(), of the disturbance along the leading direction of an unstable orbit that holds a
run.
"""
MAX_KICKS = 2
"""Maximum number of kicks in a run."""
LONGER = 4
"""Factor on the maximum number of periods of a run that comes nearer and nearer."""
CREEP = 0.01
"""Fraction of the goal to which the change over a period must fall where Newton's method finds no orbit."""
NOISE, MAX_SPECTRAL_RADIUS = 50.0, 0.95
"""Distance, in tolerances, by which new steps in each period may move a run; spectral radius of an orbit that
holds a run this near. Along a neutral direction the error of the steps accumulates.
"""
FEW_PERIODS = 16
"""Number of mesh periods with changes that are not small up to which a run counts as going straight to its
orbit: a start from rest needs some before it is near any motion. The orbit that a run reaches later may be a
matter of chance.
"""


@dataclass(frozen=True, eq=False)
class SettlingResult:
    """Motion in which a run settled.

    Attributes
    ----------
    state : (2, n) array
        State by phase at the end of the run, or of the orbit if it was refined.
    period : int
        Number of mesh periods; 0 if the motion does not repeat.
    residual : float
        Change over the period, over the length scale.
    orbit : Orbit or None
        Orbit with its multipliers, if it was refined.
    periods_run : int
        Number of mesh periods run.
    ends : (periods, 2, n) array
        Last states at the ends of mesh periods, oldest first, m and m/rad; the oldest of a long run are
        dropped.
    is_known_orbit : bool
        Whether it is the orbit that was known before.
    aperiodic_until : int
        Number of periods after which the run was last seen to be near no periodic motion.
    """

    state: Array
    period: int
    residual: float
    orbit: Orbit | None
    periods_run: int
    ends: Array
    is_known_orbit: bool = False
    aperiodic_until: int = 0


def count_unsteady_periods(integrator: Integrator, run: SettlingResult, period: int) -> int:
    """Count the periods of a run before the last change over a period that is not small.

    The count is 0 if there are at most FEW_PERIODS such changes. Of a run so long that its first states are
    not kept, it is the number of periods after which the run was last seen to be near no periodic motion: a
    run that comes slowly to its orbit, as beside a branch point, is long but not unsteady.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    run : SettlingResult
        The run and its last states.
    period : int
        Period of its orbit, mesh periods.

    Returns
    -------
    int
        Number of mesh periods.
    """
    is_large = _changes_are_large(integrator, run.ends, period)
    if is_large.sum() > FEW_PERIODS:
        quiet = int(is_large[::-1].argmax())
        return max(run.periods_run - quiet, 0)
    return run.aperiodic_until if run.periods_run > len(run.ends) else 0


def _changes_are_large(integrator: Integrator, ends: Array, period: int) -> Mask:
    """Return at which of the mesh periods after the first `period` the change over a period is above
    SMALL, a mask.

    `ends` (periods, 2, n) are the states at the ends of mesh periods.
    """
    return largest(integrator, ends[period:] - ends[: len(ends) - period]) > SMALL


def settle(
    integrator: Integrator,
    state: Array,
    settings: Settings,
    ends: Array | None = None,
    known_orbit: KnownOrbit | None = None,
) -> SettlingResult:
    """Run a single system until it settles, see settling(); no other run is integrated beside it.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    settings : Settings
        Settings of the run.
    ends : (periods, 2, n) array, optional
        States through which the run passed before, oldest first, m and m/rad.
    known_orbit : KnownOrbit, optional
        Orbit near which the run ends at once.

    Returns
    -------
    SettlingResult
        Where the run came to rest.
    """
    return alone(settling(integrator, state, settings, ends, known_orbit))


def settling(
    integrator: Integrator,
    state: Array,
    settings: Settings,
    ends: Array | None = None,
    known_orbit: KnownOrbit | None = None,
) -> RunPlan[SettlingResult]:
    """Run until the state repeats after 1 .. longest_period periods, or the maximum number of periods is
    reached.

    With `refine` the orbit to which the run tends is found by Newton's method as soon as that pays. It is
    accepted only once it attracts the run. An unstable orbit, on which exact symmetry may hold a run, is left
    by a kick.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    settings : Settings
        Settings of the run.
    ends : (periods, 2, n) array, optional
        States through which the run passed before, oldest first, m and m/rad.
    known_orbit : KnownOrbit, optional
        Orbit near which the run ends at once.

    Returns
    -------
    RunPlan of SettlingResult
        Generator for requests.alone() or side_by_side(), which returns where the run came to rest.
    """
    return SettlingRun(integrator, state, settings, ends, known_orbit).settle()


class SettlingRun:
    """A run that has not settled yet; settle() makes a run plan of it.

    `orbit` is the last to which Newton's method came, after `orbit_at` periods. `block` is the least
    number of periods in a block, `dwell` the number before anything is decided; `history` holds the last
    states.

    Newton's method, whose cost is counted in mesh periods, may take as long as the run itself.
    """

    def __init__(
        self,
        integrator: Integrator,
        state: Array,
        settings: Settings,
        ends: Array | None,
        known_orbit: KnownOrbit | None = None,
    ) -> None:
        self.integrator, self.settings = integrator, settings
        self.state, self.known_orbit = state.copy(), known_orbit
        self.history = StateHistory(4 * settings.longest_period + 2 * TREND + LONG_BLOCK, state.shape)
        if ends is not None:
            self.history.reserve(len(ends))[:] = ends
        self.initial_count = len(self.ends)
        self.periods_run = self.kicks = self.newton_cost = self.aperiodic_until = 0
        self.orbit: Orbit | None = None
        self.orbit_at = 0
        self.tried_residuals: dict[int, float] = {}
        self.block, self.dwell = _blocks(integrator, settings)

    @property
    def ends(self) -> Array:
        """Last states (periods, 2, n) at the ends of mesh periods, oldest first, m and m/rad."""
        return self.history.states

    def settle(self) -> RunPlan[SettlingResult]:
        """Continue, block by block, until the run has settled or the maximum number of periods is reached.

        Returns
        -------
        RunPlan of SettlingResult
            Generator for requests.alone() or side_by_side(), which returns where the run came to rest.
        """
        while True:
            yield from self._advance()
            if known_result := self._match_known_orbit():
                return known_result
            if self.periods_run < self.dwell and not self.initial_count:
                continue
            last = self.periods_run >= self.settings.settle
            near = best_return(self.integrator, self.ends, self.settings)
            if near.residual > SMALL:
                self.aperiodic_until = self.periods_run
            result = self._find_orbit(near, last) if self.settings.refine else None
            if result is None and len(self.ends):
                result = self._by_itself(near, last)
            if result is not None:
                return result
            if not len(self.ends):  # after a kick the run begins anew
                continue
            closer = near.shrinking and near.trend < 1.0
            if last and not (closer and self.periods_run < LONGER * self.settings.settle):
                return self._in_noise(near) or self._result(0, near.residual, None)

    def _match_known_orbit(self) -> SettlingResult | None:
        """Return the result with a state of the orbit that was known before, if the run has come to it,
        else None.
        """
        if self.known_orbit is None or not len(self.ends):
            return None
        match = self.known_orbit.attracting_state(self.integrator, self.ends)
        if match is None:
            return None
        state, off = match
        return replace(
            self._result(self.known_orbit.orbit.period, off, None), state=state, is_known_orbit=True
        )

    def _advance(self) -> RunPlan[None]:
        """Run plan of a further block of periods; their end states go to the history."""
        settings = self.settings
        block = min(max(self.block, self.periods_run // 2), max(self.block, LONG_BLOCK))
        if not self.initial_count and self.known_orbit is None:
            block = max(block, self.dwell - self.periods_run)
        if self.periods_run < settings.settle:
            block = min(block, settings.settle - self.periods_run)
        run = yield RunRequest(self.integrator, self.state, block)
        self.state = run.state
        self.history.reserve(block)[:] = run.ends
        self.periods_run += block

    def _find_orbit(self, near: BestReturn, last: bool) -> SettlingResult | None:
        """Return the result for the orbit that attracts the run, if there is one, else None.

        Newton's method seeks it where that saves time; `last` says that the run has reached its maximum
        number of periods. A run on an unstable orbit is kicked off it.
        """
        if self._worth_trying(near, last):
            self.tried_residuals[near.period] = near.residual
            orbit = self._shot(near.period)
            if orbit is not None:
                self.orbit, self.orbit_at = orbit, self.periods_run
        if self.orbit is None:
            return None
        if abs(self.orbit.multipliers[0]) > 1.0 + UNIT_TOLERANCE:
            self._kick(near)
            return None
        since = (self.periods_run - self.orbit_at) % self.orbit.period
        at_rest = since == 0 and self._stands_on(self.orbit, near)
        if at_rest or drawn_in(self.integrator, self.orbit, self.ends, since):
            return self._result(self.orbit.period, self.orbit.residual, self.orbit)
        return None

    def _worth_trying(self, near: BestReturn, last: bool) -> bool:
        """Whether Newton's method is the cheaper way to continue, and has not failed from a change nearly
        as small.

        If so, its cost in mesh periods is added to `newton_cost`.
        """
        again = near.residual < 0.1 * self.tried_residuals.get(near.period, np.inf)
        cost = NEWTON_STEPS * NEWTON_COST * near.period
        cheap = self.newton_cost + cost <= self.periods_run or last
        slow = near.periods_left(self.settings.periodic_residual) > NEWTON_COST * near.period
        near_enough = near.period <= SHORT or near.residual < VERY_SMALL
        worth = near.shrinking and near_enough and again and cheap and (slow or last)
        self.newton_cost += cost * worth
        return worth

    def _shot(self, period: int, matrices: int = MATRICES) -> Orbit | None:
        """Solve for an orbit of `period` mesh periods from the current state by shooting; None where it
        fails.
        """
        return shoot(self.integrator, self.state, period, self.settings.periodic_residual, matrices)

    def _by_itself(self, near: BestReturn, last: bool) -> SettlingResult | None:
        """Return the motion on which the run has closed by itself, with its multipliers if `refine` asks
        for them, or None.

        Newton's method detects a motion that only creeps by, because it finds no orbit there. Then the
        run continues.
        """
        period = closed_period(self.integrator, self.ends, near, self.settings)
        if not period:
            return None
        orbit = self._shot(period) if self.settings.refine else None
        if orbit is not None and abs(orbit.multipliers[0]) > 1.0 + UNIT_TOLERANCE:
            self.orbit, self.orbit_at = orbit, self.periods_run
            self._kick(near)
            return None
        if orbit is not None and not self._is_here(orbit):
            orbit = None
        if orbit is None and period > 1 and (within := self._in_noise(near)):
            return within
        creeps = near.residual > CREEP * self.settings.periodic_residual
        if self.settings.refine and orbit is None and creeps and not last:
            return None
        return self._result(period if orbit is None else orbit.period, near.residual, orbit)

    def _in_noise(self, near: BestReturn) -> SettlingResult | None:
        """Return the orbit of the shortest period near which only the errors of steps move the run; None
        if there is none.
        """
        noise = NOISE * self.settings.tolerance
        close = np.flatnonzero(changes(self.integrator, self.ends, self.settings.longest_period) < noise)
        orbit = self._shot(int(close[0]) + 1, matrices=1) if close.size else None
        if orbit is None or orbit.spectral_radius > MAX_SPECTRAL_RADIUS:
            return None
        # Tolerances are those of places: the fastest motion may err in its velocity by so much more.
        if orbit.distance(self.integrator, self.state, max(self.integrator.fastest, 1.0)) > noise:
            return None
        return self._result(orbit.period, near.residual, orbit if self.settings.refine else None)

    def _is_here(self, orbit: Orbit) -> bool:
        """Whether the run's state lies at an orbit's state, up to what is left to decay and the errors of
        steps.
        """
        distance = orbit.distance(self.integrator, self.state)
        settings, slow = self.settings, max(1.0 - abs(orbit.multipliers[0]), 1e-3)
        return distance <= max(20.0 * settings.periodic_residual, 10.0 * settings.tolerance) / slow

    def _stands_on(self, orbit: Orbit, near: BestReturn) -> bool:
        """Whether the run has come to rest at an orbit found by Newton's method, so that no more returns
        must be seen.

        The orbit is found in the steps that tangents need. The run's own steps may keep it one step's
        error aside.
        """
        left = near.residual / max(1.0 - abs(orbit.multipliers[0]), 1e-3)
        whole = near.period % orbit.period == 0
        return whole and left <= 10.0 * self.settings.periodic_residual and self._is_here(orbit)

    def _kick(self, near: BestReturn) -> None:
        """Move a run off the unstable orbit `orbit` by KICK along its leading direction, if the orbit
        holds the run.

        The kick goes to the side to which the run leaves already. The history is emptied: the run begins
        anew.
        """
        orbit = self.orbit
        assert orbit is not None
        is_held = near.period % orbit.period == 0 and near.residual <= 100.0 * self.settings.periodic_residual
        if not is_held or self.kicks >= MAX_KICKS:
            return
        self.kicks += 1
        off = self.state - orbit.state
        self.state = self.state + KICK * orbit.leading_disturbance(self.integrator, off)
        self.history.forget()
        self.orbit, self.tried_residuals = None, {}
        self.initial_count = 0

    def _result(self, period: int, residual: float, orbit: Orbit | None) -> SettlingResult:
        """Return the result for a period and residual, with the orbit's state and residual if there is an
        orbit.
        """
        state = self.state if orbit is None else orbit.state
        residual = residual if orbit is None else orbit.residual
        return SettlingResult(
            state, period, residual, orbit, self.periods_run, self.ends, aperiodic_until=self.aperiodic_until
        )


def _blocks(integrator: Integrator, settings: Settings) -> tuple[int, int]:
    """Return the number of periods in a block, and the number to run before anything is decided.

    Slow speeds forget within fewer periods: 30 time constants of the least damped coordinate are plenty.
    """
    rate = 0.5 * TAU * integrator.damping.min()
    memory_periods = int(np.ceil(30.0 / rate)) if rate > 0.0 else settings.dwell
    block = max(min(BLOCK, memory_periods), 2)
    return block, min(settings.dwell, max(block, memory_periods))
