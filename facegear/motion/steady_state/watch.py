"""A run watched until the class of its motion is known."""

from dataclasses import dataclass, replace

from facegear.arrays import Array
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Motion, Settings
from facegear.motion.requests import RunPlan
from facegear.motion.steady_state.guide import Guide, settle_by_guide
from facegear.motion.steady_state.mesh_samples import by_mesh, each_deflection
from facegear.motion.steady_state.periodicity import KnownOrbit, best_return, wanders
from facegear.motion.steady_state.settle import SettlingResult, count_unsteady_periods, settling
from facegear.motion.steady_state.statistics import drifts
from facegear.motion.steady_state.window import Exponent, Growth, Window, largest_exponent, run_window

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
        Samples and averages from which the motion is measured: one period of it, or the window of the
        exponent.
    periods_run : int
        Number of mesh periods run.
    unsteady_periods : int
        Number of unsteady mesh periods, see count_unsteady_periods(), when the run was first taken not to
        close.
    """

    settling_result: SettlingResult
    motion: Motion
    exponent: Exponent | None
    window: Window
    periods_run: int
    unsteady_periods: int = 0

    @property
    def watched_ends(self) -> Array:
        """States (periods, 2, n) at the ends of the last mesh periods that were watched, m and m/rad."""
        return self.settling_result.ends if self.exponent is None else self.exponent.ends


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
        The result where the run has settled and nothing is left to watch; None where it has not settled
        or came to a known orbit.
    """

    integrator: Integrator
    settings: Settings
    start: Array
    settling_result: SettlingResult
    watch_result: WatchResult | None

    @property
    def state(self) -> Array:
        """State by phase (2, n): on the motion in which the run has settled, else where the run is."""
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
        Generator for requests.alone() or side_by_side(), which returns the first watch.
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
        Generator for requests.alone() or side_by_side(), which returns the result.
    """
    if first_watch.watch_result is not None:
        return first_watch.watch_result
    integrator, settling_result, settings = (
        first_watch.integrator,
        first_watch.settling_result,
        first_watch.settings,
    )
    periods_run, unsteady_periods = settling_result.periods_run, 0
    for extensions_left in range(settings.extensions, -1, -1):
        motion, exponent = yield from classify_run(integrator, settling_result, settings)
        window = exponent.window
        periods_run += len(exponent.ends)
        if motion is not Motion.NOT_SETTLED or exponent.growth is Growth.INCONCLUSIVE or not extensions_left:
            break
        near = best_return(integrator, settling_result.ends, settings)
        unsteady_periods = unsteady_periods or count_unsteady_periods(
            integrator, settling_result, near.period
        )
        settling_result = yield from settling(integrator, window.ends[-1], settings, exponent.ends)
        periods_run += settling_result.periods_run
        if settling_result.period:
            return replace(
                _periodic(integrator, settling_result, settings, periods_run),
                unsteady_periods=unsteady_periods,
            )
    return WatchResult(settling_result, motion, exponent, window, periods_run)


def _periodic(
    integrator: Integrator, settling_result: SettlingResult, settings: Settings, periods_run: int
) -> WatchResult:
    """Return the result of a run that settled on a periodic motion, with a window of one period of it."""
    window = run_window(integrator, settling_result.state, settling_result.period, settings.samples)
    return WatchResult(settling_result, Motion.PERIODIC, None, window, periods_run)


def classify_run(
    integrator: Integrator, run: SettlingResult, settings: Settings
) -> RunPlan[tuple[Motion, Exponent]]:
    """Classify a motion that did not close while it was watched, by its exponent and the window after it.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    run : SettlingResult
        The run that did not close.
    settings : Settings
        Settings of the run.

    Returns
    -------
    RunPlan of tuple
        Generator for requests.alone() or side_by_side(), which returns the class of motion, NOT_SETTLED
        if it stays open, and the largest Lyapunov exponent.
    """
    exponent = yield from largest_exponent(integrator, run.state, settings)
    return _class(integrator, run, exponent, exponent.window, settings), exponent


def _class(
    integrator: Integrator,
    settling_result: SettlingResult,
    exponent: Exponent,
    window: Window,
    settings: Settings,
) -> Motion:
    """Return the class of a motion that did not close, from its Lyapunov exponent and the window after
    it.

    It is NOT_SETTLED if the run seems to close, drifts, or the growth of disturbances is inconclusive.
    """
    motion = CLASSES.get(exponent.growth, Motion.NOT_SETTLED)
    near = best_return(integrator, window.ends, settings)
    escaping = motion is Motion.CHAOTIC and min(settling_result.residual, near.residual) < ESCAPING
    contact_deflections = each_deflection(integrator.system, window.samples, window.per_period)
    deflections = by_mesh(integrator.system, contact_deflections)
    by_period = deflections.reshape(window.periods, window.per_period, -1).std(axis=1)
    drifting = motion is Motion.QUASI_PERIODIC and wanders(integrator, window.ends, near.period)
    if escaping or near.seems_to_close or drifting or drifts(window.averages, by_period):
        return Motion.NOT_SETTLED
    return motion
