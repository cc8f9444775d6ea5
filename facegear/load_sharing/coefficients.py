"""Load-sharing coefficients, equations (25) and (26)."""

import numpy as np

from facegear.arrays import Array, Mask


def sharing_coefficient(forces: Array) -> Array:
    """Return the largest over the mean magnitude of the forces that share a load.

    Equation (25) with two paths, (26) with three.

    Parameters
    ----------
    forces : (..., paths) array
        Elastic mesh forces of either flank without those that are rounding
        (`facegear.transmission.flanks.significant_forces`), N.

    Returns
    -------
    (...) array
        Dimensionless, in [1, paths]: 1 for equal loads, the number of paths where one carries all. NaN where
        all forces vanish, as the coefficient is undefined.
    """
    sizes = np.abs(_path_by_path(forces))
    total = sizes.sum(axis=0)
    has_load = total > 0.0
    ratio = len(sizes) * sizes.max(axis=0) / np.where(has_load, total, 1.0)
    return np.where(has_load, np.clip(ratio, 1.0, len(sizes)), np.nan)


def lost_contact(forces: Array) -> Mask:
    """Return where at least one of the paths carries nothing.

    Parameters
    ----------
    forces : (..., paths) array
        Forces, N.

    Returns
    -------
    (...) array of bool
        True if a force is 0.
    """
    return (_path_by_path(forces) == 0.0).any(axis=0)


def _path_by_path(forces: Array) -> Array:
    """Forces (paths, ...), each path in one piece: sums over two or three neighbours in memory are slow."""
    return np.ascontiguousarray(np.moveaxis(np.asarray(forces, dtype=float), -1, 0))
