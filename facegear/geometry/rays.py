"""Rays cut with a tooth of the face gear, compiled: the first of its surfaces that is hit.

All angles in rad, all lengths in m, for the right side of tooth 0 in the gear's body frame.
"""

from math import inf, isnan, nan, sqrt
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.geometry.ray_blank import Blank
from facegear.geometry.ray_lanes import cut_flanks, lanes
from facegear.geometry.ray_surfaces import (
    FAST_NUMBERS,
    Ray,
    cut_fillet,
    cut_flank,
    cut_land,
    inlined,
    tip_angle,
)
from facegear.machine_code.compiler import compiler

NONE, FLANK, FILLET, TIP_LAND, ROOT_LAND = range(5)


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
    radii: Array,
) -> tuple[list[AnyArray], int]:
    """Cut rays (n, 3), unit `normal` (n, 3), with the gear, as far as `search_radius` along them.

    `points`, `normals` (m, 3), `rolls`, `psis`, `inner` (m,), `spacing` and `radii` are a `FlankSample`: a
    second start where Newton's first fails, and proof that a ray misses. Returns gap (n,), the part hit (n,),
    where on it (n,) twice, the distance (n,) to the flank continued beyond its edges and the gear radius (n,)
    that is hit; and how many rays close to a surface could not be cut with it.
    """
    count = position.shape[0]
    gap, u, v, continued, radius = np.empty((5, count))
    part, live, known = np.empty(count, np.int8), np.empty(count, np.int64), np.empty(count, np.bool_)
    sample = points, normals, rolls, psis, inner, spacing, radii
    rays, hits = (position, normal, live, known), (gap, part, u, v, continued, radius)
    lost = cut_rays(blank, *rays, search_radius, *sample, *lanes(), *hits)
    return [gap, part, u, v, continued, radius], lost


@compiler(Path(__file__).parent, **FAST_NUMBERS)
def cut_rays(
    blank: Blank,
    position: Array,
    normal: Array,
    live: Integers,
    known: Mask,
    search_radius: float,
    points: Array,
    normals: Array,
    rolls: Array,
    psis: Array,
    inner: Mask,
    spacing: float,
    radii: Array,
    of_lanes: Array,
    counts: Integers,
    gap: Array,
    part: NDArray[np.int8],
    u: Array,
    v: Array,
    continued: Array,
    radius: Array,
) -> int:
    """What `cut` returns, written into arrays (n,), the lanes' own and room for numbers of rays beside them;
    how many could not be cut.
    """
    for ray in range(gap.size):
        gap[ray], part[ray], continued[ray], known[ray] = inf, NONE, inf, False
        u[ray], v[ray], radius[ray] = nan, nan, nan
    near, lost = _near_the_tooth(blank, position, normal, search_radius, live), 0
    rays, hits = (position, normal, live[:near]), (gap, u, v, continued, radius, known)
    cut_flanks(blank, *rays, search_radius, of_lanes, counts, *hits)
    for ray in live[:near]:
        if abs(gap[ray]) < search_radius:
            part[ray] = FLANK
            continue
        p = position[ray, 0], position[ray, 1], position[ray, 2]
        n = normal[ray, 0], normal[ray, 1], normal[ray, 2]
        distance, surface, a, b, at = inf, FLANK, nan, nan, nan
        if not known[ray]:
            best = _nearest(p, n, search_radius, points, normals, spacing, radii)
            if best >= 0:
                distance, straight, a, b, at, done = cut_flank(
                    blank, p, n, rolls[best], psis[best], search_radius
                )
                if abs(straight) < search_radius:
                    continued[ray] = straight
                lost += not done and inner[best]
        # no point of the ray is farther in or out than by this, in squares of the radius
        begin = sqrt(p[0] * p[0] + p[1] * p[1])
        aside = 2 * search_radius * abs(p[0] * n[0] + p[1] * n[1]) + search_radius * search_radius
        shortest, longest = blank.inner * blank.inner - aside, blank.outer * blank.outer + aside
        if not shortest < begin * begin < longest:
            continue
        low = p[2] - search_radius * abs(n[2])
        if not abs(distance) < search_radius and low < blank.fillet_top:
            distance, a, b = cut_fillet(blank, p, n, begin, search_radius)
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
            radius[ray] = at if surface == FLANK else b
    return lost


@inlined
def _near_the_tooth(
    blank: Blank, position: Array, normal: Array, search_radius: float, live: Integers
) -> int:
    """How many rays come where the tooth, or its flank continued, may be; their numbers are written."""
    count = 0
    beside = max(search_radius, blank.aside / 3)
    for ray in range(position.shape[0]):
        x, y, z = position[ray, 0], position[ray, 1], position[ray, 2]
        rise = search_radius * abs(normal[ray, 2])
        high = z - rise < blank.tip_plane + 1e-12 and z + rise > blank.root_plane
        between = blank.inner - beside < sqrt(x * x + y * y) < blank.outer + beside
        if high and between and abs(x) < blank.aside:
            live[count] = ray
            count += 1
    return count


@inlined
def _nearest(
    p: Ray, n: Ray, search_radius: float, points: Array, normals: Array, spacing: float, radii: Array
) -> int:
    """The sampled flank point that the ray passes closest, if it does so within `spacing`, else -1."""
    min_distance, best = spacing * spacing, -1
    radius, each = sqrt(p[0] * p[0] + p[1] * p[1]), points.shape[0] // radii.size
    for row in range(radii.size):
        if abs(radii[row] - radius) > search_radius + spacing:
            continue
        for k in range(row * each, (row + 1) * each):
            x, y, z = points[k, 0] - p[0], points[k, 1] - p[1], points[k, 2] - p[2]
            along = x * n[0] + y * n[1] + z * n[2]
            aside = x * x + y * y + z * z - along * along
            facing = n[0] * normals[k, 0] + n[1] * normals[k, 1] + n[2] * normals[k, 2]
            if aside < min_distance and abs(along) <= search_radius and facing <= -0.1:
                min_distance, best = aside, k
    return best
