"""Compiled: the load-dependent law in statics."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.mesh_law import terms


class LoadDependentHeld(NamedTuple):
    """Bounds of the slopes (K, M), cosines and sines (K, harmonics + 1) of K phases, and the law."""

    stiffness: Array
    cosine: Array
    sine: Array
    table: Array
    levels: Array
    kind: Integers


@terms.held_force.of(LoadDependentHeld)
def held_force(held: LoadDependentHeld, k: int, m: int, amount: float) -> tuple[float, float]:
    """The cubic and its derivative at phase number k."""
    kind = held.kind[m]
    piece = np.searchsorted(held.levels[kind], amount, side="right") - 1
    series = held.table[kind, piece]
    zeroth, first, second, third = 0.0, 0.0, 0.0, 0.0
    for j in range(series.shape[0]):
        sine, cosine = held.sine[k, j], held.cosine[k, j]
        zeroth += series[j, 0, 0] * sine + series[j, 1, 0] * cosine
        first += series[j, 0, 1] * sine + series[j, 1, 1] * cosine
        second += series[j, 0, 2] * sine + series[j, 1, 2] * cosine
        third += series[j, 0, 3] * sine + series[j, 1, 3] * cosine
    ahead = amount - held.levels[kind, piece]
    force = zeroth + ahead * (first + ahead * (second + ahead * third))
    return force, first + ahead * (2.0 * second + 3.0 * ahead * third)
