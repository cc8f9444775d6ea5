"""Signed separation between the pinion's and the gear's exact surfaces along the pinion's normal.

A ray from each pinion point along its outward normal is cut with the gear's flank, fillet, tip land and root
land in turn until one is hit (Newton on the closed forms, `facegear.geometry.rays`). Positive: a gap;
negative: the point is inside the gear. The gear ends at its inner and outer cylinders: a ray that misses the
tooth there has gap inf. What modifications and deviations take off the gear
lengthens the rays, to first order.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.errors import NotConverged
from facegear.geometry.design import PairDesign
from facegear.geometry.gear_modifications import as_generated, opened
from facegear.geometry.pinion_surface import SurfacePoints
from facegear.geometry.placement import RigidMotion, to_left_flank
from facegear.geometry.ray_blank import Blank, FlankSample, gear_rays
from facegear.geometry.rays import FILLET, FLANK, NONE, ROOT_LAND, TIP_LAND, cut
from facegear.machine_code.compiler import compiler

PARTS = ("none", "flank", "fillet", "tip land", "root land")
"""Names of the parts NONE, FLANK, FILLET, TIP_LAND, ROOT_LAND."""

__all__ = [
    "FILLET",
    "FLANK",
    "NONE",
    "PARTS",
    "ROOT_LAND",
    "TIP_LAND",
    "Separation",
    "separation",
    "separation_each",
    "separation_in",
]

RAYS_AT_ONCE = 60_000


@dataclass(frozen=True)
class Separation:
    """For p placements and n pinion points, all (p, n), or (n,) of points in one placement each.

    gap (m), the gear part hit (see PARTS), where on it.

    continued: distance (m) to the flank continued beyond its edges, inf if that is missed as well.

    u, v: th and psi (rad) on the flank, psi (rad) and gear radius (m) on the fillet, gear angle from the
    tooth's centre (rad) and gear radius (m) on the lands; nan where there is no gear opposite.
    """

    gap: Array
    part: NDArray[np.int8]
    u: Array
    v: Array
    continued: Array


def separation(
    design: PairDesign,
    points: SurfacePoints,
    phi1: ArrayLike,
    phi2: ArrayLike,
    tooth: ArrayLike = 0,
    search_radius: float | None = None,
) -> Separation:
    """Separation of the right side of pinion tooth `tooth` from the left side of that gear tooth.

    phi1, phi2 (rad) and tooth broadcast to p placements; points are n points (n, 3) of the frame of tooth 0,
    or (p, n, 3) for each placement its own. Surfaces are looked for as far as `search_radius` (m, default one
    module). Assembly errors are the design's.
    Raises NotConverged where a ray close to the flank cannot be cut with it.
    """
    phi1, phi2, tooth = (
        np.atleast_1d(part).ravel() for part in np.broadcast_arrays(phi1, phi2, np.asarray(tooth, float))
    )
    return separation_in(design, points, to_left_flank(design, phi1, phi2, tooth), search_radius)


def separation_in(
    design: PairDesign, points: SurfacePoints, motion: RigidMotion, search_radius: float | None = None
) -> Separation:
    """The same in p placements given as `placement.to_left_flank` of the design: motions (p,)."""
    search_radius = float(design.module if search_radius is None else search_radius)
    placements, count = len(motion.shift), points.position.shape[-2]
    gap = np.full((placements, count), np.inf)
    part = np.zeros(gap.shape, np.int8)
    u, v, continued = (np.full(gap.shape, value) for value in (np.nan, np.nan, np.inf))
    block, gear = max(1, RAYS_AT_ONCE // max(count, 1)), GearSide.of_design(design)
    for first in range(0, placements, block):
        rows = slice(first, first + block)
        here = motion.only(rows)
        position, normal = (
            vectors[rows] if vectors.ndim == 3 else vectors for vectors in (points.position, points.normal)
        )
        starts, ways = here.points(position).reshape(-1, 3), here.directions(normal).reshape(-1, 3)
        hit = gear.cut(starts, ways, search_radius)
        for target, values in zip((gap, part, u, v, continued), hit, strict=True):
            target[rows] = values.reshape(-1, count)
    return Separation(gap=gap, part=part, u=u, v=v, continued=continued)


def separation_each(
    design: PairDesign,
    points: SurfacePoints,
    placement: tuple[Array, Array, Array],
    at: Integers,
    search_radius: float,
) -> Separation:
    """The same of n points (n, 3) that each stand in one of p placements only, `at` (n,): all (n,).

    placement: phi1, phi2 (rad) and tooth, (p,) each. Raises NotConverged as `separation` does.
    """
    motion = to_left_flank(design, *placement)
    shift = np.ascontiguousarray(motion.shift)
    starts, ways = placed_rays(motion.matrix, shift, at, points.position, points.normal)
    return Separation(*GearSide.of_design(design).cut(starts, ways, search_radius))


@compiler()
def placed_rays(
    matrix: Array, shift: Array, at: Integers, position: Array, normal: Array
) -> tuple[Array, Array]:
    """Points and directions (n, 3), each by its own of motions: matrices (p, 3, 3) and shifts (p, 3)."""
    starts, ways = np.empty(position.shape), np.empty(position.shape)
    for row in range(at.size):
        number = at[row]
        for i in range(3):
            start, way = shift[number, i], 0.0
            for j in range(3):
                start += matrix[number, i, j] * position[row, j]
                way += matrix[number, i, j] * normal[row, j]
            starts[row, i], ways[row, i] = start, way
    return starts, ways


@dataclass(frozen=True, eq=False)
class GearSide:
    """The side of a design's gear that rays are cut with: as generated, or with modifications."""

    design: PairDesign
    blank: Blank
    sample: FlankSample
    generated: bool

    @classmethod
    def of_design(cls, design: PairDesign) -> Self:
        """Of the flank that meets the pinion's right one."""
        return cls(design, *gear_rays(design), as_generated(design))

    def cut(self, starts: Array, ways: Array, search_radius: float) -> list[AnyArray]:
        """Fields of `Separation`, (n,), of rays (n, 3) of unit length in the frame of the gear's flank.

        Raises NotConverged where a ray close to the flank cannot be cut with it.
        """
        hit, lost = cut(self.blank, starts, ways, search_radius, *self.sample)
        if lost:
            where = f"{lost} rays at the gear"
            raise NotConverged("separation", where, "Newton from two starts, 16 steps each")
        if not self.generated:
            hit[0] = hit[0] + self._opened(starts, ways, hit[0], hit[1] != ROOT_LAND)
            hit[4] = hit[4] + self._opened(starts, ways, hit[4], True)
        return hit

    def _opened(self, starts: Array, ways: Array, length: Array, where: Mask | bool) -> Array:
        """How much longer rays of a length (n,) become by the gear's modifications where they count."""
        length = np.where(where, length, np.inf)
        with np.errstate(invalid="ignore"):
            return opened(self.design, starts + length[:, None] * ways, ways)
