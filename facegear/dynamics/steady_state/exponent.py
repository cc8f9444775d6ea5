"""Largest Lyapunov exponent of a motion that did not turn out periodic, and what class that makes it."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.courses import Course
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import Settings
from facegear.dynamics.steady_state.averages import BATCHES, independent_interval
from facegear.dynamics.steady_state.window import Window, window
from facegear.dynamics.stretch import Stretch

ALIGN, MIN_ALIGN = 2, 32
"""Batches, and least periods, for which a disturbance turns before its growth counts."""
MIN_WINDOW = 8 * BATCHES
"""Growth over batches shorter than this swings from one to the next: its mean says nothing yet."""
NEUTRAL = 2e-3
"""An exponent known to lie within this of zero, per mesh period, is neutral."""


class Growth(StrEnum):
    """What becomes of a small disturbance."""

    GROWS = "grows"
    NEUTRAL = "neutral"
    SHRINKS = "shrinks"
    UNKNOWN = "unknown"


@dataclass(frozen=True, eq=False)
class Exponent:
    """Exponent per mesh period with its 95 % half-width, what it says, the run's ends (periods, 2, n), and
    the last window of that run.

    A neutral exponent comes with the half-width of its smooth mean, any other with that of the batches.
    """

    growth: Growth
    value: float
    half_width: float
    ends: Array
    window: Window


def largest_exponent(integrator: Integrator, state: Array, settings: Settings) -> Course[Exponent]:
    """Largest exponent from a state (2, n) by phase, by one tangent vector over the settings' window.

    The vector is brought back to length one after every period (Parker and Chua 1989).
    While it cannot be distinguished from zero the run is doubled, window by window, up to `extensions` times.
    """
    tangent = np.random.default_rng(0).normal(size=(1, *state.shape))
    tangent /= np.sqrt(((integrator.weights * tangent) ** 2).sum())
    # The vector first turns into the direction of fastest growth.
    align = max(ALIGN * settings.window // BATCHES, MIN_ALIGN)
    run = yield Stretch(integrator, state, align, tangent, growth=True)
    ends, rates, tangent = run.ends, np.zeros(0), run.tangents
    if settings.window < MIN_WINDOW:
        missing = MIN_WINDOW - settings.window
        run = yield Stretch(integrator, ends[-1], missing, tangent, growth=True)
        rates, tangent = run.growth, run.tangents
        ends = np.concatenate([ends, run.ends])
    for windows in range(1, 2**settings.extensions + 1):
        last = yield from window(integrator, ends[-1], settings.window, settings.samples, tangent)
        tangent = last.tangent
        ends, rates = np.concatenate([ends, last.ends]), np.concatenate([rates, last.growth])
        if windows.bit_count() > 1:
            continue
        growth, value, half_width = _judged(rates)
        if growth is not Growth.UNKNOWN:
            break
    return Exponent(growth, value, half_width, ends, last)


def _judged(rates: Array) -> tuple[Growth, float, float]:
    """What growth rates (periods,) say, their mean and its half-width."""
    batches = np.array([part.mean() for part in np.array_split(rates, BATCHES)])
    mean, half = float(batches.mean()), float(independent_interval(batches))
    if mean - half > NEUTRAL:
        return Growth.GROWS, mean, half
    smooth, doubt = smooth_mean(rates)
    if abs(smooth) + doubt <= NEUTRAL:
        return Growth.NEUTRAL, smooth, doubt
    return Growth.SHRINKS if mean + half < -NEUTRAL else Growth.UNKNOWN, mean, half


def smooth_mean(rates: Array) -> tuple[float, float]:
    """Mean of a series weighted by exp(-1/(t(1 - t))), and how far those of two overlapping parts lie off.

    On a torus, where the growth only swings to and fro, it settles faster than any power of the length,
    while the plain mean errs by one swing over the length (Das et al. 2017).
    """
    part = 3 * rates.size // 4
    whole, first, last = (_weighted(some) for some in (rates, rates[:part], rates[-part:]))
    return whole, max(abs(first - whole), abs(last - whole))


def _weighted(rates: Array) -> float:
    t = (np.arange(rates.size) + 0.5) / rates.size
    return float(np.average(rates, weights=np.exp(-1.0 / (t * (1.0 - t)))))
