"""What many samples say: percentiles, shares and Sobol indices, each with its confidence interval."""

from dataclasses import dataclass

import numpy as np
import scipy.stats
from numpy.typing import NDArray

Array = NDArray[np.float64]
RESAMPLES = 499
"""Resamples of the bootstrap for the intervals of Sobol indices."""


@dataclass(frozen=True)
class Estimate:
    """A number with the two-sided confidence interval around it."""

    value: float
    low: float
    high: float


def percentile(values: Array, probability: float, confidence: float = 0.95) -> Estimate:
    """Percentile of a sample, with the interval between order statistics that needs no distribution.

    The interval is that of independent samples; those of a scrambled Sobol sequence lie closer together, so
    it is on the safe side. An end that the sample is too small to bound is infinite.
    """
    ordered = np.sort(values)
    count, tail = ordered.size, 0.5 * (1.0 - confidence)
    binomial = scipy.stats.binom(count, probability)
    low, high = int(binomial.ppf(tail)), int(binomial.ppf(1.0 - tail)) + 1
    return Estimate(
        float(np.quantile(ordered, probability)),
        float(ordered[low - 1]) if low > 0 else -np.inf,
        float(ordered[high - 1]) if high <= count else np.inf,
    )


def share(hits: NDArray[np.bool_], confidence: float = 0.95) -> Estimate:
    """Share of samples for which something holds, with Wilson's interval."""
    count, found = hits.size, int(hits.sum())
    interval = scipy.stats.binomtest(found, count).proportion_ci(confidence, method="wilson")
    return Estimate(found / count, float(interval.low), float(interval.high))


@dataclass(frozen=True)
class SobolIndices:
    """First-order and total index of each cause; `blocks` of the design were used, `failed` held a NaN."""

    first: tuple[Estimate, ...]
    total: tuple[Estimate, ...]
    blocks: int
    failed: int


def sobol_indices(values: Array, causes: int, confidence: float = 0.95, seed: int = 0) -> SobolIndices:
    """Sobol indices of one output from the results (samples,) of Saltelli's design, in its order.

    Blocks that hold a failed sample (NaN) are left out and counted. The first of the others are used, as many
    as the largest power of two: SciPy's estimator asks for that. Intervals are bootstrapped over blocks.
    Raises ValueError where no block is whole.
    """
    blocks = values[: values.size // (causes + 2) * (causes + 2)].reshape(-1, causes + 2)
    whole = np.isfinite(blocks).all(axis=1)
    if not whole.any():
        raise ValueError("no block of the design is whole")
    kept = blocks[whole][: 2 ** int(np.log2(whole.sum()))]
    functions = {"f_A": kept[None, :, 0], "f_B": kept[None, :, 1], "f_AB": kept[:, 2:].T[:, None, :]}
    found = scipy.stats.sobol_indices(func=functions, n=len(kept), rng=np.random.default_rng(seed))
    spread = found.bootstrap(confidence_level=confidence, n_resamples=RESAMPLES)
    return SobolIndices(
        first=_estimates(found.first_order, spread.first_order.confidence_interval),
        total=_estimates(found.total_order, spread.total_order.confidence_interval),
        blocks=len(kept),
        failed=int((~whole).sum()),
    )


def _estimates(values: Array, interval: "scipy.stats._common.ConfidenceInterval") -> tuple[Estimate, ...]:
    rows = np.broadcast_arrays(values, interval.low, interval.high)
    return tuple(Estimate(*map(float, row)) for row in zip(*(part.ravel() for part in rows), strict=True))
