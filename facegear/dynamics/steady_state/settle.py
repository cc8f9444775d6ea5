"""From any start to the periodic motion that the run itself comes to, if it does."""

from dataclasses import dataclass, replace

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.courses import Course, alone
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.closing import SMALL, TREND, VERY_SMALL, Closing, closed, closing
from facegear.dynamics.steady_state.known_orbit import KnownOrbit
from facegear.dynamics.steady_state.orbits import (
    MATRICES,
    UNIT_TOLERANCE,
    Orbit,
    changes,
    drawn_in,
    shoot,
)
from facegear.dynamics.steady_state.passed import Passed
from facegear.dynamics.stretch import Stretch

NEWTON_COST = 20
"""Mesh periods that cost as much time as one with all tangents."""
NEWTON_STEPS = 2
"""Times that Newton's method usually needs them."""
SHORT = 8
"""Newton's method goes after longer periods only where the change over them is very small."""
BLOCK, LONG_BLOCK = 16, 128
"""A block is half of what was run before, within these: each call of the kernels has a price."""
KICK = 0.01
"""How far a run that rests on an unstable orbit is moved along its leading direction, as a change."""
MAX_KICKS = 2
LONGER = 4
"""A run that comes nearer and nearer is watched for so many times as long."""
CREEP = 0.01
"""Where Newton's method finds no orbit the change over a period must fall to this fraction of the goal."""
NOISE, DRAWN = 50.0, 0.95
"""Steps chosen anew in each period may move a run by NOISE times the tolerance; an orbit whose multipliers
are below DRAWN holds it there. They also push a body along its neutral direction on and on."""


@dataclass(frozen=True, eq=False)
class Settled:
    """Where a run came to rest: state (2, n) by phase, period (0: none found), residual over it, periods run.

    ends (periods, 2, n): the last states at the end of a period. orbit: with its multipliers, if refined.
    known: whether it is the orbit that was known before. aperiodic_until: periods after which the run was
    seen for the last time to be near no periodic motion.
    """

    state: Array
    period: int
    residual: float
    orbit: Orbit | None
    periods_run: int
    ends: Array
    known: bool = False
    aperiodic_until: int = 0


def settle(
    integrator: Integrator,
    state: Array,
    settings: Settings,
    ends: Array | None = None,
    known: KnownOrbit | None = None,
) -> Settled:
    """settling() of one run by itself."""
    return alone(settling(integrator, state, settings, ends, known))


def settling(
    integrator: Integrator,
    state: Array,
    settings: Settings,
    ends: Array | None = None,
    known: KnownOrbit | None = None,
) -> Course[Settled]:
    """Run until the state repeats after 1 .. longest_period periods, or patience ends without a sign of it.

    With `refine` the orbit that the run tends to is found by Newton's method as soon as that pays, and is
    taken only once the run is drawn in by it. An unstable orbit, on which exact symmetry may hold a run, is
    left by a kick. `ends`: states that the run passed through before, oldest first. `known`: an orbit near
    which the run is over at once.
    """
    return SettlingRun(integrator, state, settings, ends, known).settled()


