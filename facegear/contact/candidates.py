"""Loads of a pair of teeth that may act: their gaps, lever arms and nodal forces on both bodies."""

from dataclasses import dataclass, fields, replace

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers, Mask
from facegear.contact.averages import Lattice, rows_of, stacked
from facegear.contact.loads import Loads


@dataclass(frozen=True, eq=False)
class Candidates:
    """Loads of one tooth pair that may act: a unit force each, spread over a hat's covered area or along an
    edge.

    hats (m,) lattice nodes and their `column` along the width; gap (m,) m and lever_arm (m,) m averaged over
    the hat; whether it presses on a `fillet` (m,) of either gear; loads on the lattice nodes `pinion` (m, n1)
    and `gear` (m, n2), and on the unrefined ones `pinion_coarse`, `gear_coarse`.
    """

    tooth: int
    hats: Integers
    column: Integers
    gap: Array
    lever_arm: Array
    fillet: Mask
    pinion: sp.csr_matrix
    gear: sp.csr_matrix
    pinion_coarse: sp.csr_matrix
    gear_coarse: sp.csr_matrix

    @property
    def overlap(self) -> float:
        """Turn (rad) of the pinion that would part the teeth where they stand in each other; 0 if nowhere."""
        forward = self.lever_arm > 0
        return float(np.max(-self.gap[forward] / self.lever_arm[forward], initial=0.0))

    def only(self, keep: Mask) -> "Candidates":
        """Those marked (m,)."""
        if keep.all():
            return self
        parts = {field.name: getattr(self, field.name) for field in fields(self)[1:]}
        kept = {n: rows_of(part, keep) if sp.issparse(part) else part[keep] for n, part in parts.items()}
        return replace(self, **kept)


def candidates_of(
    pinion: Lattice, gear: Lattice, tooth: int, parts: list[Loads], limit: float
) -> list[Candidates]:
    """Those of the loads that a turn by `limit` (rad) would close: one entry, or none."""
    if not parts:
        return []
    rows = stacked([part.rows for part in parts], [part.gap.size for part in parts])
    names = [field.name for field in fields(Loads)[1:]]
    loads = Loads(rows=rows, **{n: np.concatenate([getattr(part, n) for part in parts]) for n in names})
    gap, lever_arm = rows.mean(loads.gap), rows.mean(loads.lever_arm)
    beyond = pinion.in_fillet(loads.pinion) | gear.in_fillet(loads.gear)
    near = gap < limit * lever_arm
    if not near.any():
        return []
    rows = rows.only(near)
    on_pinion, pinion_coarse = pinion.loads(rows, loads.pinion)
    on_gear, gear_coarse = gear.loads(rows, loads.gear)
    candidates = Candidates(
        tooth=tooth,
        hats=loads.hats[near],
        column=loads.hats[near] % pinion.shape[1],
        gap=gap[near],
        lever_arm=lever_arm[near],
        fillet=rows.mean(beyond.astype(float)) > 0.5,
        pinion=on_pinion,
        gear=on_gear,
        pinion_coarse=pinion_coarse,
        gear_coarse=gear_coarse,
    )
    return [candidates]
