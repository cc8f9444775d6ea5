"""Second looks at a motion: whether its class comes out again from starts beside the first.

A run may come to its motion by chance, out of a chaotic transient or at the edge of a basin, and the place at
which an irregular run is judged may decide its class. Then rounding decides which class the motion gets.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy

from facegear.arrays import Array
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Look, Motion, Settings
from facegear.motion.requests import RunPlan
from facegear.motion.steady_state.orbits import change
from facegear.motion.steady_state.periodicity import KnownOrbit, often_seems_to_close
from facegear.motion.steady_state.settle import SettlingResult, count_unsteady_periods, settling
from facegear.motion.steady_state.watch import WatchResult, classify_run
from facegear.motion.steady_state.window import largest_exponent

MAX_LOOKS = 7
"""Maximum number of other starts, unless the settings ask for more; each costs as much as the motion itself.
With eight runs in all the bound of chance_of_never_closing() is met if they are unsteady for less than a
sixth of the patience on average.
"""
CHANCE = 0.05
"""A periodic motion is out of doubt when fewer starts than this fraction would fail to close, which is itself
known with a confidence of one minus as much.
"""


def find_disagreement(
    integrator: Integrator, start: Array, settings: Settings, run: WatchResult
) -> RunPlan[tuple[SettlingResult, Look] | None]:
    """Start a motion again from other states until one of them comes to another class of motion.

    A run that went straight to its orbit is not in doubt, and one that is not settled claims nothing. Another
    periodic motion is looked at `second_looks` times, and further, up to MAX_LOOKS times if that is more,
    until the unsteady periods of all runs show that hardly a start would fail to close. An irregular motion
    is looked at once. A look that leaves its class open does not withdraw it, since it is watched once while
    the first run may have been watched for longer. A chaotic motion that often seems to close is looked at
    MAX_LOOKS times (`second_looks` times if that is more), and an open look withdraws its class: there the
    class depends on where a run is judged. A torus, too, often seems to close, but by its nature.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    start : (2, n) array
        State by phase from which the motion was started first, m and m/rad.
    settings : Settings
        Settings of the run; they say how often and how far aside motions are started again.
    run : WatchResult
        Result of the first start.

    Returns
    -------
    RunPlan of tuple or None
        Generator for requests.alone() or side_by_side(), which returns where the start that disagrees has
        come to and its motion; None if the class holds.
    """
    first, motion = run.settling_result, run.motion
    if not settings.second_looks or motion is Motion.NOT_SETTLED:
        return None
    unsteady_periods = run.unsteady_periods + count_unsteady_periods(integrator, first, first.period)
    if first.period and not unsteady_periods:
        return None
    orbit = KnownOrbit(first.orbit, run.window.ends) if first.orbit else None
    starts = other_starts(integrator, start, settings.aside, first)
    is_doubtful = motion is Motion.CHAOTIC and often_seems_to_close(integrator, run.watched_ends, settings)
    for looks in range(1, max(MAX_LOOKS, settings.second_looks) + 1):
        look = yield from settling(integrator, next(starts), settings, known_orbit=orbit)
        if look.period != first.period:
            return look, Look(look.period)
        if not first.period:
            # Two runs that do not close have the same period 0: only their classes tell them apart.
            other_motion, exponent = yield from classify_run(integrator, look, settings)
            contradicts = other_motion is not Motion.NOT_SETTLED or is_doubtful
            if other_motion is not motion and contradicts:
                periods_run = look.periods_run + len(exponent.ends)
                return replace(look, periods_run=periods_run), Look(0, other_motion)
        unsteady_periods += count_unsteady_periods(integrator, look, look.period)
        patience = 2 * settings.settle
        is_rare = first.period > 0 and chance_of_never_closing(looks + 1, unsteady_periods, patience) < CHANCE
        is_last = is_rare and looks >= settings.second_looks if first.period else not is_doubtful
        if is_last:
            break
    return None


def chance_of_never_closing(runs: int, unsteady_periods: int, patience: int) -> float:
    """Bound the chance that a run stays unsteady for longer than `patience` periods.

    A chaotic transient ends in any period with the same chance, so that the total of the unsteady periods is
    distributed as Gamma of order `runs`.

    Parameters
    ----------
    runs : int
        Number of runs, all of which have closed.
    unsteady_periods : int
        Number of unsteady mesh periods of all runs together.
    patience : int
        Number of mesh periods.

    Returns
    -------
    float
        Largest chance, dimensionless, with a confidence of 1 - CHANCE.
    """
    rate = scipy.special.gammaincinv(runs, CHANCE) / max(unsteady_periods, 1)
    return float(np.exp(-rate * patience))


def other_starts(
    integrator: Integrator, start: Array, aside: float, first: SettlingResult
) -> Iterator[Array]:
    """Draw starts beside that of a run.

    They lie in any direction in which the run itself has moved. A symmetric run is left symmetric: what
    disturbs the symmetry dies away or shows in the exponent, and until it has died away mirrored meshes,
    which all but switch together, cost half as many steps again.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    start : (2, n) array
        State by phase at the start of the run, m and m/rad.
    aside : float
        Distance over the length scale, dimensionless.
    first : SettlingResult
        The run.

    Yields
    ------
    (2, n) array
        State by phase, m and m/rad; without end.
    """
    random = np.random.default_rng(0)
    moves = first.ends - first.ends.mean(axis=0)
    while True:
        off = np.tensordot(random.normal(size=len(moves)), moves, 1)
        yield start + aside * off / change(integrator, off, 0.0 * off)


def withdraw_class(
    integrator: Integrator, run: WatchResult, look: SettlingResult, settings: Settings
) -> RunPlan[WatchResult]:
    """Return the result of a motion as not settled, because another start came to another motion.

    It is measured on the run that did not close, if there is one.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    run : WatchResult
        Result of the first start.
    look : SettlingResult
        Where the other start has come to.
    settings : Settings
        Settings of the run.

    Returns
    -------
    RunPlan of WatchResult
        Generator for requests.alone() or side_by_side(), which returns the result.
    """
    periods_run = run.periods_run + look.periods_run
    if not run.settling_result.period:
        return replace(run, motion=Motion.NOT_SETTLED, periods_run=periods_run)
    exponent = yield from largest_exponent(integrator, look.state, settings)
    periods_run += len(exponent.ends)
    not_closed = replace(look, period=0, orbit=None)
    return WatchResult(not_closed, Motion.NOT_SETTLED, exponent, exponent.window, periods_run)
