"""Largest Lyapunov exponent of a motion that did not turn out periodic, and what class that makes it."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.compiled import Packed
from facegear.dynamics.motion import Motion, Settings
from facegear.dynamics.orbits import require
from facegear.dynamics.periods import make_log, run_periods
from facegear.dynamics.taylor import Work

Array = NDArray[np.float64]
BATCHES = 16
NEUTRAL = 2e-3
"""An exponent whose interval lies within this of zero, per mesh period, is neutral."""


def largest_exponent(
    packed: Packed, work: Work, place: Array, velocity: Array, settings: Settings
) -> tuple[Motion, tuple[float, float]]:
    """Class of motion, and the exponent per mesh period with its 95 % half-width over batches of the
    window.
    """
    place, velocity = place.copy(), velocity.copy()
    tangents = np.zeros((1, 2, place.size))
    tangents[0, :, : packed.n] = np.random.default_rng(0).normal(size=(2, packed.n))
    length = max(1, settings.window // BATCHES)
    growth = []
    for batch in range(BATCHES + 2):
        tangents /= _norm(packed, tangents)
        log = make_log(packed, length)
        require(run_periods(packed, work, place, velocity, tangents, length, 0, settings.tolerance, log))
        if batch >= 2:
            growth.append(np.log(_norm(packed, tangents)) / length)
    mean = float(np.mean(growth))
    half = float(2.13 * np.std(growth, ddof=1) / np.sqrt(len(growth)))
    if mean - half > NEUTRAL:
        return Motion.CHAOTIC, (mean, half)
    if abs(mean) + half <= NEUTRAL:
        return Motion.QUASI_PERIODIC, (mean, half)
    return Motion.NOT_SETTLED, (mean, half)


def _norm(packed: Packed, tangents: Array) -> float:
    return float(np.sqrt(((packed.weights * tangents) ** 2).sum()))
