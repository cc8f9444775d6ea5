"""Moments of plain samples, and whether a run is still on its way."""

import numpy as np

from facegear.arrays import Array
from facegear.motion.between_samples import located_extremes
from facegear.motion.steady_state.averages import (
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
    """Compute the moments of evenly spaced samples over whole periods; extremes are located between the
    samples.

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
    """Compute the means over at most BATCHES batches of equally many whole periods; periods left over are
    dropped.

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
        RMS of each mesh in each mesh period, without the mean, m.

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
    """Return the AC RMS (meshes,) of the deflections over the batches, m, and its 95 % half-width, m.

    The half-width allows for the correlation of successive batches, see successive_interval().
    """
    ac_rms = averages.meshes(False).ac_rms
    half_width = successive_interval(averages.centred_squares)
    return ac_rms, half_width / (2.0 * np.where(ac_rms > 0.0, ac_rms, 1.0))


SEGMENT = 8
"""Mesh periods in a segment; orders are multiples of 1 / SEGMENT."""
MAX_ORDER = 6
"""Largest order of the grid, in multiples of the mesh frequency."""
ORDERS = np.arange(SEGMENT * MAX_ORDER + 1) / SEGMENT
"""Grid of the orders, in multiples of the mesh frequency."""


def spectrum(samples: Array, per_period: int, periodic: bool) -> tuple[Array, Array]:
    """Compute the one-sided amplitude spectrum of whole periods by FFT; Hann-weighted unless periodic.

    A sine of amplitude A at an order of the grid has the amplitude A (the mean stays the mean).

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
    (F,) array
        Orders in multiples of the mesh frequency, ratio 1.
    (F, columns) array
        Amplitudes, in the unit of the samples.
    """
    count = len(samples)
    window = np.ones(count) if periodic else np.hanning(count + 1)[:count]
    transform = np.fft.rfft(samples * window[:, None], axis=0) / window.sum()
    amplitudes = 2.0 * np.abs(transform)
    amplitudes[0] *= 0.5
    return np.arange(len(amplitudes)) * per_period / count, amplitudes


def order_spectrum(samples: Array, per_period: int, period: int) -> Array:
    """Compute the amplitudes on the fixed grid ORDERS, RMS-averaged over segments of SEGMENT periods
    (Welch 1967).

    The entry at order 0 is the magnitude of the mean.

    Lines of a period that does not divide SEGMENT go to the nearest order of the grid.

    Parameters
    ----------
    samples : (K, columns) array
        Samples, any unit.
    per_period : int
        Number of samples in each mesh period.
    period : int
        Period of the motion in mesh periods; 0 if it is not periodic.

    Returns
    -------
    (columns, orders) array
        Amplitudes, in the unit of the samples.
    """
    result = np.zeros((samples.shape[1], ORDERS.size))
    if period:
        orders, lines = spectrum(samples, per_period, True)
        bins = np.round(orders * SEGMENT).astype(int)
        for index, line in zip(bins, lines, strict=True):
            if index < ORDERS.size:
                result[:, index] = np.hypot(result[:, index], line)
        return result
    length = SEGMENT * per_period
    count = len(samples) // length
    # Columns apart, so that each transform reads what lies side by side.
    segments = samples[: count * length].reshape(count, length, -1).transpose(0, 2, 1).copy()
    window = np.hanning(length + 1)[:length]
    segments -= segments.mean(axis=2, keepdims=True)
    segments *= window
    amplitudes = np.fft.rfft(segments, axis=2)[:, :, : ORDERS.size]
    power = (amplitudes.real**2 + amplitudes.imag**2).sum(axis=0) / max(count, 1)
    result[:] = 2.0 * np.sqrt(power) / window.sum()
    result[:, 0] = np.abs(samples.mean(axis=0))
    return result
