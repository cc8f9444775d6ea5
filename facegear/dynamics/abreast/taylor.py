"""Taylor coefficients of the motions in all lanes; the formulas are those of the single integrator."""

from facegear.arrays import Array
from facegear.dynamics.abreast.functions import sine_and_cosine
from facegear.dynamics.abreast.kernel import inlined
from facegear.dynamics.abreast.lanes import Lanes
from facegear.dynamics.abreast.rows import (
    DAMPING,
    ERROR,
    JACOBIAN,
    LAW,
    LOAD,
    OMEGA,
    Structure,
)
from facegear.dynamics.abreast.wide import load, splat, store, subtract
from facegear.machine_code.lanes import take
from facegear.machine_code.vectors import add, multiply, multiply_add


@inlined
def excitation(shape: Structure, lanes: Lanes, rows: int) -> None:
    """Coefficients of law, error and load at the phases of the lanes."""
    _set_angles(lanes)
    _fourier(lanes, shape.offsets[LAW], shape.law_terms, shape.law_kinds, rows, lanes.law)
    _fourier(lanes, shape.offsets[ERROR], shape.error_terms, shape.error_kinds, rows, lanes.error)
    if shape.load_terms > 1:
        _fourier(lanes, shape.offsets[LOAD], shape.load_terms, shape.n, rows, lanes.load)
        return
    for k in range(shape.n):
        store(lanes.load, k, load(lanes.values, shape.offsets[LOAD] + shape.n + k))


@inlined
def _set_angles(lanes: Lanes) -> None:
    """Cosines and sines of the multiples of the phases."""
    sine, cosine = sine_and_cosine(load(lanes.phase, 0))
    terms = lanes.angles.shape[1]
    cos_j, sin_j = splat(1.0), splat(0.0)
    for j in range(terms):
        store(lanes.angles, j, cos_j)
        store(lanes.angles, terms + j, sin_j)
        cos_j, sin_j = (
            subtract(multiply(cos_j, cosine), multiply(sin_j, sine)),
            multiply_add(cos_j, sine, multiply(sin_j, cosine)),
        )


@inlined
def _fourier(lanes: Lanes, at: int, terms: int, count: int, rows: int, out: Array) -> None:
    """Coefficients (rows, series) at the angles of series (terms, 2, series) from value `at` on."""
    angles, parts, powers = lanes.angles, lanes.parts, lanes.powers
    span = powers.shape[1]
    for kind in range(count):
        for j in range(terms):
            cosine, sine = load(angles, j), load(angles, span + j)
            a = load(lanes.values, at + 2 * j * count + kind)
            b = load(lanes.values, at + (2 * j + 1) * count + kind)
            store(parts, j, multiply_add(b, cosine, multiply(a, sine)))
            store(parts, span + j, subtract(multiply(a, cosine), multiply(b, sine)))
        for i in range(0, rows - 1, 2):
            # Rows i and i + 1 side by side, each in two sums: one alone would wait for each addition.
            even_1, odd_1, even_2, odd_2 = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
            for j in range(0, terms - 1, 2):
                even_1 = multiply_add(load(parts, j), splat(take(powers, span * i + j)), even_1)
                odd_1 = multiply_add(load(parts, span + j), splat(take(powers, span * (i + 1) + j)), odd_1)
                even_2 = multiply_add(load(parts, j + 1), splat(take(powers, span * i + j + 1)), even_2)
                odd_2 = multiply_add(
                    load(parts, span + j + 1), splat(take(powers, span * (i + 1) + j + 1)), odd_2
                )
            if terms % 2 == 1:
                j = terms - 1
                even_1 = multiply_add(load(parts, j), splat(take(powers, span * i + j)), even_1)
                odd_1 = multiply_add(load(parts, span + j), splat(take(powers, span * (i + 1) + j)), odd_1)
            store(out, i * count + kind, add(even_1, even_2))
            store(out, (i + 1) * count + kind, add(odd_1, odd_2))
        if rows % 2 == 1:
            total = splat(0.0)
            start = span * ((rows - 1) % 2)
            for j in range(terms):
                total = multiply_add(
                    load(parts, start + j), splat(take(powers, span * (rows - 1) + j)), total
                )
            store(out, (rows - 1) * count + kind, total)


