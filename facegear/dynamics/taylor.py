"""Taylor coefficients of the motion between two contact switches.

Between switches the equations are linear with analytic coefficients, so the coefficients of y follow from
each other by a recurrence that costs one product with G and one with its transpose for each order.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from facegear.dynamics.compiled import Packed
from facegear.dynamics.roots import MAX_DEPTH, bernstein_matrix

Array = NDArray[np.float64]


class Work(NamedTuple):
    """Scratch space for one thread and one order p: coefficient tables have one row for each power of s."""

    order: int
    y: Array
    deflection: Array
    stiffness: Array
    error: Array
    load: Array
    force: Array
    active: Array
    acting: Array
    edge: Array
    state: NDArray[np.int64]
    at_edge: NDArray[np.int64]
    harmonic: Array
    polynomial: Array
    conversion: Array
    conversion_less: Array
    subdivision: Array
    tangent: Array
    tangent_deflection: Array
    zero_error: Array
    zero_load: Array


def make_work(packed: Packed, order: int) -> Work:
    """Allocate scratch space."""
    n, m = packed.directions.shape
    kinds = max(packed.stiffness.shape[0], packed.error.shape[0], n)
    rows = order + 1
    return Work(
        order=order,
        y=np.zeros((rows, n)),
        deflection=np.zeros((rows, m)),
        stiffness=np.zeros((rows, m)),
        error=np.zeros((rows, m)),
        load=np.zeros((rows, n)),
        force=np.zeros(m),
        active=np.zeros(m),
        acting=np.zeros(m),
        edge=np.zeros(m),
        state=np.zeros(m, dtype=np.int64),
        at_edge=np.zeros(m, dtype=np.int64),
        harmonic=np.zeros((rows, kinds)),
        polynomial=np.zeros(rows),
        conversion=bernstein_matrix(order),
        conversion_less=bernstein_matrix(order - 1),
        subdivision=np.zeros((MAX_DEPTH + 2, rows)),
        tangent=np.zeros((rows, n)),
        tangent_deflection=np.zeros((rows, m)),
        zero_error=np.zeros((rows, m)),
        zero_load=np.zeros((rows, n)),
    )


@njit(cache=True, nogil=True, fastmath={"contract"})
def fourier_taylor(series: Array, s: float, rows: int, out: Array) -> None:
    """Taylor coefficients at s of each Fourier series: series (kinds, 2, harmonics + 1), out (rows,
    kinds).
    """
    kinds, _, terms = series.shape
    for i in range(rows):
        for kind in range(kinds):
            out[i, kind] = 0.0
    cosine, sine = np.cos(s), np.sin(s)
    c, z = 1.0, 0.0
    for j in range(terms):
        for kind in range(kinds):
            a, b = series[kind, 0, j], series[kind, 1, j]
            if a == 0.0 and b == 0.0:
                continue
            even = b * c + a * z
            odd = a * c - b * z
            factor = 1.0
            i = 0
            while True:
                out[i, kind] += factor * even
                i += 1
                if i == rows or j == 0:
                    break
                factor *= j / i
                out[i, kind] += factor * odd
                i += 1
                if i == rows:
                    break
                factor *= -j / i
        c, z = c * cosine - z * sine, c * sine + z * cosine


@njit(cache=True, nogil=True, fastmath={"contract"})
def excitation(packed: Packed, work: Work, s: float, piece: int) -> None:
    """Taylor coefficients of stiffness, error and load at s; `piece` is the stiffness piece that holds s."""
    rows = work.order + 1
    meshes = packed.lower.size
    fourier_taylor(packed.stiffness, s, rows, work.harmonic)
    if packed.breaks.size > 0:
        _add_piece(packed, work, s, piece)
    for i in range(rows):
        for m in range(meshes):
            work.stiffness[i, m] = work.harmonic[i, packed.stiffness_kind[m]]
    fourier_taylor(packed.error, s, rows, work.harmonic)
    for i in range(rows):
        for m in range(meshes):
            work.error[i, m] = work.harmonic[i, packed.error_kind[m]]
    for m in range(packed.m, meshes):
        for i in range(rows):
            work.stiffness[i, m] = 0.0
            work.error[i, m] = 0.0
    if packed.load.shape[2] > 1:
        fourier_taylor(packed.load, s, rows, work.load)
    else:
        for k in range(packed.squares.size):
            work.load[0, k] = packed.load[k, 1, 0]


@njit(cache=True, nogil=True)
def _add_piece(packed: Packed, work: Work, s: float, piece: int) -> None:
    """Add the polynomial part of the stiffness, shifted from its break to s."""
    kinds, _, terms = packed.pieces.shape
    ahead = s - packed.breaks[piece]
    for kind in range(kinds):
        for i in range(terms):
            work.polynomial[i] = packed.pieces[kind, piece, i]
        for start in range(terms - 1):
            for i in range(terms - 2, start - 1, -1):
                work.polynomial[i] += ahead * work.polynomial[i + 1]
        for i in range(terms):
            work.harmonic[i, kind] += work.polynomial[i]


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def deflect(packed: Packed, y: Array, row: int, error: Array, deflection: Array) -> None:
    """One row of the mesh deflections, G y - e; four coordinates at a time to spare memory traffic."""
    n, meshes = packed.directions.shape
    directions = packed.directions
    for m in range(meshes):
        deflection[row, m] = -error[row, m]
    for k in range(0, n, 4):
        y0, y1, y2, y3 = y[row, k], y[row, k + 1], y[row, k + 2], y[row, k + 3]
        for m in range(meshes):
            deflection[row, m] += (
                directions[k, m] * y0
                + directions[k + 1, m] * y1
                + directions[k + 2, m] * y2
                + directions[k + 3, m] * y3
            )


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def recurrence(packed: Packed, work: Work, error: Array, load: Array, y: Array, deflection: Array) -> None:
    """Fill rows 2.. of y and of deflection from rows 0 and 1 of both.

    Row 0 of deflection has the edge of the contact subtracted. work.active (m,) masks meshes in contact,
    work.acting (m,) holds the mesh damping that acts.
    """
    n, meshes = packed.directions.shape
    transposed, stiffness, force = packed.transposed, work.stiffness, work.force
    for i in range(work.order - 1):
        rate = float(i + 1)
        for m in range(meshes):
            force[m] = stiffness[0, m] * deflection[i, m]
        first = 1
        if i % 2 == 1:
            for m in range(meshes):
                force[m] += stiffness[1, m] * deflection[i - 1, m]
            first = 2
        for j in range(first, i + 1, 2):
            for m in range(meshes):
                force[m] += (
                    stiffness[j, m] * deflection[i - j, m] + stiffness[j + 1, m] * deflection[i - j - 1, m]
                )
        for m in range(meshes):
            force[m] = work.active[m] * force[m] + work.acting[m] * rate * deflection[i + 1, m]
        factor = 1.0 / ((i + 1) * (i + 2))
        for k in range(n):
            y[i + 2, k] = factor * (
                load[i, k] - packed.damping[k] * rate * y[i + 1, k] - packed.squares[k] * y[i, k]
            )
        for m in range(0, meshes, 4):
            f0, f1 = factor * force[m], factor * force[m + 1]
            f2, f3 = factor * force[m + 2], factor * force[m + 3]
            for k in range(n):
                y[i + 2, k] -= (
                    transposed[m, k] * f0
                    + transposed[m + 1, k] * f1
                    + transposed[m + 2, k] * f2
                    + transposed[m + 3, k] * f3
                )
        deflect(packed, y, i + 2, error, deflection)


@njit(cache=True, nogil=True, fastmath={"contract"})
def step_length(packed: Packed, y: Array, order: int, tolerance: float) -> float:
    """Step at which each of the last two terms is below the tolerance times the system's length scale."""
    target = tolerance * packed.scale
    longest = 1e300
    for i in range(order - 1, order + 1):
        largest = 0.0
        for k in range(packed.n):
            term = packed.weights[k] * abs(y[i, k])
            if term > largest:
                largest = term
        if largest > 0.0:
            longest = min(longest, (target / largest) ** (1.0 / i))
    return longest


@njit(cache=True, nogil=True, fastmath={"contract"})
def evaluate(y: Array, order: int, ahead: float, place: Array, velocity: Array) -> None:
    """Value and derivative by s of the Taylor polynomials, each (n,), by Horner's rule."""
    n = place.size
    for k in range(n):
        place[k] = y[order, k]
        velocity[k] = 0.0
    for i in range(order - 1, -1, -1):
        for k in range(n):
            velocity[k] = velocity[k] * ahead + place[k]
            place[k] = place[k] * ahead + y[i, k]
