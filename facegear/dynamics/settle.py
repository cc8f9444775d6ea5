"""From any start to a steady state that is shown to be one."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.periods import make_log, run_periods
from facegear.dynamics.integrator.work import Work
from facegear.dynamics.motion import Settings
from facegear.dynamics.orbits import Orbit, change, require, shoot

Array = NDArray[np.float64]
NO_TANGENTS = 0
TRY_NEWTON = 0.02
BLOCK = 16
AFLOAT = 1e-6
"""A multiplier may exceed one by this: it is one for a body afloat inside its backlash."""


@dataclass(frozen=True, eq=False)
class Settled:
    """Where a run came to rest: state by phase, period (0: none found), residual over it, periods spent."""

    place: Array
    velocity: Array
    period: int
    residual: float
    orbit: Orbit | None
    spent: int


def settle(packed: Packed, work: Work, place: Array, velocity: Array, settings: Settings) -> Settled:
    """Run blocks of periods until the state repeats after 1 .. longest_period of them, or patience ends."""
    place, velocity = place.copy(), velocity.copy()
    longest = settings.longest_period
    # Slow speeds forget within fewer periods: 30 time constants of the least damped coordinate are plenty.
    rate = 0.5 * TAU * packed.damping[: packed.n].min()
    forgotten = int(np.ceil(30.0 / rate)) if rate > 0.0 else settings.dwell
    block = max(min(BLOCK, forgotten), longest + 1)
    dwell = min(settings.dwell, max(block, forgotten))
    tangents = np.zeros((NO_TANGENTS, 2, place.size))
    spent = 0
    residual, period = np.inf, 0
    tried: dict[int, float] = {}
    while True:
        log = make_log(packed, block)
        require(run_periods(packed, work, place, velocity, tangents, block, 0, settings.tolerance, log))
        spent += block
        period, residual = repeat(packed, log.ends, longest, settings.periodic_residual)
        enough = spent >= dwell
        if enough and settings.refine and residual < min(TRY_NEWTON, 0.1 * tried.get(period, np.inf)):
            orbit = _stable_orbit(packed, work, place, velocity, period, residual, settings)
            if orbit is not None:
                return Settled(orbit.place, orbit.velocity, orbit.period, orbit.residual, orbit, spent)
            tried[period] = residual
        repeats = residual <= settings.periodic_residual
        if enough and repeats and (not settings.refine or spent >= settings.settle):
            return Settled(place, velocity, period, residual, None, spent)
        if spent >= settings.settle:
            return Settled(place, velocity, 0, residual, None, spent)


def repeat(packed: Packed, ends: Array, longest: int, goal: float) -> tuple[int, float]:
    """The period with the smallest change at the end of a run; a shorter one wins if nearly as good.

    The residual is the largest change between the last two repetitions that were run.
    """
    best_period, best = 1, np.inf
    for period in range(1, longest + 1):
        last = change(packed, ends[-1], ends[-1 - period])
        if last < 0.2 * best and not best <= goal:
            best_period, best = period, last
    return best_period, best


def _stable_orbit(
    packed: Packed,
    work: Work,
    place: Array,
    velocity: Array,
    period: int,
    residual: float,
    settings: Settings,
) -> Orbit | None:
    """The stable orbit next to the state, or None if Newton's method leads away or to an unstable one."""
    orbit = shoot(packed, work, place, velocity, period, settings.tolerance, settings.periodic_residual)
    if orbit is None or abs(orbit.multipliers[0]) > 1.0 + AFLOAT:
        return None
    moved = change(packed, np.array([place, velocity]), np.array([orbit.place, orbit.velocity]))
    # What is left to decay is about residual / (1 - multiplier); much further away lies another orbit.
    reach = 20.0 * residual / max(1.0 - abs(orbit.multipliers[0]), 1e-3)
    return orbit if moved <= max(reach, 10.0 * settings.periodic_residual) else None
