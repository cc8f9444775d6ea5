"""Rays cut with the face gear's flank, compiled: many at once, by Newton's method side by side.

A ray alone waits for every product of its own steps. Here LANES of them step together in plain loops over
lanes, which become vectors. Each lane takes neighbouring rays in turn, each from where the one before met the
flank. All angles in rad, all lengths in m, see `facegear.geometry.ray_surfaces`.
"""

from math import atan2, factorial, inf, pi, sqrt

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.geometry.ray_blank import Blank
from facegear.geometry.ray_surfaces import (
    LARGEST_STEP,
    NEGLIGIBLE,
    NEWTON_STEPS,
    SEEN,
    across,
    inlined,
    step,
    turned_flank_frame,
)

LANES = 16
NEIGHBOURS = 64
"""Rays that a lane takes in turn."""
LATE = 4
"""Lanes that the others do not wait for: they go on beside the next rays."""
NEAR = 0.05
"""Distance (rad) between points of neighbouring rays, in roll and psi together, up to which one starts at the
other."""
ANYWHERE = 0.4
"""Roll and psi (rad) of lanes without a ray."""

SINE = tuple((-1) ** k / factorial(2 * k + 1) for k in range(11))
COSINE = tuple((-1) ** k / factorial(2 * k) for k in range(11))
"""Their series about zero, which ends below rounding for angles up to a quarter turn."""

PX, PY, PZ, NX, NY, NZ, EX, EZ, FX, FY, FZ, ROLL, PSI, X, Y, Z, XR, YR, ZR, XP, YP, ZP = range(
    0, 22 * LANES, LANES
)
"""Where the numbers of all lanes begin: point and direction of the ray, two directions across it, roll and
psi of a point of the flank, and its frame there: that point and its derivatives with respect to both."""
DA, DB, OFF, TX, TY, TZ, LENGTH, FACING, TO_ROLL, TO_PSI, NUMBERS = range(22 * LANES, 33 * LANES, LANES)
"""Newton's step from there, the distance from the ray, where the step leads from the ray's point, how far
that is along the ray, and the cosine of the ray with the flank's normal; roll and psi to go on from."""
RAY, NEXT, LAST, STEPS, WARM, COUNTS = range(0, 6 * LANES, LANES)
"""The same of whole numbers: the ray, -1 for none, the range of those to come, steps taken, and whether the
ray before met the flank."""


def lanes() -> tuple[Array, Integers]:
    """Room for what `cut_flanks` keeps of its lanes."""
    return np.zeros(NUMBERS), np.zeros(COUNTS, np.int64)


