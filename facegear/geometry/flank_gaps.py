"""Gaps between pinion flanks and the gear at many placements, asked for again and again by a search."""

from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np

from facegear.arrays import AnyArray, Array
from facegear.geometry import pinion_surface
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion import FlankNumbers, flank_numbers
from facegear.geometry.pinion_surface import added, involute_point
from facegear.geometry.placement import RigidMotion, to_left_flank
from facegear.geometry.separation import GearSide
from facegear.machine_code.compiler import compiler


@dataclass(frozen=True, eq=False)
class FlankGaps:
    """Pairs of teeth of a design, each in a placement of its own: p motions, as `to_left_flank` has them."""

    design: PairDesign
    gear: GearSide
    motion: RigidMotion

    @classmethod
    def of_pairs(cls, design: PairDesign, phi1: Array, phi2: Array, tooth: Array) -> Self:
        """Of pairs `tooth` (p,) at the angles phi1, phi2 (p,) rad."""
        return cls(design, GearSide.of_design(design), to_left_flank(design, phi1, phi2, tooth))

    def only(self, rows: AnyArray) -> Self:
        """Some of the pairs."""
        return type(self)(self.design, self.gear, self.motion.only(rows))

    def at(self, roll: Array, y: Array) -> Array:
        """Separation (p, n) m at roll angles (rad) and y (m), (p, n) or (n,) for all alike.

        As `facegear.geometry.separation` has it, no farther than a module. Raises what that raises.
        """
        extra, count = added(self.design, roll.ravel(), y.ravel()), roll.shape[-1]
        numbers, shift = flank_numbers(self.design), np.ascontiguousarray(self.motion.shift)
        places = roll.reshape(-1, count), y.reshape(-1, count)
        starts, ways = flank_rays(numbers, self.motion.matrix, shift, *places, extra)
        return np.asarray(self.gear.cut(starts, ways, self.design.module)[0].reshape(-1, count))


@compiler(Path(pinion_surface.__file__), *pinion_surface.SOURCES)
def flank_rays(
    flank: FlankNumbers, matrix: Array, shift: Array, roll: Array, y: Array, extra: Array
) -> tuple[Array, Array]:
    """Points and directions (p n, 3) at roll and y, (p, n) or (1, n), in p motions, with what is `added`."""
    shared, count = roll.shape[0] == 1, roll.shape[1]
    starts, ways = np.empty((shift.shape[0] * count, 3)), np.empty((shift.shape[0] * count, 3))
    for p in range(shift.shape[0]):
        for k in range(count):
            row, ray = 0 if shared else p, p * count + k
            beyond = extra[row * count + k] if extra.size else 0.0
            x, z, nx, nz = involute_point(flank, roll[row, k], y[row, k], beyond)
            for i in range(3):
                turned = matrix[p, i, 0] * x + matrix[p, i, 1] * y[row, k] + matrix[p, i, 2] * z
                starts[ray, i] = shift[p, i] + turned
                ways[ray, i] = matrix[p, i, 0] * nx + matrix[p, i, 2] * nz
    return starts, ways
