"""Compiled: derivatives of the energy of one-sided flanks, bearings (with clearance or without) and torques.

Pinions touch each other through the other unknowns only, which the second derivatives keep to: a block for
each pinion and one, the core, for the gears and all else.
"""

from typing import Any, NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine_code.compiler import for_callers
from facegear.mesh_law.law import Held
from facegear.mesh_law.terms import held_force

OPTIONS: dict[str, Any] = {"nogil": True, "fastmath": {"contract"}}
inlined = for_callers(**OPTIONS)


class Springs(NamedTuple):
    """F flanks, P pinions, n unknowns: x, y, turn of every pinion, then w of every gear; all are lengths.

    jacobian (F, 3 + w) by the unknowns of its pinion and its gear, which start at pinion and gear (F,);
    pinion_bearing (P, 3): xx, xy, yy; clearance (P,), where positive with xx = yy and xy = 0. core: entries
    of the symmetric stiffness among the other n - 3 P unknowns, row (E,) <= column (E,), counted from the
    first of them, value (E,). applied (n,) forces. N, m.
    """

    jacobian: Array
    pinion: Integers
    gear: Integers
    pinion_bearing: Array
    clearance: Array
    core_row: Integers
    core_column: Integers
    core_value: Array
    applied: Array


@inlined
def penetrate(springs: Springs, gap: Array, displacement: Array, over: Array) -> None:
    """How far each flank is pressed in, negative where it is open; (F,)."""
    along(springs, displacement, over)
    for f in range(gap.size):
        over[f] -= gap[f]


@inlined
def along(springs: Springs, motion: Array, out: Array) -> None:
    """Jacobian times a motion."""
    width = springs.jacobian.shape[1]
    for f in range(out.size):
        p, g = springs.pinion[f], springs.gear[f] - 3
        total = 0.0
        for j in range(3):
            total += springs.jacobian[f, j] * motion[p + j]
        for j in range(3, width):
            total += springs.jacobian[f, j] * motion[g + j]
        out[f] = total


@inlined
def _bearing(springs: Springs, i: int, x: float, y: float) -> tuple[float, float]:
    """Force of pinion i's bearing away from x, y."""
    xx, xy, yy = springs.pinion_bearing[i]
    clearance = springs.clearance[i]
    if clearance > 0.0:
        distance = np.hypot(x, y)
        factor = xx * (1.0 - clearance / distance) if distance > clearance else 0.0
        return factor * x, factor * y
    return xx * x + xy * y, xy * x + yy * y


@inlined
def balance(
    springs: Springs, held: Held, position: int, over: Array, displacement: Array, gradient: Array
) -> float:
    """Forces out of balance into gradient (n,) at a position of the law; the largest single force is
    returned.
    """
    pinions = springs.pinion_bearing.shape[0]
    first = 3 * pinions
    size = 0.0
    for j in range(gradient.size):
        gradient[j] = -springs.applied[j]
        size = max(size, abs(springs.applied[j]))
    for i in range(pinions):
        x, y = _bearing(springs, i, displacement[3 * i], displacement[3 * i + 1])
        gradient[3 * i] += x
        gradient[3 * i + 1] += y
    for e in range(springs.core_value.size):
        x, y = first + springs.core_row[e], first + springs.core_column[e]
        gradient[x] += springs.core_value[e] * displacement[y]
        if x != y:
            gradient[y] += springs.core_value[e] * displacement[x]
    for f in range(over.size):
        if over[f] > 0.0:
            force, _ = held_force(held, position, f, over[f])
            size = max(size, force)
            p, g = springs.pinion[f], springs.gear[f] - 3
            for j in range(3):
                gradient[p + j] += springs.jacobian[f, j] * force
            for j in range(3, springs.jacobian.shape[1]):
                gradient[g + j] += springs.jacobian[f, j] * force
    return size


