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

    def only(self, index: Integers | slice) -> "SurfacePoints":
        """Those of n points, or of n times many, at `index`."""
        return SurfacePoints(self.position[index], self.normal[index])

    @property
    def lever_arm(self) -> Array:
        """Of the normals about the pinion's axis (m): speed along the normal per rotation."""
        x, z = self.position[..., 0], self.position[..., 2]
        return x * self.normal[..., 2] - z * self.normal[..., 0]


def flank_points(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Involute at roll angle (rad) and y (m), broadcast together.

    Modifications move points along the unmodified normal; the normal's own change (1e-3 rad) is left out.
    """
    roll, y = np.broadcast_arrays(np.asarray(roll, float), np.asarray(y, float))
    base, angle = design.pinion_base_radius, design.pinion_half_base_angle - roll
    length, cosine, sine = base * roll - pinion.removed(design, roll, y), np.cos(angle), np.sin(angle)
    x, z = base * sine + length * cosine, length * sine - base * cosine
    return SurfacePoints(_together(x, y, z), _together(cosine, 0.0, sine))


def fillet_points(design: PairDesign, gamma: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Trochoid at gamma (rad, see `pinion.trochoid_point`) and y (m), broadcast together."""
    gamma, y = np.broadcast_arrays(np.asarray(gamma, float), np.asarray(y, float))
    position = pinion.cartesian(*pinion.trochoid_point(design, gamma), y)
    nx, nz = pinion.trochoid_normal(design, gamma)
    normal = _together(nx, 0.0, nz)
    depth = pinion.removed(design, pinion.junction_roll(design), y)
    return SurfacePoints(position - depth[..., None] * normal, normal)


def _together(x: Array, y: Array | float, z: Array) -> Array:
    vectors = np.empty((*x.shape, 3))
    vectors[..., 0], vectors[..., 1], vectors[..., 2] = x, y, z
    return vectors
