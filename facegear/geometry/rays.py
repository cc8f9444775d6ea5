"""Rays cut with the face gear's surfaces, compiled: flank, fillet, tip land, root land, the first one hit.

The closed forms are those of `facegear.geometry.closed_forms`, compiled for single rays. All angles in rad,
all lengths in m, for the right side of tooth 0 in the gear's body frame.
"""

from math import atan, atan2, hypot, inf, isfinite, isnan, nan, pi, sin, sqrt
from pathlib import Path
from typing import NamedTuple

import numpy as np

from facegear.geometry import closed_forms, face_gear
from facegear.geometry.design import PairDesign
from facegear.machine_code import compiler

NONE, FLANK, FILLET, TIP_LAND, ROOT_LAND = range(5)
NEWTON_STEPS = 40
LARGEST_STEP = 0.2
PSI_STEPS = 60

compiled = compiler(Path(__file__).parent)
inlined = compiler(Path(__file__).parent, forceinline=True)

flank_frame = inlined(closed_forms.flank_frame)
flank_normal = inlined(closed_forms.flank_normal)
fillet_frame = inlined(closed_forms.fillet_frame)
radius_at_roll = inlined(closed_forms.radius_at_roll)
radius_at_height = inlined(closed_forms.radius_at_height)
roll_at_height = inlined(closed_forms.roll_at_height)
first_psi = inlined(closed_forms.first_psi)


class Blank(NamedTuple):
    """The gear's numbers as the kernels take them."""

    base: float
    ratio: float
    space: float
    lift: float
    tip_radius: float
    tip_roll: float
    edge_start: float
    inner: float
    outer: float
    tip_plane: float
    root_plane: float
    root_start: float
    pitch: float
    aside: float
    """Largest distance from the tooth's middle plane, abs(x) in m, of points looked at."""
    fillet_top: float
    """Height (m) that no point of the fillet exceeds."""


def blank(design: PairDesign) -> Blank:
    """Numbers of a design's face gear."""
    gear, pitch = design.face_gear, 2 * pi / design.face_gear.teeth
    ends = face_gear.fillet_end(design, np.linspace(gear.inner_radius, gear.outer_radius, 65))
    tops = design.shaper_lift - design.shaper_tip_radius * np.cos(ends)
    return Blank(
        *face_gear.shaper_numbers(design),
        design.shaper_tip_radius,
        design.shaper_tip_roll,
        float(face_gear.edge_start(design)),
        gear.inner_radius,
        gear.outer_radius,
        design.gear_tip_plane,
        design.gear_root_plane,
        pitch / 2 - float(face_gear.root_half_angle(design)),
        pitch,
        3 * design.module,
        float(tops.max()) + 0.01 * design.module,
    )


@compiled
def cut(blank, position, normal, reach, points, normals, rolls, psis, inner, spacing):  # type: ignore[no-untyped-def]
    """Cut rays (n, 3), unit `normal` (n, 3), with the gear; surfaces further than `reach` do not count.

    `points`, `normals` (m, 3), `rolls`, `psis`, `inner` (m,) and `spacing` are a sample of the flank: a
    second start where Newton's first fails, and proof that a ray misses. Returns gap (n,), the part hit
    (n,), where on it (n,) twice, the distance (n,) to the flank continued beyond its edges, and how many rays
    close to a surface could not be cut with it.
    """
    count = position.shape[0]
    gap, part = np.full(count, inf), np.zeros(count, np.int8)
    u, v, continued = np.full(count, nan), np.full(count, nan), np.full(count, inf)
    beside = max(reach, blank.aside / 3)
    lost = 0
    for ray in range(count):
        p, n = position[ray], normal[ray]
        radius = hypot(p[0], p[1])
        if not (blank.inner - beside < radius < blank.outer + beside):
            continue
        rise = reach * abs(n[2])
        low, high = p[2] - rise, p[2] + rise
        if not (low < blank.tip_plane + 1e-12 and high > blank.root_plane and abs(p[0]) < blank.aside):
            continue
        inside = min(max(radius, blank.inner), blank.outer)
        distance, straight, a, b, done = _flank(blank, p, n, inside)
        if not done:
            best = _nearest(p, n, reach, points, normals, spacing)
            if best >= 0:
                distance, straight, a, b, done = _flank_from(blank, p, n, rolls[best], psis[best])
                if not done and inner[best]:
                    lost += 1
        if abs(straight) < reach:
            continued[ray] = straight
        found = FLANK
        if not abs(distance) < reach and low < blank.fillet_top:
            distance, a, b = _fillet(blank, p, n, radius)
            lost += isnan(distance)
            found = FILLET
        if not abs(distance) < reach:
            distance, a, b = _land(blank, p, n, blank.tip_plane)
            found = TIP_LAND
            if abs(distance) < reach:
                edge = _tip_angle(blank, b)
                lost += isnan(edge)
                distance = distance if abs(a) <= edge else inf
        if not abs(distance) < reach:
            distance, a, b = _land(blank, p, n, blank.root_plane)
            found = ROOT_LAND
            if not (blank.root_start <= a <= blank.pitch - blank.root_start):
                distance = inf
        if abs(distance) < reach:
            gap[ray], part[ray], u[ray], v[ray] = distance, found, a, b
    return gap, part, u, v, continued, lost


