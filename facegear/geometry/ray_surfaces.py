"""A single ray cut with one surface of the face gear, compiled: flank, fillet or a land.

The closed forms are those of `facegear.geometry.closed_forms`, compiled for single rays. All angles in rad,
all lengths in m, for the right side of tooth 0 in the gear's body frame. `blank` is a `ray_blank.Blank`, p a
point and n a unit direction.
"""

from math import atan2, cos, inf, isnan, nan, pi, sin, sqrt
from typing import Any

from facegear.arrays import Array
from facegear.geometry import closed_forms
from facegear.geometry.ray_blank import Blank
from facegear.machine_code.compiler import FAST, for_callers

NEWTON_STEPS = 16
LARGEST_STEP = 0.2
NEGLIGIBLE = 1e-9
"""Distance (m) of a ray from the point reached on the flank, whose square over the flank's radii of curvature
is below rounding: Newton's next step is exact, and its end is known without looking."""
NEGLIGIBLE_IN_FILLET = 1e-10
"""The same on the fillet, whose radii are smaller."""
SEEN = 1e-5
"""Distance (m) of a ray from the point reached from which on the ray's length is known as well as that."""
PSI_STEPS = 60
CLOSE = 1e-8
"""Step (rad) of Newton's method whose square is below rounding, so that it is the last."""
BISECTIONS = 6

Ray = tuple[float, float, float]
"""A point, or a unit direction, as plain numbers."""

FlankCut = tuple[float, float, float, float, float, bool]
"""Distance to the flank, and to the flank continued beyond its edges; roll, psi and gear radius there;
whether Newton's method converged."""

FAST_NUMBERS: dict[str, Any] = {**FAST, "error_model": "numpy"}
"""As FAST, and a division by zero is not an error but infinite."""

inlined = for_callers(**FAST_NUMBERS)

turned_flank_frame = inlined(closed_forms.turned_flank_frame)
fillet_height = inlined(closed_forms.fillet_height)
fillet_frame = inlined(closed_forms.fillet_frame)
radius_at_roll = inlined(closed_forms.radius_at_roll)
radius_at_height = inlined(closed_forms.radius_at_height)
roll_at_height = inlined(closed_forms.roll_at_height)
first_psi = inlined(closed_forms.first_psi)


@inlined
def cut_flank(blank: Blank, p: Ray, n: Ray, roll: float, psi: float, search_radius: float) -> FlankCut:
    """By Newton's method from a point of the flank."""
    beside = across(n)
    for _ in range(NEWTON_STEPS):
        turn = blank.ratio * (psi - roll - blank.space)
        ct, st, cp, sp = cos(turn), sin(turn), cos(psi), sin(psi)
        frame = turned_flank_frame(blank.base, blank.ratio, blank.lift, roll, ct, st, cp, sp)
        da, db, off, x, y, z = step(p, beside, frame)
        if not abs(da) + abs(db) < inf:
            break
        if off < SEEN:
            distance = x * n[0] + y * n[1] + z * n[2]
            if off < NEGLIGIBLE:
                straight = distance if cp * (n[0] * ct + n[1] * st) + n[2] * sp < 0 else inf
                roll, psi, x, y, z = roll - da, psi - db, x + p[0], y + p[1], z + p[2]
                radius = sqrt(x * x + y * y)
                inside = blank.inner <= radius <= blank.outer and roll <= blank.tip_roll
                distance = straight if inside and z <= blank.tip_plane + 1e-12 else inf
                return distance, straight, roll, psi, radius, True
            if abs(distance) > search_radius + SEEN:
                return inf, inf, roll, psi, nan, True
        scale = min(1.0, LARGEST_STEP / max(abs(da), abs(db), LARGEST_STEP))
        roll, psi = roll - scale * da, psi - scale * db
    return inf, inf, roll, psi, nan, False


@inlined
def across(n: Array) -> tuple[float, ...]:
    """Two unit directions across a ray: x and z of the first, x, y and z of the second."""
    length = sqrt(n[0] * n[0] + n[2] * n[2])
    e0, e2 = n[2] / length, -n[0] / length
    return e0, e2, n[1] * e2, n[2] * e0 - n[0] * e2, -n[1] * e0


@inlined
def step(p: Ray, beside: tuple[float, ...], frame: tuple[float, ...]) -> tuple[float, ...]:
    """Newton's step from a frame of a surface towards a ray that two directions stand `beside`: what to take
    off both parameters, not finite where there is none, the distance (m) of the frame's point from the ray,
    and where the step leads, x, y and z from p.
    """
    e0, e2, f0, f1, f2 = beside
    x, y, z, ax, ay, az, bx, by, bz = frame
    x, y, z = x - p[0], y - p[1], z - p[2]
    r1, r2 = x * e0 + z * e2, x * f0 + y * f1 + z * f2
    a1, a2 = ax * e0 + az * e2, ax * f0 + ay * f1 + az * f2
    b1, b2 = bx * e0 + bz * e2, bx * f0 + by * f1 + bz * f2
    inverse = 1.0 / (a1 * b2 - a2 * b1)
    da, db = (r1 * b2 - r2 * b1) * inverse, (a1 * r2 - a2 * r1) * inverse
    x, y, z = x - da * ax - db * bx, y - da * ay - db * by, z - da * az - db * bz
    return da, db, sqrt(r1 * r1 + r2 * r2), x, y, z


