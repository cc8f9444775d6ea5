"""Largest Lyapunov exponent of a motion that did not turn out periodic, and what class that makes it."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.work import Work
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.window import Window, joined, run_window

Array = NDArray[np.float64]
BATCHES = 16
ALIGN = 2
NEUTRAL = 2e-3
"""An exponent whose interval lies within this of zero, per mesh period, is neutral."""


def largest_exponent(
    packed: Packed, work: Work, place: Array, velocity: Array, settings: Settings
) -> tuple[Motion, tuple[float, float], Window]:
    """Class of motion, exponent per mesh period with its 95 % half-width over batches, and the window
    itself.
    """
    tangents = np.zeros((1, 2, place.size))
    tangents[0, :, : packed.n] = np.random.default_rng(0).normal(size=(2, packed.n))
    length = max(1, settings.window // BATCHES)
    growth, windows = [], []
    for _ in range(ALIGN + BATCHES):
        tangents /= _norm(packed, tangents)
        windows.append(run_window(packed, work, place, velocity, tangents, length, settings))
        place, velocity = windows[-1].place, windows[-1].velocity
        growth.append(np.log(_norm(packed, tangents)) / length)
    # The vector first turns into the direction of fastest growth.
    growth, window = growth[ALIGN:], joined(windows[ALIGN:])
    mean = float(np.mean(growth))
    half = float(2.13 * np.std(growth, ddof=1) / np.sqrt(len(growth)))
    if mean - half > NEUTRAL:
        return Motion.CHAOTIC, (mean, half), window
    if abs(mean) + half <= NEUTRAL:
        return Motion.QUASI_PERIODIC, (mean, half), window
    return Motion.NOT_SETTLED, (mean, half), window


def _norm(packed: Packed, tangents: Array) -> float:
    return float(np.sqrt(((packed.weights * tangents) ** 2).sum()))
