"""What many samples say: percentiles, fractions and Sobol indices, each with its confidence interval."""

from dataclasses import dataclass

import numpy as np
import scipy

from facegear.arrays import Array, Mask

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


def fraction_of(hits: Mask, confidence: float = 0.95) -> Estimate:
    """Share of samples for which something holds, with its interval (Wilson 1927)."""
    count, counts = hits.size, int(hits.sum())
    part, z = counts / count, float(scipy.special.ndtri(0.5 + 0.5 * confidence))
    whole = 2.0 * (count + z**2)
    centre = (2.0 * count * part + z**2) / whole
    reach = z / whole * float(np.sqrt(4.0 * count * part * (1.0 - part) + z**2))
    low = centre - reach if counts > 0 else 0.0
    return Estimate(part, low, centre + reach if counts < count else 1.0)


@dataclass(frozen=True)
class SobolIndices:
    """First-order and total index of each cause; `blocks` of the design were used, `failed` held a NaN."""

    first: tuple[Estimate, ...]
    total: tuple[Estimate, ...]
    blocks: int
    failed: int


def sobol_indices(
    values: Array, causes: int, confidence: float = 0.95, seed: int = 0, resamples: int = RESAMPLES
) -> SobolIndices:
    """Sobol indices of one output from the results (samples,) of Saltelli's design (Saltelli et al. 2010), in
    its order.

    Blocks that hold a failed sample (NaN) are left out and counted. The first of the others are used, as many
    as the largest power of two: SciPy's estimator asks for that. Intervals are bootstrapped over blocks.
    Raises ValueError where no block is whole.
    """
    blocks = values[: values.size // (causes + 2) * (causes + 2)].reshape(-1, causes + 2)
    whole = np.isfinite(blocks).all(axis=1)
    if not whole.any():
        raise ValueError("no block of the design is whole")
    kept = blocks[whole][: 2 ** int(np.log2(whole.sum()))]
    indices = _indices(kept)
    draw = np.random.default_rng(seed)
    resampled = [_indices(kept[draw.integers(0, len(kept), len(kept))]) for _ in range(resamples)]
    tail = 0.5 * (1.0 - confidence)
    low, high = np.nanquantile(resampled, [tail, 1.0 - tail], axis=0)
    first, total = (
        tuple(Estimate(*map(float, row)) for row in zip(*parts, strict=True))
        for parts in zip(indices, low, high, strict=True)
    )
    return SobolIndices(first, total, blocks=len(kept), failed=int((~whole).sum()))


def _indices(blocks: Array) -> Array:
    """First-order and total indices (2, causes) of whole blocks; a resample at a time, to save memory."""
    functions = {"f_A": blocks[None, :, 0], "f_B": blocks[None, :, 1], "f_AB": blocks[:, 2:].T[:, None, :]}
    estimate = scipy.stats.sobol_indices(func=functions, n=len(blocks))
    return np.array([estimate.first_order.ravel(), estimate.total_order.ravel()])
