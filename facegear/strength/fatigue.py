"""Damage of a duty cycle by Miner's rule (Miner 1945), and reliability by a Weibull distribution."""

from math import log, nan

import numpy as np

from facegear.arrays import Array
from facegear.strength.materials import Life

LIMIT_RELIABILITY = 0.99
"""Reliability for which the limits of the standard hold: one failure in a hundred."""


def damage(stress: Array, cycles: Array, allowed_stress: float, life: Life) -> Array:
    """Compute the damage of each bin of a duty cycle: cycles over those allowed at its stress.

    Parameters
    ----------
    stress : (bins,) array
        Stress, Pa.
    cycles : (bins,) array
        Number of cycles.
    allowed_stress : float
        Stress that may be repeated for ever before life factors, Pa.
    life : Life
        Life factors of the material.

    Returns
    -------
    (bins,) array
        Damage, dimensionless; infinite where a stress is above static strength.
    """
    permitted = life.allowed_cycles(stress / allowed_stress)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(cycles > 0.0, cycles / permitted, 0.0)
    return np.asarray(shares, dtype=float)


def reliability(total: float, shape: float | None) -> float:
    """Compute the share of the gears that survive, by a Weibull distribution of lives from 0.

    Sum 1 is the life that LIMIT_RELIABILITY of the gears reach. Below every limit more than LIMIT_RELIABILITY
    survive, but the distribution of lives does not say how many.

    Parameters
    ----------
    total : float
        Miner's sum, dimensionless.
    shape : float or None
        Shape of the Weibull distribution, dimensionless; None where it is not known.

    Returns
    -------
    float
        Share, 0 to 1; nan without a shape, and for a sum of 0.
    """
    if shape is None or total == 0.0:
        return nan
    return float(np.exp(log(LIMIT_RELIABILITY) * total**shape))
