"""Points and normals of the pinion's right flank and fillet in space, modifications included."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array, Integers
from facegear.geometry import pinion
from facegear.geometry.design import PairDesign


@dataclass(frozen=True)
class SurfacePoints:
    """Points of the right side of pinion tooth 0 in the body frame: position (..., 3) in m, unit normal."""

    position: Array
    normal: Array

    def flat(self) -> "SurfacePoints":
        """The same points as (n, 3) arrays."""
        return SurfacePoints(self.position.reshape(-1, 3), self.normal.reshape(-1, 3))

    def only(self, index: Integers) -> "SurfacePoints":
        """Those of n points at `index`."""
        return SurfacePoints(self.position[index], self.normal[index])

    @property
    def lever_arm(self) -> Array:
        """Of the normals about the pinion's axis (m): speed along the normal per rotation."""
        x, z = self.position[..., 0], self.position[..., 2]
        return x * self.normal[..., 2] - z * self.normal[..., 0]


def joined(first: SurfacePoints, second: SurfacePoints) -> SurfacePoints:
    """The points (n, 3) of one after those of the other."""
    return SurfacePoints(
        np.concatenate([first.position, second.position]), np.concatenate([first.normal, second.normal])
    )


def flank_points(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Involute at roll angle (rad) and y (m), broadcast together.

    Modifications move points along the unmodified normal; the normal's own change (1e-3 rad) is left out.
    """
    roll, y = np.broadcast_arrays(np.asarray(roll, float), np.asarray(y, float))
    position = pinion.cartesian(*pinion.involute_point(design, roll), y)
    normal = _normals(*pinion.involute_normal(design, roll))
    return SurfacePoints(position - pinion.removed(design, roll, y)[..., None] * normal, normal)


def fillet_points(design: PairDesign, gamma: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Trochoid at gamma (rad, see `pinion.trochoid_point`) and y (m), broadcast together."""
    gamma, y = np.broadcast_arrays(np.asarray(gamma, float), np.asarray(y, float))
    position = pinion.cartesian(*pinion.trochoid_point(design, gamma), y)
    normal = _normals(*pinion.trochoid_normal(design, gamma))
    depth = pinion.removed(design, pinion.junction_roll(design), y)
    return SurfacePoints(position - depth[..., None] * normal, normal)


def _normals(nx: Array, nz: Array) -> Array:
    return np.stack([nx, np.zeros_like(nx), nz], axis=-1)
