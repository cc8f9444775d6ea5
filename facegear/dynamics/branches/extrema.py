"""Extrema of the mesh deflections over whole mesh periods, to the accuracy of the steps."""

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator

MAX_EXTREMA = 64
"""Extrema of a mesh kept for each mesh period."""


def extrema(integrator: Integrator, state: Array, periods: int) -> Array:
    """Maxima and minima (m, 2, most) of each deflection over a run from a state (2, n), each falling, and
    minus infinity where there are fewer. Raises NotConverged where a step fails.
    """
    values, counts = integrator.extrema(state, periods, MAX_EXTREMA * periods)
    return -np.sort(-values[:, :, : min(counts.max(), values.shape[2])])
