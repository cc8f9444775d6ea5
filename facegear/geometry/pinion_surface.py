"""Points and normals of the pinion's right flank and fillet in space, modifications included."""

from dataclasses import dataclass
from math import cos, sin
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array, Integers
from facegear.geometry import pinion, reliefs
from facegear.geometry.design import PairDesign
from facegear.geometry.deviations import deviation
from facegear.machine_code.compiler import compiler, for_callers

SOURCES = Path(pinion.__file__), Path(reliefs.__file__)
"""Files of what `involute_point` compiles, beside this one."""
NOTHING = np.zeros(0)

inlined = for_callers()
distances, linear = inlined(pinion.distances), inlined(reliefs.linear)
parabola = inlined(reliefs.parabola)


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
    roll, y = np.asarray(roll, float), np.asarray(y, float)
    shape = np.broadcast_shapes(roll.shape, y.shape)
    roll, y = _filled(roll, shape), _filled(y, shape)
    position, normal = _involute(pinion.flank_numbers(design), roll, y, added(design, roll, y))
    return SurfacePoints(position.reshape(*shape, 3), normal.reshape(*shape, 3))


def added(design: PairDesign, roll: Array, y: Array) -> Array:
    """How much (m) the flank deviates at roll (rad) and y (m), (n,) each; (0,) where it does not."""
    grid = design.pinion.flanks.right
    return NOTHING if grid is None else deviation(grid, *pinion.deviation_place(design, roll, y))


def _filled(values: Array, shape: tuple[int, ...]) -> Array:
    """Values that broadcast to a shape, flat (n,)."""
    return np.ravel(values if values.shape == shape else np.broadcast_to(values, shape))


@inlined
def involute_point(flank: pinion.FlankNumbers, roll: float, y: float, extra: float) -> tuple[float, ...]:
    """x and z of a point of the flank that deviates by `extra` (m), and of its normal."""
    from_tip, from_root, from_middle = distances(flank, roll, y)
    relieved = linear(flank.tip_relief, from_tip) + linear(flank.root_relief, from_root)
    along = flank.base * roll - (relieved + parabola(flank.lead_crowning, from_middle) - extra)
    cosine, sine = cos(flank.angle - roll), sin(flank.angle - roll)
    return flank.base * sine + along * cosine, along * sine - flank.base * cosine, cosine, sine


@compiler(*SOURCES)
def _involute(flank: pinion.FlankNumbers, roll: Array, y: Array, extra: Array) -> tuple[Array, Array]:
    """Positions and normals (n, 3) at roll and y (n,), with what is `added` there (n,), (0,) for nothing."""
    position, normal = np.empty((roll.size, 3)), np.zeros((roll.size, 3))
    for i in range(roll.size):
        x, z, nx, nz = involute_point(flank, roll[i], y[i], extra[i] if extra.size else 0.0)
        position[i, 0], position[i, 1], position[i, 2] = x, y[i], z
        normal[i, 0], normal[i, 2] = nx, nz
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
