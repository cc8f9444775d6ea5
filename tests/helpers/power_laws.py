"""Another law of contact, written against the library's interface alone: F = factor(phase) c x^n.

x^n has no Taylor series at zero. Below a small level the law is therefore the cubic with slope zero at zero
that has value and slope of c x^n at the level (Hermite); above it, it is c x^n itself. The factor is
1 + depth cos of the phase, for every contact.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from facegear.machine_code.fourier import fourier_terms

from facegear.machine_code.compiler import FAST, for_callers
from facegear.machine_code.lanes import LANES, load, multiply_add, splat, take
from facegear.machine_code.memory import aligned
from facegear.machine_code.records import Record
from facegear.mesh_law import terms

inlined = for_callers(**FAST)


@Record.register
class PowerTerms(NamedTuple):
    """size c over the squared frequency; below `level` size (a x^2 + b x^3); fourier (2, 2, LANES)."""

    size: float
    exponent: float
    level: float
    a: float
    b: float
    fourier: np.ndarray


@Record.register
class PowerSeries(NamedTuple):
    """Series (rows, width) of slope, force and what they are made of; factor (rows, LANES), alike in all."""

    slope: np.ndarray
    force: np.ndarray
    shape: np.ndarray
    amount: np.ndarray
    square: np.ndarray
    factor: np.ndarray


class PowerHeld(NamedTuple):
    """No kernel of statics knows it."""

    stiffness: np.ndarray


@dataclass(frozen=True, eq=False)
class PowerLaw:
    """`largest` is an amount that bounds the slope."""

    size: float = 1.0
    exponent: float = 1.5
    level: float = 1e-3
    depth: float = 0.0
    contacts: int = 1
    largest: float = 4.0

    breaks = np.zeros(0)
    straight = False

    @property
    def levels(self):
        return np.repeat([[0.0], [self.level]], self.contacts, axis=1)

    @property
    def steepest(self):
        return np.full(self.contacts, (1.0 + self.depth) * self.shape_slope(np.array(self.largest)))

    @property
    def harmonic_fractions(self):
        return np.array([1.0, self.depth]) / (1.0 + self.depth)

    @property
    def start(self):
        """Coefficients of x^2 and x^3 below the level, over the size."""
        n, x = self.exponent, self.level
        return (3.0 - n) * x ** (n - 2.0), (n - 2.0) * x ** (n - 3.0)

    def factor(self, cycles):
        return 1.0 + self.depth * np.cos(2.0 * np.pi * cycles)

    def shape(self, x):
        a, b = self.start
        return self.size * np.where(x < self.level, x**2 * (a + b * x), x**self.exponent)

    def shape_slope(self, x):
        a, b = self.start
        high = self.exponent * np.maximum(x, self.level) ** (self.exponent - 1.0)
        return self.size * np.where(x < self.level, x * (2.0 * a + 3.0 * b * x), high)

    def force(self, cycles, beyond):
        return self.factor(cycles)[:, None] * np.sign(beyond) * self.shape(np.abs(beyond))

    def slope(self, cycles, beyond):
        return self.factor(cycles)[:, None] * self.shape_slope(np.abs(beyond))

    def mean(self):
        return replace(self, depth=0.0)

    def at_phase(self, cycle):
        return replace(self, depth=0.0, size=self.size * float(self.factor(cycle)))

    def held(self, cycles):
        return PowerHeld(np.full((cycles.size, self.contacts), self.steepest[0]))

    def terms(self, frequency, width):
        fourier = np.zeros((2, 2, LANES))
        fourier[0, 1], fourier[1, 1] = 1.0, self.depth
        return PowerTerms(self.size / frequency**2, self.exponent, self.level, *self.start, fourier)

    def series(self, rows, width):
        return PowerSeries(*(aligned(rows, width) for _ in range(5)), aligned(rows, LANES))


@inlined
def power(base, exponent, i, m, out):
    """Coefficient i of base^exponent, those before it known."""
    if i == 0:
        out[0, m] = base[0, m] ** exponent
        return
    total = 0.0
    for j in range(1, i + 1):
        total += (exponent * j - (i - j)) / i * base[j, m] * out[i - j, m]
    out[i, m] = total / base[0, m]


@inlined
def product(one, two, i, m, n):
    """Coefficient i of the product of column m of one table and column n of another."""
    total = 0.0
    for j in range(i + 1):
        total += one[j, m] * two[i - j, n]
    return total


@terms.phase_terms.of(PowerTerms)
def phase_terms(law, series, scratch, s, ahead, piece, rows):
    fourier_terms(scratch, law.fourier, s, rows, series.factor)


@terms.piece_terms.of(PowerTerms)
def piece_terms(law, series, scratch, state, s, rows):
    pass


@terms.force_terms.of(PowerTerms)
def force_terms(law, series, state, deflection, i, c):
    for m in range(c, c + LANES):
        if take(state, m) != 0:
            series.amount[i, m] = deflection[i, m]
            if state[m] == 1:
                series.square[i, m] = product(deflection, deflection, i, m, m)
                cube = product(series.square, deflection, i, m, m)
                series.shape[i, m] = law.a * series.square[i, m] + law.b * cube
            else:
                series.amount[0, m] = deflection[0, m] + law.level
                power(series.amount, law.exponent, i, m, series.shape)
            series.force[i, m] = law.size * product(series.shape, series.factor, i, m, 0)
    return load(series.force, i * series.force.shape[1] + c)


@terms.force_of.of(PowerTerms)
def force_of(law, series, state, deflection, i, m):
    terms.force_terms(law, series, state, deflection, i, m // LANES * LANES)
    return series.force[i, m]


@terms.slope_terms.of(PowerTerms)
def slope_terms(law, series, state, deflection, order):
    for m in range(state.size):
        for i in range(order + 1):
            if state[m] == 1:
                series.shape[i, m] = 2.0 * law.a * series.amount[i, m] + 3.0 * law.b * series.square[i, m]
                series.slope[i, m] = law.size * product(series.shape, series.factor, i, m, 0)
            elif state[m] == 2:
                power(series.amount, law.exponent - 1.0, i, m, series.shape)
                slope = product(series.shape, series.factor, i, m, 0)
                series.slope[i, m] = law.exponent * law.size * slope


@terms.is_curved.of(PowerTerms)
def is_curved(law):
    return True


@terms.force_ahead.of(PowerTerms)
def force_ahead(law, series, deflection, order, step, c):
    width = series.force.shape[1]
    total = splat(0.0)
    for i in range(order, -1, -1):
        total = multiply_add(total, step, load(series.force, i * width + c))
    return total


@terms.piece_of.of(PowerTerms)
def piece_of(law, m, amount):
    return 1 if amount < law.level else 2


@terms.piece_ends.of(PowerTerms)
def piece_ends(law, m, piece):
    return (0.0, law.level) if piece == 1 else (law.level, np.inf)
