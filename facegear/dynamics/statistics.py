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
    rms = np.sqrt((samples**2).mean(axis=0))
    ac_rms = np.sqrt((centred**2).mean(axis=0))
    return Moments(
        mean=mean,
        rms=rms,
        ac_rms=ac_rms,
        least=samples.min(axis=0),
        most=samples.max(axis=0),
        rms_interval=half_width(samples**2, rms, per_period, periodic),
        ac_rms_interval=half_width(centred**2, ac_rms, per_period, periodic),
    )


def half_width(squares: Array, root: Array, per_period: int, periodic: bool) -> Array:
    """95 % half-width of a root mean square by batch means, shape (columns,)."""
    periods = len(squares) // per_period
    batches = min(BATCHES, periods)
    if periodic or batches < 2:
        return np.zeros(squares.shape[1])
    whole = periods // batches * batches * per_period
    means = squares[:whole].reshape(batches, -1, squares.shape[1]).mean(axis=1)
    spread = means.std(axis=0, ddof=1) / np.sqrt(batches)
    factor = _student(batches - 1)
    return factor * spread / (2.0 * np.where(root > 0.0, root, 1.0))


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
