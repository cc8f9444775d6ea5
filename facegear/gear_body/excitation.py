"""Waves of a turning body that the meshes drive, and how strongly their phases let them add up."""

import numpy as np

from facegear.arrays import Array

HARMONICS = (1, 2, 3)
"""Multiples of the mesh frequency whose crossings are listed."""


def phase_factors(order: int, harmonic: int, teeth: int, angles: Array) -> tuple[float, float]:
    """Return how many times the force of one mesh drives the forward and the backward wave of an order.

    Force k of the mesh harmonics at the pinion at angle psi is Re[F e^(i k (w t - N psi))], the same at all
    pinions: the results are the sizes of sum e^(i (k N - n) psi) and sum e^(i (k N + n) psi).

    Parameters
    ----------
    order : int
        Number n of nodal diameters.
    harmonic : int
        Number k of the mesh harmonic.
    teeth : int
        Number of teeth N of the gear.
    angles : (n,) array
        Angles of the pinions, rad.

    Returns
    -------
    pair of float
        Forward and backward wave, relative to one mesh.
    """
    turns = harmonic * teeth * angles
    return (
        float(abs(np.exp(1j * (turns - order * angles)).sum())),
        float(abs(np.exp(1j * (turns + order * angles)).sum())),
    )
