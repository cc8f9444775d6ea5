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
    """Return the motion of another start (2, n) if it refutes the class of the first; None if the class
    holds.

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
    """Mask of the kept mesh periods at whose end the change over a period is not small."""
    ends = settled.ends
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
        wandering_periods = wandering_periods or wandering(integrator, settling_result, near.period)
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
