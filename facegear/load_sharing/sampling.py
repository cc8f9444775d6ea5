"""Samples of periodic motions as dense as averages of their coefficients need."""

from dataclasses import replace

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.motion import Motion
from facegear.dynamics.steady_state.mesh_samples import by_mesh, each_deflection
from facegear.dynamics.steady_state.response import SteadyState

DENSE, MAX_SAMPLES_OF_RUN = 2048, 16_384
"""Samples of a mesh cycle, and of a period of many cycles."""
SAME = 1e-5
"""Distance over the length scale, in mesh deflections, within which two places are one."""


def densely_sampled(response: SteadyState) -> SteadyState:
    """A periodic motion with at least as many samples, others as they are.

    Coefficients jump where a path takes up or loses load, so their means err by the time between two samples:
    by 6e-3 with 256 a cycle. The motion has no jumps, and its Fourier series gives the instants between.
    """
    if response.motion is not Motion.PERIODIC:
        return response
    factor = min(DENSE // response.per_period, MAX_SAMPLES_OF_RUN // len(response.coordinates))
    if factor < 2:
        return response
    coordinates, per_period = between(response.coordinates, factor), factor * response.per_period
    deflections = by_mesh(response.system, each_deflection(response.system, coordinates, per_period))
    return replace(response, coordinates=coordinates, deflections=deflections, per_period=per_period)


def between(samples: Array, factor: int) -> Array:
    """Values (factor K, columns) of a periodic series given by K even samples (K, columns), from the same
    start.
    """
    count = len(samples)
    spectrum = np.fft.rfft(samples, axis=0)
    if count % 2 == 0:
        spectrum[-1] *= 0.5  # half of the wave of largest order belongs to its negative frequency
    return np.asarray(np.fft.irfft(spectrum, factor * count, axis=0) * factor)


def same_orbit(first: SteadyState, other: SteadyState) -> bool:
    """Whether two periodic motions are one, perhaps begun at another cycle of it: what holds for the first
    holds for the other.
    """
    if not first.period or first.period != other.period:
        return False
    moved = first.coordinates[:: first.per_period] - other.coordinates[0]
    far = np.abs(moved @ first.system.mesh_jacobian.T).max(axis=1)
    return bool(far.min() <= SAME * first.system.scale)
