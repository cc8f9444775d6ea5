"""The load-dependent law: a table of forces and slopes over amounts, with Fourier series over the phase.

Between two levels of the amount the force is the cubic that has force and slope of the table at both
(Hermite), at every phase; so are its coefficients Fourier series. Beyond the last level it goes on straight.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine_code.memory import LANES, aligned, divided
from facegear.mesh_law.law import Held

LOOKS = 8
"""Phases for each harmonic at which slopes are checked."""


@dataclass(frozen=True, eq=False)
class ForceTable:
    """Forces and slopes of one contact at L levels of the amount pressed in.

    levels (L,) in m, rising from 0; forces (L, 2, harmonics + 1) in N and slopes of the same shape in N/m:
    Fourier series in the phase, sine part first. Forces are zero at the first level. Raises ValueError for
    other shapes or levels.
    """

    levels: Array
    forces: Array
    slopes: Array

    def __post_init__(self) -> None:
        count = self.levels.size
        if count < 2 or self.levels[0] != 0.0 or (np.diff(self.levels) <= 0.0).any():
            raise ValueError("levels must rise from 0, and there must be two at least")
        if self.forces.shape != self.slopes.shape or self.forces.shape[:2] != (count, 2):
            raise ValueError("forces and slopes must have one shape (levels, 2, harmonics + 1)")
        if self.forces[0].any():
            raise ValueError("forces must be zero at the first level")

    @cached_property
    def coefficients(self) -> Array:
        """Of the powers 0 to 3 of the amount beyond the level at which a piece begins, (L, 4, 2, harmonics +
        1).
        """
        spacing = np.diff(self.levels)[:, None, None]
        rise = np.diff(self.forces, axis=0) / spacing
        begin, end = self.slopes[:-1], self.slopes[1:]
        values = np.zeros((self.levels.size, 4, *self.forces.shape[1:]))
        values[:, 0], values[:, 1] = self.forces, self.slopes
        values[:-1, 2] = (3.0 * rise - 2.0 * begin - end) / spacing
        values[:-1, 3] = (begin + end - 2.0 * rise) / spacing**2
        return values

    @cached_property
    def bounds(self) -> Array:
        """Series (2 L - 1, 2, harmonics + 1) between whose extremes all slopes lie, N/m.

        They are the slopes at the levels, and between two of them the middle coefficient of the slope in
        Bernstein form.
        """
        spacing = np.diff(self.levels)[:, None, None]
        middle = self.slopes[:-1] + spacing * self.coefficients[:-1, 2]
        return np.concatenate([self.slopes, middle])

    @cached_property
    def steepest(self) -> float:
        """Bound of the slope over phase and amount, N/m."""
        return float(np.hypot(self.bounds[:, 0], self.bounds[:, 1]).sum(axis=1).max())

    @cached_property
    def min_slope(self) -> float:
        """Smallest slope at LOOKS phases for each harmonic and as many amounts between two levels, N/m."""
        count = LOOKS * self.forces.shape[2]
        values = _values(self.coefficients[:, 1:], np.arange(count) / count)
        first, second, third = np.moveaxis(values, 2, 0)[:, :, None]
        amounts = np.linspace(0.0, 1.0, LOOKS + 1)[:, None] * np.append(np.diff(self.levels), 0.0)
        return float((first + amounts * (2.0 * second + 3.0 * amounts * third)).min())

    def shifted(self, cycles: float) -> "ForceTable":
        """The table of a contact that comes later by some mesh periods."""
        return ForceTable(self.levels, _lagging(self.forces, cycles), _lagging(self.slopes, cycles))

    def mirrored(self) -> "ForceTable":
        """The table of a contact that goes through the phases the other way round."""
        sign = np.array([-1.0, 1.0])[:, None]
        return ForceTable(self.levels, sign * self.forces, sign * self.slopes)

    def scaled(self, factor: float) -> "ForceTable":
        """Forces and slopes times a factor."""
        return ForceTable(self.levels, factor * self.forces, factor * self.slopes)


@dataclass(frozen=True, eq=False)
class LoadDependentLaw:
    """Contacts of a few kinds: the table of each kind, all with as many levels and harmonics; kind (M,)."""

    tables: tuple[ForceTable, ...]
    kind: Integers

    @property
    def contacts(self) -> int:
        """The number M of contacts."""
        return self.kind.size

    @property
    def breaks(self) -> Array:
        """None: Fourier series are smooth in the phase."""
        return np.zeros(0)

    @cached_property
    def levels(self) -> Array:
        """Where the pieces begin, (L, M)."""
        return self._levels[self.kind].T

    @property
    def straight(self) -> bool:
        """The force is a cubic between two levels."""
        return False

    @cached_property
    def steepest(self) -> Array:
        """Bounds of the slopes, (M,)."""
        return np.array([table.steepest for table in self.tables])[self.kind]

    @cached_property
    def harmonic_fractions(self) -> Array:
        """Largest fraction of the slope's bound that each harmonic makes up, (H + 1,)."""
        fractions = [
            np.hypot(table.bounds[:, 0], table.bounds[:, 1]).max(axis=0) / max(table.steepest, 1e-300)
            for table in self.tables
        ]
        return np.asarray(np.max(fractions, axis=0))

    @cached_property
    def _levels(self) -> Array:
        return np.array([table.levels for table in self.tables])

    @cached_property
    def _coefficients(self) -> Array:
        return np.array([table.coefficients for table in self.tables])

    def force(self, cycles: Array, beyond: Array) -> Array:
        """Forces (..., K, M)."""
        ahead, (zeroth, first, second, third) = self._pieces(cycles, beyond)
        return np.asarray(np.sign(beyond) * (zeroth + ahead * (first + ahead * (second + ahead * third))))

    def slope(self, cycles: Array, beyond: Array) -> Array:
        """Slopes (..., K, M), zero where nothing is pressed in."""
        ahead, (_, first, second, third) = self._pieces(cycles, beyond)
        slopes = first + ahead * (2.0 * second + 3.0 * ahead * third)
        return np.asarray(np.where(beyond != 0.0, slopes, 0.0))

    def _pieces(self, cycles: Array, beyond: Array) -> tuple[Array, Array]:
        """Amounts (..., K, M) past the beginnings of their pieces, and coefficients (4, ..., K, M)."""
        values = _values(self._coefficients, cycles)
        ahead = np.abs(beyond)
        coefficients = np.empty((4, *ahead.shape))
        rows = np.arange(cycles.size)
        for m, kind in enumerate(self.kind):
            piece = np.searchsorted(self._levels[kind], ahead[..., m], side="right") - 1
            ahead[..., m] -= self._levels[kind][piece]
            coefficients[..., m] = np.moveaxis(values[rows, kind, piece], -1, 0)
        return ahead, coefficients

    def mean(self) -> "LoadDependentLaw":
        """Mean forces and slopes at every level."""
        return self._changed(
            [(table.forces[..., :1], table.slopes[..., :1]) for table in self.tables], self.kind
        )

    def at_phase(self, cycle: float) -> "LoadDependentLaw":
        """The law of every kind at one phase."""
        at = np.array([cycle])
        held = []
        for table in self.tables:
            both = np.zeros((2, table.levels.size, 2, 1))
            both[..., 1, 0] = _values(np.array([table.forces, table.slopes]), at)[0]
            held.append((both[0], both[1]))
        return self._changed(held, self.kind)

    def _changed(self, series: Sequence[tuple[Array, Array]], kind: Integers) -> "LoadDependentLaw":
        tables = zip(self.tables, series, strict=True)
        return LoadDependentLaw(tuple(ForceTable(table.levels, *both) for table, both in tables), kind)

    def held(self, cycles: Array) -> Held:
        """The law at some phases."""
        from facegear.mesh_law.load_dependent_terms import LoadDependentHeld  # compiled

        angle = 2.0 * np.pi * np.outer(cycles, np.arange(self._coefficients.shape[-1]))
        return LoadDependentHeld(
            np.repeat(self.steepest[None], cycles.size, axis=0),
            np.cos(angle),
            np.sin(angle),
            _columns(self),
            self._levels,
            self.kind,
        )

    def terms(self, frequency: float, width: int) -> NamedTuple:
        """The law over the squared mesh frequency."""
        from facegear.mesh_law.load_dependent_terms import LoadDependentTerms

        return LoadDependentTerms(divided(_columns(self), frequency**2), self._levels, self.kind)

    def series(self, rows: int, width: int) -> NamedTuple:
        """Scratch space for the coefficients of the pieces and the powers of the amounts."""
        from facegear.mesh_law.load_dependent_terms import LoadDependentSeries

        shapes = dict.fromkeys(LoadDependentSeries._fields, (rows, width))
        shapes |= {"four": (rows, LANES), "filled": (1, width)}
        return LoadDependentSeries(**{name: aligned(*shape) for name, shape in shapes.items()})


