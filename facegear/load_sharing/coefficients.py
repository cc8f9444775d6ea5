"""Load-sharing coefficients, equations (25) and (26)."""

import numpy as np

from facegear.arrays import Array, Mask


def sharing_coefficient(forces: Array) -> Array:
    """Largest over mean magnitude of the forces that share a load.

    `forces` has shape (..., paths), N, elastic mesh forces of either flank without those that are rounding
    (`facegear.transmission.flanks.carried`); the result (...) lies in
    [1, paths]: 1 for equal loads, the number of paths where one carries all. Where all forces vanish the
    coefficient is undefined and NaN stands there. Equation (25) with two paths, (26) with three.
    """
    sizes = np.abs(_path_by_path(forces))
    total = sizes.sum(axis=0)
    loaded = total > 0.0
    ratio = len(sizes) * sizes.max(axis=0) / np.where(loaded, total, 1.0)
    return np.where(loaded, np.clip(ratio, 1.0, len(sizes)), np.nan)


def lost_contact(forces: Array) -> Mask:
    """Where at least one of the paths carries nothing, shape (...) for forces (..., paths)."""
    return (_path_by_path(forces) == 0.0).any(axis=0)


def _path_by_path(forces: Array) -> Array:
    """Forces (paths, ...), each path in one piece: sums over two or three neighbours in memory are slow."""
    return np.ascontiguousarray(np.moveaxis(np.asarray(forces, dtype=float), -1, 0))
