"""The linear law: a stiffness that depends on the phase, times the compression."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from facegear._kernels import motion
from facegear.arrays import Array, Integers
from facegear.harmonics import Harmonics, stack_series, stacked_values
from facegear.meshing.law import LinearHeld


@dataclass(frozen=True, eq=False)
class Piecewise:
    """Periodic function of the phase that is added to the Fourier part of a stiffness, N/m.

    breaks (pieces + 1,) rising from 0 to 1, mesh periods; coefficients (pieces, degree + 1): polynomial
    of each piece in the mesh periods since its break, ascending powers, N/m.
    """

    breaks: Array
    coefficients: Array

    def __call__(self, cycles: Array) -> Array:
        """Return the added stiffness (K,), N/m, at phases (K,) in [0, 1)."""
        index = np.searchsorted(self.breaks, cycles, side="right") - 1
        powers = np.vander(cycles - self.breaks[index], self.coefficients.shape[1], True)
        return np.asarray((self.coefficients[index] * powers).sum(1))

    @property
    def mean(self) -> float:
        """Mean of the added stiffness over the mesh period, N/m."""
        widths = np.diff(self.breaks)[:, None] ** np.arange(1, self.coefficients.shape[1] + 1)
        return float((self.coefficients * widths / np.arange(1, widths.shape[1] + 1)).sum())


@dataclass(frozen=True, eq=False)
class LinearLaw:
    """Force k(phase) times compression, of M contacts of a few kinds, each with one stiffness series.

    Attributes
    ----------
    fourier : (kinds, 2, harmonics + 1)
        Series of k of each kind, sine part first, N/m.
    kind : (M,)
        Row of `fourier` that each contact has.
    pieces
        Function that is added to the series of each kind, one for each; or none at all.
    """

    fourier: Array
    kind: Integers
    pieces: tuple[Piecewise, ...] = field(default=())

    @property
    def contacts(self) -> int:
        """The number M of contacts."""
        return self.kind.size

    @property
    def breaks(self) -> Array:
        """Phases in mesh periods, rising from 0 to 1, at which pieces of any kind begin and end; (0,)
        without pieces.
        """
        if not self.pieces:
            return np.zeros(0)
        return np.unique(np.concatenate([piece.breaks for piece in self.pieces]))

    @cached_property
    def levels(self) -> Array:
        """Compressions (1, M), m, at which the law's pieces begin: the edge of contact, 0, alone."""
        return np.zeros((1, self.contacts))

    @property
    def straight(self) -> bool:
        """Whether the force is linear in the deflection beyond the edge: always."""
        return True

    @property
    def steepest(self) -> Array:
        """Upper bound (M,) of the stiffness of each contact over the phase: sum of its amplitudes, N/m."""
        return self._bounds[self.kind]

    @property
    def harmonic_fractions(self) -> Array:
        """Amplitude of each order of k over `steepest`, (H + 1,): the largest of all kinds."""
        bounds = np.maximum(self._bounds, 1e-300)
        return np.asarray((self._amplitudes / bounds[:, None]).max(axis=0))

    @property
    def _amplitudes(self) -> Array:
        """Amplitude of each order of the stiffness series of each kind, (kinds, harmonics + 1), N/m."""
        return np.hypot(self.fourier[:, 0], self.fourier[:, 1])

    @property
    def _bounds(self) -> Array:
        """Upper bound of the stiffness of each kind, (kinds,), N/m: sum of the amplitudes, plus the
        largest sum of coefficients of any added pieces.
        """
        pieces = np.array([np.abs(piece.coefficients).sum() for piece in self.pieces] or [0.0])
        return np.asarray(self._amplitudes.sum(axis=1) + pieces)

    @cached_property
    def _constant(self) -> Array | None:
        """Stiffness k (M,), N/m, where it does not depend on the phase, else None."""
        alone = self.fourier.shape[2] == 1 and not self.pieces
        return self.fourier[self.kind, 1, 0] if alone else None

    def stiffness(self, cycles: Array) -> Array:
        """Return the stiffness k at phases.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.

        Returns
        -------
        (K, M) array
            N/m.
        """
        if self._constant is not None:
            return np.repeat(self._constant[None], cycles.size, axis=0)
        values = stacked_values(self.fourier, cycles)
        for kind, piece in enumerate(self.pieces):
            values[:, kind] += piece(np.mod(cycles, 1.0))
        return values[:, self.kind]

    def force(self, cycles: Array, beyond: Array) -> Array:
        """Return k times the compressions.

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
        return beyond * (self.stiffness(cycles) if self._constant is None else self._constant)

    def slope(self, cycles: Array, beyond: Array) -> Array:
        """Return k where the compression is not zero, 0 elsewhere.

        Parameters
        ----------
        cycles : (K,) array
            Mesh periods since the start.
        beyond : (..., K, M) array
            Compression of the contacts, m; negative on a back flank.

        Returns
        -------
        (..., K, M) array
            N/m.
        """
        stiffness = self.stiffness(cycles) if self._constant is None else self._constant
        return np.where(beyond != 0.0, stiffness, 0.0)

    def mean(self) -> "LinearLaw":
        """Return the law with the mean stiffness.

        Returns
        -------
        LinearLaw
            A law that does not depend on the phase, N/m.
        """
        fourier = self.fourier[:, :, :1].copy()
        if self.pieces:
            fourier[:, 1, 0] += [piece.mean for piece in self.pieces]
        return LinearLaw(fourier, self.kind)

    def at_phase(self, cycle: float) -> "LinearLaw":
        """Return the law with k at one phase.

        Parameters
        ----------
        cycle : float
            Mesh periods since the start.

        Returns
        -------
        LinearLaw
            A law that does not depend on the phase, N/m.
        """
        fourier = np.zeros((self.contacts, 2, 1))
        fourier[:, 1, 0] = self.stiffness(np.array([cycle]))[0]
        return LinearLaw(fourier, np.arange(self.contacts))

    def statics_law(self, cycles: Array) -> LinearHeld:
        """Evaluate the stiffness at some phases for statics.

        Parameters
        ----------
        cycles : Array
            Mesh periods since the start (K,), dimensionless.

        Returns
        -------
        LinearHeld
            Stiffness (K, M), N/m.
        """
        return LinearHeld(self.stiffness(cycles))

    @property
    def numbers(self) -> dict[str, Any]:
        """Arguments of motion.linear_law: fourier, kind, breaks (rad), and pieces as `_pieces` returns
        them.
        """
        return {
            "fourier": np.ascontiguousarray(self.fourier, dtype=float),
            "kind": np.ascontiguousarray(self.kind, np.int64),
            "breaks": 2.0 * np.pi * self.breaks,
            "pieces": _pieces(self),
        }

    @cached_property
    def kernel_law(self) -> motion.LinearLaw:
        """The law as the integrator's kernels take it, made once."""
        return motion.linear_law(**self.numbers)


