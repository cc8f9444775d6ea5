"""Load-sharing coefficients, equations (25) and (26)."""

import numpy as np
from numpy.typing import NDArray


def sharing_coefficient(forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest over mean magnitude of the forces that share a load.

    `forces` has shape (..., paths), N, elastic mesh forces of either flank; the result (...) lies in
    [1, paths]: 1 for equal loads, the number of paths where one carries all. Where all forces vanish the
    coefficient is undefined and NaN stands there. Equation (25) with two paths, (26) with three.
    """
    sizes = np.abs(np.asarray(forces, dtype=float))
    largest = sizes.max(axis=-1)
    loaded = largest > 0.0
    relative = sizes / np.where(loaded, largest, 1.0)[..., None]
    mean = np.where(loaded, relative.mean(axis=-1), 1.0)
    return np.where(loaded, np.clip(1.0 / mean, 1.0, sizes.shape[-1]), np.nan)


def lost_contact(forces: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Where at least one of the paths carries nothing, shape (...) for forces (..., paths)."""
    return (np.asarray(forces) == 0.0).any(axis=-1)
