"""The active set of a contact problem, compiled: see `facegear.contact.solver` for the problem itself."""

import numpy as np

from facegear.arrays import AnyArray, Array, Integers, Mask
from facegear.machine_code.compiler import compiler, for_callers

compiled = compiler()
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
    result = np.empty(matrix.shape[0])
    for i in range(matrix.shape[0]):
        total = 0.0
        for j in range(matrix.shape[1]):
            total += matrix[i, j] * vector[j]
        result[i] = total
    return result


@for_callers()
def _put(values: Array, index: Integers, out: Array) -> None:
    """out[index] = values, which numba would compile with its check of shapes, for two seconds."""
    for i in range(index.size):
        out[index[i]] = values[i]


@compiled
def distances(compliance: Array, gap: Array, lever_arm: Array, force: Array, rotation: float) -> Array:
    """Distance (n,) m of all points by forces (n,) N, of which most are zero, and a rotation (rad)."""
    result = gap - rotation * lever_arm
    for j in range(force.size):
        if force[j] != 0.0:
            pushed = force[j]
            for i in range(result.size):
                result[i] += pushed * compliance[j, i]
    return result


@compiled
def bonded(compliance: Array, gap: Array, lever_arm: Array, torque: float, active: Mask) -> Bonded:
    """What happens if exactly the points `active` (n,) touch."""
    index = np.flatnonzero(active)
    size = index.size
    block = np.empty((size, size))
    turning, closing = np.empty(size), np.empty(size)
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
    force: Array = rotation * turning - closing
    return index.astype(np.int64), block, factor, turning, force, rotation, 1.0 / stiffness


@compiled
def violation(
    compliance: Array, gap: Array, lever_arm: Array, torque: float, force: Array, rotation: float
) -> float:
    """Largest relative violation of balance, no tension, no penetration and complementarity."""
    distance = distances(compliance, gap, lever_arm, force, rotation)
    turned = nearest = touching = balance = 0.0
    for i in range(gap.size):
        turned = max(turned, abs(rotation * lever_arm[i]))
        balance += lever_arm[i] * force[i]
        if force[i] != 0.0:
            nearest = max(nearest, abs(gap[i]))
            touching = max(touching, abs(distance[i]))
    scale = turned + nearest
    worst = max(abs(balance - torque) / torque, -force.min() / force.max())
    return max(worst, -distance.min() / scale, touching / scale)


@compiled
def refined(
    compliance: Array, gap: Array, lever_arm: Array, torque: float, touching: Bonded
) -> tuple[Array, float, float]:
    """Forces (n,), rotation and violation after two steps of iterative refinement."""
    index, block, factor, turning, force, rotation, _ = touching
    arm, apart = lever_arm[index], gap[index]
    force, unused = force.copy(), np.zeros(index.size)
    for _ in range(2):
        change = _times(block, force) + apart - rotation * arm
        missing = torque
        for i in range(index.size):
            missing -= arm[i] * force[i]
        _substituted(factor, change, unused)
        carried = stiffness = 0.0
        for i in range(index.size):
            carried += arm[i] * change[i]
            stiffness += arm[i] * turning[i]
        turn = (missing + carried) / stiffness
        force += turn * turning - change
        rotation += turn
    whole = np.zeros(gap.size)
    _put(force, index, whole)
    return whole, rotation, violation(compliance, gap, lever_arm, torque, whole, rotation)


@compiled
def newton(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    start: Mask,
    limits: tuple[int, float],
) -> tuple[int, Array, float, float, float]:
    """Primal-dual active set from the points `start` (n,), in at most `limits` steps to a tolerance.

    Returns steps, forces (n,), rotation, slope and violation. Where the sets repeat themselves, steps are 0
    and the forces those of the last set, with tension in them.
    """
    steps, tolerance = limits
    active, count = start.copy(), gap.size
    seen = np.zeros((steps, count), np.bool_)
    force = np.zeros(count)
    for step in range(1, steps + 1):
        touching = bonded(compliance, gap, lever_arm, torque, active)
        rotation = touching[5]
        force[:] = 0.0
        _put(touching[4], touching[0], force)
        distance = distances(compliance, gap, lever_arm, force, rotation)
        turned = nearest = 0.0
        for i in range(count):
            turned = max(turned, abs(rotation * lever_arm[i]))
            if active[i]:
                nearest = max(nearest, abs(gap[i]))
        edge = -tolerance * (turned + nearest)
        following, same, drives = seen[step - 1], True, False
        for i in range(count):
            following[i] = force[i] > 0.0 if active[i] else distance[i] < edge
            same &= following[i] == active[i]
            drives |= following[i] and lever_arm[i] > 0.0
        if same:
            force, rotation, residual = refined(compliance, gap, lever_arm, torque, touching)
            return step, force, rotation, touching[6], residual
        repeated = False
        for earlier in range(step - 1):
            repeated |= np.array_equal(seen[earlier], following)
        if repeated or not drives:
            break
        for i in range(count):
            active[i] = following[i]
    return 0, force, 0.0, 0.0, 0.0


