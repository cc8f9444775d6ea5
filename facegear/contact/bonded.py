"""What happens if given points of a contact touch, compiled, and how far that is from a solution."""

import numpy as np

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import empty_numbers, empty_table, marked, numbers, taken

compiled = compiler(*picked.SOURCES)
inlined_sums = for_callers(fastmath={"contract", "reassoc"})
"""For sums of products, whose terms may be added in any order."""

Bonded = tuple[Integers, Array, AnyArray, Array, Array, float, float]
"""What happens if exactly some points touch: their indices (k,), their compliance (k, k) and its Cholesky
factor, their forces by a unit turn (k,), N/rad, their forces (k,), N, the rotation (rad) and its slope over
the torque."""


@inlined_sums
def _substituted(lower: Array, first: Array, second: Array) -> None:
    """Solve for two right-hand sides in place by a lower Cholesky factor in columns."""
    size = first.size
    for j in range(size):
        first[j] /= lower[j, j]
        second[j] /= lower[j, j]
        a, b = first[j], second[j]
        for i in range(j + 1, size):
            first[i] -= lower[i, j] * a
            second[i] -= lower[i, j] * b
    for j in range(size - 1, -1, -1):
        a = b = 0.0
        for i in range(j + 1, size):
            a += lower[i, j] * first[i]
            b += lower[i, j] * second[i]
        first[j] = (first[j] - a) / lower[j, j]
        second[j] = (second[j] - b) / lower[j, j]


@inlined_sums
def _times(matrix: Array, vector: Array) -> Array:
    """A matrix times a vector."""
    result = empty_numbers(matrix.shape[0])
    for i in range(matrix.shape[0]):
        total = 0.0
        for j in range(matrix.shape[1]):
            total += matrix[i, j] * vector[j]
        result[i] = total
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
    size = index.size
    block = empty_table(size, size)
    turning, closing = empty_numbers(size), empty_numbers(size)
    for i in range(size):
        turning[i], closing[i] = lever_arm[index[i]], gap[index[i]]
        for j in range(size):
            block[i, j] = compliance[index[i], index[j]]
    factor = np.linalg.cholesky(block)
    _substituted(factor, turning, closing)
    stiffness = carried = 0.0
    for i in range(size):
        stiffness += lever_arm[index[i]] * turning[i]
        carried += lever_arm[index[i]] * closing[i]
    rotation = (torque + carried) / stiffness
    force = closing
    for i in range(size):
        force[i] = rotation * turning[i] - closing[i]
    return index, block, factor, turning, force, rotation, 1.0 / stiffness


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
    index, block, factor, turning, force, rotation, _ = touching
    arm, apart = taken(lever_arm, index), taken(gap, index)
    force, unused = force.copy(), numbers(index.size, 0.0)
    for _ in range(2):
        change, missing = _times(block, force), torque
        for i in range(index.size):
            change[i] = change[i] + apart[i] - rotation * arm[i]
            missing -= arm[i] * force[i]
        _substituted(factor, change, unused)
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
