"""Compiled: where all bodies stand when every flank, bearing and torque is in balance, position by position.

The energy of one-sided flanks, bearings (with a ring of play or without) and torques is convex and, but for
the rings, quadratic between changes of contact: a semismooth Newton method, each step an active set with its
equations solved, with an exact line search that makes it global. Pinions touch each other through the gears
only, so each is eliminated by itself (3 x 3) and the gears remain (4 or 6 unknowns each).
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
TIE, FIRST_TIE = 1e-10, 1e-1
"""Springs to ground in the matrix only (over the stiffest contact), which give free bodies a next place."""
MOST_STEPS = 200

_compiled = njit(cache=True, nogil=True, fastmath={"contract"})


class Springs(NamedTuple):
    """F flanks, P pinions, n unknowns: x, y, turn of every pinion, then w of every gear; all are lengths.

    jacobian (F, 3 + w) by the unknowns of its pinion and its gear, which start at pinion and gear (F,);
    pinion_bearing (P, 3): xx, xy, yy; clearance (P,), where positive with xx = yy and xy = 0; gear_bearing
    (n - 3 P,); applied (n,) forces. N, m.
    """

    jacobian: Array
    pinion: NDArray[np.int64]
    gear: NDArray[np.int64]
    pinion_bearing: Array
    clearance: Array
    gear_bearing: Array
    applied: Array


@_compiled
def settle_all(
    springs: Springs, stiffness: Array, gap: Array, tolerance: float, place: Array
) -> tuple[Array, Array, Array]:
    """Places (K, n), flank forces (K, F), largest imbalance over the largest force (K,).

    stiffness, gap (K, F): force = stiffness max(J q - gap, 0). `place` (n,) is where the first search starts;
    each later one starts from the one before. A position that is not solved keeps its residual.
    """
    count, flanks = gap.shape
    n = place.size
    gears = n - 3 * springs.pinion_bearing.shape[0]
    places, forces = np.zeros((count, n)), np.zeros((count, flanks))
    residuals = np.zeros(count)
    over, rate = np.zeros(flanks), np.zeros(flanks)
    gradient, step = np.zeros(n), np.zeros(n)
    blocks = np.zeros((springs.pinion_bearing.shape[0], 3, 4 + gears))
    core = np.zeros((gears, gears + 1))
    for k in range(count):
        stiffest = stiffness[k].max()
        tie = FIRST_TIE if k == 0 else TIE
        for _ in range(MOST_STEPS):
            _penetrate(springs, gap[k], place, over)
            size = _balance(springs, stiffness[k], over, place, gradient)
            worst = np.abs(gradient).max()
            residuals[k] = worst / size if size > 0.0 else 0.0
            if worst <= tolerance * size:
                break
            _newton_step(springs, stiffness[k], over, place, gradient, tie * stiffest, blocks, core, step)
            tie = max(0.1 * tie, TIE)
            _along(springs, step, rate)
            noise = 1e-15 * size * np.abs(step).sum()
            share = _line_minimum(springs, stiffness[k], over, rate, place, step, noise)
            for j in range(n):
                place[j] += share * step[j]
        for f in range(flanks):
            forces[k, f] = stiffness[k, f] * max(over[f], 0.0)
        places[k] = place
    return places, forces, residuals


@_compiled
def _penetrate(springs: Springs, gap: Array, place: Array, over: Array) -> None:
    _along(springs, place, over)
    for f in range(gap.size):
        over[f] -= gap[f]


@_compiled
def _along(springs: Springs, motion: Array, out: Array) -> None:
    """Jacobian times a motion."""
    wide = springs.jacobian.shape[1]
    for f in range(out.size):
        p, g = springs.pinion[f], springs.gear[f] - 3
        total = 0.0
        for j in range(3):
            total += springs.jacobian[f, j] * motion[p + j]
        for j in range(3, wide):
            total += springs.jacobian[f, j] * motion[g + j]
        out[f] = total


@_compiled
def _bearing(springs: Springs, i: int, x: float, y: float) -> tuple[float, float]:
    """Force of pinion i's bearing away from x, y."""
    xx, xy, yy = springs.pinion_bearing[i]
    play = springs.clearance[i]
    if play > 0.0:
        distance = np.hypot(x, y)
        share = xx * (1.0 - play / distance) if distance > play else 0.0
        return share * x, share * y
    return xx * x + xy * y, xy * x + yy * y