@compiled
def _flank(blank, p, n, inside):  # type: ignore[no-untyped-def]
    """From the generating section that the point lies in."""
    cosine = blank.base / (blank.ratio * inside)
    sine = sqrt(max(1 - cosine * cosine, 1e-12))
    roll = ((blank.lift - p[2]) / blank.base - cosine) / sine
    roll = min(max(roll, 0.0), 1.2 * blank.tip_roll)
    return _flank_from(blank, p, n, roll, atan2(sine, cosine))


@compiled
def _flank_from(blank, p, n, roll, psi):  # type: ignore[no-untyped-def]
    roll, psi, distance, x, y, z, done = _newton(blank, False, p, n, roll, psi)
    nx, ny, nz = flank_normal(blank.ratio, blank.space, roll, psi)
    facing = n[0] * nx + n[1] * ny + n[2] * nz
    straight = distance if done and facing < 0 else inf
    inside = blank.inner <= hypot(x, y) <= blank.outer and roll <= blank.tip_roll
    distance = straight if inside and z <= blank.tip_plane + 1e-12 else inf
    return distance, straight, roll, psi, done


@compiled
def _nearest(p, n, reach, points, normals, spacing):  # type: ignore[no-untyped-def]
    """The sampled flank point that the ray passes closest, if it does so within `spacing`, else -1."""
    least, best = spacing * spacing, -1
    for k in range(points.shape[0]):
        x, y, z = points[k, 0] - p[0], points[k, 1] - p[1], points[k, 2] - p[2]
        along = x * n[0] + y * n[1] + z * n[2]
        aside = x * x + y * y + z * z - along * along
        facing = n[0] * normals[k, 0] + n[1] * normals[k, 1] + n[2] * normals[k, 2]
        if aside < least and abs(along) <= reach and facing <= -0.1:
            least, best = aside, k
    return best


@compiled
def _fillet(blank, p, n, radius):  # type: ignore[no-untyped-def]
    cosine = min(max((blank.lift - p[2]) / blank.tip_radius, 0.5), 1.0)
    chi = -atan2(sqrt(max(1 - cosine * cosine, 0.0)), cosine)
    chi, radius, distance, x, y, _, done = _newton(blank, True, p, n, chi, radius)
    if not (done and chi <= 0 and blank.inner <= hypot(x, y) <= blank.outer):
        return inf, chi, radius
    inside = min(max(radius, blank.inner), blank.outer)
    end = _psi_at(blank, inside, blank.tip_roll) - atan(blank.tip_roll)
    if isnan(end):
        return nan, chi, radius
    return (distance if chi >= end else inf), chi, radius


@compiled
def _land(blank, p, n, height):  # type: ignore[no-untyped-def]
    """Distance, gear angle and radius where the ray meets the plane, inf beside the blank."""
    if not n[2] < -1e-9:
        return inf, nan, nan
    distance = (height - p[2]) / n[2]
    x, y = p[0] + distance * n[0], p[1] + distance * n[1]
    radius = hypot(x, y)
    if not blank.inner <= radius <= blank.outer:
        distance = inf
    return distance, atan2(x, y), radius


