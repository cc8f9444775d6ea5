"""Damage of a duty cycle by Miner's rule, and reliability by a Weibull distribution."""

from math import log

import numpy as np
from numpy.typing import NDArray

from facegear.strength.materials import Life

LIMIT_RELIABILITY = 0.99
"""Reliability for which the limits of the standard hold: one failure in a hundred."""


def damage(
    stress: NDArray[np.float64], cycles: NDArray[np.float64], allowed: float, life: Life
) -> NDArray[np.float64]:
    """Damage of each bin of a duty cycle, same shape: cycles over those allowed at its stress.

    stress (Pa) and cycles by bin; allowed: stress (Pa) that may be repeated for ever before life factors.
    Infinite where a stress is above static strength.
    """
    permitted = life.allowed_cycles(stress / allowed)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(cycles > 0.0, cycles / permitted, 0.0)
    return np.asarray(shares, dtype=float)


def life_at_reliability(life: float, reliability: float, shape: float) -> float:
    """Life at a reliability, from that at 99 % and the shape of the Weibull distribution (two parameters)."""
    return life * float((log(reliability) / log(LIMIT_RELIABILITY)) ** (1.0 / shape))
