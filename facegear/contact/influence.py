"""Influence matrix of candidate basis functions by sparse products; the solver of a position has its own."""

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.candidates import Candidates


def influence_matrix(
    pairs: list[Candidates],
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool = True,
) -> Array:
    """Approach (m, m) of function i by a unit force on function j, m/N, of all pairs in order; symmetric.

    `coupled` False leaves out the coupling between neighbouring teeth, for comparison.
    """
    ends = np.cumsum([0] + [len(pair.hats) for pair in pairs])
    matrix = np.zeros((ends[-1], ends[-1]))
    for i, first in enumerate(pairs):
        for j, second in enumerate(pairs[: i + 1]):
            block = np.zeros((len(first.hats), len(second.hats)))
            for side, body in enumerate((pinion, gear)):
                own = i == j
                compliance = body.own if own else body.block(first.tooth - second.tooth)
                if compliance is not None and (own or coupled):
                    block += body.scale * product(first.loads(side, own), compliance, second.loads(side, own))
            matrix[ends[i] : ends[i + 1], ends[j] : ends[j + 1]] = block
            matrix[ends[j] : ends[j + 1], ends[i] : ends[i + 1]] = block.T
    return matrix


def product(first: sp.csr_matrix, compliance: Array | None, second: sp.csr_matrix) -> Array:
    """Displacements (m, n) of rows of nodes by unit loads of others, 0 without a compliance.

    Only those columns of the compliance are read that the loads have entries for.
    """
    if compliance is None:
        return np.zeros((first.shape[0], second.shape[0]))
    columns = np.unique(second.indices)
    return np.asarray((second[:, columns] @ (first @ compliance[:, columns]).T).T)
