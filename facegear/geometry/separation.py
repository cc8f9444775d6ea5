"""Signed separation between the pinion's and the gear's exact surfaces along the pinion's normal.

A ray from each pinion point along its outward normal is cut with the gear's flank, fillet, tip land and root
land in turn until one is hit (Newton on the closed forms). Positive: a gap; negative: the point is inside the
gear. The gear ends at its inner and outer cylinders: a ray that misses the tooth there has gap inf.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.errors import NotConverged
from facegear.geometry import face_gear
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import SurfacePoints
from facegear.geometry.placement import to_left_flank

Array = NDArray[np.float64]

NONE, FLANK, FILLET, TIP_LAND, ROOT_LAND = range(5)
PARTS = ("none", "flank", "fillet", "tip land", "root land")


@dataclass(frozen=True)
class Separation:
    """For p placements and n pinion points, all (p, n): gap (m), gear part hit (see PARTS), where on it.

    u, v: th and psi (rad) on the flank, chi (rad) and gear radius (m) on the fillet, gear angle from the
    tooth's centre (rad) and gear radius (m) on the lands; nan where there is no gear opposite.
    """

    gap: Array
    part: NDArray[np.int8]
    u: Array
    v: Array


def separation(
    design: PairDesign,
    points: SurfacePoints,
    phi1: ArrayLike,
    phi2: ArrayLike,
    tooth: ArrayLike = 0,
    reach: float | None = None,
) -> Separation:
    """Separation of the right side of pinion tooth `tooth` from the left side of that gear tooth.

    phi1, phi2 (rad) and tooth broadcast to p placements; points are n points (n, 3) of the frame of tooth 0,
    or (p, n, 3) for each placement its own. Surfaces further than `reach` (m, default one module) are not
    looked for. Assembly errors are the design's.
    Raises NotConverged where a ray close to the flank cannot be cut with it.
    """
    phi1, phi2, tooth = (
        np.atleast_1d(part).ravel() for part in np.broadcast_arrays(phi1, phi2, np.asarray(tooth, float))
    )
    reach = design.module if reach is None else reach
    count = points.position.shape[-2]
    gap = np.full((len(phi1), count), np.inf)
    part = np.zeros(gap.shape, np.int8)
    u, v = np.full(gap.shape, np.nan), np.full(gap.shape, np.nan)
    block = max(1, 60_000 // max(count, 1))
    for first in range(0, len(phi1), block):
        rows = slice(first, first + block)
        position, normal = (
            to_left_flank(
                design,
                vectors[rows] if vectors.ndim == 3 else vectors,
                phi1[rows],
                phi2[rows],
                tooth[rows],
                directions,
            )
            for vectors, directions in ((points.position, False), (points.normal, True))
        )
        hit = _cut(design, position.reshape(-1, 3), normal.reshape(-1, 3), reach)
        for target, found in zip((gap, part, u, v), hit, strict=True):
            target[rows] = found.reshape(-1, count)
    return Separation(gap, part, u, v)


def _cut(design: PairDesign, position: Array, normal: Array, reach: float) -> tuple[Array, ...]:
    count = len(position)
    gap, part = np.full(count, np.inf), np.zeros(count, np.int8)
    u, v = np.full(count, np.nan), np.full(count, np.nan)
    radius = np.hypot(position[:, 0], position[:, 1])
    gear = design.face_gear
    near = (radius > gear.inner_radius - reach) & (radius < gear.outer_radius + reach)
    near &= (position[:, 2] < design.gear_tip_plane + reach) & (np.abs(position[:, 0]) < 3 * design.module)
    index = np.flatnonzero(near)
    for name, cut in ((FLANK, _flank), (FILLET, _fillet), (TIP_LAND, _tip_land), (ROOT_LAND, _root_land)):
        distance, a, b = cut(design, position[index], normal[index], reach)
        found = np.abs(distance) < reach
        chosen, index = index[found], index[~found]
        gap[chosen], part[chosen], u[chosen], v[chosen] = distance[found], name, a[found], b[found]
    return gap, part, u, v


def _flank(design: PairDesign, position: Array, normal: Array, reach: float) -> tuple[Array, Array, Array]:
    base, ratio, _, lift = face_gear.shaper_numbers(design)
    gear = design.face_gear
    inside = np.clip(np.hypot(position[:, 0], position[:, 1]), gear.inner_radius, gear.outer_radius)
    psi = np.arccos(base / (ratio * inside))
    roll = ((lift - position[:, 2]) / base - np.cos(psi)) / np.sin(psi)
    roll = np.clip(roll, 0.0, 1.2 * design.shaper_tip_roll)

    def surface(roll, psi):
        return face_gear.flank_point(design, roll, psi), *face_gear.flank_tangents(design, roll, psi)

    roll, psi, distance, hit, done = _newton(surface, position, normal, roll, psi)
    if not done.all():
        missed = np.flatnonzero(~done)
        grid = _FlankGrid.of(design)
        near, first, second, inner = grid.nearest(position[missed], normal[missed], reach)
        again = missed[near]
        found = _newton(surface, position[again], normal[again], first[near], second[near])
        for target, values in zip((roll, psi, distance, hit, done), found, strict=True):
            target[again] = values
        lost = np.count_nonzero(~done[again] & inner[near])
        if lost:
            raise NotConverged(
                "separation", f"{lost} rays at the flank", "Newton from two starts, 40 steps each"
            )
    height = design.gear_tip_plane + 1e-12
    valid = done & (hit[:, 2] <= height) & (roll <= design.shaper_tip_roll) & _within(design, hit)
    valid &= np.sum(normal * face_gear.flank_normal(design, roll, psi), axis=1) < 0
    return np.where(valid, distance, np.inf), roll, psi


@dataclass(frozen=True)
class _FlankGrid:
    """Sampled flank: a second start for rays, and proof that a ray misses it."""

    point: Array
    normal: Array
    roll: Array
    psi: Array
    inner: NDArray[np.bool_]
    spacing: float

    @classmethod
    def of(cls, design: PairDesign, size: int = 25) -> "_FlankGrid":
        gear = design.face_gear
        radius = np.linspace(gear.inner_radius, gear.outer_radius, size)[None, :]
        top, _ = face_gear.roll_and_psi_at_height(design, radius, design.gear_tip_plane)
        roll = top + np.linspace(0, 1, size)[:, None] * (design.shaper_tip_roll - top)
        psi = face_gear.psi_at(design, radius, roll)
        point = face_gear.flank_point(design, roll, psi)
        inner = np.zeros((size, size), bool)
        inner[2:-2, 2:-2] = True
        steps = (
            np.linalg.norm(np.diff(point, axis=0), axis=-1),
            np.linalg.norm(np.diff(point, axis=1), axis=-1),
        )
        normal = face_gear.flank_normal(design, roll, psi)
        return cls(
            point.reshape(-1, 3),
            normal.reshape(-1, 3),
            roll.ravel(),
            psi.ravel(),
            inner.ravel(),
            float(np.hypot(steps[0].max(), steps[1].max())),
        )

    def nearest(self, position: Array, normal: Array, reach: float) -> tuple[Array, ...]:
        """Rays that pass within the spacing, th and psi of the nearest point, whether it is an inner one."""
        offset = self.point[None] - position[:, None]
        along = np.sum(offset * normal[:, None], axis=-1)
        aside = np.sqrt(np.maximum(np.sum(offset**2, axis=-1) - along**2, 0.0))
        aside[(np.abs(along) > reach) | (normal @ self.normal.T > -0.1)] = np.inf
        best = np.argmin(aside, axis=1)
        near = aside[np.arange(len(best)), best] < self.spacing
        return near, self.roll[best], self.psi[best], self.inner[best]


def _fillet(design: PairDesign, position: Array, normal: Array, reach: float) -> tuple[Array, Array, Array]:
    radius = np.hypot(position[:, 0], position[:, 1])
    cosine = np.clip((design.shaper_lift - position[:, 2]) / design.shaper_tip_radius, 0.5, 1.0)
    chi = -np.arccos(cosine)

    def surface(chi, radius):
        return face_gear.fillet_frame(design, chi, radius)

    chi, radius, distance, hit, done = _newton(surface, position, normal, chi, radius)
    gear = design.face_gear
    inside = np.clip(np.where(done, radius, gear.inner_radius), gear.inner_radius, gear.outer_radius)
    valid = done & (chi <= 0) & (chi >= face_gear.fillet_end(design, inside)) & _within(design, hit)
    return np.where(valid, distance, np.inf), chi, radius


def _tip_land(design: PairDesign, position: Array, normal: Array, reach: float) -> tuple[Array, Array, Array]:
    distance, beta, radius, inside = _plane(design, position, normal, design.gear_tip_plane)
    roll, psi = face_gear.roll_and_psi_at_height(design, inside, design.gear_tip_plane)
    edge = face_gear.flank_point(design, roll, psi)
    valid = (np.abs(beta) <= np.arctan2(edge[:, 0], edge[:, 1])) & (radius == inside)
    return np.where(valid, distance, np.inf), beta, radius


def _root_land(
    design: PairDesign, position: Array, normal: Array, reach: float
) -> tuple[Array, Array, Array]:
    distance, beta, radius, inside = _plane(design, position, normal, design.gear_root_plane)
    start = np.pi / design.face_gear.teeth - face_gear.root_half_angle(design)
    valid = (beta >= start) & (beta <= 2 * np.pi / design.face_gear.teeth - start) & (radius == inside)
    return np.where(valid, distance, np.inf), beta, radius


def _plane(design: PairDesign, position: Array, normal: Array, height: float) -> tuple[Array, ...]:
    down = normal[:, 2] < -1e-9
    distance = np.where(down, (height - position[:, 2]) / np.where(down, normal[:, 2], 1.0), np.inf)
    hit = position + np.where(down, distance, 0.0)[:, None] * normal
    radius = np.hypot(hit[:, 0], hit[:, 1])
    inside = np.clip(radius, design.face_gear.inner_radius, design.face_gear.outer_radius)
    return distance, np.arctan2(hit[:, 0], hit[:, 1]), radius, inside


def _within(design: PairDesign, hit: Array) -> NDArray[np.bool_]:
    radius = np.hypot(hit[:, 0], hit[:, 1])
    return (radius >= design.face_gear.inner_radius) & (radius <= design.face_gear.outer_radius)


def _newton(surface, position: Array, normal: Array, a: Array, b: Array) -> tuple[Array, ...]:
    """Cut rays with a surface X(a, b); returns a, b, distance, hit point and which rays converged."""
    side = np.cross([0.0, 1.0, 0.0], normal)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(normal, side)
    done = np.zeros(len(a), bool)
    todo = np.arange(len(a))
    rounding = 1e-14 * np.max(np.abs(position), initial=0.0)
    a, b = a.copy(), b.copy()
    for _ in range(40):
        point, along_a, along_b = surface(a[todo], b[todo])
        miss = point - position[todo]
        e, f = side[todo], up[todo]
        r1, r2 = np.sum(miss * e, axis=1), np.sum(miss * f, axis=1)
        a1, a2 = np.sum(along_a * e, axis=1), np.sum(along_a * f, axis=1)
        b1, b2 = np.sum(along_b * e, axis=1), np.sum(along_b * f, axis=1)
        with np.errstate(all="ignore"):
            det = a1 * b2 - a2 * b1
            da, db = (r1 * b2 - r2 * b1) / det, (a1 * r2 - a2 * r1) / det
            scale = np.minimum(1.0, 0.2 / np.maximum(np.abs(da), np.abs(db)))
        a[todo] -= scale * da
        b[todo] -= scale * db
        converged = (np.hypot(r1, r2) < rounding) | (np.hypot(da, db) < 2e-15)
        done[todo[converged]] = True
        todo = todo[~converged & np.isfinite(da) & np.isfinite(db)]
        if len(todo) == 0:
            break
    point, _, _ = surface(np.where(done, a, 0.3), np.where(done, b, 0.3))
    distance = np.sum((point - position) * normal, axis=1)
    return a, b, np.where(done, distance, np.inf), point, done