@_compiled
def _balance(springs: Springs, stiffness: Array, over: Array, place: Array, gradient: Array) -> float:
    """Forces out of balance into gradient (n,); the largest single force is returned."""
    pinions = springs.pinion_bearing.shape[0]
    first = 3 * pinions
    size = 0.0
    for j in range(gradient.size):
        gradient[j] = -springs.applied[j]
        size = max(size, abs(springs.applied[j]))
    for i in range(pinions):
        x, y = _bearing(springs, i, place[3 * i], place[3 * i + 1])
        gradient[3 * i] += x
        gradient[3 * i + 1] += y
    for j in range(first, gradient.size):
        gradient[j] += springs.gear_bearing[j - first] * place[j]
    for f in range(over.size):
        if over[f] > 0.0:
            force = stiffness[f] * over[f]
            size = max(size, force)
            p, g = springs.pinion[f], springs.gear[f] - 3
            for j in range(3):
                gradient[p + j] += springs.jacobian[f, j] * force
            for j in range(3, springs.jacobian.shape[1]):
                gradient[g + j] += springs.jacobian[f, j] * force
    return size


@_compiled
def _newton_step(
    springs: Springs,
    stiffness: Array,
    over: Array,
    place: Array,
    gradient: Array,
    tie: float,
    blocks: Array,
    core: Array,
    step: Array,
) -> None:
    """Solve (curvature + tie) step = -gradient by block elimination, pinions first.

    blocks (P, 3, 4 + gears) holds each pinion's 3 x 3, its coupling to the gears and its right side.
    """
    _curvature(springs, stiffness, over, place, gradient, tie, blocks, core)
    gears = core.shape[0]
    wide = blocks.shape[2]
    for i in range(blocks.shape[0]):
        block = blocks[i]
        _eliminate(block)
        for r in range(3):
            for a in range(gears):
                factor = block[r, 3 + a]
                if factor != 0.0:
                    for b in range(a, gears):
                        core[a, b] -= factor * block[r, 3 + b]
                    core[a, gears] -= factor * block[r, wide - 1]
    first = step.size - gears
    _solve_core(core, step[first:])
    for i in range(blocks.shape[0]):
        for r in range(2, -1, -1):
            total = blocks[i, r, wide - 1]
            for b in range(gears):
                total -= blocks[i, r, 3 + b] * step[first + b]
            for c in range(r + 1, 3):
                total -= blocks[i, r, c] * step[3 * i + c]
            step[3 * i + r] = total / blocks[i, r, r]


@_compiled
def _curvature(
    springs: Springs,
    stiffness: Array,
    over: Array,
    place: Array,
    gradient: Array,
    tie: float,
    blocks: Array,
    core: Array,
) -> None:
    """Second derivatives of the energy and the right side, upper triangles only."""
    pinions, gears = blocks.shape[0], core.shape[0]
    first, wide = 3 * pinions, blocks.shape[2]
    blocks[:] = 0.0
    core[:] = 0.0
    for i in range(pinions):
        block = blocks[i]
        xx, xy, yy = springs.pinion_bearing[i]
        play = springs.clearance[i]
        if play > 0.0:
            x, y = place[3 * i], place[3 * i + 1]
            distance = np.hypot(x, y)
            turned = xx * (1.0 - play / distance) if distance > play else 0.0
            ahead = (xx - turned) / distance**2 if distance > play else 0.0
            xx, xy, yy = turned + ahead * x * x, ahead * x * y, turned + ahead * y * y
        block[0, 0], block[0, 1], block[1, 1], block[2, 2] = xx + tie, xy, yy + tie, tie
        for r in range(3):
            block[r, wide - 1] = -gradient[3 * i + r]
    for a in range(gears):
        core[a, a] = springs.gear_bearing[a] + tie
        core[a, gears] = -gradient[first + a]
    for f in range(over.size):
        if over[f] > 0.0:
            i, g = springs.pinion[f] // 3, springs.gear[f] - first - 3
            for r in range(3):
                factor = stiffness[f] * springs.jacobian[f, r]
                for c in range(r, 3):
                    blocks[i, r, c] += factor * springs.jacobian[f, c]
                for b in range(3, springs.jacobian.shape[1]):
                    blocks[i, r, g + 3 + b] += factor * springs.jacobian[f, b]
            for a in range(3, springs.jacobian.shape[1]):
                factor = stiffness[f] * springs.jacobian[f, a]
                for b in range(a, springs.jacobian.shape[1]):
                    core[g + a, g + b] += factor * springs.jacobian[f, b]


