"""Compliance between all candidate hats of a position: both bodies, own teeth and neighbours."""

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from facegear.contact.candidates import Candidates
from facegear.contact.compliance import FlankCompliance


def influence_matrix(
    pairs: list[Candidates],
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool = True,
) -> NDArray[np.float64]:
    """Approach (m, m) of hat i by a unit force on hat j, m/N, hats of all pairs in order; symmetric.

    `coupled` False leaves out the coupling between neighbouring teeth, for comparison.
    """
    ends = np.cumsum([0] + [len(pair.hats) for pair in pairs])
    matrix = np.zeros((ends[-1], ends[-1]))
    for i, first in enumerate(pairs):
        own = slice(ends[i], ends[i + 1])
        matrix[own, own] = _own(first.pinion, pinion.own) + _own(first.gear, gear.own)
        if not coupled:
            continue
        for j in range(i):
            second = pairs[j]
            other = slice(ends[j], ends[j + 1])
            places = first.tooth - second.tooth
            block = _between(first.pinion_coarse, pinion.block(places), second.pinion_coarse)
            block = block + _between(first.gear_coarse, gear.block(places), second.gear_coarse)
            matrix[own, other] = block
            matrix[other, own] = block.T
    return matrix


def _own(loads: sp.csr_matrix, compliance: NDArray[np.float64]) -> NDArray[np.float64]:
    used = np.unique(loads.indices)
    narrow = loads[:, used]
    part = compliance[np.ix_(used, used)]
    result = narrow @ (narrow @ part).T
    return 0.5 * (result + result.T)


def _between(
    first: sp.csr_matrix, compliance: NDArray[np.float64] | None, second: sp.csr_matrix
) -> NDArray[np.float64]:
    if compliance is None:
        return np.zeros((first.shape[0], second.shape[0]))
    return first @ (second @ compliance.T).T
