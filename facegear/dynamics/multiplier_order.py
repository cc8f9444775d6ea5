"""In which order Floquet multipliers stand, so that rounding does not decide it."""

import numpy as np

from facegear.arrays import Array, ComplexArray, Integers

SAME = 1e-9
"""Moduli and real parts nearer than this, relative to the largest modulus, are equal."""


def by_modulus(multipliers: ComplexArray) -> Integers:
    """Order (n,) by falling modulus; of equal moduli by falling real, then falling imaginary part.

    Example:
        >>> by_modulus(np.array([0.5 - 0.5j, 0.5 + 0.5j, -0.9]))
        array([2, 1, 0])
    """
    modulus = np.abs(multipliers)
    near = SAME * float(modulus.max(initial=0.0))
    return np.lexsort((-multipliers.imag, _rank(-multipliers.real, near), _rank(-modulus, near)))


def _rank(values: Array, near: float) -> Integers:
    """Rank (n,) of each value among those that lie further apart than `near`."""
    rising = np.argsort(values)
    rank = np.zeros(len(values), dtype=int)
    rank[rising[1:]] = np.cumsum(np.diff(values[rising]) > near)
    return rank
