"""Taylor coefficients of what drives the motion: mesh stiffness, transmission error, load."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.lanes import (
    LANES,
    add,
    load,
    multiply,
    multiply_add,
    put,
    splat,
    spread,
    store,
    take,
)
from facegear.dynamics.integrator.work import Work

Array = NDArray[np.float64]


@inlined
def excitation(packed: Packed, work: Work, s: float, piece: int, rows: int) -> None:
    """The first `rows` coefficients of stiffness, error and load at s; `piece` of the stiffness holds s."""
    cosine, sine = np.cos(s), np.sin(s)
    _fourier(work, packed.stiffness, cosine, sine, rows, work.kinds)
    _share(work.kinds, packed.stiffness.shape[2], packed.stiffness_kind, rows, work.stiffness)
    if packed.breaks.size > 0:
        _add_piece(packed, work, s - packed.breaks[piece], piece)
    _fourier(work, packed.error, cosine, sine, rows, work.kinds)
    _share(work.kinds, packed.error.shape[2], packed.error_kind, rows, work.error)
    if packed.drift.shape[0] > 0:
        _add_drift(packed, work, s)
    if packed.load.shape[0] > 1:
        _fourier(work, packed.load, cosine, sine, rows, work.load)
    else:
        for k in range(packed.n):
            work.load[0, k] = packed.load[0, 1, k]


@inlined
def _fourier(work: Work, series: Array, cosine: float, sine: float, rows: int, out: Array) -> None:
    """Taylor coefficients of Fourier series (harmonics + 1, 2, width) into out, row after row of `width`."""
    terms, _, wide = series.shape
    parts, powers = work.parts, work.powers
    span = powers.shape[1]
    for c in range(0, wide, LANES):
        cos_j, sin_j = 1.0, 0.0
        for j in range(terms):
            a, b = load(series, 2 * j * wide + c), load(series, (2 * j + 1) * wide + c)
            even = multiply_add(b, splat(cos_j), multiply(a, splat(sin_j)))
            odd = multiply_add(a, splat(cos_j), multiply(b, splat(-sin_j)))
            store(parts, j * LANES, even)
            store(parts, (span + j) * LANES, odd)
            cos_j, sin_j = cos_j * cosine - sin_j * sine, cos_j * sine + sin_j * cosine
        for i in range(rows):
            start, row = span * (i % 2), span * i
            # Two sums side by side: one alone would wait for each of its additions.
            first, second = splat(0.0), splat(0.0)
            for j in range(0, terms - 1, 2):
                at = start + j
                first = multiply_add(load(parts, at * LANES), spread(powers, row + j), first)
                second = multiply_add(load(parts, (at + 1) * LANES), spread(powers, row + j + 1), second)
            if terms % 2 == 1:
                last = terms - 1
                first = multiply_add(load(parts, (start + last) * LANES), spread(powers, row + last), first)
            store(out, i * wide + c, add(first, second))


@inlined
def _share(kinds: Array, wide: int, kind: NDArray[np.int64], rows: int, out: Array) -> None:
    """Give every mesh the coefficients of its kind."""
    meshes = out.shape[1]
    for m in range(kind.size):
        column = kind[m]
        for i in range(rows):
            put(out, i * meshes + m, take(kinds, i * wide + column))


@inlined
def _add_drift(packed: Packed, work: Work, s: float) -> None:
    """Add the slow part of the error, a polynomial over the whole period, shifted to s."""
    terms = packed.drift.shape[0]
    for m in range(packed.m):
        _shift(packed.drift, m, terms, s, work.polynomial)
        for i in range(terms):
            work.error[i, m] += work.polynomial[i]


@inlined
def _shift(table: Array, column: int, terms: int, ahead: float, out: Array) -> None:
    """Coefficients of a polynomial, a column of `table`, about a place further on by `ahead`."""
    for i in range(terms):
        out[i] = table[i, column]
    for start in range(terms - 1):
        for i in range(terms - 2, start - 1, -1):
            out[i] += ahead * out[i + 1]


@inlined
def _add_piece(packed: Packed, work: Work, ahead: float, piece: int) -> None:
    """Add the polynomial part of the stiffness, shifted from its break by `ahead`."""
    _, terms, _ = packed.pieces.shape
    for m in range(packed.m):
        _shift(packed.pieces[piece], m, terms, ahead, work.polynomial)
        for i in range(terms):
            work.stiffness[i, m] += work.polynomial[i]
