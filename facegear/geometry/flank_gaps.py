"""Gaps between pinion flanks and the gear at many placements, asked for again and again by a search."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from facegear.arrays import AnyArray, Array
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import flank_points
from facegear.geometry.placement import RigidMotion, to_left_flank
from facegear.geometry.separation import GearSide


@dataclass(frozen=True, eq=False)
class FlankGaps:
    """Pairs of teeth of a design, each in a placement of its own: p motions, as `to_left_flank` has them."""

    design: PairDesign
    gear: GearSide
    motion: RigidMotion

    @classmethod
    def of_pairs(cls, design: PairDesign, phi1: Array, phi2: Array, tooth: Array) -> Self:
        """Return the pairs at given angles.

        Parameters
        ----------
        design : PairDesign
            Pair of gears.
        phi1 : (p,) array
            Pinion angle, rad.
        phi2 : (p,) array
            Gear angle, rad.
        tooth : (p,) array
            Numbers of the pairs, dimensionless.

        Returns
        -------
        FlankGaps
            Pairs of teeth.
        """
        return cls(design, GearSide.of_design(design), to_left_flank(design, phi1, phi2, tooth))

    def only(self, rows: AnyArray) -> Self:
        """Return some of the pairs.

        Parameters
        ----------
        rows : (k,) array
            Numbers or mask of the pairs.

        Returns
        -------
        FlankGaps
            Chosen pairs.
        """
        return type(self)(self.design, self.gear, self.motion.only(rows))

    def at(self, roll: Array, y: Array) -> Array:
        """Compute the separation as `facegear.geometry.separation` does, no farther than a module.

        Parameters
        ----------
        roll : (p, n) array
            Roll angle, rad; (n,) for all pairs.
        y : (p, n) array
            Axial position, m; (n,) for all pairs.

        Returns
        -------
        (p, n) array
            m.

        Raises
        ------
        NotConverged
            As `separation` does.
        """
        points = flank_points(self.design, roll, y)
        starts, ways = self.motion.points(points.position), self.motion.directions(points.normal)
        gap = self.gear.cut(starts.reshape(-1, 3), ways.reshape(-1, 3), self.design.module)[0]
        return np.asarray(gap.reshape(starts.shape[:-1]))
