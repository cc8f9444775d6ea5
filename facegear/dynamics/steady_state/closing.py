"""How nearly a run comes back to where it was, and whether it does so more and more."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.orbits import changes, largest

TREND = 7
"""Periods over which the largest change is taken, twice in succession, to see it fall."""
SMALL, VERY_SMALL = 0.02, 1e-3
FALLING = 0.9
"""A change that falls by less than this over a trend is no sign of closing."""
NO_DIFFERENCE, SPLIT = 10.0, 100.0
"""A change over a part of a period that has closed is none below the first, for certain one above the second,
times the goal."""


@dataclass(frozen=True)
class Closing:
    """The best return of a run: after `period` periods, to within `residual` of the length scale.

    trend: largest change of the last TREND periods over that of the TREND before; NaN if it was not run so
    long.
    """

    period: int
    residual: float
    trend: float

    @property
    def shrinking(self) -> bool:
        """Whether the run shows signs of closing: the change is small and falls, or is very small."""
        return self.residual < (SMALL if self.trend < FALLING else VERY_SMALL)

    @property
    def rate(self) -> float:
        """By which factor the change falls each period."""
        return self.trend ** (1.0 / TREND)

    def periods_left(self, goal: float) -> float:
        """Periods until the change is the goal if it goes on falling as it does; infinite if it does not."""
        if self.residual <= goal:
            return 0.0
        return np.log(goal / self.residual) / np.log(self.rate) if 0.0 < self.trend < 1.0 else np.inf


def closing(integrator: Integrator, ends: Array, settings: Settings) -> Closing:
    """The period with the smallest change at the end of a run; a shorter one wins if nearly as good."""
    best_period, best = 1, np.inf
    for index, last in enumerate(changes(integrator, ends, settings.longest_period).tolist()):
        if last < 0.2 * best and not best <= settings.periodic_residual:
            best_period, best = index + 1, last
    return Closing(best_period, best, trend(integrator, ends, best_period))


def trend(integrator: Integrator, ends: Array, period: int) -> float:
    """Largest change over a period at the last TREND periods, over that at the TREND before."""
    if len(ends) < 2 * TREND + period:
        return np.nan
    kept = ends[-2 * TREND - period :]
    gaps = largest(integrator, kept[period:] - kept[:-period])
    early, late = gaps[:TREND].max(), gaps[TREND:].max()
    return float(late / early) if early > 0.0 else 0.0


def closed(integrator: Integrator, ends: Array, near: Closing, settings: Settings) -> int:
    """The period that a run has closed on by itself, 0 if it has not.

    A small change is not enough: a run that creeps past the place where an orbit has just vanished, or off an
    unstable one, changes little too. What is still to come, if the change goes on falling as it does, must be
    small. And where a part of the period closes as well, but is still on its way (a slow spiral is nearer
    after three periods than after one), that part must decide.
    """
    goal = settings.periodic_residual
    if not _at_rest(near, goal):
        return 0
    returns = changes(integrator, ends, near.period)
    for part in range(1, near.period):
        if near.period % part:
            continue
        short = Closing(part, float(returns[part - 1]), trend(integrator, ends, part))
        if short.residual <= NO_DIFFERENCE * goal:
            return part
        if short.residual <= SPLIT * goal and short.trend < 0.5 * (1.0 + near.trend):
            return 0
    return near.period


def wanders(integrator: Integrator, ends: Array, period: int) -> bool:
    """Whether what changes over a period adds up instead of coming round: a drift, and no torus.

    Nothing is known of a window of one period or less.
    """
    gaps = ends[period:] - ends[:-period] if period else ends[:0]
    if not len(gaps):
        return False
    steady = (integrator.weights * np.abs(gaps.mean(axis=0))).max()
    return bool(steady > 0.5 * (integrator.weights * np.abs(gaps)).max())


def _at_rest(near: Closing, goal: float) -> bool:
    if near.residual > goal or np.isnan(near.trend):
        return False
    return near.residual <= 10.0 * goal * max(1.0 - near.rate, 1e-3)
