"""Points and normals of the pinion's right flank and fillet in space, modifications included."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array, Integers
from facegear.geometry import pinion
from facegear.geometry.design import PairDesign
from facegear.machine_code.compiler import compiler


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


def joined(first: SurfacePoints, second: SurfacePoints) -> SurfacePoints:
    """The points (n, 3) of one after those of the other."""
    return SurfacePoints(
        np.concatenate([first.position, second.position]), np.concatenate([first.normal, second.normal])
    )


def flank_points(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Involute at roll angle (rad) and y (m), broadcast together.

    Modifications move points along the unmodified normal; the normal's own change (1e-3 rad) is left out.
    """
    taken = pinion.removed(design, roll, y)
    roll, y = (_filled(np.asarray(part, float), taken.shape) for part in (roll, y))
    base, angle = design.pinion_base_radius, design.pinion_half_base_angle
    position, normal = _involute(base, angle, roll, y, taken.ravel())
    return SurfacePoints(position.reshape(*taken.shape, 3), normal.reshape(*taken.shape, 3))


def _filled(values: Array, shape: tuple[int, ...]) -> Array:
    """Values that broadcast to a shape, flat (n,)."""
    return np.ravel(values if values.shape == shape else np.broadcast_to(values, shape))


@compiler()
def _involute(base: float, angle: float, roll: Array, y: Array, taken: Array) -> tuple[Array, Array]:
    """Positions and normals (n, 3) at roll and y (n,), so much `taken` (n,) m off along the normal.

    `base` radius (m) and half `angle` (rad) of the tooth there.
    """
    position, normal = np.empty((roll.size, 3)), np.empty((roll.size, 3))
    for row in range(roll.size):
        cosine, sine = cos(angle - roll[row]), sin(angle - roll[row])
        along = base * roll[row] - taken[row]
        position[row, 0] = base * sine + along * cosine
        position[row, 1] = y[row]
        position[row, 2] = along * sine - base * cosine
        normal[row, 0], normal[row, 1], normal[row, 2] = cosine, 0.0, sine
    return position, normal


def fillet_points(design: PairDesign, gamma: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Trochoid at gamma (rad, see `pinion.trochoid_point`) and y (m), broadcast together."""
    gamma, y = np.broadcast_arrays(np.asarray(gamma, float), np.asarray(y, float))
    position = pinion.cartesian(*pinion.trochoid_point(design, gamma), y)
    normal = _normals(*pinion.trochoid_normal(design, gamma))
    depth = pinion.removed(design, pinion.junction_roll(design), y)
    return SurfacePoints(position - depth[..., None] * normal, normal)


def _normals(nx: Array, nz: Array) -> Array:
    return np.stack([nx, np.zeros_like(nx), nz], axis=-1)
