"""Rays cut with a tooth of the face gear, compiled: the first of its surfaces that is hit.

All angles in rad, all lengths in m, for the right side of tooth 0 in the gear's body frame.
"""

from math import inf, isnan, nan, sqrt
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from facegear.arrays import Array, Mask
from facegear.geometry.ray_blank import Blank
from facegear.geometry.ray_surfaces import (
    AGE,
    FAST_NUMBERS,
    LAST,
    Ray,
    cut_fillet,
    cut_flank,
    cut_flank_from,
    cut_land,
    inlined,
    tip_angle,
)
from facegear.machine_code.compiler import compiler

NONE, FLANK, FILLET, TIP_LAND, ROOT_LAND = range(5)


@compiler(Path(__file__).parent, **FAST_NUMBERS)
def cut(
    blank: Blank,
    position: Array,
    normal: Array,
    search_radius: float,
    points: Array,
    normals: Array,
    rolls: Array,
    psis: Array,
    inner: Mask,
    spacing: float,
) -> tuple[Array, NDArray[np.int8], Array, Array, Array, int]:
    """Cut rays (n, 3), unit `normal` (n, 3), with the gear, as far as `search_radius` along them.

    `points`, `normals` (m, 3), `rolls`, `psis`, `inner` (m,) and `spacing` are a sample of the flank: a
    second start where Newton's first fails, and proof that a ray misses. Returns gap (n,), the part hit
    (n,), where on it (n,) twice, the distance (n,) to the flank continued beyond its edges, and how many rays
    close to a surface could not be cut with it.
    """
    count = position.shape[0]
    gap, part = np.full(count, inf), np.zeros(count, np.int8)
    u, v, continued = np.full(count, nan), np.full(count, nan), np.full(count, inf)
    beside = max(search_radius, blank.aside / 3)
    lost, last = 0, np.zeros(LAST)
    last[AGE] = -1.0
    for ray in range(count):
        p = position[ray, 0], position[ray, 1], position[ray, 2]
        n = normal[ray, 0], normal[ray, 1], normal[ray, 2]
        radius = sqrt(p[0] * p[0] + p[1] * p[1])
        if not (blank.inner - beside < radius < blank.outer + beside):
            continue
        rise = search_radius * abs(n[2])
        low, high = p[2] - rise, p[2] + rise
        if not (low < blank.tip_plane + 1e-12 and high > blank.root_plane and abs(p[0]) < blank.aside):
            continue
        inside = min(max(radius, blank.inner), blank.outer)
        distance, straight, a, b, done = cut_flank(blank, p, n, inside, search_radius, last)
        if not done:
            best = _nearest(p, n, search_radius, points, normals, spacing)
            if best >= 0:
                distance, straight, a, b, done = cut_flank_from(
                    blank, p, n, rolls[best], psis[best], search_radius, last
                )
                if not done and inner[best]:
                    lost += 1
        if abs(straight) < search_radius:
            continued[ray] = straight
        # no point of the ray is farther in or out than by this, in squares of the radius
        aside = 2 * search_radius * abs(p[0] * n[0] + p[1] * n[1]) + search_radius * search_radius
        if not (blank.inner**2 - aside < radius * radius < blank.outer**2 + aside):
            continue
        surface = FLANK
        if not abs(distance) < search_radius and low < blank.fillet_top:
            distance, a, b = cut_fillet(blank, p, n, radius, search_radius)
            lost += isnan(distance)
            surface = FILLET
        if not abs(distance) < search_radius:
            distance, a, b = cut_land(blank, p, n, blank.tip_plane, search_radius)
            surface = TIP_LAND
            if abs(distance) < search_radius:
                edge = tip_angle(blank, b)
                lost += isnan(edge)
                distance = distance if abs(a) <= edge else inf
        if not abs(distance) < search_radius:
            distance, a, b = cut_land(blank, p, n, blank.root_plane, search_radius)
            surface = ROOT_LAND
            if not (blank.root_start <= a <= blank.pitch - blank.root_start):
                distance = inf
        if abs(distance) < search_radius:
            gap[ray], part[ray], u[ray], v[ray] = distance, surface, a, b
    return gap, part, u, v, continued, lost


@inlined
def _nearest(p: Ray, n: Ray, search_radius: float, points: Array, normals: Array, spacing: float) -> int:
    """The sampled flank point that the ray passes closest, if it does so within `spacing`, else -1."""
    min_distance, best = spacing * spacing, -1
    for k in range(points.shape[0]):
        x, y, z = points[k, 0] - p[0], points[k, 1] - p[1], points[k, 2] - p[2]
        along = x * n[0] + y * n[1] + z * n[2]
        aside = x * x + y * y + z * z - along * along
        facing = n[0] * normals[k, 0] + n[1] * normals[k, 1] + n[2] * normals[k, 2]
        if aside < min_distance and abs(along) <= search_radius and facing <= -0.1:
            min_distance, best = aside, k
    return best
