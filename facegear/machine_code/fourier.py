"""Compiled: Taylor coefficients of Fourier series of an angle."""

from functools import cache
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine_code.compiler import FAST, for_callers
from facegear.machine_code.lanes import (
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
from facegear.machine_code.memory import aligned
from facegear.machine_code.records import Record

inlined = for_callers(**FAST)


@Record.register
class FourierScratch(NamedTuple):
    """powers (rows, harmonics): Taylor coefficients of cos(j s) (even rows) and sin(j s) (odd rows) at 0,
    shared and only read; parts (2, harmonics, LANES): scratch space. angles (2, harmonics): cosines and sines
    of the multiples of an angle.
    """

    powers: Array
    parts: Array
    angles: Array


def fourier_scratch(harmonics: int, rows: int) -> FourierScratch:
    """Scratch space for series of up to `harmonics` terms."""
    return FourierScratch(_powers(harmonics, rows), aligned(2, harmonics, LANES), np.zeros((2, harmonics)))


@cache
def _powers(harmonics: int, rows: int) -> Array:
    """j^i / i! with the signs of the cosine's and the sine's series, shape (rows, harmonics)."""
    table = np.ones((rows, harmonics))
    j = np.arange(harmonics)
    for i in range(1, rows):
        table[i] = table[i - 1] * j / i * (-1.0 if i % 2 == 0 else 1.0)
    return table


@inlined
def fourier_terms(scratch: FourierScratch, series: Array, s: float, rows: int, out: Array) -> None:
    """Taylor coefficients at s of Fourier series (harmonics + 1, 2, width), sine part first, into out, row
    after row of `width`.
    """
    set_angle(scratch, s, series.shape[0])
    terms_at_angle(scratch, series, rows, out)


@inlined
def set_angle(scratch: FourierScratch, s: float, terms: int) -> None:
    """Cosines and sines of the first `terms` multiples of s, for terms_at_angle()."""
    angles = scratch.angles
    cosine, sine = np.cos(s), np.sin(s)
    cos_j, sin_j = 1.0, 0.0
    for j in range(terms):
        angles[0, j], angles[1, j] = cos_j, sin_j
        cos_j, sin_j = cos_j * cosine - sin_j * sine, cos_j * sine + sin_j * cosine


@inlined
def terms_at_angle(scratch: FourierScratch, series: Array, rows: int, out: Array) -> None:
    """fourier_terms() at the angle that was set last."""
    terms, _, width = series.shape
    parts, powers, angles = scratch.parts, scratch.powers, scratch.angles
    span = powers.shape[1]
    for c in range(0, width, LANES):
        for j in range(terms):
            cos_j, sin_j = angles[0, j], angles[1, j]
            a, b = load(series, 2 * j * width + c), load(series, (2 * j + 1) * width + c)
            even = multiply_add(b, splat(cos_j), multiply(a, splat(sin_j)))
            odd = multiply_add(a, splat(cos_j), multiply(b, splat(-sin_j)))
            store(parts, j * LANES, even)
            store(parts, (span + j) * LANES, odd)
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
            store(out, i * width + c, add(first, second))


@inlined
def give(different: Array, width: int, kind: Integers, rows: int, out: Array) -> None:
    """Give every column of out (rows, columns) the coefficients of its kind."""
    columns = out.shape[1]
    for m in range(kind.size):
        column = kind[m]
        for i in range(rows):
            put(out, i * columns + m, take(different, i * width + column))


@inlined
def shifted(table: Array, column: int, terms: int, ahead: float, out: Array) -> None:
    """Coefficients of a polynomial, a column of `table`, about a point further on by `ahead`."""
    for i in range(terms):
        out[i] = table[i, column]
    for start in range(terms - 1):
        for i in range(terms - 2, start - 1, -1):
            out[i] += ahead * out[i + 1]
