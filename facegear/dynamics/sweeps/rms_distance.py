"""Distance of two motions by the RMS of their mesh deflections without mean."""

import numpy as np

from facegear.arrays import Array, Integers

FLOOR = 1e-3
"""Fraction of the largest AC RMS below which no AC RMS is compared."""
MIN_CHANGE = 0.1
"""Relative change of a mesh's AC RMS that may be a jump."""
SAME_ORBIT = 5e-3
"""Relative difference of the AC RMS of periodic motions that counts as the same orbit."""


def distance(first: Array, second: Array) -> float:
    """Largest ratio between two sets of AC RMS, as a logarithm, with a floor.

    Parameters
    ----------
    first, second : (meshes,) array
        AC RMS of each mesh, m.

    Returns
    -------
    float
        Logarithm of the ratio, dimensionless.
    """
    floor = FLOOR * max(first.max(), second.max(), 1e-300)
    return float(np.abs(np.log(np.maximum(first, floor) / np.maximum(second, floor))).max())


def image_distance(first: Array, second: Array, images: Integers) -> float:
    """Smallest distance() of one set of AC RMS from the images of another.

    Parameters
    ----------
    first, second : (meshes,) array
        AC RMS of each mesh, m.
    images : (images, meshes) array
        Permutations of the meshes by symmetry, as indices.

    Returns
    -------
    float
        Logarithm of the ratio, dimensionless.
    """
    return min(distance(first, second[image]) for image in images)
