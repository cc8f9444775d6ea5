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
        """Return the points and normals as (n, 3) arrays.

        Returns
        -------
        SurfacePoints
            All points in one row.
        """
        return SurfacePoints(self.position.reshape(-1, 3), self.normal.reshape(-1, 3))

    def only(self, index: Integers | slice) -> "SurfacePoints":
        """Return the points at `index`.

        Parameters
        ----------
        index : (k,) array
            Numbers or slice along the first axis.

        Returns
        -------
        SurfacePoints
            Chosen points.
        """
        return SurfacePoints(self.position[index], self.normal[index])

    @property
    def lever_arm(self) -> Array:
        """Lever arm (m) of the normals about the pinion's axis: speed along the normal per rotation."""
        x, z = self.position[..., 0], self.position[..., 2]
        return x * self.normal[..., 2] - z * self.normal[..., 0]


def flank_points(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Compute points of the involute; roll and y are broadcast together.

    Modifications move points along the unmodified normal; the normal's own change (1e-3 rad) is left out.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Roll angle, rad.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    SurfacePoints
        Points (..., 3), m.
    """
    roll, y = np.broadcast_arrays(np.asarray(roll, float), np.asarray(y, float))
    base, angle = design.pinion_base_radius, design.pinion_half_base_angle - roll
    length, cosine, sine = base * roll - pinion.removed_depth(design, roll, y), np.cos(angle), np.sin(angle)
    x, z = base * sine + length * cosine, length * sine - base * cosine
    return SurfacePoints(_together(x, y, z), _together(cosine, 0.0, sine))


def fillet_points(design: PairDesign, gamma: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Compute points of the trochoid; gamma and y are broadcast together.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gamma : (...) array_like
        Slope of the normal, rad, see `pinion.trochoid_point`.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    SurfacePoints
        Points (..., 3), m.
    """
    gamma, y = np.broadcast_arrays(np.asarray(gamma, float), np.asarray(y, float))
    position = pinion.cartesian(*pinion.trochoid_point(design, gamma), y)
    nx, nz = pinion.trochoid_normal(design, gamma)
    normal = _together(nx, 0.0, nz)
    depth = pinion.removed_depth(design, pinion.junction_roll(design), y)
    return SurfacePoints(position - depth[..., None] * normal, normal)


def _together(x: Array, y: Array | float, z: Array) -> Array:
    vectors = np.empty((*x.shape, 3))
    vectors[..., 0], vectors[..., 1], vectors[..., 2] = x, y, z
    return vectors
