"""The load-dependent law of all contacts of a machine, each with a table of forces of its kind."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array, Integers
from facegear.mesh_law.force_table import ForceTable, amplitudes, hermite, slope_bounds, values_at
from facegear.mesh_law.laws_at_phases import LoadDependentHeld
from facegear.mesh_law.piecewise_cubics import PiecewiseCubics


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
        """Return the derivatives of the forces by the amounts.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, M) array
            Compression of the contacts, m; negative on a back flank.

        Returns
        -------
        (..., K, M) array
            N/m; zero where nothing is pressed in.
        """
        return self._pieces.at(self.kind, cycles, beyond, slopes=True)

    @cached_property
    def _pieces(self) -> PiecewiseCubics:
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
        """Its numbers as the integrator takes them."""
        kind = np.ascontiguousarray(self.kind, np.int64)
        return {"table": _columns(self), "levels": self._levels, "kind": kind}

    @cached_property
    def kernel_law(self) -> motion.LoadDependentLaw:
        """The law as the integrator's kernels take it."""
        return motion.load_dependent_law(**self.numbers)


def load_dependent_law(tables: Sequence[ForceTable]) -> LoadDependentLaw:
    """Return the law of contacts with a table each.

    Parameters
    ----------
    tables : Sequence of ForceTable
        Table of each contact.

    Returns
    -------
    LoadDependentLaw
        N and N/m.
    """
    return LoadDependentLaw(tuple(tables), np.arange(len(tables)))


@lru_cache(maxsize=16)
def _columns(law: LoadDependentLaw) -> Array:
    """Coefficients (kinds, L, harmonics + 1, 2, 4) as compiled functions read them; shared, only read."""
    return np.ascontiguousarray(np.moveaxis(law._coefficients, (2, 3, 4), (4, 3, 2)))
