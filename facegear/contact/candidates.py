"""Loads of a pair of teeth that may act: their gaps, lever arms and nodal forces on both bodies."""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.averages import HatPoints, Lattice, NodalLoads, closing


@dataclass(frozen=True, eq=False)
class Candidates:
    """Loads of one tooth pair that may act: a unit force each, spread over a hat's covered area or along an
    edge.

    hats (m,) lattice nodes and their `column` along the width; gap (m,) m and lever_arm (m,) m averaged over
    the hat; whether it presses on a `fillet` (m,) of either gear; loads on the lattice nodes `pinion` and
    `gear`, and on the unrefined ones `pinion_coarse`, `gear_coarse`, m rows each.
    """

    tooth: int
    hats: Integers
    column: Integers
    gap: Array
    lever_arm: Array
    fillet: Mask
    pinion: NodalLoads
    gear: NodalLoads
    pinion_coarse: NodalLoads
    gear_coarse: NodalLoads

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
        kept: dict[str, Any] = {
            name: part.only(keep) if isinstance(part, NodalLoads) else part[keep]
            for name, part in parts.items()
        }
        return replace(self, **kept)


def candidates_of(
    pinion: Lattice,
    gear: Lattice,
    tooth: int,
    points: HatPoints,
    min_area: Array,
    limit: float,
    first: int = 0,
) -> list[Candidates]:
    """Those of the hats over points that a turn by `limit` (rad) would close: one entry, or none.

    min_area: the covered area below which a hat is left out; those of the pinion's nodes begin at `first`,
    the others are hats of edges.
    """
    ends = pinion.flank_end, gear.flank_end
    rows, node, gap, lever_arm, fillet = closing(points, min_area, first, pinion.shape, ends, limit)
    if node.size == 0:
        return []
    on_pinion, pinion_coarse = pinion.loads(rows, points.pinion)
    on_gear, gear_coarse = gear.loads(rows, points.gear)
    candidates = Candidates(
        tooth=tooth,
        hats=node,
        column=node % pinion.shape[1],
        gap=gap,
        lever_arm=lever_arm,
        fillet=fillet,
        pinion=on_pinion,
        gear=on_gear,
        pinion_coarse=pinion_coarse,
        gear_coarse=gear_coarse,
    )
    return [candidates]
