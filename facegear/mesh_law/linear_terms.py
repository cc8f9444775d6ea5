"""Compiled: the linear law in the steps of a motion."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine_code.compiler import FAST, for_callers
from facegear.machine_code.fourier import FourierScratch, fourier_terms, give, shifted
from facegear.machine_code.lanes import load, multiply, multiply_add, splat
from facegear.machine_code.records import Record
from facegear.mesh_law import terms

inlined = for_callers(**FAST)


@Record.register
class LinearTerms(NamedTuple):
    """fourier (harmonics + 1, 2, width): the stiffness of each kind, sine part first; kind (M,) of each
    contact. pieces (pieces, degree + 1, width) add a polynomial of the phase since the last break.
    """

    fourier: Array
    kind: Integers
    pieces: Array


@Record.register
class LinearSeries(NamedTuple):
    """slope (rows, width); per_kind and polynomial: scratch space."""

    slope: Array
    per_kind: Array
    polynomial: Array


@inlined
def product_terms(first: Array, second: Array, i: int, c: int) -> terms.Lanes:
    """Coefficient i of the product of two series (rows, width) of the contacts from number c on."""
    width = first.shape[1]
    # The newest rows come last: the others do not wait for them.
    total = splat(0.0)
    for j in range(i, -1, -1):
        total = multiply_add(load(first, j * width + c), load(second, (i - j) * width + c), total)
    return total


@inlined
def product_of(first: Array, second: Array, i: int, m: int) -> float:
    """Coefficient i of the product of two series (rows, width) of contact m alone."""
    total = 0.0
    for j in range(i + 1):
        total += first[j, m] * second[i - j, m]
    return total


@inlined
def values_ahead(series: Array, order: int, step: terms.Lanes, c: int) -> terms.Lanes:
    """Values of series (rows, width) at a step ahead, of the contacts from number c on."""
    width = series.shape[1]
    total = splat(0.0)
    for i in range(order, -1, -1):
        total = multiply_add(total, step, load(series, i * width + c))
    return total


@terms.phase_terms.of(LinearTerms)
def phase_terms(
    law: LinearTerms,
    series: LinearSeries,
    scratch: FourierScratch,
    s: float,
    ahead: float,
    piece: int,
    rows: int,
) -> None:
    """The series of k."""
    fourier_terms(scratch, law.fourier, s, rows, series.per_kind)
    give(series.per_kind, law.fourier.shape[2], law.kind, rows, series.slope)
    if law.pieces.shape[0] > 0:
        degrees = law.pieces.shape[1]
        for m in range(law.kind.size):
            shifted(law.pieces[piece], m, degrees, ahead, series.polynomial)
            for i in range(degrees):
                series.slope[i, m] += series.polynomial[i]


@terms.piece_terms.of(LinearTerms)
def piece_terms(
    law: LinearTerms,
    series: LinearSeries,
    scratch: FourierScratch,
    state: Integers,
    s: float,
    rows: int,
) -> None:
    """There is one piece."""


@terms.force_terms.of(LinearTerms)
def force_terms(
    law: LinearTerms, series: LinearSeries, state: Integers, deflection: Array, i: int, c: int
) -> terms.Lanes:
    """k times the deflection."""
    return product_terms(series.slope, deflection, i, c)


@terms.force_of.of(LinearTerms)
def force_of(
    law: LinearTerms, series: LinearSeries, state: Integers, deflection: Array, i: int, m: int
) -> float:
    """k times the deflection."""
    return product_of(series.slope, deflection, i, m)


@terms.slope_terms.of(LinearTerms)
def slope_terms(
    law: LinearTerms, series: LinearSeries, state: Integers, deflection: Array, order: int
) -> None:
    """The series of k stands there already."""


@terms.is_curved.of(LinearTerms)
def is_curved(law: LinearTerms) -> bool:
    """The slope is k, whatever the amount."""
    return False


@terms.force_ahead.of(LinearTerms)
def force_ahead(
    law: LinearTerms, series: LinearSeries, deflection: terms.Lanes, order: int, step: terms.Lanes, c: int
) -> terms.Lanes:
    """k ahead times the deflection."""
    return multiply(values_ahead(series.slope, order, step, c), deflection)


@terms.piece_of.of(LinearTerms)
def piece_of(law: LinearTerms, m: int, amount: float) -> int:
    """There is one piece."""
    return 1


@terms.piece_ends.of(LinearTerms)
def piece_ends(law: LinearTerms, m: int, piece: int) -> tuple[float, float]:
    """From the edge on."""
    return 0.0, np.inf
