"""Which waves of a turning body the meshes drive, and how strongly their phases let them add up."""

import numpy as np

from facegear.arrays import Array

HARMONICS = (1, 2, 3)
"""Multiples of the mesh frequency whose crossings are listed."""


def phase_factors(order: int, harmonic: int, teeth: int, angles: Array) -> tuple[float, float]:
    """How many times the force of one mesh drives the forward and the backward wave of an order.

    Force k of the mesh harmonics at the pinion at angle psi is Re[F e^(i k (w t - N psi))], the same at all
    pinions: the sizes of sum e^(i (k N - n) psi) and sum e^(i (k N + n) psi). angles (n,), rad; teeth N.
    """
    turns = harmonic * teeth * angles
    return (
        float(abs(np.exp(1j * (turns - order * angles)).sum())),
        float(abs(np.exp(1j * (turns + order * angles)).sum())),
    )
