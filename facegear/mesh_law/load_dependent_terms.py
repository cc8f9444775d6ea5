"""Compiled: the load-dependent law in the steps of a motion and in statics."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine_code.compiler import FAST, for_callers
from facegear.machine_code.fourier import FourierScratch, fourier_terms
from facegear.machine_code.lanes import add, load, multiply, multiply_add, splat, store
from facegear.mesh_law import terms
from facegear.mesh_law.linear_terms import product_of, product_terms, values_ahead

inlined = for_callers(**FAST)


class LoadDependentHeld(NamedTuple):
    """Bounds of the slopes (K, M), cosines and sines (K, harmonics + 1) of K phases, and the law."""

    stiffness: Array
    cosine: Array
    sine: Array
    table: Array
    levels: Array
    kind: Integers


class LoadDependentTerms(NamedTuple):
    """table (kinds, L, harmonics + 1, 2, 4): series of the coefficients of the pieces, by powers of the
    amount since the piece began; levels (kinds, L) at which they begin; kind (M,) of each contact.
    """

    table: Array
    levels: Array
    kind: Integers


class LoadDependentSeries(NamedTuple):
    """slope (rows, width); coefficients of the pieces that the contacts are in, zero where they are open;
    square and cube of the deflections; four (rows, 4): coefficients of one contact.
    """

    slope: Array
    zeroth: Array
    first: Array
    second: Array
    third: Array
    square: Array
    cube: Array
    four: Array


@inlined
def _piece(levels: Array, kind: int, amount: float) -> int:
    """The piece, from 0, that holds an amount."""
    low, high = 0, levels.shape[1]
    while high - low > 1:
        middle = (low + high) // 2
        if levels[kind, middle] <= amount:
            low = middle
        else:
            high = middle
    return low


@terms.phase_terms.of(LoadDependentTerms)
def phase_terms(
    law: LoadDependentTerms,
    series: LoadDependentSeries,
    scratch: FourierScratch,
    s: float,
    ahead: float,
    piece: int,
    rows: int,
) -> None:
    """Everything depends on the pieces as well."""


@terms.piece_terms.of(LoadDependentTerms)
def piece_terms(
    law: LoadDependentTerms,
    series: LoadDependentSeries,
    scratch: FourierScratch,
    state: Integers,
    s: float,
    rows: int,
) -> None:
    """The series of the four coefficients of every contact's piece, odd ones on a back flank."""
    four = series.four
    for m in range(law.kind.size):
        if state[m] == 0:
            for i in range(rows):
                series.zeroth[i, m] = 0.0
                series.first[i, m] = 0.0
                series.second[i, m] = 0.0
                series.third[i, m] = 0.0
            continue
        fourier_terms(scratch, law.table[law.kind[m], abs(state[m]) - 1], s, rows, four)
        side = 1.0 if state[m] > 0 else -1.0
        for i in range(rows):
            series.zeroth[i, m] = side * four[i, 0]
            series.first[i, m] = four[i, 1]
            series.second[i, m] = side * four[i, 2]
            series.third[i, m] = four[i, 3]


@terms.force_terms.of(LoadDependentTerms)
def force_terms(
    law: LoadDependentTerms,
    series: LoadDependentSeries,
    state: Integers,
    deflection: Array,
    i: int,
    c: int,
) -> terms.Lanes:
    """The cubic of the deflection."""
    at = i * deflection.shape[1] + c
    store(series.square, at, product_terms(deflection, deflection, i, c))
    store(series.cube, at, product_terms(series.square, deflection, i, c))
    total = add(load(series.zeroth, at), product_terms(series.first, deflection, i, c))
    total = add(total, product_terms(series.second, series.square, i, c))
    return add(total, product_terms(series.third, series.cube, i, c))


@terms.force_of.of(LoadDependentTerms)
def force_of(
    law: LoadDependentTerms,
    series: LoadDependentSeries,
    state: Integers,
    deflection: Array,
    i: int,
    m: int,
) -> float:
    """The cubic of the deflection."""
    series.square[i, m] = product_of(deflection, deflection, i, m)
    series.cube[i, m] = product_of(series.square, deflection, i, m)
    total = series.zeroth[i, m] + product_of(series.first, deflection, i, m)
    total += product_of(series.second, series.square, i, m)
    return total + product_of(series.third, series.cube, i, m)


@terms.slope_terms.of(LoadDependentTerms)
def slope_terms(
    law: LoadDependentTerms,
    series: LoadDependentSeries,
    state: Integers,
    deflection: Array,
    order: int,
) -> None:
    """The derivative of the cubic."""
    width = deflection.shape[1]
    two, three = splat(2.0), splat(3.0)
    for i in range(order + 1):
        for c in range(0, width, 4):
            at = i * width + c
            total = multiply_add(two, product_terms(series.second, deflection, i, c), load(series.first, at))
            total = multiply_add(three, product_terms(series.third, series.square, i, c), total)
            store(series.slope, at, total)


@terms.is_curved.of(LoadDependentTerms)
def is_curved(law: LoadDependentTerms) -> bool:
    """The slope changes with the amount."""
    return True


@terms.force_ahead.of(LoadDependentTerms)
def force_ahead(
    law: LoadDependentTerms,
    series: LoadDependentSeries,
    deflection: terms.Lanes,
    order: int,
    step: terms.Lanes,
    c: int,
) -> terms.Lanes:
    """The cubic of the deflection, with its coefficients ahead."""
    total = multiply(values_ahead(series.third, order, step, c), deflection)
    total = multiply(add(total, values_ahead(series.second, order, step, c)), deflection)
    total = multiply(add(total, values_ahead(series.first, order, step, c)), deflection)
    return add(total, values_ahead(series.zeroth, order, step, c))


@terms.piece_of.of(LoadDependentTerms)
def piece_of(law: LoadDependentTerms, m: int, amount: float) -> int:
    """The piece between two levels, or beyond the last."""
    return _piece(law.levels, law.kind[m], amount) + 1


@terms.piece_ends.of(LoadDependentTerms)
def piece_ends(law: LoadDependentTerms, m: int, piece: int) -> tuple[float, float]:
    """Its levels."""
    kind = law.kind[m]
    end = law.levels[kind, piece] if piece < law.levels.shape[1] else np.inf
    return law.levels[kind, piece - 1], end


@terms.held_force.of(LoadDependentHeld)
def held_force(held: LoadDependentHeld, k: int, m: int, amount: float) -> tuple[float, float]:
    """The cubic and its derivative at phase number k."""
    kind = held.kind[m]
    piece = np.searchsorted(held.levels[kind], amount, side="right") - 1
    series = held.table[kind, piece]
    zeroth, first, second, third = 0.0, 0.0, 0.0, 0.0
    for j in range(series.shape[0]):
        sine, cosine = held.sine[k, j], held.cosine[k, j]
        zeroth += series[j, 0, 0] * sine + series[j, 1, 0] * cosine
        first += series[j, 0, 1] * sine + series[j, 1, 1] * cosine
        second += series[j, 0, 2] * sine + series[j, 1, 2] * cosine
        third += series[j, 0, 3] * sine + series[j, 1, 3] * cosine
    ahead = amount - held.levels[kind, piece]
    force = zeroth + ahead * (first + ahead * (second + ahead * third))
    return force, first + ahead * (2.0 * second + 3.0 * ahead * third)
