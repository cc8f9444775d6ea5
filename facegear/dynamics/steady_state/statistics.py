"""Moments of plain samples, and whether a run is still on its way."""

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.between_samples import located_extremes
from facegear.dynamics.steady_state.averages import (
    BATCHES,
    Averages,
    Moments,
    mean_interval,
    successive_interval,
)

SMOOTH = 0.02
"""Von Neumann's ratio below which the RMS from period to period is a smooth curve (2 for independent
values).
"""


def moments(samples: Array, per_period: int, periodic: bool) -> Moments:
    """Moments of evenly spaced samples over whole periods; extremes are located between the samples.

    They are right where the samples resolve all motion; the moments of a response come from its step
    polynomials.

    Parameters
    ----------
    samples : (K, columns) array
        Samples, any unit.
    per_period : int
        Number of samples in each mesh period.
    periodic : bool
        Whether the samples are a whole period of the motion.

    Returns
    -------
    Moments
        Moments of each column, in the unit of the samples.
    """
    mean = samples.mean(axis=0)
    deviations = samples - mean
    squared = deviations**2
    variance = squared.mean(axis=0)
    rms, ac_rms = np.sqrt(variance + mean**2), np.sqrt(variance)
    spread, ac_spread = np.zeros((2, mean.size))
    if not periodic:
        from_mean, from_squared = (batch_means(values, per_period) for values in (deviations, squared))
        spread = mean_interval(from_squared + 2.0 * mean * from_mean) / (2.0 * np.where(rms > 0.0, rms, 1.0))
        ac_spread = mean_interval(from_squared) / (2.0 * np.where(ac_rms > 0.0, ac_rms, 1.0))
    minimum, maximum = located_extremes(samples, periodic)
    return Moments(
        mean=mean,
        rms=rms,
        ac_rms=ac_rms,
        minimum=minimum,
        maximum=maximum,
        rms_interval=spread,
        ac_rms_interval=ac_spread,
    )


def batch_means(values: Array, per_period: int) -> Array:
    """Means over batches of whole periods.

    Parameters
    ----------
    values : (K, columns) array
        Samples, any unit.
    per_period : int
        Number of samples in each mesh period.

    Returns
    -------
    (batches, columns) array
        Means, in the unit of the samples.
    """
    periods = len(values) // per_period
    batches = max(min(BATCHES, periods), 1)
    whole = periods // batches * batches * per_period
    return values[:whole].reshape(batches, -1, values.shape[1]).mean(axis=1)


def drifts(averages: Averages, by_period: Array) -> bool:
    """Whether a run is still on its way: its halves differ, or its RMS from period to period is a smooth
    curve.

    Halves differ if the AC RMS of a mesh does so by more than chance and 10 %. A smooth curve has successive
    differences that are small beside its variance (von Neumann's ratio, 2 for independent values).

    Parameters
    ----------
    averages : Averages
        Averages over the batches of the run.
    by_period : (periods, columns) array
        RMS in each period, m.

    Returns
    -------
    bool
        True if the run has not settled.
    """
    half = len(averages.weight) // 2
    if half == 0:
        return False
    (first, first_doubt), (last, last_doubt) = (
        _ac_rms(averages.part(part)) for part in (slice(0, half), slice(-half, None))
    )
    doubt = 3.0 * (first_doubt + last_doubt)
    if (np.abs(first - last) > np.maximum(doubt, 0.1 * np.maximum(first, last))).any():
        return True
    successive = (np.diff(by_period, axis=0) ** 2).mean(axis=0)
    return bool((successive < SMOOTH * by_period.var(axis=0)).all())


def _ac_rms(averages: Averages) -> tuple[Array, Array]:
    """AC RMS (meshes,) of the deflections over a few batches, and its half-width by successive batches."""
    ac_rms = averages.meshes(False).ac_rms
    half_width = successive_interval(averages.centred_squares)
    return ac_rms, half_width / (2.0 * np.where(ac_rms > 0.0, ac_rms, 1.0))
