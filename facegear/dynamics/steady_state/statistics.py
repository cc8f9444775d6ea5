"""Numbers that describe a response: RMS with and without mean, extremes, loads, loss of contact."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

Array = NDArray[np.float64]
BATCHES = 16
CONFIDENCE = 0.95
SMOOTH = 0.02


@dataclass(frozen=True, eq=False)
class Moments:
    """Of each column: mean, RMS with mean, RMS without mean, smallest, largest, and the 95 % half-widths of
    the RMS.

    The half-widths come from the spread between batches of periods; they are zero for a periodic motion.
    """

    mean: Array
    rms: Array
    ac_rms: Array
    least: Array
    most: Array
    rms_interval: Array
    ac_rms_interval: Array


def moments(samples: Array, per_period: int, periodic: bool) -> Moments:
    """Moments of evenly spaced samples (K, columns) over whole periods (the mean is exact for smooth
    motion).
    """
    mean = samples.mean(axis=0)
    centred = samples - mean
    squares = centred**2
    variance = squares.mean(axis=0)
    rms, ac_rms = np.sqrt(variance + mean**2), np.sqrt(variance)
    spread, ac_spread = np.zeros((2, mean.size))
    if not periodic:
        from_mean, from_squares = (batch_means(values, per_period) for values in (centred, squares))
        spread = half_width(from_squares + 2.0 * mean * from_mean, rms)
        ac_spread = half_width(from_squares, ac_rms)
    return Moments(
        mean=mean,
        rms=rms,
        ac_rms=ac_rms,
        least=samples.min(axis=0),
        most=samples.max(axis=0),
        rms_interval=spread,
        ac_rms_interval=ac_spread,
    )


def batch_means(values: Array, per_period: int) -> Array:
    """Means over batches of whole periods, shape (batches, columns)."""
    periods = len(values) // per_period
    batches = max(min(BATCHES, periods), 1)
    whole = periods // batches * batches * per_period
    return values[:whole].reshape(batches, -1, values.shape[1]).mean(axis=1)


def view_moments(samples: Array, views: Array, per_period: int, periodic: bool) -> tuple[Array, Array, Array]:
    """Of samples @ views (n, columns): RMS, RMS without mean and its 95 % half-width, each (columns,).

    From the covariances of the samples (K, n), batch by batch, without the product itself.
    """
    centre = samples.mean(axis=0)
    centred = samples - centre
    periods = len(samples) // per_period
    batches = 1 if periodic else max(min(BATCHES, periods), 1)
    whole = len(samples) if batches == 1 else periods // batches * batches * per_period
    parts = centred[:whole].reshape(batches, -1, samples.shape[1])
    covariances = parts.transpose(0, 2, 1) @ parts / parts.shape[1]
    variances = np.maximum(((covariances @ views) * views).sum(axis=1), 0.0)
    mean = centre @ views
    variance = variances.mean(axis=0)
    ac_rms = np.sqrt(variance)
    return np.sqrt(variance + mean**2), ac_rms, half_width(variances, ac_rms)


def half_width(means: Array, root: Array) -> Array:
    """95 % half-width (columns,) of a root mean square from batch means of what differs from its square."""
    batches = len(means)
    if batches < 2:
        return np.zeros(root.size)
    error = _student(batches - 1) * means.std(axis=0, ddof=1) / np.sqrt(batches)
    return error / (2.0 * np.where(root > 0.0, root, 1.0))


@cache
def _student(freedom: int) -> float:
    """Two-sided quantile of Student's distribution."""
    return float(student.ppf(0.5 + 0.5 * CONFIDENCE, freedom))


def drifts(samples: Array, per_period: int) -> bool:
    """Whether a run is still on its way: its halves differ, or its RMS from period to period is a smooth
    curve.

    Halves differ if the AC RMS of a column does so by more than chance and 10 %. A smooth curve has
    successive differences that are small beside its variance (von Neumann's ratio, 2 for independent values).
    """
    periods = len(samples) // per_period
    half = periods // 2 * per_period
    if half == 0:
        return False
    first, last = moments(samples[:half], per_period, False), moments(samples[-half:], per_period, False)
    doubt = 3.0 * (first.ac_rms_interval + last.ac_rms_interval)
    gap = np.abs(first.ac_rms - last.ac_rms)
    if (gap > np.maximum(doubt, 0.1 * np.maximum(first.ac_rms, last.ac_rms))).any():
        return True
    by_period = samples[: periods * per_period].reshape(periods, per_period, -1).std(axis=1)
    successive = (np.diff(by_period, axis=0) ** 2).mean(axis=0)
    return bool((successive < SMOOTH * by_period.var(axis=0)).all())
