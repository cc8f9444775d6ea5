"""The load-dependent law of all contacts of a machine, each with a table of forces of its kind."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.machine_code.memory import LANES, aligned, divided
from facegear.mesh_law.force_table import ForceTable, amplitudes, hermite, slope_bounds, values_at
from facegear.mesh_law.law import Held

KEPT = 2
"""Sets of phases at which the coefficients of the pieces are kept."""


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
        return self._steepest[self.kind]

    @cached_property
    def harmonic_fractions(self) -> Array:
        """Largest fraction of the slope's bound that each harmonic makes up, (H + 1,)."""
        fractions = self._bound_sizes.max(axis=1) / np.maximum(self._steepest, 1e-300)[:, None]
        return np.asarray(fractions.max(axis=0))

    @cached_property
    def _steepest(self) -> Array:
        """Bounds of the slopes of each kind."""
        return np.asarray(self._bound_sizes.sum(axis=-1).max(axis=1))

    @cached_property
    def _bound_sizes(self) -> Array:
        """Amplitudes (kinds, 2 L - 1, harmonics + 1) of the series that bound the slopes."""
        return amplitudes(slope_bounds(self._levels, self._coefficients))

    @cached_property
    def _levels(self) -> Array:
        return np.array([table.levels for table in self.tables])

    @cached_property
    def _coefficients(self) -> Array:
        forces, slopes = (
            np.array([getattr(table, name) for table in self.tables]) for name in ("forces", "slopes")
        )
        return hermite(self._levels, forces, slopes)

    def force(self, cycles: Array, beyond: Array) -> Array:
        """Forces (..., K, M)."""
        forces = self._by_piece(cycles, beyond, _cubic)
        np.negative(forces, out=forces, where=beyond < 0.0)
        return forces

    def slope(self, cycles: Array, beyond: Array) -> Array:
        """Slopes (..., K, M), zero where nothing is pressed in."""
        return self._by_piece(cycles, beyond, _cubic_slope)

    def _by_piece(self, cycles: Array, beyond: Array, law: Callable[[Array, Array], Array]) -> Array:
        """What `law` gives for amounts (..., K) past the beginning of a piece and its coefficients (4, K), at
        every contact (..., K, M); zero where nothing is pressed in.

        Only pieces that contacts are pressed into are evaluated.
        """
        pieces, values = self._pieces_at(cycles), np.zeros(beyond.shape)
        for m, kind in enumerate(self.kind.tolist()):
            ahead = np.abs(beyond[..., m])
            pressed = ahead > 0.0
            if not pressed.any():
                continue
            piece = np.searchsorted(self._levels[kind], ahead, side="right") - 1
            for number in range(piece.min(where=pressed, initial=len(self._levels[kind])), piece.max() + 1):
                here = pressed & (piece == number)
                if here.any():
                    begin = self._levels[kind, number]
                    np.copyto(values[..., m], law(ahead - begin, pieces(kind, number)), where=here)
        return values

    def _pieces_at(self, cycles: Array) -> Callable[[int, int], Array]:
        """Coefficients (4, K) of the pieces of each kind at some phases; the last ones are kept."""
        phases, kept = cycles.tobytes(), self._pieces
        pieces = kept.get(phases)
        if pieces is None:
            for old in list(kept)[: max(len(kept) + 1 - KEPT, 0)]:
                kept.pop(old, None)
            pieces = kept[phases] = _Pieces(self._coefficients, cycles)
        return pieces

    @cached_property
    def _pieces(self) -> dict[bytes, "_Pieces"]:
        return {}

    def mean(self) -> "LoadDependentLaw":
        """Mean forces and slopes at every level."""
        return self._mean

    @cached_property
    def _mean(self) -> "LoadDependentLaw":
        return self._changed(
            [(table.forces[..., :1], table.slopes[..., :1]) for table in self.tables], self.kind
        )

    def at_phase(self, cycle: float) -> "LoadDependentLaw":
        """The law of every kind at one phase."""
        at = np.array([cycle])
        held = []
        for table in self.tables:
            both = np.zeros((2, table.levels.size, 2, 1))
            both[..., 1, 0] = values_at(np.array([table.forces, table.slopes]), at)[0]
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


class _Pieces:
    """Coefficients (4, K) of cubics at K phases, of series (kinds, L, 4, 2, harmonics + 1), as asked for."""

    def __init__(self, series: Array, cycles: Array) -> None:
        angle = 2.0 * np.pi * np.outer(np.arange(series.shape[-1]), cycles)
        self.series, self.sine, self.cosine = series, np.sin(angle), np.cos(angle)
        self.kept: dict[tuple[int, int], Array] = {}

    def __call__(self, kind: int, number: int) -> Array:
        """Those of one piece of one kind."""
        if (kind, number) not in self.kept:
            own = self.series[kind, number]
            self.kept[kind, number] = own[:, 0] @ self.sine + own[:, 1] @ self.cosine
        return self.kept[kind, number]


def load_dependent_law(tables: Sequence[ForceTable]) -> LoadDependentLaw:
    """The law of contacts with a table each."""
    return LoadDependentLaw(tuple(tables), np.arange(len(tables)))


def _cubic(ahead: Array, coefficients: Array) -> Array:
    zeroth, first, second, third = coefficients
    return np.asarray(zeroth + ahead * (first + ahead * (second + ahead * third)))


def _cubic_slope(ahead: Array, coefficients: Array) -> Array:
    _, first, second, third = coefficients
    return np.asarray(first + ahead * (2.0 * second + 3.0 * ahead * third))


@lru_cache(maxsize=16)
def _columns(law: LoadDependentLaw) -> Any:
    """Coefficients (kinds, L, harmonics + 1, 2, 4) as compiled functions read them; shared, only read."""
    columns = aligned(*np.moveaxis(law._coefficients, (2, 3, 4), (4, 3, 2)).shape)
    columns[:] = np.moveaxis(law._coefficients, (2, 3, 4), (4, 3, 2))
    return columns
