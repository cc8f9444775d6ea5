"""A single ray cut with one surface of the face gear, compiled: flank, fillet or a land.

The closed forms are those of `facegear.geometry.closed_forms`, compiled for single rays. All angles in rad,
all lengths in m, for the right side of tooth 0 in the gear's body frame. `blank` is a `ray_blank.Blank`, p a
point and n a unit direction.
"""

from math import atan2, hypot, inf, isfinite, isnan, nan, pi, sqrt

from facegear.arrays import Array
from facegear.geometry import closed_forms
from facegear.geometry.ray_blank import Blank
from facegear.machine_code.compiler import for_callers

NEWTON_STEPS = 40
LARGEST_STEP = 0.2
NEGLIGIBLE = 1e-10
"""Distance (m) of a ray from the point reached on the flank, whose square over the flank's radii of curvature
is below rounding: Newton's next step is exact, and its end is known without looking."""
PSI_STEPS = 60
BISECTIONS = 6

FlankCut = tuple[float, float, float, float, bool]
"""Distance to the flank, and to the flank continued beyond its edges; roll and psi there; whether Newton's
method converged."""

inlined = for_callers()

flank_frame = inlined(closed_forms.flank_frame)
surface_normal = inlined(closed_forms.normal)
fillet_frame = inlined(closed_forms.fillet_frame)
radius_at_roll = inlined(closed_forms.radius_at_roll)
radius_at_height = inlined(closed_forms.radius_at_height)
roll_at_height = inlined(closed_forms.roll_at_height)
first_psi = inlined(closed_forms.first_psi)


@inlined
def cut_flank(blank: Blank, p: Array, n: Array, inside: float) -> FlankCut:
    """From the generating section that the point lies in."""
    cosine = blank.base / (blank.ratio * inside)
    sine = sqrt(max(1 - cosine * cosine, 1e-12))
    roll = ((blank.lift - p[2]) / blank.base - cosine) / sine
    roll = min(max(roll, 0.0), 1.2 * blank.tip_roll)
    return cut_flank_from(blank, p, n, roll, atan2(sine, cosine))


@inlined
def cut_flank_from(blank: Blank, p: Array, n: Array, roll: float, psi: float) -> FlankCut:
    roll, psi, distance, x, y, z, done = _newton(blank, False, p, n, roll, psi)
    nx, ny, nz = surface_normal(blank.ratio * (psi - roll - blank.space), psi)
    facing = n[0] * nx + n[1] * ny + n[2] * nz
    straight = distance if done and facing < 0 else inf
    inside = blank.inner <= hypot(x, y) <= blank.outer and roll <= blank.tip_roll
    distance = straight if inside and z <= blank.tip_plane + 1e-12 else inf
    return distance, straight, roll, psi, done


@inlined
def cut_fillet(blank: Blank, p: Array, n: Array, radius: float) -> tuple[float, float, float]:
    """Distance, slope psi of the fillet's normal and gear radius where the ray meets it, inf beside it."""
    psi = _psi_at_height(blank, radius, p[2])
    psi, _, distance, x, y, _, done = _newton(blank, True, p, n, psi, radius)
    radius = hypot(x, y)
    if not (done and psi <= 0.5 * pi and blank.inner <= radius <= blank.outer):
        return inf, psi, radius
    start = _psi_at(blank, radius, blank.tip_roll)
    if isnan(start):
        return nan, psi, radius
    return (distance if psi >= start else inf), psi, radius


@inlined
def _psi_at_height(blank: Blank, q: float, z: float) -> float:
    """psi on the fillet's section near a height, by bisection to a few degrees."""
    low, high = blank.fillet_start, 0.5 * pi
    for _ in range(BISECTIONS):
        psi = 0.5 * (low + high)
        if _fillet_frame(blank, psi, q)[2] > z:
            low = psi
        else:
            high = psi
    return 0.5 * (low + high)


@inlined
def cut_land(blank: Blank, p: Array, n: Array, height: float) -> tuple[float, float, float]:
    """Distance, gear angle and radius where the ray meets the plane, inf beside the blank."""
    if not n[2] < -1e-9:
        return inf, nan, nan
    distance = (height - p[2]) / n[2]
    x, y = p[0] + distance * n[0], p[1] + distance * n[1]
    radius = hypot(x, y)
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
        if abs(step) < 1e-14:
            break
    if not abs(step) < 1e-12:
        return nan
    x, y, _, _, _, _, _, _, _ = _flank_frame(blank, roll_at_height(height, psi), psi)
    return atan2(x, y)


@inlined
def _psi_at(blank: Blank, radius: float, roll: float) -> float:
    psi = first_psi(blank.base, blank.ratio, radius)
    for _ in range(PSI_STEPS):
        value, slope = radius_at_roll(blank.base, blank.ratio, radius, roll, psi)
        step = min(max(value / slope, -0.1), 0.1)
        psi -= step
        if abs(step) < 1e-14:
            return psi
    return psi if abs(step) < 1e-12 else nan


@inlined
def _flank_frame(blank: Blank, roll: float, psi: float) -> tuple[float, ...]:
    return flank_frame(blank.base, blank.ratio, blank.space, blank.lift, roll, psi)


@inlined
def _fillet_frame(blank: Blank, psi: float, q: float) -> tuple[float, ...]:
    """Point and derivatives with respect to psi and q; nan where the shaper's tip generates nothing."""
    return fillet_frame(
        blank.tip_centre, blank.tip_rounding, blank.ratio, blank.lift, blank.edge_start, psi, q
    )


@inlined
def _newton(
    blank: Blank, fillet: bool, p: Array, n: Array, a: float, b: float
) -> tuple[float, float, float, float, float, float, bool]:
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
        if not fillet and hypot(r1, r2) < NEGLIGIBLE:
            x, y, z = x - da * ax - db * bx, y - da * ay - db * by, z - da * az - db * bz
            return a, b, x * n[0] + y * n[1] + z * n[2], x + p[0], y + p[1], z + p[2], True
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
