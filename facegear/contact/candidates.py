"""Loads of a pair of teeth that may act: their gaps, lever arms and nodal forces on both bodies."""

from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers, Mask
from facegear.contact.basis_functions import (
    Cover,
    FacingPairs,
    FacingPoints,
    Rows,
    chosen_rows,
    functions_within,
)
from facegear.contact.lattice import Lattice


@dataclass(frozen=True, eq=False)
class Candidates:
    """Loads of one tooth pair that may act: unit forces, each spread over a basis function's covered area or
    along an edge.

    hats (m,): lattice nodes of the basis functions; gap (m,) m and lever_arm (m,) m: averages over each
    basis function; `fillet` (m,): whether it presses on a fillet of either gear; `averages`: weights of
    the points under each basis function, which lie at refined coordinates `at` (q, 2) on the `lattices` of
    pinion and gear.
    """

    tooth: int
    hats: Integers
    gap: Array
    lever_arm: Array
    fillet: Mask
    averages: Rows
    at: tuple[Array, Array]
    lattices: tuple[Lattice, Lattice]
    _load_cache: dict[tuple[int, bool], sp.csr_matrix] = field(default_factory=dict, init=False)

    def loads(self, side: int, is_refined: bool) -> sp.csr_matrix:
        """Return the nodal forces of all loads on one gear's lattice.

        Parameters
        ----------
        side : int
            0 for the pinion, 1 for the gear.
        is_refined : bool
            Whether the nodes are those after refinement.

        Returns
        -------
        (m, nodes) sparse matrix
            Dimensionless: forces on nodes of unit loads.
        """
        if (side, is_refined) not in self._load_cache:
            self._load_cache[side, is_refined] = self.lattices[side].loads(
                self.averages, self.at[side], is_refined
            )
        return self._load_cache[side, is_refined]

    def only(self, keep: Mask) -> "Candidates":
        """Return some of the loads.

        Parameters
        ----------
        keep : (m,) array of bool
            Marks the loads to return.

        Returns
        -------
        Candidates
            Marked loads.
        """
        if keep.all():
            return self
        return replace(
            self,
            hats=self.hats[keep],
            gap=self.gap[keep],
            lever_arm=self.lever_arm[keep],
            fillet=self.fillet[keep],
            averages=chosen_rows(self.averages, keep),
        )


def candidates_of(
    pinion: Lattice,
    gear: Lattice,
    tooth: int,
    points: FacingPoints,
    min_area: Array,
    limit: float,
    first: int = 0,
) -> list[Candidates]:
    """Return the loads of basis functions whose gap a rotation would close.

    Parameters
    ----------
    pinion : Lattice
        Lattice of the pinion.
    gear : Lattice
        Lattice of the gear.
    tooth : int
        Number of the pair.
    points : FacingPoints
        Points of the pair.
    min_area : (functions,) array
        Covered area below which a basis function is left out, m2.
    limit : float
        Rotation, rad.
    first : int
        Number of the first basis function of the pinion's nodes; all others are those of edges.

    Returns
    -------
    list[Candidates]
        One entry, or none if no gap is closed.
    """
    starts, teeth = np.array([0, points.gap.size]), np.array([tooth])
    cover = Cover(min_area, first, pinion.shape, (pinion.flank_end, gear.flank_end))
    functions = functions_within(FacingPairs(points, starts, teeth), cover, limit)
    if functions.node.size == 0:
        return []
    return [
        Candidates(
            tooth=tooth,
            hats=functions.node,
            gap=functions.gap,
            lever_arm=functions.lever_arm,
            fillet=functions.fillet,
            averages=functions.average,
            at=(points.pinion, points.gear),
            lattices=(pinion, gear),
        )
    ]
