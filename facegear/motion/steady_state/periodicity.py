"""Distance of a run from a state to which it may come back: its own past, or a known orbit."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Settings
from facegear.motion.steady_state.orbits import Orbit, changes, drawn_in, largest, near_for_ever

TREND = 7
"""Periods over which the largest change is taken, twice in succession, to see it fall."""
SMALL, VERY_SMALL = 0.02, 1e-3
"""Changes over a period, over the length scale, that are a sign of closing: if they fall, and in any case."""
MAX_TREND = 0.9
"""Ratio of the changes over a trend above which they are not falling."""
OFTEN = 0.25
"""Fraction of the places of a run at which it seems to close, above which its class depends on where it is
judged. Of 41 irregular motions among 500 random oscillators 38 lie below 0.23, and starts 1e-12 aside leave
none of them open; of the three above 0.33 two are chaotic or not settled by chance, and one never settles.
"""
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
    def seems_to_close(self) -> bool:
        """Whether the change is small and falls, which a motion that never closes may show for a while."""
        return self.residual < SMALL and self.trend < MAX_TREND

    @property
    def rate(self) -> float:
        """Factor by which the change falls in each mesh period: the trend's TREND-th root."""
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


def often_seems_to_close(integrator: Integrator, ends: Array, settings: Settings) -> bool:
    """Whether an irregular run often seems to close, although it does not.

    A chaotic attractor that is small over the length scale returns near to one of its last states almost
    anywhere. Whether its run counts as chaotic or as not settled is then a matter of where it is judged.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    ends : (periods, 2, n) array
        States at the ends of successive mesh periods, m and m/rad.
    settings : Settings
        Settings of the run; they say which periods are looked for.

    Returns
    -------
    bool
        Whether the change over some period is small and falls at more than OFTEN of the places.
    """
    first = min(settings.longest_period + 2 * TREND, len(ends))
    returns = (best_return(integrator, ends[:stop], settings) for stop in range(first, len(ends) + 1, TREND))
    return bool(np.mean([near.seems_to_close for near in returns]) > OFTEN)


def trend(integrator: Integrator, ends: Array, period: int) -> float:
    """Return the largest change over a period in the last TREND mesh periods, over that in the TREND
    before them.

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
    """Find the period after which a run repeats, by the changes of its own states alone.

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
    """Whether the change over the period, and the sum of all changes still to come, are within a goal
    (length scales).
    """
    if near.residual > goal or np.isnan(near.trend):
        return False
    return near.residual <= 10.0 * goal * max(1.0 - near.rate, 1e-3)


NEAR = 0.02
"""Whether an orbit draws a run in is asked within this distance of it alone, over the length scale."""


@dataclass(frozen=True, eq=False)
class KnownOrbit:
    """A stable orbit, and the states (period, 2, n) at the ends of its mesh periods, to end runs that
    come to it.
    """

    orbit: Orbit
    states: Array

    def attracting_state(self, integrator: Integrator, ends: Array) -> tuple[Array, float] | None:
        """Return the orbit's state next to the end of a run, if nothing can lead the run away from the orbit
        again.

        Parameters
        ----------
        integrator : Integrator
            Integrates the system at one mesh frequency.
        ends : (periods, 2, n) array
            States of the run at the ends of successive mesh periods, m and m/rad.

        Returns
        -------
        tuple or None
            State (2, n) of the orbit, m and m/rad, and the distance over the length scale; None if the run
            may leave.
        """
        distances = largest(integrator, self.states - ends[-1])
        nearest = int(distances.argmin())
        distance = float(distances[nearest])
        is_attracted = near_for_ever(integrator, self.orbit, distance)
        if not is_attracted and distance < NEAR:
            is_attracted = drawn_in(integrator, self.orbit, ends, (nearest + 1) % self.orbit.period)
        return (self.states[nearest], distance) if is_attracted else None


def known_orbit(integrator: Integrator, orbit: Orbit | None) -> KnownOrbit | None:
    """Make a known orbit, to which other runs of its system may come.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    orbit : Orbit or None
        Orbit of the integrator's system.

    Returns
    -------
    KnownOrbit or None
        None where there is no orbit or it is not stable.

    Raises
    ------
    NotConverged
        If a step fails.
    """
    if orbit is None or abs(orbit.multipliers[0]) >= 1.0:
        return None
    return KnownOrbit(orbit, integrator.run(orbit.state, orbit.period).ends)


class StateHistory:
    """Buffer of at least the last `capacity` states (2, n) of a run at the ends of periods; `states`
    returns them.
    """

    def __init__(self, capacity: int, shape: tuple[int, ...]) -> None:
        self.capacity, self.count = capacity, 0
        self.buffer = np.empty((2 * capacity, *shape))

    @property
    def states(self) -> Array:
        """Last states (up to capacity, 2, n), oldest first, m and m/rad; a view of the buffer."""
        return self.buffer[max(self.count - self.capacity, 0) : self.count]

    def reserve(self, periods: int) -> Array:
        """Reserve space behind the stored states; it counts as filled from now on.

        Parameters
        ----------
        periods : int
            Number of states.

        Returns
        -------
        (periods, 2, n) array
            View to write the states to, m and m/rad.
        """
        if self.count + periods > len(self.buffer):
            last_states = self.states.copy()
            if len(last_states) + periods > len(self.buffer):
                self.buffer = np.empty((len(last_states) + periods, *self.buffer.shape[1:]))
            self.buffer[: len(last_states)] = last_states
            self.count = len(last_states)
        self.count += periods
        return self.buffer[self.count - periods : self.count]

    def forget(self) -> None:
        """Remove all states."""
        self.count = 0
