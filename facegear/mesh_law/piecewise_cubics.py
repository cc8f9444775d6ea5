"""Cubics in pieces at many amounts, whose coefficients are periodic series of the phase."""

from collections.abc import Sequence

import numpy as np

from facegear._kernels import samples
from facegear.arrays import Array, Integers

MAX_PHASE_SETS = 2
"""Sets of phases at which the coefficients of the pieces are kept."""


class PiecewiseCubics:
    """Cubics of some kinds in pieces, whose coefficients are periodic series of the phase.

    Levels (kinds, L), at which the pieces begin, and series (kinds, L, 4, 2, harmonics + 1) of the
    coefficients. Coefficients at the phases that were used last are cached.
    """

    def __init__(self, levels: Array, series: Array) -> None:
        self.levels, self.series = levels, series
        self.cache: dict[bytes, _AtPhases] = {}

    def at(self, kind: Integers, cycles: Array, beyond: Array, slopes: bool = False) -> Array:
        """Return values, or slopes, of contacts of some kinds.

        Parameters
        ----------
        kind : (M,) array of int
            Index of the kind of each contact.
        cycles : (K,) array
            Phases, mesh periods.
        beyond : (..., K, M) array
            Amounts, m.
        slopes : bool
            Whether slopes are returned instead of values.

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
        phases, cache = cycles.tobytes(), self.cache
        at_phases = cache.get(phases)
        if at_phases is None:
            for old in list(cache)[: max(len(cache) + 1 - MAX_PHASE_SETS, 0)]:
                cache.pop(old, None)
            at_phases = cache[phases] = _AtPhases(self.levels, self.series, cycles)
        return at_phases


class _AtPhases:
    """Coefficients (kinds, L, K, 4) at K phases, of each kind down to the deepest piece asked for."""

    def __init__(self, levels: Array, series: Array, cycles: Array) -> None:
        angle = 2.0 * np.pi * np.outer(np.arange(series.shape[-1]), cycles)
        self.levels, self.series, self.sine, self.cosine = levels, series, np.sin(angle), np.cos(angle)
        self.coefficients = np.empty((*levels.shape, len(cycles), 4))
        self.known_pieces = [0] * len(levels)

    def down_to(self, of_contacts: Sequence[int], amounts: Sequence[float]) -> Array:
        """Return all coefficients, of which those are known that contacts of these kinds meet up to some
        amounts.
        """
        for kind, amount in zip(of_contacts, amounts, strict=True):
            pieces = int(np.searchsorted(self.levels[kind], amount, side="right")) if amount > 0.0 else 0
            for piece in range(self.known_pieces[kind], pieces):
                series = self.series[kind, piece]
                self.coefficients[kind, piece] = (series[:, 0] @ self.sine + series[:, 1] @ self.cosine).T
            self.known_pieces[kind] = max(self.known_pieces[kind], pieces)
        return self.coefficients
