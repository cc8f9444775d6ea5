"""Whether a class of motion comes out again from starts a little aside.

A chaotic transient that ends on an orbit of a long period while a run is watched may go on for longer from
the next start, and one that does not end may end. Rounding of the machine's numbers then decides what the
motion is called.
"""

from collections.abc import Iterator

import numpy as np
import scipy

from facegear.arrays import Array, Mask
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.run_plans import RunPlan
from facegear.dynamics.steady_state.known_orbit import KnownOrbit
from facegear.dynamics.steady_state.orbits import change, largest
from facegear.dynamics.steady_state.periodicity import SMALL
from facegear.dynamics.steady_state.settle import SettlingResult, settling

WANDERED = 16
"""After so many periods with changes that are not small the orbit reached may be a matter of chance."""
MAX_LOOKS = 7
CHANCE = 0.05
"""A periodic motion is out of doubt when fewer starts than this fraction would fail to close, which is itself
known with a confidence of one minus as much."""


def disagreeing(
    integrator: Integrator,
    start: Array,
    settings: Settings,
    first: SettlingResult,
    motion: Motion,
    states: Array,
    before: int,
) -> RunPlan[SettlingResult | None]:
    """Where another start (2, n) settles if that takes the class of the first back; None if the class holds.

    A run that went straight to its orbit is not in doubt, and one that is not settled says nothing. Another
    periodic motion is looked at `second_looks` times, and on, up to MAX_LOOKS times if that is more, until
    the periods for which the runs have wandered show that hardly a start would fail to close. Two irregular
    motions are one class, which is looked at once. `states` (periods, 2, n): of the first motion at the end
    of its periods.
    before: periods for which it had wandered when it was given up for the first time.
    """
    if not settings.second_looks or motion is Motion.NOT_SETTLED:
        return None
    wandered = before + wandering(integrator, first, first.period)
    if first.period and not wandered:
        return None
    known = KnownOrbit(first.orbit, states) if first.orbit else None
    starts = other_starts(integrator, start, settings.aside, first)
    for looks in range(1, max(MAX_LOOKS, settings.second_looks) + 1):
        other = yield from settling(integrator, next(starts), settings, known_orbit=known)
        if other.period != first.period:
            return other
        wandered += wandering(integrator, other, other.period)
        rare = never_closing(looks + 1, wandered, 2 * settings.settle) < CHANCE
        if not first.period or (rare and looks >= settings.second_looks):
            break
    return None


def never_closing(runs: int, wandered: int, patience: int) -> float:
    """Largest chance, with a confidence of 1 - CHANCE, that a run wanders for longer than `patience` periods.

    `runs` that all closed have wandered for `wandered` periods in all. A chaotic transient ends in any period
    with the same chance, so that the total is distributed as Gamma of order `runs`.
    """
    rate = scipy.special.gammaincinv(runs, CHANCE) / max(wandered, 1)
    return float(np.exp(-rate * patience))


def other_starts(
    integrator: Integrator, start: Array, aside: float, first: SettlingResult
) -> Iterator[Array]:
    """Starts (2, n) beside that of a run, by a fraction `aside` of the length scale.

    They lie in any direction in which the run itself has moved. A symmetric run is left symmetric: what
    disturbs the symmetry dies away or shows in the exponent, and until it has died away mirrored meshes,
    which all but switch together, cost half as many steps again.
    """
    random = np.random.default_rng(0)
    moves = first.ends - first.ends.mean(axis=0)
    while True:
        off = np.tensordot(random.normal(size=len(moves)), moves, 1)
        yield start + aside * off / change(integrator, off, 0.0 * off)


def wandering(integrator: Integrator, settled: SettlingResult, period: int) -> int:
    """Count the periods of a run before the last change over a period that is not small.

    They are 0 if there are but few. Of a run so long that its first states are not kept any more, what counts
    is when it was seen for the last time to be near no periodic motion.
    """
    large = _large(integrator, settled, period)
    if large.sum() > WANDERED:
        quiet = int(large[::-1].argmax())
        return max(settled.periods_run - quiet, 0)
    return settled.aperiodic_until if settled.periods_run > len(settled.ends) else 0


def _large(integrator: Integrator, settled: SettlingResult, period: int) -> Mask:
    """Where the change over a period is not small, at the end of each mesh period that is kept."""
    ends = settled.ends
    return largest(integrator, ends[period:] - ends[: len(ends) - period]) > SMALL
