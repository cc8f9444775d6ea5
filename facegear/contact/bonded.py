"""What happens if given points of a contact touch, compiled, and how far that is from a solution."""

import numpy as np

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import empty_numbers, marked, numbers, table, taken, unsigned

compiled = compiler(*picked.SOURCES)
inlined_sums = for_callers(fastmath={"contract", "reassoc"})
"""For sums of products, whose terms may be added in any order."""

Bonded = tuple[Integers, Array, AnyArray, Array, Array, float, float]
"""What happens if exactly some points touch: their indices (k,), their compliance (k, k) up to its diagonal,
the columns of its Cholesky factor as rows (k, k), their forces by a unit turn (k,), N/rad, their forces (k,),
N, the rotation (rad) and its slope over the torque."""


@inlined_sums
def _substituted(columns: Array, first: Array, second: Array) -> None:
    """Solve for two right-hand sides in place by a lower Cholesky factor, whose columns are rows here."""
    size = first.size
    end = np.uint64(size)
    for j in range(size):
        column = columns[j]
        first[j] /= column[j]
        second[j] /= column[j]
        a, b = first[j], second[j]
        for i in range(np.uint64(j + 1), end):
            first[i] -= column[i] * a
            second[i] -= column[i] * b
    for j in range(size - 1, -1, -1):
        column = columns[j]
        a = b = 0.0
        for i in range(np.uint64(j + 1), end):
            a += column[i] * first[i]
            b += column[i] * second[i]
        first[j] = (first[j] - a) / column[j]
        second[j] = (second[j] - b) / column[j]


@inlined_sums
def _times(lower: Array, vector: Array) -> Array:
    """A symmetric matrix, of which what is above the diagonal is not looked at, times a vector."""
    result = numbers(vector.size, 0.0)
    for i in range(vector.size):
        row, factor, total = lower[i], vector[i], 0.0
        for j in range(np.uint64(i)):
            total += row[j] * vector[j]
            result[j] += row[j] * factor
        result[i] += total + row[i] * factor
    return result


@for_callers()
def put(values: Array, index: Integers, out: Array) -> None:
    """out[index] = values, which numba would compile with its check of shapes, for two seconds."""
    for i in range(index.size):
        out[index[i]] = values[i]


@compiled
def distances(compliance: Array, gap: Array, lever_arm: Array, force: Array, rotation: float) -> Array:
    """Distance (n,) m of all points by forces (n,) N, of which most are zero, and a rotation (rad)."""
    result = empty_numbers(gap.size)
    for i in range(gap.size):
        result[i] = gap[i] - rotation * lever_arm[i]
    for j in range(force.size):
        if force[j] != 0.0:
            pushed = force[j]
            for i in range(result.size):
                result[i] += pushed * compliance[j, i]
    return result


@compiled
def bonded(compliance: Array, gap: Array, lever_arm: Array, torque: float, active: Mask) -> Bonded:
    """What happens if exactly the points `active` (n,) touch."""
    index = marked(active)
    size, column = index.size, unsigned(index)
    block = table(size, size)
    turning, closing = empty_numbers(size), empty_numbers(size)
    for i in range(size):
        turning[i], closing[i] = lever_arm[index[i]], gap[index[i]]
        row = compliance[index[i]]
        for j in range(i + 1):
            block[i, j] = row[column[j]]
    columns = np.linalg.cholesky(block).T
    _substituted(columns, turning, closing)
    stiffness = carried = 0.0
    for i in range(size):
        stiffness += lever_arm[index[i]] * turning[i]
        carried += lever_arm[index[i]] * closing[i]
    rotation = (torque + carried) / stiffness
    force = closing
    for i in range(size):
        force[i] = rotation * turning[i] - closing[i]
    return index, block, columns, turning, force, rotation, 1.0 / stiffness


@compiled
def violation(
    compliance: Array, gap: Array, lever_arm: Array, torque: float, force: Array, rotation: float
) -> float:
    """Largest relative violation of balance, no tension, no penetration and complementarity."""
    distance = distances(compliance, gap, lever_arm, force, rotation)
    turned = nearest = touching = balance = deepest = 0.0
    pulling, pressing = force[0], force[0]
    for i in range(gap.size):
        turned = max(turned, abs(rotation * lever_arm[i]))
        balance += lever_arm[i] * force[i]
        deepest = max(deepest, -distance[i])
        pulling, pressing = min(pulling, force[i]), max(pressing, force[i])
        if force[i] != 0.0:
            nearest = max(nearest, abs(gap[i]))
            touching = max(touching, abs(distance[i]))
    scale = turned + nearest
    worst = max(abs(balance - torque) / torque, -pulling / pressing)
    return max(worst, deepest / scale, touching / scale)


@compiled
def refined(
    compliance: Array, gap: Array, lever_arm: Array, torque: float, touching: Bonded
) -> tuple[Array, float, float]:
    """Forces (n,), rotation and violation after two steps of iterative refinement."""
    index, block, columns, turning, force, rotation, _ = touching
    arm, apart = taken(lever_arm, index), taken(gap, index)
    force, unused = force.copy(), numbers(index.size, 0.0)
    for _ in range(2):
        change, missing = _times(block, force), torque
        for i in range(index.size):
            change[i] = change[i] + apart[i] - rotation * arm[i]
            missing -= arm[i] * force[i]
        _substituted(columns, change, unused)
        carried = stiffness = 0.0
        for i in range(index.size):
            carried += arm[i] * change[i]
            stiffness += arm[i] * turning[i]
        turn = (missing + carried) / stiffness
        for i in range(index.size):
            force[i] += turn * turning[i] - change[i]
        rotation += turn
    whole = numbers(gap.size, 0.0)
    put(force, index, whole)
    return whole, rotation, violation(compliance, gap, lever_arm, torque, whole, rotation)
