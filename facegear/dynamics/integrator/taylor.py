"""Taylor coefficients of the motion between two contact switches.

Between switches the forces are analytic, and coefficient i of the forces needs no more than those up to i of
the deflections: so the coefficients of y follow from each other by a recurrence that costs one product with
G, one with its transpose and what the law asks for each order. Sums are
kept in several parts side by side, as a processor adds many numbers at once but one number slowly.
"""

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.block_products import couple, feel, find_pressing, push
from facegear.dynamics.integrator.blocks import Coupled
from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.rings import ring_push, ring_row, ring_tangent_row
from facegear.dynamics.integrator.rubbing import keep_elastic, rub
from facegear.dynamics.integrator.work import Pressing, Work
from facegear.machine_code.lanes import (
    LANES,
    add,
    load,
    magnitude,
    multiply,
    multiply_add,
    splat,
    spread,
    store,
)
from facegear.mesh_law.linear_terms import product_terms
from facegear.mesh_law.terms import force_terms


@inlined
def accumulate(matrix: Array, rows: int, factors: Array, at: int, out: Array, to: int) -> None:
    """Add sum_j matrix[j] factors[at + j] over the first `rows` (even) rows to out, from its index `to` on.

    Three vectors at a time share each factor that is read.
    """
    width = matrix.shape[1]
    triples = width // (3 * LANES) * (3 * LANES)
    for c in range(0, triples, 3 * LANES):
        sum_1, sum_2, sum_3 = load(out, to + c), load(out, to + c + LANES), load(out, to + c + 2 * LANES)
        sum_4, sum_5, sum_6 = splat(0.0), splat(0.0), splat(0.0)
        for j in range(0, rows, 2):
            row = j * width + c
            factor, other = spread(factors, at + j), spread(factors, at + j + 1)
            sum_1 = multiply_add(load(matrix, row), factor, sum_1)
            sum_2 = multiply_add(load(matrix, row + LANES), factor, sum_2)
            sum_3 = multiply_add(load(matrix, row + 2 * LANES), factor, sum_3)
            row += width
            sum_4 = multiply_add(load(matrix, row), other, sum_4)
            sum_5 = multiply_add(load(matrix, row + LANES), other, sum_5)
            sum_6 = multiply_add(load(matrix, row + 2 * LANES), other, sum_6)
        store(out, to + c, add(sum_1, sum_4))
        store(out, to + c + LANES, add(sum_2, sum_5))
        store(out, to + c + 2 * LANES, add(sum_3, sum_6))
    for c in range(triples, width, LANES):
        sum_1, sum_2 = load(out, to + c), splat(0.0)
        for j in range(0, rows, 2):
            row = j * width + c
            sum_1 = multiply_add(load(matrix, row), spread(factors, at + j), sum_1)
            sum_2 = multiply_add(load(matrix, row + width), spread(factors, at + j + 1), sum_2)
        store(out, to + c, add(sum_1, sum_2))


@inlined
def deflect(packed: Packed, y: Array, row: int, error: Array, deflection: Array) -> None:
    """One row of the mesh deflections, G y - e."""
    _feel(packed.coupled, packed, y, row, error, deflection)


@inlined
def _feel(
    coupled: Coupled | None, packed: Packed, y: Array, row: int, error: Array, deflection: Array
) -> None:
    if coupled is not None:
        feel(coupled.blocks, packed.transposed, y, row, error, deflection)
        return
    n, width = packed.mesh_jacobian.shape
    minus = splat(-1.0)
    for c in range(row * width, (row + 1) * width, LANES):
        store(deflection, c, multiply(minus, load(error, c)))
    accumulate(packed.mesh_jacobian, packed.n + packed.n % 2, y, row * n, deflection, row * width)


