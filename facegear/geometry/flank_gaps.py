"""Gaps between pinion flanks and the gear at many placements, asked for again and again by a search."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from facegear.arrays import AnyArray, Array
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import flank_points
from facegear.geometry.placement import to_left_flank
from facegear.geometry.separation import GearSide, placed_rays


@dataclass(frozen=True, eq=False)
class FlankGaps:
    """Pairs of teeth of a design, each in a placement of its own: motions `matrix` (p, 3, 3) and `shift`
    (p, 3) m, as `to_left_flank` has them.
    """

    design: PairDesign
    gear: GearSide
    matrix: Array
    shift: Array

    @classmethod
    def of_pairs(cls, design: PairDesign, phi1: Array, phi2: Array, tooth: Array) -> Self:
        """Of pairs `tooth` (p,) at the angles phi1, phi2 (p,) rad."""
        motion = to_left_flank(design, phi1, phi2, tooth)
        return cls(design, GearSide.of_design(design), motion.matrix, np.ascontiguousarray(motion.shift))

    def only(self, rows: AnyArray) -> Self:
        """Some of the pairs."""
        return type(self)(self.design, self.gear, self.matrix[rows], self.shift[rows])

    def at(self, roll: Array, y: Array) -> Array:
        """Separation (p, n) m at roll angles (rad) and y (m), (p, n) or (n,) for all alike.

        As `facegear.geometry.separation` has it, no farther than a module. Raises what that raises.
        """
        points = flank_points(self.design, roll, y)
        position, normal = points.position, points.normal
        size = position.shape[-2]
        number = np.repeat(np.arange(len(self.shift)), size)
        if position.ndim == 2:
            position, normal = (np.tile(part, (len(self.shift), 1)) for part in (position, normal))
        flat = position.reshape(-1, 3), normal.reshape(-1, 3)
        starts, ways = placed_rays(self.matrix, self.shift, number, *flat)
        return np.asarray(self.gear.cut(starts, ways, self.design.module)[0].reshape(-1, size))
