"""Flank compliance of a whole gear from one of its teeth."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from facegear.contact.body import Piece
from facegear.contact.layer import tied_system
from facegear.contact.options import Ends, Refinement
from facegear.contact.ring import face_compliance
from facegear.contact.substructure import condense


@dataclass(frozen=True, eq=False)
class FlankCompliance:
    """Normal displacements of the flanks of a gear by unit normal forces on one of them, m/N.

    `own` (n, n): on the loaded tooth, nodes of the refined lattice `shape`; `others` (2 d + 1, c, c): on the
    tooth t - d places further, nodes of the lattice before refinement `coarse_shape` (the field of a
    neighbour is smooth); the middle block repeats the own tooth and is not used. `refinement` relates the two
    lattices.
    """

    own: NDArray[np.float64]
    others: NDArray[np.float64]
    shape: tuple[int, int]
    coarse_shape: tuple[int, int]
    refinement: Refinement

    def block(self, places: int) -> NDArray[np.float64] | None:
        """Coarse block for a tooth `places` further than the loaded one; None beyond those computed."""
        reach = len(self.others) // 2
        return self.others[places + reach] if abs(places) <= reach else None


def flank_compliance(
    piece: Piece,
    refinement: Refinement,
    teeth: int,
    neighbours: int = 2,
    ends: Ends = "ring",
) -> FlankCompliance:
    """Condense one tooth and couple `teeth` copies of it; `neighbours` on each side are kept.

    Raises FacegearError if the body is not held, ValueError if there are too few teeth.
    """
    system = tied_system(piece, refinement)
    tooth = condense(piece, system)
    shape = system.surface.shape[:2]
    coarse_shape = piece.flank.shape
    moved = face_compliance(tooth.faces, neighbours, teeth, ends)
    flank = tooth.flank
    if piece.left.size:
        flank = flank + tooth.influence @ moved[neighbours] @ tooth.influence.T
    corners = np.arange(flank_size(shape)).reshape(shape)[:: refinement.profile, :: refinement.width].ravel()
    coarse = system.spread[corners] @ tooth.influence
    others = coarse @ moved @ coarse.T
    return FlankCompliance(_spread(system.spread, flank), others, shape, coarse_shape, refinement)


def flank_size(shape: tuple[int, int]) -> int:
    """Number of nodes of a lattice."""
    return shape[0] * shape[1]


def _spread(spread: sp.csr_matrix, flank: NDArray[np.float64]) -> NDArray[np.float64]:
    """Bring the masters' compliance (k, k) to all lattice nodes, which mostly are masters themselves."""
    if spread.nnz == spread.shape[0] and (spread.data == 1.0).all():
        return flank[np.ix_(spread.indices, spread.indices)]
    half = spread @ flank
    return np.ascontiguousarray((spread @ half.T).T)


def to_arrays(compliance: FlankCompliance) -> dict[str, NDArray]:
    """Named arrays from which `from_arrays` rebuilds the compliance."""
    cuts = compliance.refinement
    return {
        "own_m_per_n": compliance.own,
        "others_m_per_n": compliance.others,
        "shape": np.array(compliance.shape),
        "coarse_shape": np.array(compliance.coarse_shape),
        "refinement": np.array([cuts.profile, cuts.width, cuts.depth, cuts.grading], dtype=float),
    }


STORED = {
    "own_m_per_n": (None, None),
    "others_m_per_n": (None, None, None),
    "shape": (2,),
    "coarse_shape": (2,),
    "refinement": (4,),
}
"""Names and shapes of the arrays of a stored compliance."""


def from_arrays(arrays: Mapping[str, NDArray]) -> FlankCompliance:
    """Inverse of `to_arrays`."""
    profile, width, depth, grading = arrays["refinement"]
    shape, coarse_shape = (tuple(int(n) for n in arrays[name]) for name in ("shape", "coarse_shape"))
    return FlankCompliance(
        arrays["own_m_per_n"],
        arrays["others_m_per_n"],
        shape,
        coarse_shape,
        Refinement(int(profile), int(width), int(depth), float(grading)),
    )
