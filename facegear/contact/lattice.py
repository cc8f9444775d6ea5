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
        """Number of refined cells in a coarse one, along profile and face."""
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
        """Return which points lie beyond the flank.

        Parameters
        ----------
        at : Array
            Refined lattice coordinates (q, 2), dimensionless.

        Returns
        -------
        Mask
            Whether a point lies in the fillet (q,).
        """
        return np.asarray(at[:, 0] > self.flank_end)

    def interpolation_rows(self) -> Rows:
        """Interpolate from the nodes before refinement to the refined ones.

        Returns
        -------
        Rows
            Weights (n, c), dimensionless, of the displacements before refinement; shared by all callers.
        """
        return _interpolation_rows(self)

    def loads(self, rows: Rows, at: Array, is_refined: bool = True) -> sp.csr_matrix:
        """Spread unit forces on nodes.

        Parameters
        ----------
        rows : Rows
            By which parts (m, q) each unit force acts at points, dimensionless.
        at : Array
            Refined lattice coordinates (q, 2) of the points, dimensionless.
        is_refined : bool
            Whether the nodes are the refined ones, not those before refinement.

        Returns
        -------
        csr_matrix
            Force (m, n) on each node by each unit force, N/N.
        """
        pointer, index, weight = rows
        points, column = np.unique(index, return_inverse=True)
        spread = sp.csr_matrix((weight, column, pointer), shape=(pointer.size - 1, points.size))
        if is_refined:
            return spread @ interpolation(at[points], self.shape, self.linear)
        return spread @ interpolation(at[points] / self.factors, self.coarse, self.linear)


@lru_cache(maxsize=8)
def _interpolation_rows(lattice: Lattice) -> Rows:
    """Return the interpolation from coarse nodes as arrays of a sparse matrix for the kernel."""
    nodes = np.argwhere(np.ones(lattice.shape)) / lattice.factors
    matrix = interpolation(nodes, lattice.coarse, lattice.linear)
    matrix.eliminate_zeros()
    return matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data
