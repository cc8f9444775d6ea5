"""Any linear function of a motion and of its velocity, at evenly spaced instants.

A periodic motion is the Fourier series through its samples, so that the instants may lie closer than those;
any other one has its samples alone.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy

from facegear.arrays import Array, ComplexArray
from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.steady_state.response import SteadyState


class Track(Protocol):
    """A motion of n coordinates at K evenly spaced instants."""

    @property
    def count(self) -> int:
        """The number K of instants."""

    def along(self, places: Array, speeds: Array) -> Array:
        """y places + dy/dt speeds (columns, K) of matrices (n, columns)."""


@dataclass(frozen=True, eq=False)
class PeriodicTrack:
    """waves (n, W): complex amplitudes of the coordinates times K; step: time between two instants, s.

    Velocities are the slopes of the periodic cubic spline through the K instants. Its slopes m satisfy
    m[i-1] + 4 m[i] + m[i+1] = 3 (f[i+1] - f[i-1]) / step, which a Fourier series solves wave by wave.
    """

    waves: ComplexArray
    count: int
    step: float

    def along(self, places: Array, speeds: Array) -> Array:
        """y places + dy/dt speeds (columns, K)."""
        parts, angle = self.waves.view(np.float64), TAU * np.arange(self.waves.shape[1]) / self.count
        total = (places.T @ parts).view(np.complex128)
        moving = speeds.any(axis=0)
        slope = 3.0j * np.sin(angle) / ((2.0 + np.cos(angle)) * self.step)
        total[moving] += (speeds.T[moving] @ parts).view(np.complex128) * slope
        return np.asarray(np.fft.irfft(total, self.count, axis=1))


@dataclass(frozen=True, eq=False)
class SampledTrack:
    """samples (K, n) of the coordinates; step: time between two of them, s.

    Velocities are the slopes of the cubic spline through all samples.
    """

    samples: Array
    step: float

    @property
    def count(self) -> int:
        """The number K of samples."""
        return len(self.samples)

    @cached_property
    def rates(self) -> Array:
        """Velocities (K, n)."""
        time = np.arange(self.count) * self.step
        return np.asarray(scipy.interpolate.CubicSpline(time, self.samples)(time, 1))

    def along(self, places: Array, speeds: Array) -> Array:
        """y places + dy/dt speeds (columns, K)."""
        total = places.T @ self.samples.T
        moving = speeds.any(axis=0)
        if moving.any():
            total[moving] += speeds.T[moving] @ self.rates.T
        return total


def track(response: SteadyState, factor: int = 1) -> Track:
    """The track of a response with `factor` instants for each sample, which only a periodic one may have
    more than one of.
    """
    step = TAU / (response.frequency * response.per_period)
    if response.period == 0:
        return SampledTrack(response.coordinates, step)
    return periodic_track(response.coordinates, step, factor)


def periodic_track(samples: Array, step: float, factor: int = 1) -> PeriodicTrack:
    """Through even samples (K, n) of a period, `step` (s) apart, with `factor` instants for each."""
    count = len(samples)
    waves = np.fft.rfft(np.ascontiguousarray(samples.T), axis=1)
    if factor > 1 and count % 2 == 0:
        waves[:, -1] *= 0.5  # half of the wave of largest order belongs to its negative frequency
    return PeriodicTrack(waves * factor, factor * count, step / factor)
