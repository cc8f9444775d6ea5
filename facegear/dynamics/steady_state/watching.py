"""A run watched until the class of its motion is known."""

from dataclasses import dataclass, replace

from facegear.arrays import Array
from facegear.dynamics.courses import Course
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.steady_state.closing import FALLING, SMALL, closing, wanders
from facegear.dynamics.steady_state.exponent import Exponent, Growth, largest_exponent
from facegear.dynamics.steady_state.guide import Guide, guided
from facegear.dynamics.steady_state.known_orbit import KnownOrbit
from facegear.dynamics.steady_state.mesh_samples import by_mesh, each_deflection
from facegear.dynamics.steady_state.second_look import wandering
from facegear.dynamics.steady_state.settle import Settled, settling
from facegear.dynamics.steady_state.statistics import drifts
from facegear.dynamics.steady_state.window import Window, run_window

CLASSES = {Growth.GROWS: Motion.CHAOTIC, Growth.NEUTRAL: Motion.QUASI_PERIODIC}
ESCAPING = 1e-3
"""Growing disturbances of a motion that repeats as closely as this tell of its end, not of chaos."""


@dataclass(frozen=True, eq=False)
class Watched:
    """What watching a run has shown: where it settled, its class, and the stretch that it is measured on.

    wandered: periods for which it had wandered when it was first taken not to close.
    """

    settled: Settled
    motion: Motion
    exponent: Exponent | None
    window: Window
    periods_run: int
    wandered: int = 0


@dataclass(frozen=True, eq=False)
class Begun:
    """A run from a state (2, n) by phase that was watched for the first time, where it settled if it did, and
    what there is to see where that leaves nothing to be watched.
    """

    integrator: Integrator
    settings: Settings
    start: Array
    settled: Settled
    seen: Watched | None

    @property
    def state(self) -> Array:
        """Where the run stands (2, n): on the motion that it has settled on, or on its way."""
        return self.settled.state if self.seen is None else self.seen.window.ends[-1]


def begin(
    integrator: Integrator,
    state: Array,
    settings: Settings,
    guide: Guide | None = None,
    known: KnownOrbit | None = None,
) -> Course[Begun]:
    """Watch a run from a state (2, n) by phase until it settles or patience ends for the first time.

    A `guide` of a system with the same coordinates makes it short where it leads to an orbit like its own.
    `known`: an orbit of this system, at which the run is over with nothing seen.
    """
    settled = None if guide is None else guided(integrator, state, guide)
    settled = settled or (yield from settling(integrator, state, settings, known=known))
    new = settled.period and not settled.known
    seen = _periodic(integrator, settled, settings, settled.periods_run) if new else None
    return Begun(integrator, settings, state, settled, seen)


def watch(begun: Begun) -> Course[Watched]:
    """Watch a run until its class is known or patience ends.

    A run that shows no sign of closing while it is watched gets its largest exponent on the window that it is
    measured on, which is also a second watch. Where the two do not agree it is watched for longer.
    """
    if begun.seen is not None:
        return begun.seen
    integrator, settled, settings = begun.integrator, begun.settled, begun.settings
    periods_run, wandered = settled.periods_run, 0
    for extensions_left in range(settings.extensions, -1, -1):
        exponent = yield from largest_exponent(integrator, settled.state, settings)
        window = exponent.window
        motion = _class(integrator, settled, exponent, window, settings)
        periods_run += len(exponent.ends)
        if motion is not Motion.NOT_SETTLED or exponent.growth is Growth.UNKNOWN or not extensions_left:
            break
        near = closing(integrator, settled.ends, settings)
        wandered = wandered or wandering(integrator, settled, near.period)
        settled = yield from settling(integrator, window.ends[-1], settings, exponent.ends)
        periods_run += settled.periods_run
        if settled.period:
            return replace(_periodic(integrator, settled, settings, periods_run), wandered=wandered)
    return Watched(settled, motion, exponent, window, periods_run)


def _periodic(integrator: Integrator, settled: Settled, settings: Settings, periods_run: int) -> Watched:
    window = run_window(integrator, settled.state, settled.period, settings.samples)
    return Watched(settled, Motion.PERIODIC, None, window, periods_run)


def not_settled(integrator: Integrator, seen: Watched, other: Settled, settings: Settings) -> Course[Watched]:
    """What is left where another start came to another motion: a stretch to be measured, that of the run
    which did not close if one did not.
    """
    settled = other if seen.settled.period else seen.settled
    periods_run = seen.periods_run + other.periods_run
    if not seen.settled.period:
        return replace(seen, motion=Motion.NOT_SETTLED, periods_run=periods_run)
    exponent = yield from largest_exponent(integrator, settled.state, settings)
    periods_run += len(exponent.ends)
    left = replace(settled, period=0, orbit=None)
    return Watched(left, Motion.NOT_SETTLED, exponent, exponent.window, periods_run)


def _class(
    integrator: Integrator,
    settled: Settled,
    exponent: Exponent,
    window: Window,
    settings: Settings,
) -> Motion:
    """Class of a motion that was watched without closing, by its exponent and the window after it."""
    motion = CLASSES.get(exponent.growth, Motion.NOT_SETTLED)
    near = closing(integrator, window.ends, settings)
    escaping = motion is Motion.CHAOTIC and min(settled.residual, near.residual) < ESCAPING
    each = each_deflection(integrator.system, window.samples, window.per_period)
    deflections = by_mesh(integrator.system, each)
    by_period = deflections.reshape(window.periods, window.per_period, -1).std(axis=1)
    converging = near.residual < SMALL and near.trend < FALLING
    drifting = motion is Motion.QUASI_PERIODIC and wanders(integrator, window.ends, near.period)
    if escaping or converging or drifting or drifts(window.averages, by_period):
        return Motion.NOT_SETTLED
    return motion
