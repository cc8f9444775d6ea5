"""Samples of periodic motions as dense as averages of their coefficients need."""

import numpy as np

from facegear.dynamics.dense_motion import DenseMotion
from facegear.dynamics.motion import Motion
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.track import track

DENSE, MAX_SAMPLES_OF_RUN = 2048, 16_384
"""Samples of a mesh cycle, and of a period of many cycles."""
SAME = 1e-5
"""Distance over the length scale, in mesh deflections, within which two places are one."""


def densely_sampled(response: SteadyState) -> DenseMotion:
    """A periodic motion at many instants, others at their samples.

    Coefficients jump where a path takes up or loses load, so their means err by the time between two samples:
    by 6e-3 with 256 a cycle. The motion has no jumps, and its Fourier series gives the instants between.
    """
    factor = 1
    if response.motion is Motion.PERIODIC:
        longest = MAX_SAMPLES_OF_RUN // len(response.coordinates)
        factor = max(min(DENSE // response.per_period, longest), 1)
    return DenseMotion(response, factor * response.per_period, track(response, factor))


def same_orbit(first: SteadyState, other: SteadyState) -> bool:
    """Whether two periodic motions are one, perhaps begun at another cycle of it: what holds for the first
    holds for the other.
    """
    if not first.period or first.period != other.period:
        return False
    moved = first.coordinates[:: first.per_period] - other.coordinates[0]
    far = np.abs(moved @ first.system.mesh_jacobian.T).max(axis=1)
    return bool(far.min() <= SAME * first.system.scale)
