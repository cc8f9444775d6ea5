"""Samples of periodic motions as dense as averages of their coefficients need."""

import numpy as np

from facegear.dynamics.dense_motion import DenseMotion
from facegear.dynamics.motion import Motion
from facegear.dynamics.steady_state.response import SteadyState
from facegear.dynamics.track import track

DENSE, MAX_SAMPLES_OF_RUN = 2048, 16_384
"""Samples of a mesh cycle, and of a period of many cycles."""
ORBIT_TOLERANCE = 1e-5
"""Distance over the length scale, in mesh deflections, within which two positions count as one."""


def densely_sampled(response: SteadyState) -> DenseMotion:
    """Return a periodic motion at many instants, others at their samples.

    Coefficients jump where a path takes up or loses load, so their means err by the time between two samples:
    by 6e-3 with 256 a cycle. The motion has no jumps, and its Fourier series gives the instants between.

    Parameters
    ----------
    response : SteadyState
        The motion at its own samples.

    Returns
    -------
    DenseMotion
        At most DENSE samples in a mesh cycle, or MAX_SAMPLES_OF_RUN in a period of many cycles.
    """
    factor = 1
    if response.motion is Motion.PERIODIC:
        longest = MAX_SAMPLES_OF_RUN // len(response.coordinates)
        factor = max(min(DENSE // response.per_period, longest), 1)
    return DenseMotion(response, factor * response.per_period, track(response, factor))


def same_orbit(first: SteadyState, second: SteadyState) -> bool:
    """Whether two periodic motions are one, perhaps begun at another cycle of it.

    Parameters
    ----------
    first : SteadyState
        A motion.
    second : SteadyState
        Another motion of the same machine.

    Returns
    -------
    bool
        False where one is not periodic.
    """
    if not first.period or first.period != second.period:
        return False
    distances = first.coordinates[:: first.per_period] - second.coordinates[0]
    far = np.abs(distances @ first.system.mesh_jacobian.T).max(axis=1)
    return bool(far.min() <= ORBIT_TOLERANCE * first.system.scale)
