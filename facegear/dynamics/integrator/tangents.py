"""Disturbances of the motion: moved over a step by the same recurrence, with the slopes of the forces.

A single tangent goes coordinate by coordinate, in the vectors that the motion itself uses. Many go in blocks
of ABREAST, side by side along the innermost axis: then every entry of G is read once for all of them, and
those that are zero are left out. Rings, and coordinates that are coupled beside the meshes, go one by one.
"""

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import Packed, Sparse
from facegear.dynamics.integrator.kernel import called, inlined
from facegear.dynamics.integrator.parting import shearing_damping
from facegear.dynamics.integrator.rings import ring_switches
from facegear.dynamics.integrator.taylor import deflect, evaluate, recurrence
from facegear.dynamics.integrator.work import ABREAST, Work
from facegear.machine_code.lanes import LANES, load, multiply, multiply_add, splat, spread, store, take
from facegear.mesh_law.terms import is_curved


@inlined
def switch_tangents(packed: Packed, work: Work, acting: Array, tangents: Array) -> None:
    """Saltation: where the mesh damping starts or stops the velocity part shears by G^T (c- - c+) G.

    The law alone gives none, since its force is continuous at every level (Leine and Nijmeijer 2004). Neither
    do flanks that part where a contact only pushes: their force was zero before.
    """
    ring_switches(packed.rings, packed, work, acting, tangents)
    for m in range(packed.contacts):
        jump = acting[m] - shearing_damping(packed, work, m)
        if jump == 0.0 or (packed.push_only and jump > 0.0):
            continue
        for column in range(tangents.shape[0]):
            along = 0.0
            for k in range(packed.n):
                along += packed.transposed[m, k] * tangents[column, 0, k]
            for k in range(packed.n):
                tangents[column, 1, k] += packed.transposed[m, k] * jump * along


@inlined
def tangent_step(packed: Packed, work: Work, length: float, tolerance: float) -> float:
    """The step, or so much less of it that the last terms of a curved law's slopes turn a disturbance by no
    more than the tolerance. The motion alone says nothing of them where its force is small.
    """
    if is_curved(packed.law):
        for m in range(packed.contacts):
            if work.active[m] == 0.0:
                continue
            for i in range(work.order - 1, work.order + 1):
                size = packed.leverage[m] * abs(work.law.slope[i, m]) / ((i + 1) * (i + 2))
                if size > 0.0:
                    length = min(length, np.exp(np.log(tolerance / size) / (i + 2)))
    return length


@called
def move_tangents(packed: Packed, work: Work, length: float, tangents: Array, tolerance: float) -> None:
    """Move tangents (columns, 2, n) over the step whose polynomials `work` holds."""
    order = work.order if is_curved(packed.law) else _order_needed(packed, work.order, length, tolerance)
    if packed.rings is None and packed.rubbing is None and packed.coupled is None:
        if tangents.shape[0] > 1:
            for first in range(0, tangents.shape[0], ABREAST):
                _move_block(packed, work, order, length, tangents, first)
        else:
            _move_one(packed, work, order, length, tangents[0])
    else:
        for column in range(tangents.shape[0]):
            _move_one(packed, work, work.order, length, tangents[column])


@inlined
def _order_needed(packed: Packed, order: int, length: float, tolerance: float) -> int:
    """Terms that disturbances need over a step: most steps end at a switch, below the longest.

    The fastest disturbance's last term is then below a tenth of what disturbance_step() leaves it.
    """
    reach, goal = length * packed.fastest, min(10.0 * tolerance, 1e-3)
    term = 0.5 * reach * reach
    for i in range(2, order):
        if term < goal:
            return i
        term *= reach / (i + 1)
    return order


@inlined
def _move_one(packed: Packed, work: Work, order: int, length: float, tangent: Array) -> None:
    for k in range(packed.omega_squared.size):
        work.tangent[0, k] = tangent[0, k]
        work.tangent[1, k] = tangent[1, k]
    for row in range(2):
        deflect(packed, work.tangent, row, work.zero_error, work.tangent_deflection)
    error, forcing, deflection = work.zero_error, work.zero_load, work.tangent_deflection
    recurrence(packed, work, order, error, forcing, work.tangent, deflection, True)
    evaluate(work.tangent, order, length, tangent[0], tangent[1])


