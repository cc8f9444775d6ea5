"""Taylor coefficients of the motion between two contact switches.

Between switches the equations are linear with analytic coefficients, so the coefficients of y follow from
each other by a recurrence that costs one product with G and one with its transpose for each order.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.compiled import Packed
from facegear.dynamics.kernel import kernel
from facegear.dynamics.lanes import LANES, load, magnitude, multiply, multiply_add, splat, store
from facegear.dynamics.roots import MAX_DEPTH, bernstein_matrix

Array = NDArray[np.float64]


class Work(NamedTuple):
    """Scratch space for one thread and one order p: coefficient tables have one row for each power of s.

    edge, active, acting, state, at_edge describe the contact of each mesh during the step. powers (harmonics
    + 1, rows) holds the Taylor coefficients of cos(j s) (even rows) and sin(j s) (odd rows) at 0.
    """

    order: int
    y: Array
    deflection: Array
    stiffness: Array
    error: Array
    load: Array
    force: Array
    edge: Array
    active: Array
    acting: Array
    state: NDArray[np.int64]
    at_edge: NDArray[np.int64]
    powers: Array
    polynomial: Array
    conversion: Array
    conversion_less: Array
    subdivision: Array
    tangent: Array
    tangent_deflection: Array
    zero_error: Array
    zero_load: Array
    sample: Array
    scratch: Array
    was_acting: Array
    least: Array
    most: Array


def make_work(packed: Packed, order: int) -> Work:
    """Allocate scratch space."""
    n, m = packed.directions.shape
    rows = order + 1
    harmonics = max(len(packed.stiffness), len(packed.error), len(packed.load))
    return Work(
        order=order,
        y=np.zeros((rows, n)),
        deflection=np.zeros((rows, m)),
        stiffness=np.zeros((rows, m)),
        error=np.zeros((rows, m)),
        load=np.zeros((rows, n)),
        force=np.zeros(m),
        edge=np.zeros(m),
        active=np.zeros(m),
        acting=np.zeros(m),
        state=np.zeros(m, dtype=np.int64),
        at_edge=np.zeros(m, dtype=np.int64),
        powers=_powers(harmonics, rows),
        polynomial=np.zeros(rows),
        conversion=bernstein_matrix(order),
        conversion_less=bernstein_matrix(order - 1),
        subdivision=np.zeros((MAX_DEPTH + 2, rows)),
        tangent=np.zeros((rows, n)),
        tangent_deflection=np.zeros((rows, m)),
        zero_error=np.zeros((rows, m)),
        zero_load=np.zeros((rows, n)),
        sample=np.zeros(n),
        scratch=np.zeros(n),
        was_acting=np.zeros(m),
        least=np.zeros(m),
        most=np.zeros(m),
    )


def _powers(harmonics: int, rows: int) -> Array:
    """j^i / i! with the signs of the cosine's and the sine's series."""
    table = np.ones((harmonics, rows))
    j = np.arange(harmonics)
    for i in range(1, rows):
        table[:, i] = table[:, i - 1] * j / i * (-1.0 if i % 2 == 0 else 1.0)
    return table


@kernel
def fourier_taylor(series: Array, powers: Array, cosine: float, sine: float, rows: int, out: Array) -> None:
    """Taylor coefficients at s of Fourier series (harmonics + 1, 2, width) into out (rows, width)."""
    terms, _, wide = series.shape
    zero = splat(0.0)
    for i in range(rows):
        for c in range(0, wide, LANES):
            store(out, i * wide + c, zero)
    cos_j, sin_j = 1.0, 0.0
    for j in range(terms):
        last = rows if j > 0 else 1
        for c in range(0, wide, LANES):
            a, b = load(series, 2 * j * wide + c), load(series, (2 * j + 1) * wide + c)
            even = multiply_add(b, splat(cos_j), multiply(a, splat(sin_j)))
            odd = multiply_add(a, splat(cos_j), multiply(b, splat(-sin_j)))
            for i in range(0, last, 2):
                at = i * wide + c
                store(out, at, multiply_add(even, splat(powers[j, i]), load(out, at)))
            for i in range(1, last, 2):
                at = i * wide + c
                store(out, at, multiply_add(odd, splat(powers[j, i]), load(out, at)))
        cos_j, sin_j = cos_j * cosine - sin_j * sine, cos_j * sine + sin_j * cosine


@kernel
def excitation(packed: Packed, work: Work, s: float, piece: int) -> None:
    """Taylor coefficients of stiffness, error and load at s; `piece` is the stiffness piece that holds s."""
    rows = work.order + 1
    cosine, sine = np.cos(s), np.sin(s)
    fourier_taylor(packed.stiffness, work.powers, cosine, sine, rows, work.stiffness)
    if packed.breaks.size > 0:
        _add_piece(packed, work, s - packed.breaks[piece], piece)
    fourier_taylor(packed.error, work.powers, cosine, sine, rows, work.error)
    if packed.load.shape[0] > 1:
        fourier_taylor(packed.load, work.powers, cosine, sine, rows, work.load)
    else:
        for k in range(packed.n):
            work.load[0, k] = packed.load[0, 1, k]


@kernel
def _add_piece(packed: Packed, work: Work, ahead: float, piece: int) -> None:
    """Add the polynomial part of the stiffness, shifted from its break by `ahead`."""
    _, terms, _ = packed.pieces.shape
    for m in range(packed.m):
        for i in range(terms):
            work.polynomial[i] = packed.pieces[piece, i, m]
        for start in range(terms - 1):
            for i in range(terms - 2, start - 1, -1):
                work.polynomial[i] += ahead * work.polynomial[i + 1]
        for i in range(terms):
            work.stiffness[i, m] += work.polynomial[i]


@kernel
def deflect(packed: Packed, y: Array, row: int, error: Array, deflection: Array) -> None:
    """One row of the mesh deflections, G y - e."""
    wide = packed.directions.shape[1]
    minus = splat(-1.0)
    for c in range(0, wide, LANES):
        total = multiply(minus, load(error, row * wide + c))
        for k in range(packed.n):
            total = multiply_add(load(packed.directions, k * wide + c), splat(y[row, k]), total)
        store(deflection, row * wide + c, total)


@kernel
def recurrence(packed: Packed, work: Work, error: Array, applied: Array, y: Array, deflection: Array) -> None:
    """Fill rows 2.. of y and of deflection from rows 0 and 1 of both.

    Row 0 of deflection has the edge of the contact subtracted. work.active (m,) masks meshes in contact,
    work.acting (m,) holds the mesh damping that acts.
    """
    n, wide = packed.directions.shape
    minus = splat(-1.0)
    for i in range(work.order - 1):
        rate = splat(float(i + 1))
        for c in range(0, wide, LANES):
            total = multiply(load(work.stiffness, c), load(deflection, i * wide + c))
            for j in range(1, i + 1):
                total = multiply_add(
                    load(work.stiffness, j * wide + c), load(deflection, (i - j) * wide + c), total
                )
            damped = multiply(multiply(load(work.acting, c), rate), load(deflection, (i + 1) * wide + c))
            store(work.force, c, multiply_add(load(work.active, c), total, damped))
        backward = splat(-float(i + 1))
        factor = splat(1.0 / ((i + 1) * (i + 2)))
        for c in range(0, n, LANES):
            drag = multiply(backward, load(packed.damping, c))
            total = multiply_add(drag, load(y, (i + 1) * n + c), load(applied, i * n + c))
            total = multiply_add(multiply(minus, load(packed.squares, c)), load(y, i * n + c), total)
            for m in range(packed.m):
                total = multiply_add(load(packed.transposed, m * n + c), splat(-work.force[m]), total)
            store(y, (i + 2) * n + c, multiply(total, factor))
        deflect(packed, y, i + 2, error, deflection)


@kernel
def step_length(packed: Packed, work: Work, tolerance: float) -> float:
    """Step at which each of the last two terms is below the tolerance times the system's length scale."""
    n = packed.squares.size
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


@kernel
def evaluate(y: Array, order: int, ahead: float, place: Array, velocity: Array) -> None:
    """Value and derivative by s of the Taylor polynomials, each (n,), by Horner's rule."""
    n = place.size
    step = splat(ahead)
    for c in range(0, n, LANES):
        value, slope = load(y, order * n + c), splat(0.0)
        for i in range(order - 1, -1, -1):
            slope = multiply_add(slope, step, value)
            value = multiply_add(value, step, load(y, i * n + c))
        store(place, c, value)
        store(velocity, c, slope)
