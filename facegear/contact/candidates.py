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
    """Loads of one tooth pair that may act: a unit force each, spread over a hat's covered area or along an
    edge.

    hats (m,) lattice nodes; gap (m,) m and lever_arm (m,) m averaged over
    the hat; whether it presses on a `fillet` (m,) of either gear; `averages` over the points under each hat,
    which stand at refined coordinates `at` (q, 2) on the `lattices` of pinion and gear.
    """

    tooth: int
    hats: Integers
    gap: Array
    lever_arm: Array
    fillet: Mask
    averages: Rows
    at: tuple[Array, Array]
    lattices: tuple[Lattice, Lattice]
    _made: dict[tuple[int, bool], sp.csr_matrix] = field(default_factory=dict, init=False)

    def loads(self, side: int, refined: bool) -> sp.csr_matrix:
        """Nodal forces (m, nodes) on the pinion's (0) or the gear's (1) lattice.

        Its nodes are those before refinement unless `refined`.
        """
        if (side, refined) not in self._made:
            self._made[side, refined] = self.lattices[side].loads(self.averages, self.at[side], refined)
        return self._made[side, refined]

    def only(self, keep: Mask) -> "Candidates":
        """Those marked (m,)."""
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
    """Those of the hats over points that a turn by `limit` (rad) would close: one entry, or none.

    min_area: the covered area below which a hat is left out; those of the pinion's nodes begin at `first`,
    the others are hats of edges.
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
