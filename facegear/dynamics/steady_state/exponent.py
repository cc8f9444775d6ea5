"""Largest Lyapunov exponent of a motion that did not turn out periodic, and what class that makes it."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.work import Work
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.steady_state.window import Window, run_disturbed

Array = NDArray[np.float64]
BATCHES = 16
ALIGN = 2
NEUTRAL = 2e-3
"""An exponent known to lie within this of zero, per mesh period, is neutral."""


def largest_exponent(
    packed: Packed, work: Work, displacement: Array, velocity: Array, settings: Settings
) -> tuple[Motion, tuple[float, float], Window]:
    """Class of motion, exponent per mesh period with its 95 % half-width, and the window itself.

    A neutral exponent comes with the half-width of its smooth mean, any other with that of the batches.
    """
    tangent = np.zeros((1, 2, displacement.size))
    tangent[0, :, : packed.n] = np.random.default_rng(0).normal(size=(2, packed.n))
    tangent /= np.sqrt(((packed.weights * tangent) ** 2).sum())
    length = max(1, settings.window // BATCHES)
    # The vector first turns into the direction of fastest growth.
    aside = run_disturbed(packed, work, displacement, velocity, tangent, ALIGN * length, settings)
    window = run_disturbed(
        packed, work, aside.displacement, aside.velocity, tangent, BATCHES * length, settings
    )
    batches = window.growth.reshape(BATCHES, length).mean(axis=1)
    mean = float(batches.mean())
    half = float(2.13 * batches.std(ddof=1) / np.sqrt(BATCHES))
    if mean - half > NEUTRAL:
        return Motion.CHAOTIC, (mean, half), window
    smooth, doubt = smooth_mean(window.growth)
    if abs(smooth) + doubt <= NEUTRAL:
        return Motion.QUASI_PERIODIC, (smooth, doubt), window
    return Motion.NOT_SETTLED, (mean, half), window


def smooth_mean(rates: Array) -> tuple[float, float]:
    """Mean of a series weighted by exp(-1/(t(1 - t))), and how far those of two overlapping parts lie off.

    On a torus, where the growth only swings to and fro, it settles faster than any power of the length,
    while the plain mean errs by one swing over the length (Das, Saiki, Sander, Yorke 2017).
    """
    part = 3 * rates.size // 4
    whole, first, last = (_weighted(some) for some in (rates, rates[:part], rates[-part:]))
    return whole, max(abs(first - whole), abs(last - whole))


def _weighted(rates: Array) -> float:
    t = (np.arange(rates.size) + 0.5) / rates.size
    return float(np.average(rates, weights=np.exp(-1.0 / (t * (1.0 - t)))))
