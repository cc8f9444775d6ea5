"""Nodes of a contact surface, and the nodal forces that unit forces make which are spread over its points."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers, Mask
from facegear.contact.basis_functions import Rows
from facegear.contact.bodies.surface import LINEAR_STEPS, QUADRATIC_STEPS, interpolation
from facegear.contact.options import Refinement

ROUNDING = 1e-6
"""Rounding errors of coordinates on a lattice are smaller, in distances of its nodes."""


@dataclass(frozen=True)
class Lattice:
    """Nodes of a contact surface: their numbers before refinement both ways, and how they are refined.

    `linear` where the body is of elements linear between nodes; `flank_rows`: how many of the rows before
    refinement belong to the flank, None for all; the others lie in the fillet.
    """

    coarse: tuple[int, int]
    refinement: Refinement
    linear: bool = False
    flank_rows: int | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of nodes across the profile and along the width, refined."""
        nu, nv = self.coarse
        return (nu - 1) * self.refinement.profile + 1, (nv - 1) * self.refinement.width + 1

    @property
    def factors(self) -> Integers:
        """Refined nodes a coarse one, both ways."""
        return np.array([self.refinement.profile, self.refinement.width])

    @property
    def flank_end(self) -> float:
        """The refined row beyond which points lie in the fillet."""
        rows = self.coarse[0] if self.flank_rows is None else self.flank_rows
        return (rows - 1) * self.refinement.profile + ROUNDING

    @property
    def steps(self) -> Integers:
        """Rows and columns (a, 2) from the corner of an element's face to its nodes."""
        return LINEAR_STEPS if self.linear else QUADRATIC_STEPS

    def in_fillet(self, at: Array) -> Mask:
        """Which points at refined coordinates (q, 2) lie beyond the flank."""
        return np.asarray(at[:, 0] > self.flank_end)

    def interpolated(self) -> Rows:
        """Displacements of the refined nodes as sums of those of the nodes before refinement: shared."""
        return _interpolated(self)

    def loads(self, rows: Rows, at: Array, refined: bool = True) -> sp.csr_matrix:
        """Nodal forces (m, nodes) of unit forces, spread by `rows` over points at refined coordinates (q, 2).

        The nodes are the refined ones, or those before refinement.
        """
        pointer, index, weight = rows
        points, place = np.unique(index, return_inverse=True)
        spread = sp.csr_matrix((weight, place, pointer), shape=(pointer.size - 1, points.size))
        if refined:
            return spread @ interpolation(at[points], self.shape, self.linear)
        return spread @ interpolation(at[points] / self.factors, self.coarse, self.linear)


@lru_cache(maxsize=8)
def _interpolated(lattice: Lattice) -> Rows:
    refined = np.argwhere(np.ones(lattice.shape)) / lattice.factors
    matrix = interpolation(refined, lattice.coarse, lattice.linear)
    matrix.eliminate_zeros()
    return matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data
