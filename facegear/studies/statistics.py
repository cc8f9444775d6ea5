"""Percentiles, fractions and Sobol indices with their confidence, and the loosest tolerances."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
import scipy

from facegear.arrays import Array, Mask
from facegear.errors import FacegearError

RESAMPLES = 499
"""Resamples of the bootstrap for the intervals of Sobol indices."""


@dataclass(frozen=True)
class Estimate:
    """A number with the two-sided confidence interval around it."""

    value: float
    low: float
    high: float


def percentile(values: Array, probability: float, confidence: float = 0.95) -> Estimate:
    """Estimate a percentile, with the distribution-free interval between order statistics.

    The interval is that of independent samples; those of a scrambled Sobol sequence lie closer together,
    so it is on the safe side. An end that the sample is too small to bound is infinite.

    Parameters
    ----------
    values : (samples,) array
        Sample, any unit.
    probability : float
        Level of the percentile, a fraction from 0 to 1.
    confidence : float
        Confidence of the interval, a fraction.

    Returns
    -------
    Estimate
        Percentile (linear between order statistics) and both ends of the interval, in the unit of the
        values.
    """
    sorted_values = np.sort(values)
    count, tail = sorted_values.size, 0.5 * (1.0 - confidence)
    binomial = scipy.stats.binom(count, probability)
    low, high = int(binomial.ppf(tail)), int(binomial.ppf(1.0 - tail)) + 1
    return Estimate(
        float(np.quantile(sorted_values, probability)),
        float(sorted_values[low - 1]) if low > 0 else -np.inf,
        float(sorted_values[high - 1]) if high <= count else np.inf,
    )


def fraction_of(hits: Mask, confidence: float = 0.95) -> Estimate:
    """Estimate the share of samples for which something holds, with its interval (Wilson 1927).

    Parameters
    ----------
    hits : (samples,) array of bool
        True where it holds.
    confidence : float
        Confidence of the interval, a fraction.

    Returns
    -------
    Estimate
        Share and both ends of the interval, fractions from 0 to 1; the interval ends at 0 or 1 where no
        or every sample counts.
    """
    count, counts = hits.size, int(hits.sum())
    part, z = counts / count, float(scipy.special.ndtri(0.5 + 0.5 * confidence))
    whole = 2.0 * (count + z**2)
    centre = (2.0 * count * part + z**2) / whole
    reach = z / whole * float(np.sqrt(4.0 * count * part * (1.0 - part) + z**2))
    low = centre - reach if counts > 0 else 0.0
    return Estimate(part, low, centre + reach if counts < count else 1.0)


@dataclass(frozen=True)
class SobolIndices:
    """First-order and total index of each cause; `blocks` of the design were used, `failed_blocks` held a
    NaN.
    """

    first: tuple[Estimate, ...]
    total: tuple[Estimate, ...]
    blocks: int
    failed_blocks: int


def sobol_indices(
    values: Array, causes: int, confidence: float = 0.95, seed: int = 0, resamples: int = RESAMPLES
) -> SobolIndices:
    """Estimate the Sobol indices of one output from the results of Saltelli's design (Saltelli et al.
    2010).

    Blocks that hold a failed sample (NaN) are left out and counted. The first of the others are used, as
    many as the largest power of two: SciPy's estimator asks for that. Intervals are bootstrapped over
    blocks.

    Parameters
    ----------
    values : (samples,) array
        Results in the order of `sampling.index_samples`, blocks of `causes` + 2, any unit; NaN where a
        sample failed. An incomplete last block is left out.
    causes : int
        Number of causes.
    confidence : float
        Confidence of the intervals, a fraction.
    seed : int
        Seed of the bootstrap.
    resamples : int
        Number of resamples of the bootstrap.

    Returns
    -------
    SobolIndices
        First-order and total index of each cause with its interval, dimensionless, and numbers of blocks
        used and failed.

    Raises
    ------
    ValueError
        If every block holds a failed sample.
    """
    blocks = values[: values.size // (causes + 2) * (causes + 2)].reshape(-1, causes + 2)
    whole = np.isfinite(blocks).all(axis=1)
    if not whole.any():
        raise ValueError("no block of the design is whole")
    used_blocks = blocks[whole][: 2 ** int(np.log2(whole.sum()))]
    indices = _indices(used_blocks)
    draw = np.random.default_rng(seed)
    resampled = [
        _indices(used_blocks[draw.integers(0, len(used_blocks), len(used_blocks))]) for _ in range(resamples)
    ]
    tail = 0.5 * (1.0 - confidence)
    low, high = np.nanquantile(resampled, [tail, 1.0 - tail], axis=0)
    first, total = (
        tuple(Estimate(*map(float, row)) for row in zip(*parts, strict=True))
        for parts in zip(indices, low, high, strict=True)
    )
    return SobolIndices(first, total, blocks=len(used_blocks), failed_blocks=int((~whole).sum()))


def _indices(blocks: Array) -> Array:
    """Return first-order and total Sobol indices (2, causes) from whole blocks (blocks, causes + 2).

    A block holds the results at A, at B, and at A with each cause from B. The bootstrap calls it resample
    by resample, to save memory.
    """
    functions = {"f_A": blocks[None, :, 0], "f_B": blocks[None, :, 1], "f_AB": blocks[:, 2:].T[:, None, :]}
    estimate = scipy.stats.sobol_indices(func=functions, n=len(blocks))
    return np.array([estimate.first_order.ravel(), estimate.total_order.ravel()])


HALVINGS = 10
"""Halvings of the range of scales: its width falls to a thousandth."""


@dataclass(frozen=True, eq=False)
class Loosest:
    """`scale` that all deviations may be multiplied by, what the percentile is there, and all that was tried.

    `interval`: the scales at which the upper and the lower end of the percentile's interval meet the limit,
    interpolated between the trials; infinite where no trial bounds it. `trials`: scale, value, low, high (the
    interval of the percentile), failed (samples without result).
    """

    scale: float
    interval: tuple[float, float]
    percentile: Estimate
    trials: pd.DataFrame


def loosest(
    sample_results: Callable[[float], Array], at_most: float, level: float, max_factor: float
) -> Loosest:
    """Find the largest scale of all deviations at which a percentile does not exceed a limit, by
    bisection.

    The percentile is taken to rise with the scale. Tried are 0 and `max_factor`, then HALVINGS midpoints;
    the result is the largest scale tried that holds the limit.

    Parameters
    ----------
    sample_results : callable
        Function from a scale to the results (samples,) of the same samples, nan where one has none, which
        counts as above every limit; scale dimensionless.
    at_most : float
        Limit, in the unit of the results.
    level : float
        Level of the percentile, a fraction from 0 to 1.
    max_factor : float
        Largest scale to try, dimensionless factor; the result if it holds.

    Returns
    -------
    Loosest
        Largest scale, the scales at which the ends of the percentile's interval meet the limit, the
        percentile there, and a table of all trials.

    Raises
    ------
    FacegearError
        If the limit is exceeded by the machine without any deviation.
    """
    results_by_scale: dict[float, tuple[Estimate, int]] = {}

    def holds(scale: float) -> bool:
        """Evaluate the samples at a scale, keep the percentile, and tell whether it is at most the limit."""
        values = sample_results(scale)
        is_failed = np.isnan(values)
        results_by_scale[scale] = percentile(np.where(is_failed, np.inf, values), level), int(is_failed.sum())
        return bool(results_by_scale[scale][0].value <= at_most)  # inf and nan do not hold

    if not holds(0.0):
        requirement = f"already {results_by_scale[0.0][0].value:.6g} without any deviation"
        raise FacegearError(f"at_most = {at_most:g}: {requirement}")
    low, high = 0.0, max_factor
    if holds(max_factor):
        low = max_factor
    for _ in range(HALVINGS if low < max_factor else 0):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    rows = [
        (scale, answer.value, answer.low, answer.high, failures)
        for scale, (answer, failures) in sorted(results_by_scale.items())
    ]
    trials = pd.DataFrame(rows, columns=["scale", "value", "low", "high", "failed"])
    return Loosest(low, _interval(trials, at_most), results_by_scale[low][0], trials)


def _interval(trials: pd.DataFrame, at_most: float) -> tuple[float, float]:
    """Return the scales at which the upper and the lower end of the percentile's interval pass the limit.

    `trials` has the columns scale (rising), low and high. Ends are first made to rise with the scale by
    their running maximum, then interpolated linearly between trials. A scale is infinite where no trial
    is above the limit, and 0 where the first is.
    """
    scale = trials["scale"].to_numpy(float)
    bounds = []
    for end in ("high", "low"):
        values = np.maximum.accumulate(trials[end].to_numpy(float))
        above = np.flatnonzero(values > at_most)
        first = int(above[0]) if above.size else len(scale)
        if first in (0, len(scale)):
            bounds.append(0.0 if first == 0 else np.inf)
        elif not np.isfinite(values[[first - 1, first]]).all():
            bounds.append(float(scale[first - 1]))
        else:
            bounds.append(
                float(np.interp(at_most, values[first - 1 : first + 1], scale[first - 1 : first + 1]))
            )
    return bounds[0], bounds[1]
