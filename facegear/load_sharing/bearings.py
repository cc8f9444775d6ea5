"""Mass of the bearings of a machine for the loads that they carry."""

import numpy as np

from facegear.arrays import Array

LIFE_EXPONENT = 10.0 / 3.0
"""Exponent of roller bearings, ISO 281: life falls as this power of the load."""

MASS_EXPONENT = 3.0 / (7.0 / 9.0 + 29.0 / 27.0)
"""Mass grows as this power of the dynamic rating: of similar roller bearings the first goes with the cube of
their size, the second, ISO 281, with roller length^(7/9) times roller diameter^(29/27)."""

NO_LOAD = 1e-100
"""Square of a load (N2) that counts as none."""

REFERENCE = 1e4
"""Load (N) of the bearing whose mass is the unit."""


def bearing_mass(forces: Array) -> float:
    """Return the mass of all bearings, in masses of one that carries REFERENCE for the same life.

    Each bearing is of one series, as large as its equivalent load P = (mean of F^(10/3))^(3/10) asks for at
    equal life, so that its mass goes with P^1.62; F is the length of the force. Bodies turn at different
    speeds, which is left out.

    Parameters
    ----------
    forces : (bodies, 3, K) array
        Force of every body on its bearing at K evenly spaced times, N.

    Returns
    -------
    float
        Relative to the mass of that bearing.
    """
    square = np.einsum("bik,bik->bk", forces, forces)
    powers = np.exp(0.5 * LIFE_EXPONENT * np.log(np.maximum(square, NO_LOAD)))  # np.power is slower
    equivalent = np.mean(powers, axis=-1) ** (1.0 / LIFE_EXPONENT)
    return float(np.sum((equivalent / REFERENCE) ** MASS_EXPONENT))