@inlined
def cut_fillet(
    blank: Blank, p: Ray, n: Ray, radius: float, search_radius: float
) -> tuple[float, float, float]:
    """Distance, slope psi of the fillet's normal and gear radius where the ray meets it, inf beside it."""
    psi = _psi_at_height(blank, radius, p[2])
    psi, distance, x, y, done = _fillet_newton(blank, p, n, psi, radius, search_radius)
    radius = sqrt(x * x + y * y)
    if not (done and psi <= 0.5 * pi and blank.inner <= radius <= blank.outer):
        return inf, psi, radius
    start = psi_at(blank.base, blank.ratio, radius, blank.tip_roll)
    if isnan(start):
        return nan, psi, radius
    return (distance if psi >= start else inf), psi, radius


@inlined
def _psi_at_height(blank: Blank, q: float, z: float) -> float:
    """psi on the fillet's section near a height, by bisection to a few degrees."""
    low, high = blank.fillet_start, 0.5 * pi
    for _ in range(BISECTIONS):
        psi = 0.5 * (low + high)
        height = fillet_height(blank.tip_centre, blank.tip_rounding, blank.ratio, blank.lift, psi, q)
        if height > z:
            low = psi
        else:
            high = psi
    return 0.5 * (low + high)


@inlined
def cut_land(blank: Blank, p: Ray, n: Ray, height: float, search_radius: float) -> tuple[float, float, float]:
    """Distance, gear angle and radius where the ray meets the plane, inf beside the blank and farther than
    `search_radius`.
    """
    if not n[2] < -1e-9:
        return inf, nan, nan
    distance = (height - p[2]) / n[2]
    if not abs(distance) < search_radius:
        return inf, nan, nan
    x, y = p[0] + distance * n[0], p[1] + distance * n[1]
    radius = sqrt(x * x + y * y)
    if not blank.inner <= radius <= blank.outer:
        distance = inf
    return distance, atan2(x, y), radius


@inlined
def tip_angle(blank: Blank, radius: float) -> float:
    """Gear angle of the tip edge at a gear radius."""
    height = (blank.lift - blank.tip_plane) / blank.base
    psi = first_psi(blank.base, blank.ratio, radius)
    for _ in range(PSI_STEPS):
        value, slope = radius_at_height(blank.base, blank.ratio, radius, height, psi)
        step = min(max(value / slope, -0.1), 0.1)
        psi -= step
        if abs(step) < CLOSE:
            break
    if not abs(step) < CLOSE:
        return nan
    x, y, _, _, _, _, _, _, _ = _flank_frame(blank, roll_at_height(height, psi), psi)
    return atan2(x, y)


@inlined
def psi_at(base: float, ratio: float, radius: float, roll: float) -> float:
    """Slope psi of the flank's normal at a gear radius and roll; nan where it is not found."""
    psi = first_psi(base, ratio, radius)
    for _ in range(PSI_STEPS):
        value, slope = radius_at_roll(base, ratio, radius, roll, psi)
        step = min(max(value / slope, -0.1), 0.1)
        psi -= step
        if abs(step) < CLOSE:
            return psi
    return nan


@inlined
def _flank_frame(blank: Blank, roll: float, psi: float) -> tuple[float, ...]:
    turn = blank.ratio * (psi - roll - blank.space)
    ct, st, cp, sp = cos(turn), sin(turn), cos(psi), sin(psi)
    return turned_flank_frame(blank.base, blank.ratio, blank.lift, roll, ct, st, cp, sp)


@inlined
def _fillet_frame(blank: Blank, psi: float, q: float) -> tuple[float, ...]:
    """Point and derivatives with respect to psi and q; nan where the shaper's tip generates nothing."""
    return fillet_frame(
        blank.tip_centre, blank.tip_rounding, blank.ratio, blank.lift, blank.edge_start, psi, q
    )


@inlined
def _fillet_newton(
    blank: Blank, p: Ray, n: Ray, psi: float, q: float, search_radius: float
) -> tuple[float, float, float, float, bool]:
    """psi, distance along the ray, x and y of the point hit, and whether it converged, no farther than
    `search_radius`.
    """
    beside = across(n)
    for _ in range(NEWTON_STEPS):
        da, db, off, x, y, z = step(p, beside, _fillet_frame(blank, psi, q))
        if not abs(da) + abs(db) < inf:
            break
        scale = min(1.0, LARGEST_STEP / max(abs(da), abs(db), LARGEST_STEP))
        psi -= scale * da
        q -= scale * db
        if off < SEEN:
            distance = x * n[0] + y * n[1] + z * n[2]
            if abs(distance) > search_radius + SEEN:
                break
            if off < NEGLIGIBLE_IN_FILLET:
                return psi, distance, x + p[0], y + p[1], abs(distance) < search_radius
    return psi, inf, nan, nan, False
