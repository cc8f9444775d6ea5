"""Extrema of the mesh deflections over whole mesh periods, to the accuracy of the steps."""

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.integrator import Integrator

MAX_EXTREMA = 64
"""Number of extrema of a mesh that are stored for each mesh period."""


def extrema(integrator: Integrator, state: Array, periods: int) -> Array:
    """Maxima and minima of each mesh deflection over a run.

    Parameters
    ----------
    integrator : Integrator
        Integrates the system at one mesh frequency.
    state : (2, n) array
        State by phase at the start, m and m/rad.
    periods : int
        Number of mesh periods.

    Returns
    -------
    (m, 2, most) array
        Maxima, then minima of each mesh in falling order, m; minus infinity fills the rows that have fewer.

    Raises
    ------
    NotConverged
        If a step fails.
    """
    values, counts = integrator.extrema(state, periods, MAX_EXTREMA * periods)
    return -np.sort(-values[:, :, : min(counts.max(), values.shape[2])])