class SettlingRun:
    """A run under way. `orbit` is the last that Newton's method came to, after `orbit_at` periods.

    Newton's method, whose cost is counted in mesh periods, may take as long as the run itself.
    """

    def __init__(
        self,
        integrator: Integrator,
        state: Array,
        settings: Settings,
        ends: Array | None,
        known: KnownOrbit | None = None,
    ) -> None:
        self.integrator, self.settings = integrator, settings
        self.state, self.known_orbit = state.copy(), known
        self.passed = Passed(4 * settings.longest_period + 2 * TREND + LONG_BLOCK, state.shape)
        if ends is not None:
            self.passed.room_for(len(ends))[:] = ends
        self.known = len(self.ends)
        self.periods_run = self.kicks = self.newton_cost = self.aperiodic_until = 0
        self.orbit: Orbit | None = None
        self.orbit_at = 0
        self.tried: dict[int, float] = {}
        self.block, self.dwell = _blocks(integrator, settings)

    @property
    def ends(self) -> Array:
        """The last states at the end of a period, oldest first."""
        return self.passed.states

    def settled(self) -> Course[Settled]:
        """Go on, block by block, until the run has settled or patience ends."""
        while True:
            yield from self._advance()
            if known := self._known():
                return known
            if self.periods_run < self.dwell and not self.known:
                continue
            last = self.periods_run >= self.settings.settle
            near = closing(self.integrator, self.ends, self.settings)
            if near.residual > SMALL:
                self.aperiodic_until = self.periods_run
            result = self._refined(near, last) if self.settings.refine else None
            if result is None and len(self.ends):
                result = self._by_itself(near, last)
            if result is not None:
                return result
            if not len(self.ends):  # after a kick the run begins anew
                continue
            closer = near.shrinking and near.trend < 1.0
            if last and not (closer and self.periods_run < LONGER * self.settings.settle):
                return self._in_noise(near) or self._result(0, near.residual, None)

    def _known(self) -> Settled | None:
        """The orbit that was known before, if the run has come to it."""
        if self.known_orbit is None or not len(self.ends):
            return None
        reached = self.known_orbit.reached(self.integrator, self.ends)
        if reached is None:
            return None
        state, off = reached
        return replace(self._result(self.known_orbit.orbit.period, off, None), state=state, known=True)

    def _advance(self) -> Course[None]:
        settings = self.settings
        block = min(max(self.block, self.periods_run // 2), max(self.block, LONG_BLOCK))
        if not self.known and self.known_orbit is None:
            block = max(block, self.dwell - self.periods_run)
        if self.periods_run < settings.settle:
            block = min(block, settings.settle - self.periods_run)
        run = yield Stretch(self.integrator, self.state, block)
        self.state = run.state
        self.passed.room_for(block)[:] = run.ends
        self.periods_run += block

    def _refined(self, near: Closing, last: bool) -> Settled | None:
        """The orbit that draws the run in, if there is one; looked for where it saves time."""
        if self._worth_trying(near, last):
            self.tried[near.period] = near.residual
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

    def _worth_trying(self, near: Closing, last: bool) -> bool:
        """Whether Newton's method is the cheaper way to go on, and has not failed here before."""
        again = near.residual < 0.1 * self.tried.get(near.period, np.inf)
        cost = NEWTON_STEPS * NEWTON_COST * near.period
        cheap = self.newton_cost + cost <= self.periods_run or last
        slow = near.periods_left(self.settings.periodic_residual) > NEWTON_COST * near.period
        near_enough = near.period <= SHORT or near.residual < VERY_SMALL
        worth = near.shrinking and near_enough and again and cheap and (slow or last)
        self.newton_cost += cost * worth
        return worth

    def _shot(self, period: int, matrices: int = MATRICES) -> Orbit | None:
        return shoot(self.integrator, self.state, period, self.settings.periodic_residual, matrices)

    def _by_itself(self, near: Closing, last: bool) -> Settled | None:
        """The motion that the run has closed on without help, with its multipliers if they are wanted.

        Newton's method detects what only creeps by, because it finds no orbit there: then the run goes on.
        """
        period = closed(self.integrator, self.ends, near, self.settings)
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

    def _in_noise(self, near: Closing) -> Settled | None:
        """The motion of the shortest period about which nothing but the choice of steps moves the run."""
        noise = NOISE * self.settings.tolerance
        close = np.flatnonzero(changes(self.integrator, self.ends, self.settings.longest_period) < noise)
        orbit = self._shot(int(close[0]) + 1, matrices=1) if close.size else None
        if orbit is None or orbit.holding > DRAWN:
            return None
        # Tolerances are those of places: the fastest motion may err in its velocity by so much more.
        if orbit.distance(self.integrator, self.state, max(self.integrator.fastest, 1.0)) > noise:
            return None
        return self._result(orbit.period, near.residual, orbit if self.settings.refine else None)

    def _is_here(self, orbit: Orbit) -> bool:
        """Whether an orbit is the one that the run stands on: what is left to decay, and errors of steps."""
        moved = orbit.distance(self.integrator, self.state)
        settings, slow = self.settings, max(1.0 - abs(orbit.multipliers[0]), 1e-3)
        return moved <= max(20.0 * settings.periodic_residual, 10.0 * settings.tolerance) / slow

    def _stands_on(self, orbit: Orbit, near: Closing) -> bool:
        """Whether a run has come to rest where the orbit draws it in.

        The orbit is found in the steps that tangents need, the run's own may hold it a step's error aside.
        """
        left = near.residual / max(1.0 - abs(orbit.multipliers[0]), 1e-3)
        whole = near.period % orbit.period == 0
        return whole and left <= 10.0 * self.settings.periodic_residual and self._is_here(orbit)

    def _kick(self, near: Closing) -> None:
        """Move a run that an unstable orbit holds along the way by which it is leaving already, if it is."""
        orbit = self.orbit
        assert orbit is not None
        held = near.period % orbit.period == 0 and near.residual <= 100.0 * self.settings.periodic_residual
        if not held or self.kicks >= MAX_KICKS:
            return
        self.kicks += 1
        off = self.state - orbit.state
        self.state = self.state + KICK * orbit.leaving(self.integrator, off)
        self.passed.forget()
        self.orbit, self.tried = None, {}
        self.known = 0

    def _result(self, period: int, residual: float, orbit: Orbit | None) -> Settled:
        state = self.state if orbit is None else orbit.state
        residual = residual if orbit is None else orbit.residual
        return Settled(
            state, period, residual, orbit, self.periods_run, self.ends, aperiodic_until=self.aperiodic_until
        )


def _blocks(integrator: Integrator, settings: Settings) -> tuple[int, int]:
    """Periods in a block, and those to run before anything is judged.

    Slow speeds forget within fewer periods: 30 time constants of the least damped coordinate are plenty.
    """
    rate = 0.5 * TAU * integrator.damping.min()
    forgotten = int(np.ceil(30.0 / rate)) if rate > 0.0 else settings.dwell
    block = max(min(BLOCK, forgotten), 2)
    return block, min(settings.dwell, max(block, forgotten))
