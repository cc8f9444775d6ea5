"""Measure how nearly a run comes back to where it was, and whether it does so more and more."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.orbits import changes, largest

TREND = 7
"""Periods over which the largest change is taken, twice in succession, to see it fall."""
SMALL, VERY_SMALL = 0.02, 1e-3
"""Changes over a period, over the length scale, that are a sign of closing: if they fall, and in any case."""
MAX_TREND = 0.9
"""Ratio of the changes over a trend above which they are not falling."""
NO_DIFFERENCE, SPLIT = 10.0, 100.0
"""Change over a part of a closed period, in goals: below the first there is none, above the second there
is one.
"""


@dataclass(frozen=True)
class BestReturn:
    """The best return of a run.

    Attributes
    ----------
    period : int
        Number of mesh periods after which the run returns.
    residual : float
        Its change over them, over the length scale.
    trend : float
        Largest change of the last TREND periods over that of the TREND before; NaN if the run was shorter.
    """

    period: int
    residual: float
    trend: float

    @property
    def shrinking(self) -> bool:
        """Whether the run shows signs of closing: the change is small and falls, or is very small."""
        return self.residual < (SMALL if self.trend < MAX_TREND else VERY_SMALL)

    @property
    def rate(self) -> float:
        """Factor by which the change falls each period."""
        return self.trend ** (1.0 / TREND)

    def periods_left(self, goal: float) -> float:
        """Number of periods until the change is the goal if it continues to fall as it does.

        Parameters
        ----------
        goal : float
            Change over the length scale, dimensionless.

        Returns
        -------
        float
            Number of mesh periods; infinite if the change does not fall.
        """
        if self.residual <= goal:
            return 0.0
        return np.log(goal / self.residual) / np.log(self.rate) if 0.0 < self.trend < 1.0 else np.inf


def best_return(integrator: Integrator, ends: Array, settings: Settings) -> BestReturn:
    """Find the period with the smallest change at the end of a run; a shorter one wins if nearly as good.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    ends : (periods, 2, n) array
        States at the ends of mesh periods, m and m/rad.
    settings : Settings
        Settings of the run.

    Returns
    -------
    BestReturn
        Period, change and trend.
    """
    best_period, best = 1, np.inf
    for index, last in enumerate(changes(integrator, ends, settings.longest_period).tolist()):
        if last < 0.2 * best and not best <= settings.periodic_residual:
            best_period, best = index + 1, last
    return BestReturn(best_period, best, trend(integrator, ends, best_period))


def trend(integrator: Integrator, ends: Array, period: int) -> float:
    """Largest change over a period in the last TREND periods, over that in the TREND before.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    ends : (periods, 2, n) array
        States at the ends of mesh periods, m and m/rad.
    period : int
        Number of mesh periods.

    Returns
    -------
    float
        Ratio of the changes; NaN if the run was too short.
    """
    if len(ends) < 2 * TREND + period:
        return np.nan
    last_states = ends[-2 * TREND - period :]
    gaps = largest(integrator, last_states[period:] - last_states[:-period])
    early, late = gaps[:TREND].max(), gaps[TREND:].max()
    return float(late / early) if early > 0.0 else 0.0


def closed_period(integrator: Integrator, ends: Array, near: BestReturn, settings: Settings) -> int:
    """Find the period on which a run has closed by itself.

    A small change is not enough: a run that creeps past the place where an orbit has just vanished, or off an
    unstable one, changes little, too. The change that is still to come, if it continues to fall as it does,
    must be small. And a part of the period may close as well but still be on its way (a slow spiral is nearer
    after three periods than after one). Then that part must decide.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    ends : (periods, 2, n) array
        States at the ends of mesh periods, m and m/rad.
    near : BestReturn
        Result of best_return().
    settings : Settings
        Settings of the run.

    Returns
    -------
    int
        Number of mesh periods, 0 if the run has not closed.
    """
    goal = settings.periodic_residual
    if not _at_rest(near, goal):
        return 0
    returns = changes(integrator, ends, near.period)
    for part in range(1, near.period):
        if near.period % part:
            continue
        short = BestReturn(part, float(returns[part - 1]), trend(integrator, ends, part))
        if short.residual <= NO_DIFFERENCE * goal:
            return part
        if short.residual <= SPLIT * goal and short.trend < 0.5 * (1.0 + near.trend):
            return 0
    return near.period


def wanders(integrator: Integrator, ends: Array, period: int) -> bool:
    """Whether the changes over a period add up instead of coming round: a drift, and no torus.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    ends : (periods, 2, n) array
        States at the ends of mesh periods, m and m/rad.
    period : int
        Number of mesh periods.

    Returns
    -------
    bool
        False for a window of one period or less, about which nothing is known.
    """
    gaps = ends[period:] - ends[:-period] if period else ends[:0]
    if not len(gaps):
        return False
    steady = (integrator.weights * np.abs(gaps.mean(axis=0))).max()
    return bool(steady > 0.5 * (integrator.weights * np.abs(gaps)).max())


def _at_rest(near: BestReturn, goal: float) -> bool:
    if near.residual > goal or np.isnan(near.trend):
        return False
    return near.residual <= 10.0 * goal * max(1.0 - near.rate, 1e-3)
