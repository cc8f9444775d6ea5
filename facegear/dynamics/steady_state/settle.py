"""From any start to a steady state that is shown to be one."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.periods import make_log, run_periods
from facegear.dynamics.integrator.work import Work
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.orbits import AFLOAT, Orbit, change, changes, require, shoot

Array = NDArray[np.float64]
NO_TANGENTS = 0
TRY_NEWTON = 0.02
NEWTON_COST = 20
"""Periods that a run may take for each period of an orbit before Newton's method is the cheaper way."""
BLOCK = 16
KICK = 0.1
"""Disturbance of an unstable orbit along its leading direction, as a change."""
MOST_KICKS = 2
TREND = 7


@dataclass(frozen=True, eq=False)
class Settled:
    """Where a run came to rest: state by phase, period (0: none found), residual over it, periods run."""

    displacement: Array
    velocity: Array
    period: int
    residual: float
    orbit: Orbit | None
    periods_run: int


def settle(packed: Packed, work: Work, displacement: Array, velocity: Array, settings: Settings) -> Settled:
    """Run blocks of periods until the state repeats after 1 .. longest_period of them, or patience ends.

    With `refine` a motion that seems to repeat is made an orbit by Newton's method as soon as that pays. An
    unstable orbit, which exact symmetry or a slow escape may hold a run on, is left by a kick.
    """
    displacement, velocity = displacement.copy(), velocity.copy()
    longest, goal = settings.longest_period, settings.periodic_residual
    block, dwell = _blocks(packed, settings)
    tangents = np.zeros((NO_TANGENTS, 2, displacement.size))
    ends = np.zeros((0, 2, displacement.size))
    periods_run, kicks = 0, 0
    tried: dict[int, float] = {}
    while True:
        log = make_log(packed, block)
        require(
            run_periods(
                packed, work, displacement, velocity, tangents, block, 0, settings.tolerance, log, TAU
            )
        )
        periods_run += block
        ends = np.concatenate([ends, log.ends])[-(2 * longest + BLOCK) :]
        period, residual = repeat(packed, ends, longest, goal)
        left = periods_run >= settings.settle
        if periods_run < dwell:
            continue
        pays = NEWTON_COST * period <= periods_run or left
        if settings.refine and pays and residual < min(TRY_NEWTON, 0.1 * tried.get(period, np.inf)):
            orbit = _near_orbit(packed, work, displacement, velocity, period, residual, settings)
            tried[period] = residual
            if orbit is not None and abs(orbit.multipliers[0]) <= 1.0 + AFLOAT:
                return Settled(
                    orbit.displacement, orbit.velocity, orbit.period, orbit.residual, orbit, periods_run
                )
            if orbit is not None and kicks < MOST_KICKS and not left:
                kicks += 1
                displacement += KICK * orbit.leading[0]
                velocity += KICK * orbit.leading[1]
                ends = ends[:0]
                continue
        done = settled_by_itself(packed, ends, period, residual, goal)
        if done and (not settings.refine or left):
            return Settled(displacement, velocity, period, residual, None, periods_run)
        if left:
            return Settled(displacement, velocity, 0, residual, None, periods_run)


def _blocks(packed: Packed, settings: Settings) -> tuple[int, int]:
    """Periods in a block, and those to run before anything is judged.

    Slow speeds forget within fewer periods: 30 time constants of the least damped coordinate are plenty.
    """
    rate = 0.5 * TAU * packed.damping[: packed.n].min()
    forgotten = int(np.ceil(30.0 / rate)) if rate > 0.0 else settings.dwell
    block = max(min(BLOCK, forgotten), 2)
    return block, min(settings.dwell, max(block, forgotten))


def repeat(packed: Packed, ends: Array, longest: int, goal: float) -> tuple[int, float]:
    """The period with the smallest change at the end of a run; a shorter one wins if nearly as good."""
    best_period, best = 1, np.inf
    for index, last in enumerate(changes(packed, ends, longest)):
        if last < 0.2 * best and not best <= goal:
            best_period, best = index + 1, float(last)
    return best_period, best


def settled_by_itself(packed: Packed, ends: Array, period: int, residual: float, goal: float) -> bool:
    """Whether the change over the period is small and what is still to come of it is too.

    A run that creeps past the place where an orbit has just vanished, or off an unstable one, changes little
    too, but not less and less: so the largest change of the last TREND periods is held against that of the
    TREND before them.
    """
    if residual > goal or len(ends) < 2 * TREND + period:
        return False
    kept = ends[-2 * TREND - period :]
    gaps = (packed.weights * np.abs(kept[period:] - kept[:-period])).max(axis=(1, 2))
    early, late = gaps[:TREND].max(), gaps[TREND:].max()
    rate = (late / early) ** (1.0 / TREND) if early > 0.0 else 0.0
    return residual <= 10.0 * goal * max(1.0 - rate, 1e-3)


def _near_orbit(
    packed: Packed,
    work: Work,
    displacement: Array,
    velocity: Array,
    period: int,
    residual: float,
    settings: Settings,
) -> Orbit | None:
    """The orbit next to the state, or None if Newton's method does not settle or leads away."""
    orbit = shoot(
        packed, work, displacement, velocity, period, settings.tolerance, settings.periodic_residual
    )
    if orbit is None:
        return None
    moved = change(packed, np.array([displacement, velocity]), np.array([orbit.displacement, orbit.velocity]))
    # What is left to decay is about residual / (1 - multiplier); much further away lies another orbit. The
    # error of a step moves an orbit likewise.
    slow = max(abs(1.0 - abs(orbit.multipliers[0])), 1e-3)
    reach = max(20.0 * residual, 10.0 * settings.tolerance) / slow
    return orbit if moved <= max(reach, 10.0 * settings.periodic_residual) else None
