"""Rigid motions along a line: x, y, z and the two tilts, as shafts and their bearings take them."""

from collections.abc import Sequence

import numpy as np

from facegear.arrays import Array

MOTIONS = 5
"""Motions of a cross-section: x, y, z, tilt_x, tilt_y."""
LOOSE = 1e-9
"""Stiffness of the softest rigid motion over the stiffest's below which bearings do not hold a shaft.

Rounding leaves 1e-16; the softest real bearing against the stiffest one that a config allows gives 1e-8.
"""


def carry_motion(distance: float) -> Array:
    """Return the matrix that gives the motion of a point of a rigid shaft from that of another point.

    With small tilts (rad) about x and y it is x + distance tilt_y and y - distance tilt_x; the rest is
    equal.

    Parameters
    ----------
    distance : float
        Place of the point along z less that of the other one, m.

    Returns
    -------
    Array
        Motions by motions (5, 5), in the order x, y, z, tilt_x, tilt_y, m and rad; its transpose carries
        a
        load at the point back to the other one.
    """
    matrix = np.eye(MOTIONS)
    matrix[0, 4], matrix[1, 3] = distance, -distance
    return matrix


def is_held(distances: Sequence[float], stiffnesses: Sequence[Array], length: float) -> bool:
    """Tell whether bearings hold a rigid shaft against every motion but rotation about its axis.

    The 5 x 5 stiffness of the shaft is summed over the bearings, its tilts are scaled by `length`, and
    its smallest eigenvalue must be above LOOSE times the largest.

    Parameters
    ----------
    distances : sequence of float
        Places of the bearings along the shaft from any point of it, m.
    stiffnesses : sequence of Array
        Stiffness of each bearing (5, 5), order x, y, z, tilt_x, tilt_y; N/m, N/rad and N m/rad.
    length : float
        Length of the shaft, m, by which tilts are compared with shifts.

    Returns
    -------
    bool
        Whether no motion is left free.
    """
    total = np.zeros((MOTIONS, MOTIONS))
    for distance, stiffness in zip(distances, stiffnesses, strict=True):
        motion = carry_motion(distance)
        total += motion.T @ stiffness @ motion
    scale = np.array([1.0, 1.0, 1.0, length, length])
    softest, *_, stiffest = np.linalg.eigvalsh(total / np.outer(scale, scale))
    return bool(softest > LOOSE * stiffest)
