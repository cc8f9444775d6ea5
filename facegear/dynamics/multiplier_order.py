"""Order of Floquet multipliers that does not depend on rounding."""

import numpy as np

from facegear.arrays import Array, ComplexArray, Integers

RELATIVE_TOLERANCE = 1e-9
"""Moduli and real parts nearer than this, relative to the largest modulus, are equal."""


def by_modulus(multipliers: ComplexArray) -> Integers:
    """Order multipliers by falling modulus; those of equal modulus by falling real, then falling imaginary
    part.

    Parameters
    ----------
    multipliers : (n,) array
        Floquet multipliers, dimensionless.

    Returns
    -------
    (n,) array
        Indices.

    Examples
    --------
    >>> by_modulus(np.array([0.5 - 0.5j, 0.5 + 0.5j, -0.9]))
    array([2, 1, 0])
    """
    modulus = np.abs(multipliers)
    near = RELATIVE_TOLERANCE * float(modulus.max(initial=0.0))
    return np.lexsort((-multipliers.imag, _rank(-multipliers.real, near), _rank(-modulus, near)))


def _rank(values: Array, near: float) -> Integers:
    """Rank (n,) of each value among those that lie further apart than `near`."""
    ascending = np.argsort(values)
    rank = np.zeros(len(values), dtype=int)
    rank[ascending[1:]] = np.cumsum(np.diff(values[ascending]) > near)
    return rank
