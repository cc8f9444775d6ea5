"""Amplitude spectra over multiples of the mesh frequency."""

import numpy as np

from facegear.arrays import Array

SEGMENT = 8
"""Mesh periods in a segment; orders are multiples of 1 / SEGMENT."""
MAX_ORDER = 6
"""Largest order of the grid, in multiples of the mesh frequency."""
ORDERS = np.arange(SEGMENT * MAX_ORDER + 1) / SEGMENT
"""Grid of the orders, in multiples of the mesh frequency."""


def spectrum(samples: Array, per_period: int, periodic: bool) -> tuple[Array, Array]:
    """Amplitude spectrum of whole periods; Hann-weighted unless periodic.

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
    """Amplitudes on the fixed grid ORDERS, RMS-averaged over segments (Welch 1967).

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
