"""Signed separation between the pinion's and the gear's exact surfaces along the pinion's normal.

A ray from each pinion point along its outward normal is cut with the gear's flank, fillet, tip land and root
land in turn until one is hit (Newton on the closed forms, `facegear.teeth.rays`). Positive: a gap;
negative: the point is inside the gear. The gear ends at its inner and outer cylinders: a ray that misses the
tooth there has gap inf. What modifications and deviations take off the gear
lengthens the rays, to first order.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear._kernels import flanks
from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.errors import NotConverged
from facegear.teeth.design import PairDesign
from facegear.teeth.modifications import as_generated, gap_opening
from facegear.teeth.placement import RigidMotion, to_left_flank
from facegear.teeth.rays import ROOT_LAND, Blank, FlankSample, cut, gear_rays
from facegear.teeth.surfaces import SurfacePoints

PARTS = ("none", "flank", "fillet", "tip land", "root land")
"""Names of the parts NO_PART, FLANK, FILLET, TIP_LAND, ROOT_LAND."""

__all__ = ["PARTS", "Separation", "separation", "separation_each"]

RAYS_AT_ONCE = 60_000
"""Number of rays searched together, which bounds memory; results do not depend on it."""


@dataclass(frozen=True)
class Separation:
    """Where normals of pinion points meet the gear: p placements and n points, all (p, n), or (n,) of
    points in one placement each.

    gap (m), the gear part hit (see PARTS), where on it.

    continued: distance (m) to the flank continued beyond its edges, inf if that is missed as well.

    u, v: th and psi (rad) on the flank, psi (rad) and gear radius (m) on the fillet, gear angle from the
    tooth's centre (rad) and gear radius (m) on the lands; radius: the gear radius (m) of all. nan where there
    is no gear opposite.
    """

    gap: Array
    part: NDArray[np.int8]
    u: Array
    v: Array
    continued: Array
    radius: Array


def separation(
    design: PairDesign,
    points: SurfacePoints,
    phi1: ArrayLike,
    phi2: ArrayLike,
    tooth: ArrayLike = 0,
    search_radius: float | None = None,
) -> Separation:
    """Compute the signed distance along the pinion's normals from the right side of a pinion tooth to the
    left side of the gear tooth of that number.

    Angles and tooth broadcast to p placements. Assembly errors are the design's.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    points : SurfacePoints
        Points (n, 3) of the frame of tooth 0, or (p, n, 3) separately for each placement, m.
    phi1 : (p,) array_like
        Pinion angle, rad.
    phi2 : (p,) array_like
        Gear angle, rad.
    tooth : (p,) array_like
        Number of both teeth.
    search_radius : float, optional
        Distance up to which surfaces are searched, m; one module if None.

    Returns
    -------
    Separation
        Gaps (p, n), m, positive where there is room, with the gear's part and place that is hit.

    Raises
    ------
    NotConverged
        Where a ray close to the flank cannot be cut with it.
    """
    phi1, phi2, tooth = (
        np.atleast_1d(part).ravel() for part in np.broadcast_arrays(phi1, phi2, np.asarray(tooth, float))
    )
    search_radius = float(design.module if search_radius is None else search_radius)
    motion, gear = to_left_flank(design, phi1, phi2, tooth), GearSide.of_design(design)
    count = points.position.shape[-2]
    block = max(1, RAYS_AT_ONCE // max(count, 1))
    cuts = []
    for first in range(0, max(1, phi1.size), block):
        rows = slice(first, first + block)
        block_points = points if points.position.ndim == 2 else points.only(rows)
        cuts.append(gear.cut(*_rays_of_all(motion.only(rows), block_points), search_radius))
    hit = cuts[0] if len(cuts) == 1 else [np.concatenate(parts) for parts in zip(*cuts, strict=True)]
    return Separation(*(values.reshape(phi1.size, count) for values in hit))


def separation_each(
    design: PairDesign,
    points: SurfacePoints,
    placement: tuple[Array, Array, Array],
    at: Integers,
    search_radius: float,
    number: Integers | None = None,
) -> Separation:
    """Compute `separation` for points that each have one of p placements only.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    points : SurfacePoints
        Points (m, 3), m.
    placement : tuple of (p,) arrays
        phi1, phi2 (rad) and tooth.
    at : (n,) array of int
        Number of the placement of each point.
    search_radius : float
        Distance up to which surfaces are searched, m.
    number : (n,) array of int, optional
        Numbers of the points; all of them if None.

    Returns
    -------
    Separation
        Gaps (n,), m, with the gear's part and place that is hit.

    Raises
    ------
    NotConverged
        As `separation` does.
    """
    motion = to_left_flank(design, *placement)
    if number is None:
        number = np.arange(at.size)
    return Separation(*GearSide.of_design(design).cut(*_rays(motion, points, at, number), search_radius))


def _rays_of_all(motion: RigidMotion, points: SurfacePoints) -> tuple[Array, Array]:
    """Return starts (m) and unit directions of rays, (p n, 3) each, the placement counting slowest.

    They are the points and normals (n, 3) in each of p motions, or (p, n, 3) each in its own.
    """
    placements, (*placement_shape, count, _) = len(motion.shift), points.position.shape
    at, number = np.repeat(np.arange(placements), count), np.arange(placements * count)
    number = number if placement_shape else number - count * at
    return _rays(motion, points.flat(), at, number)


def _rays(motion: RigidMotion, points: SurfacePoints, at: Integers, number: Integers) -> tuple[Array, Array]:
    """Return starts (m) and unit directions of rays, (n, 3) each, in the frame that `motion` leads to.

    Ray i is point and normal `number[i]` of `points` (m, 3), moved by motion `at[i]`.
    """
    starts, ways = np.empty((2, at.size, 3))
    flanks.place(motion.matrix, motion.shift, at, number, points.position, points.normal, starts, ways)
    return starts, ways


@dataclass(frozen=True, eq=False)
class GearSide:
    """The left side of a design's gear tooth 0 (mirrored, see `to_left_flank`), with which rays are cut."""

    design: PairDesign
    blank: Blank
    sample: FlankSample
    is_generated: bool

    @classmethod
    def of_design(cls, design: PairDesign) -> Self:
        """Return the side of the design's gear that meets the pinion's right flank, with its modifications.

        Parameters
        ----------
        design : PairDesign
            Pair of gears.

        Returns
        -------
        GearSide
            Side of the gear.
        """
        return cls(design, *gear_rays(design), as_generated(design))

    def cut(self, starts: Array, ways: Array, search_radius: float) -> list[AnyArray]:
        """Find where rays, in the frame of the gear's flank, first meet the gear.

        Parameters
        ----------
        starts : (n, 3) array
            Starts of the rays, m.
        ways : (n, 3) array
            Directions of the rays, unit vectors, dimensionless.
        search_radius : float
            Distance up to which surfaces are searched, m.

        Returns
        -------
        list of (n,) arrays
            Fields of `Separation` in their order: gap, part, u, v, continued, radius, in SI units.

        Raises
        ------
        NotConverged
            Where a ray close to the flank cannot be cut with it.
        """
        hit, lost_count = cut(self.blank, self.sample, starts, ways, search_radius)
        if lost_count:
            place_text = f"{lost_count} rays at the gear"
            raise NotConverged("separation", place_text, "Newton from two starts, 16 steps each")
        if not self.is_generated:
            hit[0] = hit[0] + self._gap_opening(starts, ways, hit[0], hit[1] != ROOT_LAND)
            hit[4] = hit[4] + self._gap_opening(starts, ways, hit[4], True)
        return hit

    def _gap_opening(self, starts: Array, ways: Array, length: Array, is_counted: Mask | bool) -> Array:
        """Return how much longer (m) rays (n, 3) of lengths (n,), m, become by the gear's modifications
        and deviations; 0 where the mask says that these do not count, or a length is infinite.
        """
        length = np.where(is_counted, length, np.inf)
        with np.errstate(invalid="ignore"):
            return gap_opening(self.design, starts + length[:, None] * ways, ways)
