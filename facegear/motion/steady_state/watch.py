"""A run watched until the class of its motion is known, and second looks from other starts.

Whether a class of motion comes out again from starts a little aside. A chaotic transient that ends on an
orbit of a long period while a run is watched may go on for longer from the next start, and one that does not
end may end. Rounding of the machine's numbers then decides what the motion is called.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import scipy

from facegear.arrays import Array, Mask
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Motion, Settings
from facegear.motion.requests import RunPlan
from facegear.motion.steady_state.guide import Guide, settle_by_guide
from facegear.motion.steady_state.mesh_samples import by_mesh, each_deflection
from facegear.motion.steady_state.orbits import change, largest
from facegear.motion.steady_state.periodicity import MAX_TREND, SMALL, KnownOrbit, best_return, wanders
from facegear.motion.steady_state.settle import SettlingResult, settling
from facegear.motion.steady_state.statistics import drifts
from facegear.motion.steady_state.window import Exponent, Growth, Window, largest_exponent, run_window

NEGLIGIBLE_WANDERING = 16
"""Number of periods with changes that are not small up to which a run counts as having gone straight to its
orbit; after more of them the orbit reached may be a matter of chance.
"""
MAX_LOOKS = 7
"""Largest number of further starts from which a periodic motion is checked, where `second_looks` is not
larger. Free choice that bounds the cost.
"""
CHANCE = 0.05
"""A periodic motion is out of doubt when fewer starts than this fraction would fail to close, which is itself
known with a confidence of one minus as much."""


def find_disagreeing_motion(
    integrator: Integrator,
    start: Array,
    settings: Settings,
    first_result: SettlingResult,
    first_motion: Motion,
    states: Array,
    earlier_wandering: int,
) -> RunPlan[SettlingResult | None]:
    """Look for another start whose motion refutes the class of the first motion.

    A run that went straight to its orbit is not in doubt, and a run that is not settled decides nothing.
    Another periodic motion is checked from `second_looks` other starts, and from up to MAX_LOOKS if that is
    more, until the periods for which the runs have wandered show that hardly a start would fail to close. Two
    irregular motions are of one class, which is checked from one other start.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    start : (2, n) array
        State by phase at the first start, m and m/rad.
    settings : Settings
        Settings of the run.
    first_result : SettlingResult
        Where the first run settled.
    first_motion : Motion
        Class of the first motion.
    states : (periods, 2, n) array
        States of the first motion at the end of its periods, m and m/rad.
    earlier_wandering : int
        Number of periods for which the first run had wandered when it was first taken not to close.

    Returns
    -------
    RunPlan of SettlingResult or None
        Computation that returns where the other start settled; None if the class holds.
    """
    if not settings.second_looks or first_motion is Motion.NOT_SETTLED:
        return None
    wandering_periods = earlier_wandering + count_wandering_periods(
        integrator, first_result, first_result.period
    )
    if first_result.period and not wandering_periods:
        return None
    known_orbit = KnownOrbit(first_result.orbit, states) if first_result.orbit else None
    starts = other_starts(integrator, start, settings.aside, first_result)
    for looks in range(1, max(MAX_LOOKS, settings.second_looks) + 1):
        other_result = yield from settling(integrator, next(starts), settings, known_orbit=known_orbit)
        if other_result.period != first_result.period:
            return other_result
        wandering_periods += count_wandering_periods(integrator, other_result, other_result.period)
        rare = wandering_chance(looks + 1, wandering_periods, 2 * settings.settle) < CHANCE
        if not first_result.period or (rare and looks >= settings.second_looks):
            break
    return None


def wandering_chance(runs: int, wandering_periods: int, patience: int) -> float:
    """Bound the chance that a run wanders for longer than `patience` periods before it closes.

    A chaotic transient ends in any period with the same chance, so that the total number of wandering periods
    is distributed as Gamma of order `runs`.

    Parameters
    ----------
    runs : int
        Number of runs, all of which closed.
    wandering_periods : int
        Number of periods for which they wandered, all together.
    patience : int
        Number of periods after which a run is taken not to close.

    Returns
    -------
    float
        Largest chance, with a confidence of 1 - CHANCE, dimensionless.
    """
    rate = scipy.special.gammaincinv(runs, CHANCE) / max(wandering_periods, 1)
    return float(np.exp(-rate * patience))


def other_starts(
    integrator: Integrator, start: Array, aside: float, first_result: SettlingResult
) -> Iterator[Array]:
    """Yield random starts beside the start of a run, in directions in which the run itself has moved.

    A symmetric run is left symmetric: disturbances of the symmetry die away or show in the exponent, and
    until they have died away mirrored meshes, which all but switch together, cost half as many steps again.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    start : (2, n) array
        State by phase at the start of the run, m and m/rad.
    aside : float
        Distance of the starts as a fraction of the length scale, dimensionless.
    first_result : SettlingResult
        Result of the run.

    Yields
    ------
    (2, n) array
        State by phase, m and m/rad.
    """
    random = np.random.default_rng(0)
    moves = first_result.ends - first_result.ends.mean(axis=0)
    while True:
        off = np.tensordot(random.normal(size=len(moves)), moves, 1)
        yield start + aside * off / change(integrator, off, 0.0 * off)


def count_wandering_periods(integrator: Integrator, settling_result: SettlingResult, period: int) -> int:
    """Count the periods of a run before the last change over a period that is not small.

    The count is 0 if there are at most NEGLIGIBLE_WANDERING such changes. A run so long that its first states
    are not kept any more counts until it was last seen near no periodic motion.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    settling_result : SettlingResult
        Result of the run.
    period : int
        Period over which changes are measured, number of mesh periods.

    Returns
    -------
    int
        Number of mesh periods.
    """
    large = _is_change_large(integrator, settling_result, period)
    if large.sum() > NEGLIGIBLE_WANDERING:
        quiet = int(large[::-1].argmax())
        return max(settling_result.periods_run - quiet, 0)
    return settling_result.aperiodic_until if settling_result.periods_run > len(settling_result.ends) else 0


def _is_change_large(integrator: Integrator, settling_result: SettlingResult, period: int) -> Mask:
    """Return for each kept mesh period whether the change over `period` periods at its end is not small."""
    ends = settling_result.ends
    return largest(integrator, ends[period:] - ends[: len(ends) - period]) > SMALL


CLASSES = {Growth.GROWS: Motion.CHAOTIC, Growth.NEUTRAL: Motion.QUASI_PERIODIC}
"""Class of a motion that does not close, by the growth of small disturbances."""
ESCAPING = 1e-3
"""Growing disturbances of a motion that repeats as closely as this (over the length scale) show its end,
not chaos.
"""


@dataclass(frozen=True, eq=False)
class WatchResult:
    """Result of watching a run.

    Attributes
    ----------
    settling_result : SettlingResult
        Where the run settled.
    motion : Motion
        Class of motion.
    exponent : Exponent or None
        Largest Lyapunov exponent of a motion that is not periodic.
    window : Window
        Stretch on which the motion is measured.
    periods_run : int
        Number of mesh periods run.
    wandering_periods : int
        Periods for which the run had wandered when it was first taken not to close.
    """

    settling_result: SettlingResult
    motion: Motion
    exponent: Exponent | None
    window: Window
    periods_run: int
    wandering_periods: int = 0


@dataclass(frozen=True, eq=False)
class FirstWatch:
    """A run from a state by phase after it was watched for the first time.

    Attributes
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    settings : Settings
        Settings of the run.
    start : (2, n) array
        State at the start.
    settling_result : SettlingResult
        Where the run settled, if it did.
    watch_result : WatchResult or None
        The result where the run has settled and nothing is left to watch.
    """

    integrator: Integrator
    settings: Settings
    start: Array
    settling_result: SettlingResult
    watch_result: WatchResult | None

    @property
    def state(self) -> Array:
        """Current state (2, n) of the run: on the motion on which it has settled, or on its way."""
        return self.settling_result.state if self.watch_result is None else self.watch_result.window.ends[-1]


def begin(
    integrator: Integrator,
    state: Array,
    settings: Settings,
    guide: Guide | None = None,
    known_orbit: KnownOrbit | None = None,
) -> RunPlan[FirstWatch]:
    """Watch a run until it settles or the maximum number of periods is reached for the first time.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    settings : Settings
        Settings of the run.
    guide : Guide, optional
        Orbit of a system with the same coordinates; it shortens the run where it leads to an orbit like its
        own.
    known_orbit : KnownOrbit, optional
        Orbit of this system at which the run ends without a window.

    Returns
    -------
    RunPlan of FirstWatch
        Computation that returns the first watch.
    """
    settling_result = None if guide is None else settle_by_guide(integrator, state, guide)
    settling_result = settling_result or (
        yield from settling(integrator, state, settings, known_orbit=known_orbit)
    )
    new = settling_result.period and not settling_result.is_known_orbit
    watch_result = (
        _periodic(integrator, settling_result, settings, settling_result.periods_run) if new else None
    )
    return FirstWatch(integrator, settings, state, settling_result, watch_result)


def watch(first_watch: FirstWatch) -> RunPlan[WatchResult]:
    """Watch a run until its class is known or the maximum number of periods is reached.

    For a run that shows no sign of closing while it is watched, the largest Lyapunov exponent is computed on
    the window on which the motion is measured. That is a second watch. Where the two disagree the run is
    watched for longer.

    Parameters
    ----------
    first_watch : FirstWatch
        The run after its first watch.

    Returns
    -------
    RunPlan of WatchResult
        Computation that returns the result.
    """
    if first_watch.watch_result is not None:
        return first_watch.watch_result
    integrator, settling_result, settings = (
        first_watch.integrator,
        first_watch.settling_result,
        first_watch.settings,
    )
    periods_run, wandering_periods = settling_result.periods_run, 0
    for extensions_left in range(settings.extensions, -1, -1):
        exponent = yield from largest_exponent(integrator, settling_result.state, settings)
        window = exponent.window
        motion = _class(integrator, settling_result, exponent, window, settings)
        periods_run += len(exponent.ends)
        if motion is not Motion.NOT_SETTLED or exponent.growth is Growth.INCONCLUSIVE or not extensions_left:
            break
        near = best_return(integrator, settling_result.ends, settings)
        wandering_periods = wandering_periods or count_wandering_periods(
            integrator, settling_result, near.period
        )
        settling_result = yield from settling(integrator, window.ends[-1], settings, exponent.ends)
        periods_run += settling_result.periods_run
        if settling_result.period:
            return replace(
                _periodic(integrator, settling_result, settings, periods_run),
                wandering_periods=wandering_periods,
            )
    return WatchResult(settling_result, motion, exponent, window, periods_run)


def _periodic(
    integrator: Integrator, settling_result: SettlingResult, settings: Settings, periods_run: int
) -> WatchResult:
    """Return the result of a run that settled on a periodic motion, measured over one window."""
    window = run_window(integrator, settling_result.state, settling_result.period, settings.samples)
    return WatchResult(settling_result, Motion.PERIODIC, None, window, periods_run)


def not_settled(
    integrator: Integrator, watch_result: WatchResult, other_result: SettlingResult, settings: Settings
) -> RunPlan[WatchResult]:
    """Result where another start came to another motion: not settled, measured on one of the two.

    It is measured on the run that did not close, if there is one.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    watch_result : WatchResult
        Result of the first start.
    other_result : SettlingResult
        Where the other start settled.
    settings : Settings
        Settings of the run.

    Returns
    -------
    RunPlan of WatchResult
        Computation that returns the result.
    """
    settling_result = other_result if watch_result.settling_result.period else watch_result.settling_result
    periods_run = watch_result.periods_run + other_result.periods_run
    if not watch_result.settling_result.period:
        return replace(watch_result, motion=Motion.NOT_SETTLED, periods_run=periods_run)
    exponent = yield from largest_exponent(integrator, settling_result.state, settings)
    periods_run += len(exponent.ends)
    left = replace(settling_result, period=0, orbit=None)
    return WatchResult(left, Motion.NOT_SETTLED, exponent, exponent.window, periods_run)


def _class(
    integrator: Integrator,
    settling_result: SettlingResult,
    exponent: Exponent,
    window: Window,
    settings: Settings,
) -> Motion:
    """Class of a motion that was watched without closing, from its exponent and the window after it."""
    motion = CLASSES.get(exponent.growth, Motion.NOT_SETTLED)
    near = best_return(integrator, window.ends, settings)
    escaping = motion is Motion.CHAOTIC and min(settling_result.residual, near.residual) < ESCAPING
    contact_deflections = each_deflection(integrator.system, window.samples, window.per_period)
    deflections = by_mesh(integrator.system, contact_deflections)
    by_period = deflections.reshape(window.periods, window.per_period, -1).std(axis=1)
    converging = near.residual < SMALL and near.trend < MAX_TREND
    drifting = motion is Motion.QUASI_PERIODIC and wanders(integrator, window.ends, near.period)
    if escaping or converging or drifting or drifts(window.averages, by_period):
        return Motion.NOT_SETTLED
    return motion
