"""Cubics in pieces at many amounts, whose coefficients are periodic series of the phase."""

from collections.abc import Sequence

import numpy as np

from facegear._kernels import samples
from facegear.arrays import Array, Integers

KEPT = 2
"""Sets of phases at which the coefficients of the pieces are kept."""


class PiecewiseCubics:
    """Cubics of some kinds: levels (kinds, L) where their pieces begin, series (kinds, L, 4, 2, harmonics +
    1) of the coefficients, which are kept for the phases that were asked for last.
    """

    def __init__(self, levels: Array, series: Array) -> None:
        self.levels, self.series = levels, series
        self.kept: dict[bytes, _AtPhases] = {}

    def at(self, kind: Integers, cycles: Array, beyond: Array, slopes: bool = False) -> Array:
        """Values, or slopes, (..., K, M) of contacts of some kinds at amounts (..., K, M) and phases (K,)."""
        contacts = np.moveaxis(beyond, -1, 0)
        amounts = np.ascontiguousarray(contacts).reshape(len(kind), -1, len(cycles))
        deepest = np.abs(amounts).max(axis=(1, 2), initial=0.0)
        table = self._at_phases(cycles).down_to(kind.tolist(), deepest.tolist())
        values = np.empty(amounts.shape)
        samples.evaluate(self.levels, kind, table, amounts, slopes, values)
        return np.moveaxis(values.reshape(contacts.shape), 0, -1)

    def _at_phases(self, cycles: Array) -> "_AtPhases":
        phases, kept = cycles.tobytes(), self.kept
        at_phases = kept.get(phases)
        if at_phases is None:
            for old in list(kept)[: max(len(kept) + 1 - KEPT, 0)]:
                kept.pop(old, None)
            at_phases = kept[phases] = _AtPhases(self.levels, self.series, cycles)
        return at_phases


class _AtPhases:
    """Coefficients (kinds, L, K, 4) at K phases, of each kind down to the deepest piece asked for."""

    def __init__(self, levels: Array, series: Array, cycles: Array) -> None:
        angle = 2.0 * np.pi * np.outer(np.arange(series.shape[-1]), cycles)
        self.levels, self.series, self.sine, self.cosine = levels, series, np.sin(angle), np.cos(angle)
        self.coefficients = np.empty((*levels.shape, len(cycles), 4))
        self.known = [0] * len(levels)

    def down_to(self, of_contacts: Sequence[int], amounts: Sequence[float]) -> Array:
        """All coefficients, of which those are known that contacts of these kinds meet up to some amounts."""
        for kind, amount in zip(of_contacts, amounts, strict=True):
            pieces = int(np.searchsorted(self.levels[kind], amount, side="right")) if amount > 0.0 else 0
            for piece in range(self.known[kind], pieces):
                own = self.series[kind, piece]
                self.coefficients[kind, piece] = (own[:, 0] @ self.sine + own[:, 1] @ self.cosine).T
            self.known[kind] = max(self.known[kind], pieces)
        return self.coefficients
