"""Linear functions of a motion and of its velocity, at evenly spaced instants.

A periodic motion is the Fourier series through its samples, so that the instants may lie closer than the
samples. Any other motion has its samples alone.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy

from facegear.arrays import Array, ComplexArray
from facegear.dynamics.integrator.kernel_system import TAU
from facegear.dynamics.steady_state.response import SteadyState


class Track(Protocol):
    """A motion of n coordinates at K evenly spaced instants."""

    @property
    def count(self) -> int:
        """The number K of instants."""

    def along(self, displacement_weights: Array, velocity_weights: Array) -> Array:
        """Compute y displacement_weights + dy/dt velocity_weights at each instant.

        Parameters
        ----------
        displacement_weights, velocity_weights : (n, columns) array
            Weights of the coordinates and of their velocities, any unit.

        Returns
        -------
        (columns, K) array
            Values, in the unit of the weighted coordinates.
        """


@dataclass(frozen=True, eq=False)
class PeriodicTrack:
    """A periodic motion at K evenly spaced instants.

    Velocities are the slopes of the periodic cubic spline through the K instants. Its slopes m satisfy
    m[i-1] + 4 m[i] + m[i+1] = 3 (f[i+1] - f[i-1]) / step, which a Fourier series solves wave by wave.

    Attributes
    ----------
    waves : (n, W) array
        Complex amplitudes of the coordinates times K.
    count : int
        Number K of instants.
    step : float
        Time between two instants, s.
    """

    waves: ComplexArray
    count: int
    step: float

    def along(self, displacement_weights: Array, velocity_weights: Array) -> Array:
        """Compute y displacement_weights + dy/dt velocity_weights at each instant.

        Parameters
        ----------
        displacement_weights, velocity_weights : (n, columns) array
            Weights of the coordinates and of their velocities, any unit.

        Returns
        -------
        (columns, K) array
            Values, in the unit of the weighted coordinates.
        """
        parts, angle = self.waves.view(np.float64), TAU * np.arange(self.waves.shape[1]) / self.count
        total = (displacement_weights.T @ parts).view(np.complex128)
        has_velocity = velocity_weights.any(axis=0)
        slope = 3.0j * np.sin(angle) / ((2.0 + np.cos(angle)) * self.step)
        total[has_velocity] += (velocity_weights.T[has_velocity] @ parts).view(np.complex128) * slope
        return np.asarray(np.fft.irfft(total, self.count, axis=1))


@dataclass(frozen=True, eq=False)
class SampledTrack:
    """Samples (K, n) of the coordinates, `step` (s) apart.

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

    def along(self, displacement_weights: Array, velocity_weights: Array) -> Array:
        """Compute y displacement_weights + dy/dt velocity_weights at each instant.

        Parameters
        ----------
        displacement_weights, velocity_weights : (n, columns) array
            Weights of the coordinates and of their velocities, any unit.

        Returns
        -------
        (columns, K) array
            Values, in the unit of the weighted coordinates.
        """
        total = displacement_weights.T @ self.samples.T
        has_velocity = velocity_weights.any(axis=0)
        if has_velocity.any():
            total[has_velocity] += velocity_weights.T[has_velocity] @ self.rates.T
        return total


def track(response: SteadyState, factor: int = 1) -> Track:
    """Make the track of a response.

    Parameters
    ----------
    response : SteadyState
        Response.
    factor : int
        Number of instants for each sample; above 1 only for a periodic response.

    Returns
    -------
    Track
        Motion at evenly spaced instants.
    """
    step = TAU / (response.frequency * response.per_period)
    if response.period == 0:
        return SampledTrack(response.coordinates, step)
    return periodic_track(response.coordinates, step, factor)


def periodic_track(samples: Array, step: float, factor: int = 1) -> PeriodicTrack:
    """Make the track through the samples of a periodic motion.

    Parameters
    ----------
    samples : (K, n) array
        Evenly spaced samples of a whole period, any unit.
    step : float
        Time between two samples, s.
    factor : int
        Number of instants for each sample.

    Returns
    -------
    PeriodicTrack
        Motion at `factor` K instants.
    """
    count = len(samples)
    waves = np.fft.rfft(np.ascontiguousarray(samples.T), axis=1)
    if factor > 1 and count % 2 == 0:
        waves[:, -1] *= 0.5  # half of the wave of largest order belongs to its negative frequency
    return PeriodicTrack(waves * factor, factor * count, step / factor)
