"""A periodic mesh stiffness as a Fourier series."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array


@dataclass(frozen=True, eq=False)
class Harmonics:
    """k(t) = sum_j a[j] sin(j w t) + b[j] cos(j w t), equation (8) of the paper; w is the mesh frequency.

    `a` and `b` have shape (H+1,) and the unit N/m. a[0] is zero and b[0] is the mean.
    """

    a: Array
    b: Array

    def __post_init__(self) -> None:
        a = np.array(self.a, dtype=float)
        b = np.array(self.b, dtype=float)
        if a.ndim != 1 or a.shape != b.shape or a.size == 0:
            raise ValueError(f"a and b must have one shape (H+1,), not {a.shape} and {b.shape}")
        if not (np.isfinite(a).all() and np.isfinite(b).all()):
            raise ValueError("harmonics must be finite")
        if a[0] != 0.0:
            raise ValueError(f"a[0] multiplies sin(0) and must be 0, not {a[0]}")
        a.flags.writeable = False
        b.flags.writeable = False
        object.__setattr__(self, "a", a)
        object.__setattr__(self, "b", b)

    @property
    def order(self) -> int:
        """Largest order H."""
        return self.a.size - 1

    @property
    def mean(self) -> float:
        """Mean stiffness b[0], N/m."""
        return float(self.b[0])

    @cached_property
    def minimum(self) -> float:
        """Smallest value at 64 (H+1) even points of a period, N/m."""
        points = 64 * (self.order + 1)
        halves = 0.5 * (self.b - 1j * self.a)
        halves[0] = self.b[0]
        return float(np.fft.irfft(points * halves, points).min())

    @cached_property
    def amplitudes(self) -> Array:
        """Amplitude of each order, shape (H+1,), N/m, read-only; the first entry is the mean."""
        sizes = np.hypot(self.a, self.b)
        sizes.flags.writeable = False
        return sizes

    def __call__(self, cycles: ArrayLike) -> Array:
        """Stiffness at `cycles` = w t / 2 pi (mesh periods since the start), any shape, N/m."""
        angle = 2.0 * np.pi * np.multiply.outer(np.asarray(cycles, dtype=float), np.arange(self.order + 1))
        return np.sin(angle) @ self.a + np.cos(angle) @ self.b

    def shifted(self, cycles: float) -> "Harmonics":
        """The series of k(t - cycles T)."""
        angle = 2.0 * np.pi * cycles * np.arange(self.order + 1)
        cos, sin = np.cos(angle), np.sin(angle)
        a = self.a * cos + self.b * sin
        a[0] = 0.0
        return Harmonics(a, self.b * cos - self.a * sin)

    def kept(self, order: int) -> "Harmonics":
        """The series cut after `order`."""
        return Harmonics(self.a[: order + 1], self.b[: order + 1])

    def scaled(self, factor: float) -> "Harmonics":
        """The series times `factor`."""
        return Harmonics(self.a * factor, self.b * factor)

    def softened(self, compliance: float) -> "Harmonics":
        """The series of 1 / (1 / k + compliance) up to the same order; compliance in m/N."""
        points = 64 * (self.order + 1)
        stiff = self(np.arange(points) / points)
        spectrum = np.fft.rfft(stiff / (1.0 + compliance * stiff))[: self.order + 1] / points
        spectrum[1:] *= 2.0
        a = -spectrum.imag
        a[0] = 0.0
        return Harmonics(a, spectrum.real)

    def varied(self, factor: float) -> "Harmonics":
        """The series with the same mean and `factor` times its variation about it."""
        b = self.b * factor
        b[0] = self.b[0]
        return Harmonics(self.a * factor, b)


def stacked(series: Sequence[Harmonics]) -> Array:
    """Fourier series as rows (series, 2, harmonics + 1), sine part first, padded to the longest."""
    rows = np.zeros((len(series), 2, max(harmonics.order for harmonics in series) + 1))
    for row, harmonics in zip(rows, series, strict=True):
        row[0, : harmonics.order + 1], row[1, : harmonics.order + 1] = harmonics.a, harmonics.b
    return rows


def stacked_values(rows: Array, cycles: Array) -> Array:
    """Values of stacked Fourier series at `cycles` (K,) in mesh periods, shape (K, series)."""
    angle = 2.0 * np.pi * np.outer(cycles, np.arange(rows.shape[2]))
    return np.sin(angle) @ rows[:, 0].T + np.cos(angle) @ rows[:, 1].T