@inlined
def deflect(shape: Structure, lanes: Lanes, y: Array, deflection: Array, i: int, turns: bool) -> None:
    """Row i of the deflections, G y - e; of a disturbance that `turns` with the motion, G y."""
    at, first, row = shape.offsets[JACOBIAN], i * shape.n, i * shape.m
    for m in range(shape.m):
        total, other = splat(0.0), splat(0.0)
        if not turns:
            total = subtract(total, load(lanes.error, i * shape.error_kinds + take(shape.error_kind, m)))
        begin, end = take(shape.starts, m), take(shape.starts, m + 1)
        for e in range(begin, end - 1, 2):
            total = multiply_add(load(lanes.values, at + e), load(y, first + take(shape.columns, e)), total)
            other = multiply_add(
                load(lanes.values, at + e + 1), load(y, first + take(shape.columns, e + 1)), other
            )
        if (end - begin) % 2 == 1:
            e = end - 1
            total = multiply_add(load(lanes.values, at + e), load(y, first + take(shape.columns, e)), total)
        store(deflection, row + m, add(total, other))


@inlined
def recurrence(shape: Structure, lanes: Lanes, y: Array, deflection: Array, turns: bool) -> None:
    """Fill rows 2 .. order of y and of deflection from rows 0 and 1 of both: of the motion, or of a
    disturbance that turns with it.
    """
    for i in range(lanes.order - 1):
        _push(shape, lanes, deflection, i)
        _accelerate(shape, lanes, y, i, turns)
        deflect(shape, lanes, y, deflection, i + 2, turns)


@inlined
def _push(shape: Structure, lanes: Lanes, deflection: Array, i: int) -> None:
    """Coefficient i of the forces, with the factor of the next coefficient of y."""
    m, count = shape.m, shape.law_kinds
    rate, pushed = splat(i + 1.0), splat(-1.0 / ((i + 1) * (i + 2)))
    for contact in range(m):
        kind = take(shape.law_kind, contact)
        total, other = splat(0.0), splat(0.0)
        for j in range(i, 0, -2):
            total = multiply_add(
                load(lanes.law, j * count + kind), load(deflection, (i - j) * m + contact), total
            )
            other = multiply_add(
                load(lanes.law, (j - 1) * count + kind),
                load(deflection, (i - j + 1) * m + contact),
                other,
            )
        if i % 2 == 0:
            other = multiply_add(load(lanes.law, kind), load(deflection, i * m + contact), other)
        total = multiply(load(lanes.active, contact), add(total, other))
        damping = multiply(load(lanes.acting, contact), rate)
        total = multiply_add(damping, load(deflection, (i + 1) * m + contact), total)
        store(lanes.force, contact, multiply(pushed, total))


@inlined
def _accelerate(shape: Structure, lanes: Lanes, y: Array, i: int, turns: bool) -> None:
    """Row i + 2 of y."""
    n, at = shape.n, shape.offsets[JACOBIAN]
    rate, factor = splat(i + 1.0), splat(1.0 / ((i + 1) * (i + 2)))
    unloaded = turns or (shape.load_terms == 1 and i > 0)
    for k in range(n):
        damping = load(lanes.values, shape.offsets[DAMPING] + k)
        total = multiply(damping, multiply(rate, load(y, (i + 1) * n + k)))
        omega_squared = load(lanes.values, shape.offsets[OMEGA] + k)
        total = multiply_add(omega_squared, load(y, i * n + k), total)
        applied = splat(0.0) if unloaded else load(lanes.load, i * n + k)
        total, other = multiply(factor, subtract(applied, total)), splat(0.0)
        begin, end = take(shape.back_starts, k), take(shape.back_starts, k + 1)
        for e in range(begin, end - 1, 2):
            total = multiply_add(
                load(lanes.values, at + take(shape.entry, e)),
                load(lanes.force, take(shape.back_rows, e)),
                total,
            )
            other = multiply_add(
                load(lanes.values, at + take(shape.entry, e + 1)),
                load(lanes.force, take(shape.back_rows, e + 1)),
                other,
            )
        if (end - begin) % 2 == 1:
            e = end - 1
            total = multiply_add(
                load(lanes.values, at + take(shape.entry, e)),
                load(lanes.force, take(shape.back_rows, e)),
                total,
            )
        store(y, (i + 2) * n + k, add(total, other))


@inlined
def move(shape: Structure, lanes: Lanes, y: Array) -> None:
    """Move rows 0 and 1 of y to the ends of the steps, by Horner's rule."""
    n, order, step = shape.n, lanes.order, load(lanes.length, 0)
    for k in range(n):
        value, slope = load(y, order * n + k), splat(0.0)
        for i in range(order - 1, -1, -1):
            slope = multiply_add(slope, step, value)
            value = multiply_add(value, step, load(y, i * n + k))
        store(y, k, value)
        store(y, n + k, slope)


@inlined
def values(shape: Structure, lanes: Lanes) -> None:
    """Coordinates at `ahead` into `sample`."""
    n, step = shape.n, load(lanes.ahead, 0)
    for k in range(n):
        value = load(lanes.y, lanes.order * n + k)
        for i in range(lanes.order - 1, -1, -1):
            value = multiply_add(value, step, load(lanes.y, i * n + k))
        store(lanes.sample, k, value)