@compiled
def solved(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    start: Mask,
    limits: tuple[int, float],
) -> tuple[int, Array, float, float, float]:
    """`newton` and, where that fails, an exchange of one point at a time; steps are 0 if both fail."""
    begin = start
    if not _drives(start, lever_arm):
        begin = _first_guess(gap, lever_arm)
    solution = newton(compliance, gap, lever_arm, torque, begin, limits)
    if solution[0]:
        return solution
    pressing = feasible(gap, lever_arm, torque, solution[1])
    return _exchanged(compliance, gap, lever_arm, torque, pressing, limits)


@for_callers()
def _drives(active: Mask, lever_arm: Array) -> bool:
    drives = False
    for i in range(active.size):
        drives |= active[i] and lever_arm[i] > 0.0
    return drives


@for_callers()
def _turns(gap: Array, lever_arm: Array) -> Array:
    """Turns (n,) that close the gaps, inf where none does."""
    turns = np.full(gap.size, np.inf)
    for i in range(gap.size):
        if lever_arm[i] > 0.0:
            turns[i] = gap[i] / lever_arm[i]
    return turns


@for_callers()
def _first_guess(gap: Array, lever_arm: Array) -> Mask:
    """The quarter of the points whose gaps close first."""
    turns = _turns(gap, lever_arm)
    rising = np.sort(turns)
    last = 0
    for i in range(rising.size):
        last += rising[i] < np.inf
    return turns <= rising[(last - 1) // 4]


@compiled
def feasible(gap: Array, lever_arm: Array, torque: float, force: Array) -> Array:
    """Forces without tension that carry the torque: those given, or one where the gap closes first."""
    pressing = np.maximum(force, 0.0)
    carried = (lever_arm * pressing).sum()
    if carried > 0.0:
        return pressing * (torque / carried)
    first = int(np.argmin(_turns(gap, lever_arm)))
    alone = np.zeros(gap.size)
    alone[first] = torque / lever_arm[first]
    return alone


@compiled
def _exchanged(
    compliance: Array,
    gap: Array,
    lever_arm: Array,
    torque: float,
    start: Array,
    limits: tuple[int, float],
) -> tuple[int, Array, float, float, float]:
    """One point at a time from feasible forces, energy falling at every step, hence finite. As `newton`."""
    force, active = start.copy(), start > 0.0
    for step in range(exchanges(gap.size)):
        touching = bonded(compliance, gap, lever_arm, torque, active)
        index, rotation = touching[0], touching[5]
        target = np.zeros(gap.size)
        _put(touching[4], index, target)
        fraction = np.inf
        for i in index:
            if target[i] <= 0.0:
                fraction = min(fraction, force[i] / (force[i] - target[i]))
        if fraction < np.inf:
            force += fraction * (target - force)
            for i in index:
                if target[i] <= 0.0 and force[i] <= 1e-14 * force.max():
                    active[i] = False
            continue
        force = target
        distance = distances(compliance, gap, lever_arm, force, rotation)
        turned = nearest = 0.0
        worst = -1
        for i in range(gap.size):
            turned = max(turned, abs(rotation * lever_arm[i]))
            if active[i]:
                nearest = max(nearest, abs(gap[i]))
            elif worst < 0 or distance[i] < distance[worst]:
                worst = i
        if worst < 0 or distance[worst] >= -limits[1] * (turned + nearest):
            force, rotation, residual = refined(compliance, gap, lever_arm, torque, touching)
            return limits[0] + step, force, rotation, touching[6], residual
        active[worst] = True
    return 0, force, 0.0, 0.0, 0.0


@for_callers()
def exchanges(count: int) -> int:
    """Exchanges of single points after which many points count as not solved."""
    return 20 * count + 100