@inlined
def cut_flanks(
    blank: Blank,
    position: Array,
    normal: Array,
    live: Integers,
    search_radius: float,
    of_lanes: Array,
    counts: Integers,
    gap: Array,
    u: Array,
    v: Array,
    continued: Array,
    radius: Array,
    known: Mask,
) -> None:
    """Cut those of rays (n, 3), points and unit directions, that `live` numbers; write gap, roll, psi, the
    distance to the flank continued beyond its edges, and the gear radius, (n,) each, where there are any.

    known: marked for those rays (n,) that Newton's method found to hit or to miss.
    """
    for k in range(LANES):
        counts[RAY + k], of_lanes[NX + k], of_lanes[NZ + k] = -1, 1.0, 0.0
        of_lanes[TO_ROLL + k], of_lanes[TO_PSI + k] = ANYWHERE, ANYWHERE
    together, begun, left = min(NEIGHBOURS, -(-live.size // LANES)), 0, live.size
    while left > 0:
        for k in range(LANES):
            if counts[RAY + k] < 0 and counts[NEXT + k] == counts[LAST + k] and begun < live.size:
                counts[NEXT + k], counts[LAST + k] = begun, min(begun + together, live.size)
                begun, counts[WARM + k] = counts[LAST + k], 0
            if counts[RAY + k] < 0 and counts[NEXT + k] < counts[LAST + k]:
                ray = live[counts[NEXT + k]]
                counts[RAY + k], counts[NEXT + k] = ray, counts[NEXT + k] + 1
                of_lanes[PX + k], of_lanes[NX + k] = position[ray, 0], normal[ray, 0]
                of_lanes[PY + k], of_lanes[NY + k] = position[ray, 1], normal[ray, 1]
                of_lanes[PZ + k], of_lanes[NZ + k] = position[ray, 2], normal[ray, 2]
        _step_from_last(of_lanes)
        for k in range(LANES):
            if counts[RAY + k] >= 0 and counts[STEPS + k] == 0:
                if counts[WARM + k] and abs(of_lanes[DA + k]) + abs(of_lanes[DB + k]) < NEAR:
                    of_lanes[TO_ROLL + k] = of_lanes[ROLL + k] - of_lanes[DA + k]
                    of_lanes[TO_PSI + k] = of_lanes[PSI + k] - of_lanes[DB + k]
                else:
                    counts[WARM + k] = 0
                    _start(blank, of_lanes, k)
        going, longest = LANES, 0
        while going > LATE and longest < NEWTON_STEPS:
            _newton_steps(blank, of_lanes)
            going = 0
            for k in range(LANES):
                counts[STEPS + k] += 1
                longest = max(longest, counts[STEPS + k])
                going += counts[RAY + k] >= 0 and _on_the_way(of_lanes, k, search_radius)
        for k in range(LANES):
            ray = counts[RAY + k]
            if ray < 0:
                counts[STEPS + k] = 0
            elif counts[STEPS + k] >= NEWTON_STEPS or not _on_the_way(of_lanes, k, search_radius):
                length = of_lanes[LENGTH + k]
                roll, psi = of_lanes[ROLL + k] - of_lanes[DA + k], of_lanes[PSI + k] - of_lanes[DB + k]
                turn = blank.ratio * (psi - roll - blank.space)
                met = of_lanes[OFF + k] < NEGLIGIBLE and max(abs(psi), abs(turn)) < 0.5 * pi
                hit = met and of_lanes[FACING + k] < 0 and abs(length) < search_radius
                if hit:
                    continued[ray] = length
                    x, y = of_lanes[TX + k] + of_lanes[PX + k], of_lanes[TY + k] + of_lanes[PY + k]
                    z = of_lanes[TZ + k] + of_lanes[PZ + k]
                    out = sqrt(x * x + y * y)
                    inside = blank.inner <= out <= blank.outer and roll <= blank.tip_roll
                    if inside and z <= blank.tip_plane + 1e-12:
                        gap[ray], u[ray], v[ray], radius[ray] = length, roll, psi, out
                else:
                    of_lanes[TO_ROLL + k], of_lanes[TO_PSI + k] = ANYWHERE, ANYWHERE
                if hit or not counts[WARM + k]:
                    far = of_lanes[OFF + k] < SEEN and abs(length) > search_radius + SEEN
                    known[ray] = met or far
                    counts[RAY + k], left = -1, left - 1
                counts[WARM + k], counts[STEPS + k] = hit, 0


@inlined
def _step_from_last(of_lanes: Array) -> None:
    """Both directions across the rays, and the first steps from the frames that the rays before have met."""
    for k in range(LANES):
        beside = across((of_lanes[NX + k], of_lanes[NY + k], of_lanes[NZ + k]))
        of_lanes[EX + k], of_lanes[EZ + k] = beside[0], beside[1]
        of_lanes[FX + k], of_lanes[FY + k], of_lanes[FZ + k] = beside[2], beside[3], beside[4]
        frame = (
            *(of_lanes[X + k], of_lanes[Y + k], of_lanes[Z + k]),
            *(of_lanes[XR + k], of_lanes[YR + k], of_lanes[ZR + k]),
            *(of_lanes[XP + k], of_lanes[YP + k], of_lanes[ZP + k]),
        )
        p = of_lanes[PX + k], of_lanes[PY + k], of_lanes[PZ + k]
        of_lanes[DA + k], of_lanes[DB + k], _, _, _, _ = step(p, beside, frame)


@inlined
def _start(blank: Blank, of_lanes: Array, k: int) -> None:
    """Of a lane at the flank's point of the generating section that its ray's point lies in."""
    x, y, z = of_lanes[PX + k], of_lanes[PY + k], of_lanes[PZ + k]
    cosine = blank.base / (blank.ratio * min(max(sqrt(x * x + y * y), blank.inner), blank.outer))
    sine = sqrt(max(1 - cosine * cosine, 1e-12))
    roll = ((blank.lift - z) / blank.base - cosine) / sine
    of_lanes[TO_ROLL + k] = min(max(roll, 0.0), 1.2 * blank.tip_roll)
    of_lanes[TO_PSI + k] = atan2(sine, cosine)


@inlined
def _newton_steps(blank: Blank, of_lanes: Array) -> None:
    """Frames of the flank where all lanes go on, and Newton's steps from there, no longer than allowed."""
    for k in range(LANES):
        roll, psi = of_lanes[TO_ROLL + k], of_lanes[TO_PSI + k]
        turn = blank.ratio * (psi - roll - blank.space)
        ct, st, cp, sp = _cosine(turn), _sine(turn), _cosine(psi), _sine(psi)
        frame = turned_flank_frame(blank.base, blank.ratio, blank.lift, roll, ct, st, cp, sp)
        of_lanes[X + k], of_lanes[Y + k], of_lanes[Z + k] = frame[0], frame[1], frame[2]
        of_lanes[XR + k], of_lanes[YR + k], of_lanes[ZR + k] = frame[3], frame[4], frame[5]
        of_lanes[XP + k], of_lanes[YP + k], of_lanes[ZP + k] = frame[6], frame[7], frame[8]
        p = of_lanes[PX + k], of_lanes[PY + k], of_lanes[PZ + k]
        n = of_lanes[NX + k], of_lanes[NY + k], of_lanes[NZ + k]
        beside = (
            *(of_lanes[EX + k], of_lanes[EZ + k]),
            *(of_lanes[FX + k], of_lanes[FY + k], of_lanes[FZ + k]),
        )
        da, db, off, x, y, z = step(p, beside, frame)
        scale = min(1.0, LARGEST_STEP / max(abs(da), abs(db), LARGEST_STEP))
        of_lanes[ROLL + k], of_lanes[TO_ROLL + k] = roll, roll - scale * da
        of_lanes[PSI + k], of_lanes[TO_PSI + k] = psi, psi - scale * db
        of_lanes[DA + k], of_lanes[DB + k], of_lanes[OFF + k] = da, db, off
        of_lanes[TX + k], of_lanes[TY + k], of_lanes[TZ + k] = x, y, z
        of_lanes[LENGTH + k] = x * n[0] + y * n[1] + z * n[2]
        of_lanes[FACING + k] = cp * (n[0] * ct + n[1] * st) + n[2] * sp


@inlined
def _on_the_way(of_lanes: Array, k: int, search_radius: float) -> bool:
    """Whether a lane's ray neither is met nor seen to miss, and can go on."""
    off, far = of_lanes[OFF + k], abs(of_lanes[LENGTH + k]) > search_radius + SEEN
    met = off < NEGLIGIBLE or (off < SEEN and far)
    return not met and abs(of_lanes[DA + k]) + abs(of_lanes[DB + k]) < inf


@inlined
def _sine(angle: float) -> float:
    return angle * _series(angle * angle, *SINE)


@inlined
def _cosine(angle: float) -> float:
    return _series(angle * angle, *COSINE)


@inlined
def _series(
    x: float,
    a: float,
    b: float,
    c: float,
    d: float,
    e: float,
    f: float,
    g: float,
    h: float,
    i: float,
    j: float,
    k: float,
) -> float:
    low = c + x * (d + x * (e + x * (f + x * (g + x * (h + x * (i + x * (j + x * k)))))))
    return a + x * (b + x * low)
