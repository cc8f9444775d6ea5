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
    is_coupled: bool = True,
) -> Array:
    """Compute the influence matrix of all pairs in order: approach of function i by a unit force on function
    j.

    Parameters
    ----------
    pairs : list[Candidates]
        Candidates of each pair.
    pinion : FlankCompliance
        Compliance of the pinion.
    gear : FlankCompliance
        Compliance of the gear.
    is_coupled : bool
        False leaves out the coupling between neighbouring teeth, for comparison.

    Returns
    -------
    (m, m) array
        Symmetric, m/N.
    """
    ends = np.cumsum([0] + [len(pair.hats) for pair in pairs])
    matrix = np.zeros((ends[-1], ends[-1]))
    for i, first in enumerate(pairs):
        for j, second in enumerate(pairs[: i + 1]):
            block = np.zeros((len(first.hats), len(second.hats)))
            for side, body in enumerate((pinion, gear)):
                is_same_pair = i == j
                compliance = body.loaded_tooth if is_same_pair else body.block(first.tooth - second.tooth)
                if compliance is not None and (is_same_pair or is_coupled):
                    block += body.scale * product(
                        first.loads(side, is_same_pair), compliance, second.loads(side, is_same_pair)
                    )
            matrix[ends[i] : ends[i + 1], ends[j] : ends[j + 1]] = block
            matrix[ends[j] : ends[j + 1], ends[i] : ends[i + 1]] = block.T
    return matrix


def product(first: sp.csr_matrix, compliance: Array | None, second: sp.csr_matrix) -> Array:
    """Compute displacements by loads through a compliance.

    Only those columns of the compliance are read that the loads have entries for.

    Parameters
    ----------
    first : (m, nodes) sparse matrix
        Weights of nodes whose displacement is taken.
    compliance : (nodes, nodes) array, optional
        m/N; None gives 0.
    second : (n, nodes) sparse matrix
        Unit loads on nodes.

    Returns
    -------
    (m, n) array
        Displacements by unit loads, m/N.
    """
    if compliance is None:
        return np.zeros((first.shape[0], second.shape[0]))
    columns = np.unique(second.indices)
    return np.asarray((second[:, columns] @ (first @ compliance[:, columns]).T).T)