@inlined
def recurrence(
    packed: Packed,
    work: Work,
    order: int,
    error: Array,
    applied: Array,
    y: Array,
    deflection: Array,
    tangent: bool,
) -> None:
    """Fill rows 2 .. order of y and of deflection from rows 0 and 1 of both.

    Row 0 of deflection has the edge of the contact subtracted. work.active (m,) masks meshes in contact,
    work.acting (m,) holds the mesh damping that acts. A `tangent` is moved by the slopes of the forces along
    the motion, which must be known.
    """
    n, width = packed.mesh_jacobian.shape
    force = work.force
    minus = splat(-1.0)
    for i in range(2):
        _ring(packed, work, i, deflection, tangent)
    find_pressing(packed.coupled, work.pressing, packed, work)
    for i in range(order - 1):
        rate = splat(float(i + 1))
        # Forces push back; they carry the factor of the next coefficient already.
        pushed = splat(-1.0 / ((i + 1) * (i + 2)))
        for c in range(0, width, LANES):
            if tangent:
                total = product_terms(work.law.slope, deflection, i, c)
            else:
                total = force_terms(packed.law, work.law, work.state, deflection, i, c)
            keep_elastic(work.rubbing, work.side, total, i, c)
            total = multiply(load(work.active, c), total)
            damping = multiply(load(work.acting, c), rate)
            total = multiply_add(damping, load(deflection, (i + 1) * width + c), total)
            store(force, c, multiply(pushed, total))
        ring_push(packed.rings, work.rings, work.active, i, force, -1.0 / ((i + 1) * (i + 2)))
        factor = splat(1.0 / ((i + 1) * (i + 2)))
        for c in range(0, n, LANES):
            total = multiply(load(packed.damping, c), multiply(rate, load(y, (i + 1) * n + c)))
            total = multiply_add(load(packed.omega_squared, c), load(y, i * n + c), total)
            total = multiply_add(minus, total, load(applied, i * n + c))
            store(y, (i + 2) * n + c, multiply(factor, total))
        _push(packed.coupled, work.pressing, packed, work, y, i)
        rub(packed.rubbing, work.rubbing, work.side, i, 1.0 / ((i + 1) * (i + 2)), y, i + 2)
        deflect(packed, y, i + 2, error, deflection)
        _ring(packed, work, i + 2, deflection, tangent)


@inlined
def _push(
    coupled: Coupled | None, pressing: Pressing | None, packed: Packed, work: Work, y: Array, i: int
) -> None:
    """Add what the meshes and the coupling beside them push to row i + 2 of y."""
    if coupled is None or pressing is None:
        accumulate(packed.transposed, packed.m + packed.m % 2, work.force, 0, y, (i + 2) * y.shape[1])
        return
    push(coupled.blocks, pressing, packed.transposed, work.force, y, i + 2)
    couple(coupled.own, coupled.strips, work.coupled, y, i)


@inlined
def _ring(packed: Packed, work: Work, i: int, deflection: Array, tangent: bool) -> None:
    if tangent:
        ring_tangent_row(packed.rings, work.rings, deflection, i)
    else:
        ring_row(packed.rings, work.rings, work, i)


@inlined
def step_length(packed: Packed, work: Work, tolerance: float) -> float:
    """Step at which each of the last two terms is below the tolerance times the system's length scale (Jorba
    and Zou 2005).
    """
    n = packed.omega_squared.size
    target = tolerance * packed.scale
    longest = 1e300
    for i in range(work.order - 1, work.order + 1):
        total = splat(0.0)
        for c in range(0, n, LANES):
            total = multiply_add(load(packed.weights, c), magnitude(load(work.y, i * n + c)), total)
        store(work.force, 0, total)
        size = work.force[0] + work.force[1] + work.force[2] + work.force[3]
        if size > 0.0:
            longest = min(longest, np.exp(np.log(target / size) / i))
    return longest


@inlined
def evaluate(y: Array, order: int, ahead: float, displacement: Array, velocity: Array) -> None:
    """Value and derivative by s of the Taylor polynomials, each (n,), by Horner's rule."""
    n = displacement.size
    step = splat(ahead)
    for c in range(0, n, LANES):
        value, slope = load(y, order * n + c), splat(0.0)
        for i in range(order - 1, -1, -1):
            slope = multiply_add(slope, step, value)
            value = multiply_add(value, step, load(y, i * n + c))
        store(displacement, c, value)
        store(velocity, c, slope)


@inlined
def values(y: Array, order: int, ahead: float, out: Array) -> None:
    """Values (n,) alone of the Taylor polynomials."""
    n = out.size
    step = splat(ahead)
    for c in range(0, n, LANES):
        value = load(y, order * n + c)
        for i in range(order - 1, -1, -1):
            value = multiply_add(value, step, load(y, i * n + c))
        store(out, c, value)
