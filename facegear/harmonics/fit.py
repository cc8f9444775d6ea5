"""Fourier series of a periodic curve sampled evenly, with the errors of truncation and of sampling."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.harmonics.series import Harmonics

LEVELS = (0.001, 0.01, 0.05)
"""Fractions of the peak-to-peak value for which the orders needed are reported."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Fourier series through all n samples, orders 0..(n-1)//2.

    Attributes
    ----------
    series : Harmonics
        The series, N/m.
    truncation : (H+1,) array
        Largest deviation from the samples if the series is cut after each order, N/m.
    sampling : (H+1,) array
        Estimated error of each amplitude, from leaving out every second sample, whose aliasing is that of
        half the points, N/m; NaN for orders that half the points do not reach.
    peak_to_peak : float
        Range of the samples, N/m.
    """

    series: Harmonics
    truncation: Array
    sampling: Array
    peak_to_peak: float

    def orders_within(self, level: float) -> int | None:
        """Find the smallest order after which the series may be cut.

        Parameters
        ----------
        level : float
            Largest deviation from the samples, as a fraction of their peak-to-peak value.

        Returns
        -------
        int or None
            Order; None if no order suffices.
        """
        enough = np.flatnonzero(self.truncation <= level * self.peak_to_peak)
        return int(enough[0]) if enough.size else None


def fit_harmonics(samples: Array) -> Fit:
    """Fit a Fourier series to samples at 0, 1/n, 2/n ... of a period by least squares (discrete Fourier
    transform).

    Parameters
    ----------
    samples : (n,) array
        Samples of one period, N/m or any unit.

    Returns
    -------
    Fit
        Series and its errors, in the unit of the samples.

    Raises
    ------
    ValueError
        For fewer than four samples.
    """
    samples = np.asarray(samples, dtype=float)
    if samples.ndim != 1 or samples.size < 4:
        raise ValueError("at least four samples of one period are needed")
    series = _transform(samples)
    angle = 2.0 * np.pi * np.arange(samples.size) / samples.size
    truncation, rest = np.empty(series.order + 1), samples.copy()
    for h in range(series.order + 1):
        rest -= series.sine[h] * np.sin(h * angle) + series.cosine[h] * np.cos(h * angle)
        truncation[h] = np.abs(rest).max()
    halves = [_transform(samples[start::2]) for start in (0, 1)] if samples.size >= 8 else []
    sampling = np.full(series.order + 1, np.nan)
    for half, shift in zip(halves, (0.0, 1.0 / samples.size), strict=False):
        shifted_series = half.shift(shift)
        count = half.order + 1
        change = np.hypot(
            shifted_series.sine - series.sine[:count], shifted_series.cosine - series.cosine[:count]
        )
        sampling[:count] = np.fmax(sampling[:count], change)
    return Fit(series, truncation, sampling, float(np.ptp(samples)))


def _transform(samples: Array) -> Harmonics:
    count = samples.size
    spectrum = np.fft.rfft(samples)[: (count - 1) // 2 + 1] / count
    spectrum[1:] *= 2.0
    a = -spectrum.imag
    a[0] = 0.0
    return Harmonics(a, spectrum.real)
