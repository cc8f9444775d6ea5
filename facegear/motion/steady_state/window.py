"""The motion that a result is measured on, and its largest Lyapunov exponent."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Settings
from facegear.motion.requests import RunPlan, RunRequest, alone
from facegear.motion.steady_state.averages import BATCHES, Averages, averages, independent_interval

MAX_SAMPLES = 4096
"""Maximum number of samples in a period."""
MAX_IN_ALL = 65_536
"""Maximum number of samples in a window of many periods; a single period may have MAX_SAMPLES."""
FINENESS = 3.0
"""Samples per period of the fastest motion that a system can answer with."""


@dataclass(frozen=True, eq=False)
class Window:
    """Samples and averages of a motion over a window of whole mesh periods, with n coordinates and m
    rows.

    Attributes
    ----------
    periods, per_period : int
        Number of mesh periods, and of samples in each.
    samples : (periods * per_period, n) array
        Samples of the coordinates.
    fractions : (3, m) array
        Fraction of the time that each contact is open, on its drive flank, and on its back flank.
    ends : (periods, 2, n) array
        State by phase at the end of each period.
    averages : Averages
        Exact averages.
    growth : (periods,) array
        Natural logarithm of the growth of a disturbance in each period, if one was run.
    tangent : (1, 2, n) array
        The disturbance at the end.
    """

    periods: int
    per_period: int
    samples: Array
    fractions: Array
    ends: Array
    averages: Averages
    growth: Array
    tangent: Array


def run_window(integrator: Integrator, state: Array, periods: int, samples: int) -> Window:
    """Run a single window without a disturbance, see window().

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    periods : int
        Number of mesh periods.
    samples : int
        Least number of samples in each period.

    Returns
    -------
    Window
        The window.
    """
    return alone(window(integrator, state, periods, samples))


def window(
    integrator: Integrator, state: Array, periods: int, samples: int, tangent: Array | None = None
) -> RunPlan[Window]:
    """Run some periods and measure them.

    A periodic motion over its own period needs one batch; BATCHES batches of other motions give confidence
    intervals.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    periods : int
        Number of mesh periods.
    samples : int
        Least number of samples in each period.
    tangent : (1, 2, n) array, optional
        Disturbance of length one (dimensionless), which is integrated along and scaled.

    Returns
    -------
    RunPlan of Window
        Generator for requests.alone() or side_by_side(), which returns the window.

    Raises
    ------
    NotConverged
        If a step fails.
    """
    per_period = samples_needed(integrator, samples, periods)
    result = yield RunRequest(
        integrator,
        state,
        periods,
        tangent,
        samples=per_period,
        batches=min(BATCHES, periods),
        growth=tangent is not None,
    )
    return Window(
        periods=periods,
        per_period=per_period,
        samples=result.samples,
        fractions=result.fractions,
        ends=result.ends,
        averages=averages(integrator, result.sums, periods),
        growth=result.growth,
        tangent=result.tangents,
    )


def samples_needed(integrator: Integrator, minimum: int, periods: int) -> int:
    """Number of samples per period that resolve the fastest motion: `minimum` times a power of two, within
    memory.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    minimum : int
        Least number of samples in each period.
    periods : int
        Number of mesh periods.

    Returns
    -------
    int
        Number of samples in each period.
    """
    target = min(FINENESS * integrator.fastest, MAX_SAMPLES)
    maximum = max(MAX_IN_ALL // periods, minimum)
    doublings = max(0, int(np.ceil(np.log2(target / minimum))))
    while doublings and minimum * 2**doublings > maximum:
        doublings -= 1
    return minimum * 2**doublings


ALIGN, MIN_ALIGN = 2, 32
"""Number of batches, and least number of periods, in which a disturbance turns before its growth counts."""
MIN_WINDOW = 8 * BATCHES
"""Least number of periods: growth over shorter batches swings from one to the next, and its mean says
nothing yet.
"""
NEUTRAL = 2e-3
"""An exponent known to lie within this of zero, per mesh period, is neutral."""


class Growth(StrEnum):
    """Behaviour of a small disturbance of a motion, by the sign of the largest Lyapunov exponent."""

    GROWS = "grows"
    NEUTRAL = "neutral"
    SHRINKS = "shrinks"
    INCONCLUSIVE = "unknown"


@dataclass(frozen=True, eq=False)
class Exponent:
    """Largest Lyapunov exponent of a motion.

    A neutral exponent has the half-width of its smooth mean, any other that of the batches.

    Attributes
    ----------
    growth : Growth
        Whether disturbances grow, by value and half-width.
    value, half_width : float
        Exponent per mesh period and its 95 % half-width.
    ends : (periods, 2, n) array
        States of the run at the ends of periods.
    window : Window
        Last window of the run.
    """

    growth: Growth
    value: float
    half_width: float
    ends: Array
    window: Window


def largest_exponent(integrator: Integrator, state: Array, settings: Settings) -> RunPlan[Exponent]:
    """Compute the largest Lyapunov exponent by one tangent vector over the settings' window.

    The vector is scaled back to length one after every period (Parker and Chua 1989). While the exponent
    cannot be distinguished from zero the run is doubled, window by window, up to `extensions` times.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    settings : Settings
        Settings of the run.

    Returns
    -------
    RunPlan of Exponent
        Generator for requests.alone() or side_by_side(), which returns the exponent.
    """
    tangent = np.random.default_rng(0).normal(size=(1, *state.shape))
    tangent /= np.sqrt(((integrator.weights * tangent) ** 2).sum())
    # The vector first turns into the direction of fastest growth.
    align = max(ALIGN * settings.window // BATCHES, MIN_ALIGN)
    run = yield RunRequest(integrator, state, align, tangent, growth=True)
    ends, rates, tangent = run.ends, np.zeros(0), run.tangents
    if settings.window < MIN_WINDOW:
        extra_periods = MIN_WINDOW - settings.window
        run = yield RunRequest(integrator, ends[-1], extra_periods, tangent, growth=True)
        rates, tangent = run.growth, run.tangents
        ends = np.concatenate([ends, run.ends])
    for windows in range(1, 2**settings.extensions + 1):
        last = yield from window(integrator, ends[-1], settings.window, settings.samples, tangent)
        tangent = last.tangent
        ends, rates = np.concatenate([ends, last.ends]), np.concatenate([rates, last.growth])
        if windows.bit_count() > 1:
            continue
        growth, value, half_width = _classify_growth(rates)
        if growth is not Growth.INCONCLUSIVE:
            break
    return Exponent(growth, value, half_width, ends, last)


def _classify_growth(rates: Array) -> tuple[Growth, float, float]:
    """Return the class of growth rates (periods,) per mesh period, their mean and its 95 % half-width.

    A neutral mean is that of smooth_mean(), any other that of BATCHES batches.
    """
    batches = np.array([part.mean() for part in np.array_split(rates, BATCHES)])
    mean, half = float(batches.mean()), float(independent_interval(batches))
    if mean - half > NEUTRAL:
        return Growth.GROWS, mean, half
    smooth, doubt = smooth_mean(rates)
    if abs(smooth) + doubt <= NEUTRAL:
        return Growth.NEUTRAL, smooth, doubt
    return Growth.SHRINKS if mean + half < -NEUTRAL else Growth.INCONCLUSIVE, mean, half


def smooth_mean(rates: Array) -> tuple[float, float]:
    """Compute the mean of a series weighted by exp(-1/(t(1 - t))), and how far the means of its parts
    differ from it.

    The parts are its first and its last three quarters.

    On a torus, where the growth only oscillates, it converges faster than any power of the length, while the
    plain mean errs by one oscillation over the length (Das et al. 2017).

    Parameters
    ----------
    rates : (periods,) array
        Series, any unit.

    Returns
    -------
    tuple of float
        Mean, and the larger difference, in the unit of the series.
    """
    part = 3 * rates.size // 4
    whole, first, last = (_weighted_mean(series) for series in (rates, rates[:part], rates[-part:]))
    return whole, max(abs(first - whole), abs(last - whole))


def _weighted_mean(rates: Array) -> float:
    """Return the mean of rates (periods,) with the weight exp(-1 / (t (1 - t))), t from 0 to 1, which
    vanishes at both ends.
    """
    t = (np.arange(rates.size) + 0.5) / rates.size
    return float(np.average(rates, weights=np.exp(-1.0 / (t * (1.0 - t)))))