@inlined
def _move_block(packed: Packed, work: Work, order: int, length: float, tangents: Array, first: int) -> None:
    """Move up to ABREAST tangents from number `first` on; places without one stay zero."""
    y, deflection = work.block, work.block_deflection
    count = min(ABREAST, tangents.shape[0] - first)
    for row in range(2):
        for k in range(packed.n):
            for j in range(ABREAST):
                y[row, k * ABREAST + j] = tangents[first + j, row, k] if j < count else 0.0
        _products(packed.touched, y, row, deflection, row)
    for i in range(order - 1):
        _push_block(packed, work, i)
        _expand_block(packed, work, i)
        _products(packed.touched, y, i + 2, deflection, i + 2)
    evaluate(y, order, length, y[0], y[1])
    for row in range(2):
        for k in range(packed.n):
            for j in range(count):
                tangents[first + j, row, k] = y[row, k * ABREAST + j]


@inlined
def _products(matrix: Sparse, factors: Array, at: int, out: Array, to: int) -> None:
    """Row `to` of out: the sparse matrix times row `at` of factors, for each tangent of a block."""
    read, write = at * factors.shape[1], to * out.shape[1]
    for row in range(matrix.starts.size - 1):
        total_1, total_2, total_3 = splat(0.0), splat(0.0), splat(0.0)
        for entry in range(take(matrix.starts, row), take(matrix.starts, row + 1)):
            value, start = spread(matrix.values, entry), read + ABREAST * take(matrix.columns, entry)
            total_1 = multiply_add(value, load(factors, start), total_1)
            total_2 = multiply_add(value, load(factors, start + LANES), total_2)
            total_3 = multiply_add(value, load(factors, start + 2 * LANES), total_3)
        start = write + ABREAST * row
        store(out, start, total_1)
        store(out, start + LANES, total_2)
        store(out, start + 2 * LANES, total_3)


@inlined
def _push_block(packed: Packed, work: Work, i: int) -> None:
    """Coefficient i of every mesh's force on each tangent, with the factor of the coordinates' next one."""
    deflection, force = work.block_deflection, work.block_force
    slope = work.law.slope
    width, meshes = deflection.shape[1], slope.shape[1]
    pushed = splat(-1.0 / ((i + 1) * (i + 2)))
    for m in range(packed.m):
        damping, offset = splat(work.acting[m] * (i + 1)), m * ABREAST
        at = (i + 1) * width + offset
        total_1 = multiply(damping, load(deflection, at))
        total_2 = multiply(damping, load(deflection, at + LANES))
        total_3 = multiply(damping, load(deflection, at + 2 * LANES))
        if work.active[m] != 0.0:
            for j in range(i, -1, -1):
                value, at = spread(slope, j * meshes + m), (i - j) * width + offset
                total_1 = multiply_add(value, load(deflection, at), total_1)
                total_2 = multiply_add(value, load(deflection, at + LANES), total_2)
                total_3 = multiply_add(value, load(deflection, at + 2 * LANES), total_3)
        store(force, offset, multiply(pushed, total_1))
        store(force, offset + LANES, multiply(pushed, total_2))
        store(force, offset + 2 * LANES, multiply(pushed, total_3))


@inlined
def _expand_block(packed: Packed, work: Work, i: int) -> None:
    """Coefficient i + 2 of every coordinate from those before it and the meshes' forces."""
    y, force, matrix = work.block, work.block_force, packed.touching
    width, factor = y.shape[1], -1.0 / ((i + 1) * (i + 2))
    for k in range(packed.n):
        damping = splat(factor * (i + 1) * packed.damping[k])
        stiffness = splat(factor * packed.omega_squared[k])
        at = i * width + k * ABREAST
        total_1 = multiply(stiffness, load(y, at))
        total_2 = multiply(stiffness, load(y, at + LANES))
        total_3 = multiply(stiffness, load(y, at + 2 * LANES))
        at += width
        total_1 = multiply_add(damping, load(y, at), total_1)
        total_2 = multiply_add(damping, load(y, at + LANES), total_2)
        total_3 = multiply_add(damping, load(y, at + 2 * LANES), total_3)
        for entry in range(take(matrix.starts, k), take(matrix.starts, k + 1)):
            value, start = spread(matrix.values, entry), ABREAST * take(matrix.columns, entry)
            total_1 = multiply_add(value, load(force, start), total_1)
            total_2 = multiply_add(value, load(force, start + LANES), total_2)
            total_3 = multiply_add(value, load(force, start + 2 * LANES), total_3)
        at += width
        store(y, at, total_1)
        store(y, at + LANES, total_2)
        store(y, at + 2 * LANES, total_3)
