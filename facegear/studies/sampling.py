"""Samples by number: the same number gives the same sample in any chunk, order or count of jobs."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
import scipy.special
import scipy.stats
from scipy.stats import qmc

from facegear.arrays import Array
from facegear.schema.tolerances import Tolerances, correlation_matrix


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
        """Return the values at cumulative probabilities: the inverse of the cumulative distribution.

        With limits the distribution is truncated: probabilities are mapped linearly onto those between
        the limits. For `choice` equal parts of (0, 1) belong to the values in turn. Without spread all
        values are `centre`.

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
        """Lower and upper limit of the values, infinite where none is given."""
        return self.limits if self.limits is not None else (-np.inf, np.inf)

    @property
    def _scipy_distribution(self) -> "scipy.stats.rv_frozen":
        """Frozen SciPy distribution without limits: Rayleigh with scale `spread`, or normal; of no use
        for other shapes.
        """
        if self.shape is Shape.RAYLEIGH:
            return scipy.stats.rayleigh(scale=self.spread)
        return scipy.stats.norm(self.centre, self.spread)


SMALLEST = 2.0**-53
"""Probabilities keep this distance from 0 and 1, where a normal quantile is infinite."""


@dataclass(frozen=True)
class Cause:
    """Something that varies from machine to machine, and the config keys that it moves.

    `gains` maps a dotted key to the change of its value for one unit of the cause; the change is added to the
    nominal value. `source` says where the distribution is from: an ISO grade, a drawing's limits.
    """

    name: str
    distribution: Distribution
    gains: tuple[tuple[str, float], ...]
    source: str


@dataclass(frozen=True, eq=False)
class Population:
    """Causes, the seed of their scrambled Sobol sequence, and their rank correlation (d, d) if they have one.

    The correlation is that of the normal scores (a Gaussian copula); its Cholesky factor must exist.
    """

    causes: tuple[Cause, ...]
    seed: int
    correlation: Array | None = None
    factor: Array | None = field(init=False)

    def __post_init__(self) -> None:
        factor = None if self.correlation is None else np.linalg.cholesky(self.correlation)
        object.__setattr__(self, "factor", factor)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the causes."""
        return tuple(cause.name for cause in self.causes)


def samples(population: Population, start: int, count: int) -> Array:
    """Return the values of consecutive samples of a scrambled Sobol sequence.

    Sample s is the same whatever `start` and `count` are.

    Parameters
    ----------
    population : Population
        Causes with their distributions, seed, and rank correlation if there is one.
    start : int
        Number of the first sample, from 0.
    count : int
        Number of samples.

    Returns
    -------
    (count, causes) array
        Values of the causes, in the unit of each cause: one row a sample.
    """
    probability = _sobol(len(population.causes), population.seed, start, count)
    return _values(population.causes, _correlated(probability, population.factor))


def index_samples(population: Population, start: int, count: int) -> Array:
    """Return the values of consecutive samples of Saltelli's design for Sobol indices.

    Sample s belongs to block s // (d + 2) with d causes. Within its block come the point A, the point B,
    and for each cause in turn the point A with this cause taken from B. Sobol point s // (d + 2) in 2 d
    dimensions holds A in its first half and B in its second.

    Parameters
    ----------
    population : Population
        The causes; they must be independent.
    start : int
        Number of the first sample, from 0.
    count : int
        Number of samples.

    Returns
    -------
    (count, causes) array
        Values of the causes, in the unit of each cause: one row a sample.

    Raises
    ------
    ValueError
        If the causes are correlated.
    """
    if population.factor is not None:
        raise ValueError("Sobol indices ask for independent causes")
    size = len(population.causes)
    first, last = start // (size + 2), (start + count - 1) // (size + 2)
    base = _sobol(2 * size, population.seed, first, last - first + 1)
    blocks = np.empty((len(base), size + 2, size))
    blocks[:, 0], blocks[:, 1] = base[:, :size], base[:, size:]
    blocks[:, 2:] = base[:, None, :size]
    for cause in range(size):
        blocks[:, 2 + cause, cause] = base[:, size + cause]
    rows = blocks.reshape(-1, size)[start - first * (size + 2) :][:count]
    return _values(population.causes, rows)


def changes(population: Population, values: Sequence[float]) -> dict[str, float]:
    """Return the changes of config keys in one sample: gain times value, summed over all causes that move
    a key.

    Parameters
    ----------
    population : Population
        Causes with their distributions, seed, and rank correlation if there is one.
    values : Sequence[float]
        Values (causes,) of the sample, in the unit of each cause.

    Returns
    -------
    dict[str, float]
        Increment of the nominal value by dotted config key, in the unit of the key.
    """
    increments: dict[str, float] = {}
    for cause, value in zip(population.causes, values, strict=True):
        for key, gain in cause.gains:
            increments[key] = increments.get(key, 0.0) + gain * float(value)
    return increments


def _sobol(dimensions: int, seed: int, start: int, count: int) -> Array:
    """Return scrambled Sobol points (count, dimensions) from number `start` on, in the open interval (0,
    1).

    The sequence depends on `dimensions` and `seed` alone. Points keep the distance SMALLEST from 0 and 1.
    """
    sequence = qmc.Sobol(dimensions, scramble=True, rng=np.random.default_rng(seed))
    if start:
        sequence.fast_forward(start)
    with warnings.catch_warnings():
        warnings.filterwarnings(
            "ignore", "The balance properties", UserWarning
        )  # a chunk need not be balanced
        return np.clip(sequence.random(count), SMALLEST, 1.0 - SMALLEST)


def _correlated(probability: Array, factor: Array | None) -> Array:
    """Return probabilities (samples, causes) with the rank correlation of a Gaussian copula.

    `probability` has independent columns in (0, 1). Their normal scores are multiplied by `factor`
    (causes, causes), the lower Cholesky factor of the correlation of scores. None returns them as they
    are. Sums run in a fixed order, so that a row does not depend on the number of rows.
    """
    if factor is None:
        return probability
    scores = scipy.special.ndtri(probability)
    correlated_scores = np.zeros_like(scores)
    for row in range(len(factor)):
        for column in range(row + 1):
            correlated_scores[:, row] += factor[row, column] * scores[:, column]
    return np.clip(scipy.special.ndtr(correlated_scores), SMALLEST, 1.0 - SMALLEST)


def _values(causes: tuple[Cause, ...], probability: Array) -> Array:
    """Return the values (samples, causes), each in its cause's unit, at cumulative probabilities
    (samples, causes).
    """
    columns = [cause.distribution.quantile(probability[:, i]) for i, cause in enumerate(causes)]
    return np.column_stack(columns)


def population(section: Tolerances) -> "Population":
    """Return the causes of section `tolerances` with their distributions, seed and rank correlation, for
    sampling.

    Parameters
    ----------
    section : Tolerances
        Section `tolerances` of the config.

    Returns
    -------
    Population
        Causes in the order of the config. A value of a cause times its gain is a change in the unit of
        the key.
    """
    causes = tuple(
        Cause(
            cause.name,
            Distribution(Shape(cause.shape), cause.centre, cause.spread or 0.0, cause.limits, cause.values),
            tuple(cause.moves.items()),
            cause.source,
        )
        for cause in section.causes
    )
    return Population(causes, section.seed, correlation_matrix(section))
