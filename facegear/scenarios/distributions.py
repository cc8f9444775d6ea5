"""Distributions of tolerances by their quantile functions."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy.stats

from facegear.arrays import Array


class Shape(StrEnum):
    """Kinds of distributions."""

    NORMAL = "normal"
    UNIFORM = "uniform"
    RAYLEIGH = "rayleigh"
    CHOICE = "choice"


@dataclass(frozen=True)
class Distribution:
    """A distribution of one cause.

    normal: `centre` and standard deviation `spread`, cut at `limits` and renormalised where they are given.
    uniform: between the two `limits`. rayleigh: the amount of a vector whose two components are normal with
    `spread`, as of a runout; cut at the upper of the `limits`. choice: one of `values`, each as likely.
    """

    shape: Shape
    centre: float = 0.0
    spread: float = 0.0
    limits: tuple[float, float] | None = None
    values: tuple[float, ...] = ()

    def quantile(self, probability: Array) -> Array:
        """Return the quantiles of the distribution.

        Parameters
        ----------
        probability : (...) array
            Probabilities in (0, 1), dimensionless.

        Returns
        -------
        (...) array
            Value at each probability, in the unit of the distribution.
        """
        if self.shape is Shape.CHOICE:
            index = np.floor(probability * len(self.values)).astype(int)
            return np.asarray(self.values)[np.minimum(index, len(self.values) - 1)]
        if self.shape is Shape.UNIFORM:
            low, high = self._limits
            return low + (high - low) * probability
        if self.spread == 0.0:
            return np.full(np.shape(probability), self.centre)
        distribution = self._scipy_distribution
        low, high = (distribution.cdf(limit) for limit in self._limits)
        return np.asarray(distribution.ppf(low + (high - low) * probability), dtype=float)

    @property
    def _limits(self) -> tuple[float, float]:
        return self.limits if self.limits is not None else (-np.inf, np.inf)

    @property
    def _scipy_distribution(self) -> "scipy.stats.rv_frozen":
        if self.shape is Shape.RAYLEIGH:
            return scipy.stats.rayleigh(scale=self.spread)
        return scipy.stats.norm(self.centre, self.spread)
