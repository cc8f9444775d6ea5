"""Compiled: the load-dependent law in the steps of a motion."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine_code.compiler import FAST, for_callers
from facegear.machine_code.fourier import FourierScratch, set_angle, terms_at_angle
from facegear.machine_code.lanes import LANES, add, load, multiply, multiply_add, splat, store
from facegear.machine_code.records import Record
from facegear.mesh_law import terms
from facegear.mesh_law.linear_terms import product_of, product_terms, values_ahead

inlined = for_callers(**FAST)


@Record.register
class LoadDependentTerms(NamedTuple):
    """table (kinds, L, harmonics + 1, 2, 4): series of the coefficients of the pieces, by powers of the
    amount since the piece began; levels (kinds, L) at which they begin; kind (M,) of each contact.
    """

    table: Array
    levels: Array
    kind: Integers


@Record.register
class LoadDependentSeries(NamedTuple):
    """slope (rows, width); coefficients of the pieces that the contacts are in, zero where they are open;
    four (rows, 4): coefficients of one contact. With d the deflection the force is

        zeroth + d rise,   rise = first + d bend,   bend = second + d third,

    and the slope rise + d (2 bend - second); lever holds what is in brackets. filled (1, width): 1 where a
    contact has coefficients.
    """

    slope: Array
    zeroth: Array
    first: Array
    second: Array
    third: Array
    bend: Array
    rise: Array
    lever: Array
    four: Array
    filled: Array


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
    set_angle(scratch, s, law.table.shape[2])
    for m in range(law.kind.size):
        if state[m] == 0:
            if series.filled[0, m] == 1.0:
                _empty(series, m, rows)
            continue
        series.filled[0, m] = 1.0
        terms_at_angle(scratch, law.table[law.kind[m], abs(state[m]) - 1], rows, four)
        side = 1.0 if state[m] > 0 else -1.0
        for i in range(rows):
            series.zeroth[i, m] = side * four[i, 0]
            series.first[i, m] = four[i, 1]
            series.second[i, m] = side * four[i, 2]
            series.third[i, m] = four[i, 3]


@inlined
def _empty(series: LoadDependentSeries, m: int, rows: int) -> None:
    """No coefficients for an open contact."""
    series.filled[0, m] = 0.0
    for i in range(rows):
        series.zeroth[i, m] = 0.0
        series.first[i, m] = 0.0
        series.second[i, m] = 0.0
        series.third[i, m] = 0.0


@inlined
def _all_open(state: Integers, c: int) -> bool:
    """Whether none of the LANES contacts from number c on is in contact."""
    return state[c] == 0 and state[c + 1] == 0 and state[c + 2] == 0 and state[c + 3] == 0


@terms.force_terms.of(LoadDependentTerms)
def force_terms(
    law: LoadDependentTerms,
    series: LoadDependentSeries,
    state: Integers,
    deflection: Array,
    i: int,
    c: int,
) -> terms.Lanes:
    """The cubic of the deflection; nothing where all contacts are open."""
    if _all_open(state, c):
        return splat(0.0)
    at = i * deflection.shape[1] + c
    store(series.bend, at, add(load(series.second, at), product_terms(series.third, deflection, i, c)))
    store(series.rise, at, add(load(series.first, at), product_terms(series.bend, deflection, i, c)))
    return add(load(series.zeroth, at), product_terms(series.rise, deflection, i, c))


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
    series.bend[i, m] = series.second[i, m] + product_of(series.third, deflection, i, m)
    series.rise[i, m] = series.first[i, m] + product_of(series.bend, deflection, i, m)
    return series.zeroth[i, m] + product_of(series.rise, deflection, i, m)


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
    two, minus = splat(2.0), splat(-1.0)
    for c in range(0, width, LANES):
        if _all_open(state, c):
            continue
        for i in range(order + 1):
            at = i * width + c
            lever = multiply_add(minus, load(series.second, at), multiply(two, load(series.bend, at)))
            store(series.lever, at, lever)
            total = add(load(series.rise, at), product_terms(series.lever, deflection, i, c))
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