@_compiled
def _eliminate(block: Array) -> None:
    """Cholesky factor of the leading 3 x 3 (upper triangle), applied to the columns right of it."""
    for r in range(3):
        root = np.sqrt(block[r, r])
        for c in range(r, block.shape[1]):
            block[r, c] /= root
        for below in range(r + 1, 3):
            factor = block[r, below]
            for c in range(below, block.shape[1]):
                block[below, c] -= factor * block[r, c]


@_compiled
def _solve_core(core: Array, out: Array) -> None:
    """Solve the gears' symmetric equations, upper triangle and right side in core (g, g + 1)."""
    size = core.shape[0]
    for r in range(size):
        for below in range(r + 1, size):
            factor = core[r, below] / core[r, r]
            for c in range(below, size + 1):
                core[below, c] -= factor * core[r, c]
    for r in range(size - 1, -1, -1):
        total = core[r, size]
        for c in range(r + 1, size):
            total -= core[r, c] * out[c]
        out[r] = total / core[r, r]


@_compiled
def _slope(
    springs: Springs, stiffness: Array, over: Array, rate: Array, place: Array, step: Array, share: float
) -> tuple[float, float]:
    """First and second derivative of the energy along the step."""
    pinions = springs.pinion_bearing.shape[0]
    first = 3 * pinions
    slope, curvature = 0.0, 0.0
    for j in range(step.size):
        slope -= springs.applied[j] * step[j]
    for i in range(pinions):
        dx, dy = step[3 * i], step[3 * i + 1]
        x, y = place[3 * i] + share * dx, place[3 * i + 1] + share * dy
        along_x, along_y = _bearing(springs, i, x, y)
        slope += along_x * dx + along_y * dy
        xx, xy, yy = springs.pinion_bearing[i]
        if springs.clearance[i] == 0.0:
            curvature += xx * dx * dx + 2.0 * xy * dx * dy + yy * dy * dy
        elif along_x != 0.0 or along_y != 0.0:
            ahead, square = (x * dx + y * dy), x * x + y * y
            turned = 1.0 - springs.clearance[i] / np.sqrt(square)
            curvature += xx * (turned * (dx * dx + dy * dy) + (1.0 - turned) * ahead * ahead / square)
    for j in range(first, step.size):
        stiff = springs.gear_bearing[j - first] * step[j]
        slope += stiff * (place[j] + share * step[j])
        curvature += stiff * step[j]
    for f in range(over.size):
        depth = over[f] + share * rate[f]
        if depth > 0.0:
            slope += stiffness[f] * depth * rate[f]
            curvature += stiffness[f] * rate[f] * rate[f]
    return slope, curvature


@_compiled
def _line_minimum(
    springs: Springs,
    stiffness: Array,
    over: Array,
    rate: Array,
    place: Array,
    step: Array,
    noise: float,
) -> float:
    """Where the energy is least along the step: 1 as long as no contact changes."""
    start, _ = _slope(springs, stiffness, over, rate, place, step, 0.0)
    slope, curvature = _slope(springs, stiffness, over, rate, place, step, 1.0)
    close = 1e-9 * abs(start) + noise
    if start >= 0.0 or abs(slope) <= close:
        return 1.0
    low, high, share = 0.0, 1.0, 1.0
    while slope < 0.0 and high < 1e30:
        low, high = high, 2.0 * high
        share = high
        slope, curvature = _slope(springs, stiffness, over, rate, place, step, share)
    for _ in range(200):
        if abs(slope) <= close or high - low <= 1e-15 * high:
            break
        share = share - slope / curvature if curvature > 0.0 else low
        if not low < share < high:
            share = 0.5 * (low + high)
        slope, curvature = _slope(springs, stiffness, over, rate, place, step, share)
        if slope < 0.0:
            low = share
        else:
            high = share
    return share
