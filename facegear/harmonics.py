"""A periodic mesh stiffness as a Fourier series, and the series nearest to a sampled curve."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array


@dataclass(frozen=True, eq=False)
class Harmonics:
    """Fourier series k(t) = sum_j sine[j] sin(j w t) + cosine[j] cos(j w t); w is the mesh frequency.

    Equation (8) of the paper calls the coefficients a and b; most texts call the cosine a.

    Attributes
    ----------
    sine : (H+1,) array
        Coefficients of the sines, N/m; sine[0] is zero.
    cosine : (H+1,) array
        Coefficients of the cosines, N/m; cosine[0] is the mean.
    """

    sine: Array
    cosine: Array

    def __post_init__(self) -> None:
        """Copy both arrays as read-only floats; raise ValueError unless shapes agree, all is finite and
        sine[0] is 0.
        """
        sine = np.array(self.sine, dtype=float)
        cosine = np.array(self.cosine, dtype=float)
        if sine.ndim != 1 or sine.shape != cosine.shape or sine.size == 0:
            raise ValueError(
                f"sine and cosine must have one shape (H+1,), not {sine.shape} and {cosine.shape}"
            )
        if not (np.isfinite(sine).all() and np.isfinite(cosine).all()):
            raise ValueError("harmonics must be finite")
        if sine[0] != 0.0:
            raise ValueError(f"sine[0] multiplies sin(0) and must be 0, not {sine[0]}")
        sine.flags.writeable = False
        cosine.flags.writeable = False
        object.__setattr__(self, "sine", sine)
        object.__setattr__(self, "cosine", cosine)

    @property
    def order(self) -> int:
        """Largest order H."""
        return self.sine.size - 1

    @property
    def mean(self) -> float:
        """Mean stiffness cosine[0], N/m."""
        return float(self.cosine[0])

    @cached_property
    def minimum(self) -> float:
        """Smallest value at 64 (H+1) even points of a period, N/m."""
        points = 64 * (self.order + 1)
        halves = 0.5 * (self.cosine - 1j * self.sine)
        halves[0] = self.cosine[0]
        return float(np.fft.irfft(points * halves, points).min())

    @cached_property
    def amplitudes(self) -> Array:
        """Amplitude of each order, shape (H+1,), N/m, read-only; the first entry is the mean."""
        sizes = np.hypot(self.sine, self.cosine)
        sizes.flags.writeable = False
        return sizes

    def __call__(self, cycles: ArrayLike) -> Array:
        """Stiffness at `cycles` = w t / 2 pi (mesh periods since the start), any shape, N/m."""
        angle = 2.0 * np.pi * np.multiply.outer(np.asarray(cycles, dtype=float), np.arange(self.order + 1))
        return np.sin(angle) @ self.sine + np.cos(angle) @ self.cosine

    def shift(self, cycles: float) -> "Harmonics":
        """Return the series of k(t - cycles T), T the mesh period: features come later by `cycles`.

        Parameters
        ----------
        cycles : float
            Shift in mesh periods.

        Returns
        -------
        Harmonics
            Shifted series.
        """
        angle = 2.0 * np.pi * cycles * np.arange(self.order + 1)
        cos, sin = np.cos(angle), np.sin(angle)
        sine = self.sine * cos + self.cosine * sin
        sine[0] = 0.0
        return Harmonics(sine, self.cosine * cos - self.sine * sin)

    def truncate(self, order: int) -> "Harmonics":
        """Return the series without the terms above an order; no other coefficient changes.

        Parameters
        ----------
        order : int
            Largest order.

        Returns
        -------
        Harmonics
            Truncated series; the same if it has no higher orders.
        """
        return Harmonics(self.sine[: order + 1], self.cosine[: order + 1])

    def scale(self, factor: float) -> "Harmonics":
        """Return the series times a factor, the mean included.

        Parameters
        ----------
        factor : float
            The factor, dimensionless.

        Returns
        -------
        Harmonics
            Scaled series.
        """
        return Harmonics(self.sine * factor, self.cosine * factor)

    def add_compliance(self, compliance: float) -> "Harmonics":
        """Return the series of 1 / (1 / k + compliance) up to the same order.

        It is found by a Fourier transform of 64 (H+1) samples of a period; higher orders are cut off.

        Parameters
        ----------
        compliance : float
            Compliance in series, m/N.

        Returns
        -------
        Harmonics
            Series of the softer stiffness.
        """
        points = 64 * (self.order + 1)
        stiff = self(np.arange(points) / points)
        spectrum = np.fft.rfft(stiff / (1.0 + compliance * stiff))[: self.order + 1] / points
        spectrum[1:] *= 2.0
        sine = -spectrum.imag
        sine[0] = 0.0
        return Harmonics(sine, spectrum.real)

    def scale_variation(self, factor: float) -> "Harmonics":
        """Return the series with the same mean and a multiple of its variation about it.

        Parameters
        ----------
        factor : float
            Factor on the variation, dimensionless.

        Returns
        -------
        Harmonics
            Series with other amplitudes.
        """
        cosine = self.cosine * factor
        cosine[0] = self.cosine[0]
        return Harmonics(self.sine * factor, cosine)


def stack_series(series: Sequence[Harmonics]) -> Array:
    """Stack Fourier series as rows of one array, padded to the longest.

    Parameters
    ----------
    series : sequence of Harmonics
        The series.

    Returns
    -------
    (series, 2, harmonics + 1) array
        Coefficients of the sines, then of the cosines, in the unit of the series.
    """
    rows = np.zeros((len(series), 2, max(harmonics.order for harmonics in series) + 1))
    for row, harmonics in zip(rows, series, strict=True):
        row[0, : harmonics.order + 1], row[1, : harmonics.order + 1] = harmonics.sine, harmonics.cosine
    return rows


def stacked_values(rows: Array, cycles: Array) -> Array:
    """Evaluate stacked Fourier series.

    Parameters
    ----------
    rows : (series, 2, harmonics + 1) array
        Coefficients of stack_series(), any unit.
    cycles : (K,) array
        Instants in mesh periods.

    Returns
    -------
    (K, series) array
        Values, in the unit of the coefficients.
    """
    angle = 2.0 * np.pi * np.outer(cycles, np.arange(rows.shape[2]))
    return np.sin(angle) @ rows[:, 0].T + np.cos(angle) @ rows[:, 1].T


LEVELS = (0.001, 0.01, 0.05)
"""Fractions of the peak-to-peak value for which the orders needed are reported."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Discrete Fourier series of n samples, orders 0..(n-1)//2; it passes through all of them if n is
    odd.

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
    """Compute the discrete Fourier series of samples at 0, 1/n, 2/n ... of a period, orders 0..(n-1)//2.

    It is the least-squares fit of these orders. It passes through all samples if n is odd; if n is even,
    the order n/2 is missing.

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
    """Return the Fourier series of n evenly spaced samples of one period, the first at its start, up to
    (n-1)//2.
    """
    count = samples.size
    spectrum = np.fft.rfft(samples)[: (count - 1) // 2 + 1] / count
    spectrum[1:] *= 2.0
    a = -spectrum.imag
    a[0] = 0.0
    return Harmonics(a, spectrum.real)
