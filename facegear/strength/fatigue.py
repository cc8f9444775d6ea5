"""Damage of a duty cycle by Miner's rule (Miner 1945), and reliability by a Weibull distribution."""

from math import log, nan

import numpy as np

from facegear.arrays import Array
from facegear.strength.materials import Life

LIMIT_RELIABILITY = 0.99
"""Reliability for which the limits of the standard hold: one failure in a hundred."""


def damage(stress: Array, cycles: Array, allowed: float, life: Life) -> Array:
    """Damage of each bin of a duty cycle, same shape: cycles over those allowed at its stress.

    stress (Pa) and cycles by bin; allowed: stress (Pa) that may be repeated for ever before life factors.
    Infinite where a stress is above static strength.
    """
    permitted = life.allowed_cycles(stress / allowed)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(cycles > 0.0, cycles / permitted, 0.0)
    return np.asarray(shares, dtype=float)


def reliability(total: float, shape: float | None) -> float:
    """Share of the gears that survive Miner's sum `total`, by a Weibull distribution of lives from 0.

    Sum 1 is the life that LIMIT_RELIABILITY of them reach. nan without a shape, and for a sum of 0: below
    every limit more than LIMIT_RELIABILITY survive, but the distribution of lives does not say how many.
    """
    if shape is None or total == 0.0:
        return nan
    return float(np.exp(log(LIMIT_RELIABILITY) * total**shape))
