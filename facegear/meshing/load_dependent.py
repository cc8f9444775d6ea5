"""The load-dependent law of all contacts of a machine, each with a table of forces of its kind."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from facegear._kernels import motion, samples
from facegear.arrays import Array, Integers
from facegear.meshing.force_table import LOOKS, ForceTable, amplitudes, hermite, slope_bounds, values_at
from facegear.meshing.law import LoadDependentHeld

MAX_PHASE_SETS = 2
"""Sets of phases at which the coefficients of the pieces are kept."""


class PiecewiseCubics:
    """Cubics of the compression in pieces, whose coefficients are Fourier series of the mesh phase.

    levels (kinds, L): compressions, m, at which the pieces begin; series (kinds, L, 4, 2, harmonics + 1):
    their coefficients by powers of the compression since the level, as `hermite` returns them.
    Coefficients at the MAX_PHASE_SETS sets of phases used last are cached in `cache`.
    """

    def __init__(self, levels: Array, series: Array) -> None:
        self.levels, self.series = levels, series
        self.cache: dict[bytes, _AtPhases] = {}

    def at(self, kind: Integers, cycles: Array, beyond: Array, slopes: bool = False) -> Array:
        """Return forces, or their derivatives by the compression, of M contacts.

        Parameters
        ----------
        kind : (M,) array of int
            Index of the kind of each contact.
        cycles : (K,) array
            Phases, mesh periods.
        beyond : (..., K, M) array
            Compression of the contacts, m; forces are odd in it.
        slopes : bool
            Whether slopes are returned instead of forces.

        Returns
        -------
        (..., K, M) array
            N, or N/m for slopes.
        """
        contacts = np.moveaxis(beyond, -1, 0)
        amounts = np.ascontiguousarray(contacts).reshape(len(kind), -1, len(cycles))
        deepest = np.abs(amounts).max(axis=(1, 2), initial=0.0)
        table = self._at_phases(cycles).down_to(kind.tolist(), deepest.tolist())
        values = np.empty(amounts.shape)
        samples.evaluate(self.levels, kind, table, amounts, slopes, values)
        return np.moveaxis(values.reshape(contacts.shape), 0, -1)

    def _at_phases(self, cycles: Array) -> "_AtPhases":
        """Return the coefficients at phases (K,), mesh periods, from a cache of at most MAX_PHASE_SETS
        sets.
        """
        phases, cache = cycles.tobytes(), self.cache
        at_phases = cache.get(phases)
        if at_phases is None:
            for old in list(cache)[: max(len(cache) + 1 - MAX_PHASE_SETS, 0)]:
                cache.pop(old, None)
            at_phases = cache[phases] = _AtPhases(self.levels, self.series, cycles)
        return at_phases


class _AtPhases:
    """Coefficients (kinds, L, K, 4) of the cubics at K phases, computed only down to the deepest piece
    needed.

    levels, series: as in `PiecewiseCubics`; cycles (K,): mesh periods; known_pieces: number of pieces of
    each kind whose coefficients are computed.
    """

    def __init__(self, levels: Array, series: Array, cycles: Array) -> None:
        angle = 2.0 * np.pi * np.outer(np.arange(series.shape[-1]), cycles)
        self.levels, self.series, self.sine, self.cosine = levels, series, np.sin(angle), np.cos(angle)
        self.coefficients = np.empty((*levels.shape, len(cycles), 4))
        self.known_pieces = [0] * len(levels)

    def down_to(self, of_contacts: Sequence[int], amounts: Sequence[float]) -> Array:
        """Return the coefficients (kinds, L, K, 4), after those of all pieces are computed that are
        needed.

        of_contacts: kind of each contact; amounts: largest compression of each contact, m. Deeper pieces
        may hold arbitrary numbers.
        """
        for kind, amount in zip(of_contacts, amounts, strict=True):
            pieces = int(np.searchsorted(self.levels[kind], amount, side="right")) if amount > 0.0 else 0
            for piece in range(self.known_pieces[kind], pieces):
                series = self.series[kind, piece]
                self.coefficients[kind, piece] = (series[:, 0] @ self.sine + series[:, 1] @ self.cosine).T
            self.known_pieces[kind] = max(self.known_pieces[kind], pieces)
        return self.coefficients


@dataclass(frozen=True, eq=False)
class LoadDependentLaw:
    """Law of M contacts by force tables of a few kinds.

    tables: force table of each kind, all with as many levels and harmonics; kind (M,): index of the table
    of each contact.
    """

    tables: tuple[ForceTable, ...]
    kind: Integers

    @property
    def contacts(self) -> int:
        """The number M of contacts."""
        return self.kind.size

    @property
    def breaks(self) -> Array:
        """Phases at which the law is not smooth: none, as Fourier series are smooth."""
        return np.zeros(0)

    @cached_property
    def levels(self) -> Array:
        """Compressions (L, M) at which the pieces begin, m."""
        return self._levels[self.kind].T

    @property
    def straight(self) -> bool:
        """Whether the force is linear in the deflection beyond the edge: it is cubic between levels."""
        return False

    @cached_property
    def steepest(self) -> Array:
        """Upper bound (M,) of the slope of each contact's force over phase and deflection, N/m."""
        return self._steepest[self.kind]

    @cached_property
    def harmonic_fractions(self) -> Array:
        """Amplitude of each order of the slope's bounds over `steepest`, (H + 1,): the largest of all
        kinds.
        """
        fractions = self._bound_sizes.max(axis=1) / np.maximum(self._steepest, 1e-300)[:, None]
        return np.asarray(fractions.max(axis=0))

    @cached_property
    def _steepest(self) -> Array:
        """Upper bound of the slope of each kind, (kinds,), N/m."""
        return np.asarray(self._bound_sizes.sum(axis=-1).max(axis=1))

    @cached_property
    def _bound_sizes(self) -> Array:
        """Amplitudes (kinds, 2 L - 1, harmonics + 1), N/m, of the series between whose extremes all
        slopes lie.
        """
        return amplitudes(slope_bounds(self._levels, self._coefficients))

    @cached_property
    def _levels(self) -> Array:
        """Levels of the compression of each kind, (kinds, L), m."""
        return np.array([table.levels for table in self.tables])

    @cached_property
    def _coefficients(self) -> Array:
        """Coefficients (kinds, L, 4, 2, harmonics + 1) of the cubics as `hermite` returns them, N/m^k for
        the power k.
        """
        forces, slopes = (
            np.array([getattr(table, name) for table in self.tables]) for name in ("forces", "slopes")
        )
        return hermite(self._levels, forces, slopes)

    def force(self, cycles: Array, beyond: Array) -> Array:
        """Return the forces of the contacts.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, M) array
            Compression of the contacts, m; negative on a back flank.

        Returns
        -------
        (..., K, M) array
            N.
        """
        return self._pieces.at(self.kind, cycles, beyond)

    def slope(self, cycles: Array, beyond: Array) -> Array:
        """Return the derivatives of the forces by the compressions.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, M) array
            Compression of the contacts, m; negative on a back flank.

        Returns
        -------
        (..., K, M) array
            N/m; zero where the compression is zero.
        """
        return self._pieces.at(self.kind, cycles, beyond, slopes=True)

    @cached_property
    def _pieces(self) -> PiecewiseCubics:
        """Cubics of all kinds, to be evaluated at phases and compressions, made once with their cache."""
        return PiecewiseCubics(self._levels, self._coefficients)

    def mean(self) -> "LoadDependentLaw":
        """Return the law with the mean forces and slopes at every level.

        Returns
        -------
        LoadDependentLaw
            A law that does not depend on the phase.
        """
        return self._mean

    @cached_property
    def _mean(self) -> "LoadDependentLaw":
        """Law of the mean forces and slopes over the phase at every level, made once."""
        return self._with_series(
            [(table.forces[..., :1], table.slopes[..., :1]) for table in self.tables], self.kind
        )

    def at_phase(self, cycle: float) -> "LoadDependentLaw":
        """Return the law of every kind at one phase.

        Parameters
        ----------
        cycle : float
            Mesh periods since the start.

        Returns
        -------
        LoadDependentLaw
            A law that does not depend on the phase.
        """
        at = np.array([cycle])
        series = []
        for table in self.tables:
            values = np.zeros((2, table.levels.size, 2, 1))
            values[..., 1, 0] = values_at(np.array([table.forces, table.slopes]), at)[0]
            series.append((values[0], values[1]))
        return self._with_series(series, self.kind)

    def _with_series(self, series: Sequence[tuple[Array, Array]], kind: Integers) -> "LoadDependentLaw":
        """Return a law with the same levels, whose tables have other series of forces and slopes, each
        (L, 2, orders); kind (M,): table of each contact.
        """
        tables = zip(self.tables, series, strict=True)
        return LoadDependentLaw(
            tuple(ForceTable(table.levels, *table_series) for table, table_series in tables), kind
        )

    def statics_law(self, cycles: Array) -> LoadDependentHeld:
        """Evaluate the law at some phases for statics.

        Parameters
        ----------
        cycles : Array
            Mesh periods since the start (K,), dimensionless.

        Returns
        -------
        LoadDependentHeld
            The law at these phases.
        """
        angle = 2.0 * np.pi * np.outer(cycles, np.arange(self._coefficients.shape[-1]))
        return LoadDependentHeld(
            np.repeat(self.steepest[None], cycles.size, axis=0),
            np.cos(angle),
            np.sin(angle),
            _columns(self),
            self._levels,
            self.kind,
        )

    @property
    def numbers(self) -> dict[str, Any]:
        """Arguments of motion.load_dependent_law: table (`_columns`), levels (kinds, L) in m, kind
        (M,).
        """
        kind = np.ascontiguousarray(self.kind, np.int64)
        return {"table": _columns(self), "levels": self._levels, "kind": kind}

    @cached_property
    def kernel_law(self) -> motion.LoadDependentLaw:
        """The law as the integrator's kernels take it, made once."""
        return motion.load_dependent_law(**self.numbers)