def linear_law(series: Sequence[Harmonics]) -> LinearLaw:
    """Return the linear law of contacts with a stiffness series each; equal series make one kind.

    Parameters
    ----------
    series : Sequence of Harmonics
        Stiffness of each contact, N/m.

    Returns
    -------
    LinearLaw
        N/m.
    """
    fourier, kind = different(series)
    return LinearLaw(fourier, kind)


def different(series: Sequence[Harmonics]) -> tuple[Array, Integers]:
    """Return the different ones among Fourier series, and the kind of each.

    Parameters
    ----------
    series : Sequence of Harmonics
        Series in any unit.

    Returns
    -------
    tuple of (kinds, 2, harmonics + 1) array and (series,) array of int
        Different series in the same unit, and index of the kind.
    """
    rows = stack_series(series)
    distinct, kind = np.unique(rows.reshape(len(rows), -1), axis=0, return_inverse=True)
    return distinct.reshape(-1, *rows.shape[1:]), kind.ravel().astype(np.int64)


def _pieces(law: LinearLaw) -> Array:
    """Return the coefficients of the pieces of each contact between the breaks of all kinds.

    The shape is (pieces, degree + 1, M); N/m, in ascending powers of the phase in rad since the piece's
    break.
    """
    if not law.pieces:
        return np.zeros((0, 0, law.contacts))
    breaks = law.breaks
    degree = max(piece.coefficients.shape[1] for piece in law.pieces)
    table = np.zeros((breaks.size - 1, degree, law.contacts))
    for contact, kind in enumerate(law.kind):
        piece = law.pieces[kind]
        for row, start in zip(table, breaks[:-1], strict=True):
            source = int(np.searchsorted(piece.breaks, start, side="right")) - 1
            ahead = np.polynomial.Polynomial([start - piece.breaks[source], 1.0])
            shifted_coefficients = np.asarray(
                np.polynomial.Polynomial(piece.coefficients[source])(ahead).coef, float
            )
            row[: shifted_coefficients.size, contact] = shifted_coefficients / (2.0 * np.pi) ** np.arange(
                shifted_coefficients.size
            )
    return table