@compiled
def _tip_angle(blank, radius):  # type: ignore[no-untyped-def]
    """Gear angle of the tip edge at a gear radius."""
    height = (blank.lift - blank.tip_plane) / blank.base
    psi = first_psi(blank.base, blank.ratio, radius)
    for _ in range(PSI_STEPS):
        value, slope = radius_at_height(blank.base, blank.ratio, radius, height, psi)
        step = min(max(value / slope, -0.1), 0.1)
        psi -= step
        if abs(step) < 1e-14:
            break
    if not abs(step) < 1e-12:
        return nan
    x, y, _, _, _, _, _, _, _ = _flank_frame(blank, roll_at_height(height, psi), psi)
    return atan2(x, y)


@compiled
def _psi_at(blank, radius, roll):  # type: ignore[no-untyped-def]
    psi = first_psi(blank.base, blank.ratio, radius)
    for _ in range(PSI_STEPS):
        value, slope = radius_at_roll(blank.base, blank.ratio, radius, roll, psi)
        step = min(max(value / slope, -0.1), 0.1)
        psi -= step
        if abs(step) < 1e-14:
            return psi
    return psi if abs(step) < 1e-12 else nan


@compiled
def _flank_frame(blank, roll, psi):  # type: ignore[no-untyped-def]
    return flank_frame(blank.base, blank.ratio, blank.space, blank.lift, roll, psi)


@compiled
def _fillet_frame(blank, chi, radius):  # type: ignore[no-untyped-def]
    """Point and derivatives with respect to chi and gear radius; nan where the locus does not reach."""
    if not radius > abs(blank.tip_radius * sin(chi)):
        return nan, nan, nan, nan, nan, nan, nan, nan, nan
    return fillet_frame(blank.tip_radius, blank.ratio, blank.lift, blank.edge_start, chi, radius)


@compiled
def _newton(blank, fillet, p, n, a, b):  # type: ignore[no-untyped-def]
    """Cut a ray with X(a, b): a, b, distance along the ray, the point hit, and whether it converged."""
    length = hypot(n[0], n[2])
    e0, e2 = n[2] / length, -n[0] / length
    f0, f1, f2 = n[1] * e2, n[2] * e0 - n[0] * e2, -n[1] * e0
    rounding = 1e-14 * max(abs(p[0]), abs(p[1]), abs(p[2]))
    done = False
    for _ in range(NEWTON_STEPS):
        if fillet:
            x, y, z, ax, ay, az, bx, by, bz = _fillet_frame(blank, a, b)
        else:
            x, y, z, ax, ay, az, bx, by, bz = _flank_frame(blank, a, b)
        x, y, z = x - p[0], y - p[1], z - p[2]
        r1, r2 = x * e0 + z * e2, x * f0 + y * f1 + z * f2
        a1, a2 = ax * e0 + az * e2, ax * f0 + ay * f1 + az * f2
        b1, b2 = bx * e0 + bz * e2, bx * f0 + by * f1 + bz * f2
        det = a1 * b2 - a2 * b1
        if det == 0.0:
            break
        da, db = (r1 * b2 - r2 * b1) / det, (a1 * r2 - a2 * r1) / det
        if not (isfinite(da) and isfinite(db)):
            break
        scale = min(1.0, LARGEST_STEP / max(abs(da), abs(db), LARGEST_STEP))
        a -= scale * da
        b -= scale * db
        if hypot(r1, r2) < rounding or hypot(da, db) < 2e-15:
            done = True
            break
    if not done:
        return a, b, inf, nan, nan, nan, False
    if fillet:
        x, y, z, _, _, _, _, _, _ = _fillet_frame(blank, a, b)
    else:
        x, y, z, _, _, _, _, _, _ = _flank_frame(blank, a, b)
    distance = (x - p[0]) * n[0] + (y - p[1]) * n[1] + (z - p[2]) * n[2]
    return a, b, distance, x, y, z, True