def load_dependent_law(tables: Sequence[ForceTable]) -> LoadDependentLaw:
    """Return the law of contacts with a table each; every contact is a kind of its own, even where tables
    are equal.

    Parameters
    ----------
    tables : Sequence of ForceTable
        Table of each contact, all with as many levels and harmonics.

    Returns
    -------
    LoadDependentLaw
        N and N/m.
    """
    return LoadDependentLaw(tuple(tables), np.arange(len(tables)))


@lru_cache(maxsize=16)
def _columns(law: LoadDependentLaw) -> Array:
    """Return coefficients (kinds, L, harmonics + 1, 2, 4) of the cubics in the order of axes that
    compiled functions read; the array is shared and must not be changed.
    """
    return np.ascontiguousarray(np.moveaxis(law._coefficients, (2, 3, 4), (4, 3, 2)))


PARTS = 2
"""Pieces that one piece becomes behind a spring: cubics are no longer exact, and finer ones are nearer."""
HALVINGS, NEWTON = 12, 5
"""Steps towards a root, by halving an interval and by Newton's method."""


def soften_table(table: ForceTable, compliance: float) -> ForceTable:
    """Return the force table of a contact in series with a spring, over the compression of both together.

    At every phase x + compliance F(x) = level is solved for the compression x of the contact. Levels are
    those of the mean force, each piece divided in PARTS, and the last level is that of the largest force,
    so that all of the table is inside. Forces and slopes there hold at every phase, but for harmonics
    above the table's own.

    Parameters
    ----------
    table : ForceTable
        Force table.
    compliance : float
        Compliance of the spring, m/N.

    Returns
    -------
    ForceTable
        The same table for a compliance of 0; levels in m, forces in N.
    """
    if compliance == 0.0:
        return table
    law, orders = load_dependent_law([table]), table.forces.shape[2]
    phases = np.arange(LOOKS * orders) / (LOOKS * orders)
    spacing = np.diff(table.levels)[:, None] / PARTS
    level_compressions = np.append(
        (table.levels[:-1, None] + spacing * np.arange(PARTS)).ravel(), table.levels[-1]
    )
    mean = law.mean().force(np.zeros(1), level_compressions[:, None, None])[:, 0, 0]
    levels = level_compressions + compliance * mean
    levels[-1] = (
        level_compressions[-1]
        + compliance * law.force(phases, np.full((phases.size, 1), level_compressions[-1])).max()
    )
    low = np.zeros((levels.size, phases.size))
    high = np.repeat(levels[:, None], phases.size, axis=1)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        short = middle + compliance * law.force(phases, middle[..., None])[..., 0] < levels[:, None]
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    compression = 0.5 * (low + high)
    for _ in range(NEWTON):
        residual = (
            levels[:, None] - compression - compliance * law.force(phases, compression[..., None])[..., 0]
        )
        slope = law.slope(phases, compression[..., None])[..., 0]
        compression = np.clip(compression + residual / (1.0 + compliance * np.maximum(slope, 0.0)), low, high)
    compression[0] = 0.0
    forces = law.force(phases, compression[..., None])[..., 0]
    # At the edge itself, where nothing is pressed in, a law counts no slope.
    slopes = law.slope(phases, np.maximum(compression, np.finfo(float).tiny)[..., None])[..., 0]
    return ForceTable(levels, _series(forces, orders), _series(slopes / (1.0 + compliance * slopes), orders))


def _series(values: Array, orders: int) -> Array:
    """Return Fourier series (A, 2, orders), sine part first, of values (A, K) at evenly spaced phases,
    cut to orders 0 to orders - 1; in the unit of the values.
    """
    spectrum = np.fft.rfft(values, axis=1)[:, :orders] / values.shape[1]
    spectrum[:, 1:] *= 2.0
    return np.stack([-spectrum.imag, spectrum.real], axis=1)
