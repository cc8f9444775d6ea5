"""Rays cut with a tooth of the face gear: the first of its surfaces that is hit.

All angles in rad, all lengths in m, for the right side of tooth 0 in the gear's body frame.
"""

import numpy as np

from facegear._kernels import flanks
from facegear.arrays import AnyArray, Array
from facegear.geometry.ray_blank import Blank, FlankSample

NO_PART, FLANK, FILLET, TIP_LAND, ROOT_LAND = range(5)


def cut(
    blank: Blank, sample: FlankSample, starts: Array, ways: Array, search_radius: float
) -> tuple[list[AnyArray], int]:
    """Cut rays with the gear by Newton's method.

    Parameters
    ----------
    blank, sample
        The gear, as `gear_rays` makes them.
    starts : (n, 3)
        Where rays begin, m.
    ways : (n, 3)
        Their directions, unit vectors.
    search_radius
        How far (m) along them surfaces are looked for.

    Returns
    -------
    list of (n,)
        Fields of `Separation` in its order.
    int
        Number of rays close to a surface that could not be cut with it.
    """
    count = len(starts)
    numbers, part = np.empty((5, count)), np.empty(count, np.int8)
    lost_count = flanks.cut_rays(blank, sample, starts, ways, search_radius, numbers, part)
    gap, u, v, continued, radius = numbers
    return [gap, part, u, v, continued, radius], lost_count
