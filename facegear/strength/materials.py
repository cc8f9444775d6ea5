"""Material cards: the limits that a rating needs, each with its source."""

from dataclasses import dataclass

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