@inlined
def assemble(
    springs: Springs,
    held: Held,
    position: int,
    over: Array,
    closed: Array,
    displacement: Array,
    gradient: Array,
    tie: float,
    blocks: Array,
    core: Array,
) -> None:
    """Second derivatives of the energy and the right side, upper triangles only; closed (F,) 1 or 0."""
    pinions, gears = blocks.shape[0], core.shape[0]
    first, width = 3 * pinions, blocks.shape[2]
    blocks[:] = 0.0
    core[:] = 0.0
    for i in range(pinions):
        block = blocks[i]
        xx, xy, yy = springs.pinion_bearing[i]
        clearance = springs.clearance[i]
        if clearance > 0.0:
            x, y = displacement[3 * i], displacement[3 * i + 1]
            distance = np.hypot(x, y)
            turned = xx * (1.0 - clearance / distance) if distance > clearance else 0.0
            ahead = (xx - turned) / distance**2 if distance > clearance else 0.0
            xx, xy, yy = turned + ahead * x * x, ahead * x * y, turned + ahead * y * y
        block[0, 0], block[0, 1], block[1, 1], block[2, 2] = xx + tie, xy, yy + tie, tie
        for r in range(3):
            block[r, width - 1] = -gradient[3 * i + r]
    for a in range(gears):
        core[a, a] = tie
        core[a, gears] = -gradient[first + a]
    for e in range(springs.core_value.size):
        core[springs.core_row[e], springs.core_column[e]] += springs.core_value[e]
    for f in range(closed.size):
        if closed[f] > 0.0:
            _, stiffness = held_force(held, position, f, max(over[f], 0.0))
            i, g = springs.pinion[f] // 3, springs.gear[f] - first - 3
            for r in range(3):
                factor = stiffness * springs.jacobian[f, r]
                for c in range(r, 3):
                    blocks[i, r, c] += factor * springs.jacobian[f, c]
                for b in range(3, springs.jacobian.shape[1]):
                    blocks[i, r, g + 3 + b] += factor * springs.jacobian[f, b]
            for a in range(3, springs.jacobian.shape[1]):
                factor = stiffness * springs.jacobian[f, a]
                for b in range(a, springs.jacobian.shape[1]):
                    core[g + a, g + b] += factor * springs.jacobian[f, b]


@inlined
def slope_along(
    springs: Springs,
    held: Held,
    position: int,
    over: Array,
    rate: Array,
    displacement: Array,
    step: Array,
    fraction: float,
) -> tuple[float, float]:
    """First and second derivative of the energy along the step."""
    pinions = springs.pinion_bearing.shape[0]
    first = 3 * pinions
    slope, curvature = 0.0, 0.0
    for j in range(step.size):
        slope -= springs.applied[j] * step[j]
    for i in range(pinions):
        dx, dy = step[3 * i], step[3 * i + 1]
        x, y = displacement[3 * i] + fraction * dx, displacement[3 * i + 1] + fraction * dy
        along_x, along_y = _bearing(springs, i, x, y)
        slope += along_x * dx + along_y * dy
        xx, xy, yy = springs.pinion_bearing[i]
        if springs.clearance[i] == 0.0:
            curvature += xx * dx * dx + 2.0 * xy * dx * dy + yy * dy * dy
        elif along_x != 0.0 or along_y != 0.0:
            ahead, square = (x * dx + y * dy), x * x + y * y
            turned = 1.0 - springs.clearance[i] / np.sqrt(square)
            curvature += xx * (turned * (dx * dx + dy * dy) + (1.0 - turned) * ahead * ahead / square)
    for e in range(springs.core_value.size):
        x, y = first + springs.core_row[e], first + springs.core_column[e]
        stiff = springs.core_value[e] * step[y]
        slope += stiff * (displacement[x] + fraction * step[x])
        curvature += stiff * step[x]
        if x != y:
            stiff = springs.core_value[e] * step[x]
            slope += stiff * (displacement[y] + fraction * step[y])
            curvature += stiff * step[y]
    for f in range(over.size):
        depth = over[f] + fraction * rate[f]
        if depth > 0.0:
            force, stiffness = held_force(held, position, f, depth)
            slope += force * rate[f]
            curvature += stiffness * rate[f] * rate[f]
    return slope, curvature