def load_dependent_law(tables: Sequence[ForceTable]) -> LoadDependentLaw:
    """The law of contacts with a table each."""
    return LoadDependentLaw(tuple(tables), np.arange(len(tables)))


def _values(series: Array, cycles: Array) -> Array:
    """Values (K, ...) of Fourier series (..., 2, harmonics + 1) at phases (K,)."""
    angle = 2.0 * np.pi * np.outer(cycles, np.arange(series.shape[-1]))
    return np.asarray(
        np.tensordot(np.sin(angle), series[..., 0, :], axes=(1, -1))
        + np.tensordot(np.cos(angle), series[..., 1, :], axes=(1, -1))
    )


def _lagging(series: Array, cycles: float) -> Array:
    """Fourier series (..., 2, harmonics + 1) of what comes later by some mesh periods."""
    angle = 2.0 * np.pi * cycles * np.arange(series.shape[-1])
    cosine, sine = np.cos(angle), np.sin(angle)
    a, b = series[..., 0, :], series[..., 1, :]
    return np.stack([a * cosine + b * sine, b * cosine - a * sine], axis=-2)


@lru_cache(maxsize=16)
def _columns(law: LoadDependentLaw) -> Any:
    """Coefficients (kinds, L, harmonics + 1, 2, 4) as compiled functions read them; shared, only read."""
    columns = aligned(*np.moveaxis(law._coefficients, (2, 3, 4), (4, 3, 2)).shape)
    columns[:] = np.moveaxis(law._coefficients, (2, 3, 4), (4, 3, 2))
    return columns
