"""Limits of materials, damage by Miner's rule (Miner 1945), and reliability."""

from dataclasses import dataclass
from math import log, nan

import numpy as np

from facegear.arrays import Array


@dataclass(frozen=True)
class Life:
    """Life factor over load cycles: log-log straight lines between (cycles, factor) points.

    Constant before the first point (static strength) and beyond the last one.
    """

    cycles: tuple[float, ...]
    factors: tuple[float, ...]

    def factor(self, cycles: Array | float) -> Array:
        """Return the life factor at numbers of cycles.

        Parameters
        ----------
        cycles : (...) array or float
            Number of cycles.

        Returns
        -------
        (...) array
            Life factor, dimensionless, in the shape of `cycles`.
        """
        at = np.log(np.maximum(np.asarray(cycles, dtype=float), self.cycles[0]))
        return np.exp(np.interp(at, np.log(self.cycles), np.log(self.factors)))

    def allowed_cycles(self, factor: Array | float) -> Array:
        """Return how often a stress may be repeated.

        Parameters
        ----------
        factor : (...) array or float
            Stress over the limit, dimensionless.

        Returns
        -------
        (...) array
            Number of cycles, in the shape of `factor`: 0 above static strength, infinite at or below the
            factor of the last point.
        """
        level = np.asarray(factor, dtype=float)
        log_factors = np.log(self.factors[::-1])
        cycles = np.exp(np.interp(np.log(np.maximum(level, 1e-300)), log_factors, np.log(self.cycles[::-1])))
        return np.where(level > self.factors[0], 0.0, np.where(level <= self.factors[-1], np.inf, cycles))


@dataclass(frozen=True)
class PittingLimits:
    """Allowable contact stress: `limit` sigma_H lim in Pa.

    weibull_shape: of the distribution of lives; None where the card does not give it.
    """

    limit: float
    life: Life
    weibull_shape: float | None


@dataclass(frozen=True)
class BendingLimits:
    """Allowable root stress: `limit` sigma_F lim of the reference gear in Pa.

    slip_layer: thickness rho' in m; mean_stress: constant and slope of the mean stress ratio
    M = constant - slope Y_S. Either is None where the card does not give it; the factors that need it then
    stop the rating with its name. weibull_shape as for pitting.
    """

    limit: float
    life: Life
    weibull_shape: float | None
    slip_layer: float | None
    mean_stress: tuple[float, float] | None


@dataclass(frozen=True)
class MaterialCard:
    """A material with its elasticity and the limits its source gives; those it does not give are None."""

    name: str
    source: str
    grade: str
    young_modulus: float
    poisson_ratio: float
    pitting: PittingLimits | None
    bending: BendingLimits | None


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
