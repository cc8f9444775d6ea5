"""Forces and slopes of one contact over its compression, with Fourier series over the phase.

Between two levels of the compression the force is the cubic that has force and slope of the table at both
(Hermite), at every phase; so are its coefficients Fourier series. Beyond the last level it goes on straight.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from facegear.arrays import Array

LOOKS = 8
"""Phases for each harmonic at which slopes are checked."""


@dataclass(frozen=True, eq=False)
class ForceTable:
    """Forces and slopes of one contact at L levels of its compression.

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
        """Coefficients (L, 4, 2, harmonics + 1) of the cubics, N/m^k for the power k = 0 to 3, by powers
        of the compression beyond the level at which each piece begins; beyond the last level the square
        and cube are 0.
        """
        return hermite(self.levels, self.forces, self.slopes)

    @cached_property
    def bounds(self) -> Array:
        """Series (2 L - 1, 2, harmonics + 1), N/m, between whose extremes all slopes lie; see
        `slope_bounds`.
        """
        return slope_bounds(self.levels, self.coefficients)

    @cached_property
    def steepest(self) -> float:
        """Upper bound of the slope over phase and compression, N/m: the largest sum of amplitudes among
        `bounds`.
        """
        return float(amplitudes(self.bounds).sum(axis=-1).max())

    @cached_property
    def min_slope(self) -> float:
        """Smallest slope of the force over compression, N/m, sampled at LOOKS phases for each harmonic
        and at LOOKS + 1 even compressions in each piece.
        """
        count = LOOKS * self.forces.shape[2]
        values = values_at(self.coefficients[:, 1:], np.arange(count) / count)
        first, second, third = np.moveaxis(values, 2, 0)[:, :, None]
        amounts = np.linspace(0.0, 1.0, LOOKS + 1)[:, None] * np.append(np.diff(self.levels), 0.0)
        return float((first + amounts * (2.0 * second + 3.0 * amounts * third)).min())

    def mirror(self) -> "ForceTable":
        """Return the table of a contact that goes through the phases the other way round.

        Returns
        -------
        ForceTable
            The same levels, N and N/m.
        """
        sign = np.array([-1.0, 1.0])[:, None]
        return ForceTable(self.levels, sign * self.forces, sign * self.slopes)

    def scale(self, factor: float) -> "ForceTable":
        """Return the table with forces and slopes times a factor.

        Parameters
        ----------
        factor : float
            The factor, dimensionless.

        Returns
        -------
        ForceTable
            The same levels, N and N/m.
        """
        return ForceTable(self.levels, factor * self.forces, factor * self.slopes)


def shift_tables(tables: Sequence[ForceTable], cycles: Sequence[float]) -> list[ForceTable]:
    """Return the tables of contacts whose force comes later by some mesh periods each: f(phase - lag).

    Parameters
    ----------
    tables : Sequence of ForceTable
        One table for each contact, all with as many levels and harmonics.
    cycles : Sequence of float
        Lag of each contact, mesh periods.

    Returns
    -------
    list of ForceTable
        One table for each contact, N and N/m.
    """
    series = np.array([[table.forces, table.slopes] for table in tables])
    angle = 2.0 * np.pi * np.multiply.outer(cycles, np.arange(series.shape[-1]))[:, None, None]
    cosine, sine = np.cos(angle), np.sin(angle)
    a, b = series[..., 0, :], series[..., 1, :]
    later = np.stack([a * cosine + b * sine, b * cosine - a * sine], axis=-2)
    return [ForceTable(table.levels, *series) for table, series in zip(tables, later, strict=True)]


def hermite(levels: Array, forces: Array, slopes: Array) -> Array:
    """Return the coefficients of cubics with given forces and slopes at levels.

    Parameters
    ----------
    levels : (..., L) array
        Levels, m.
    forces : (..., L, 2, harmonics + 1) array
        Series of the forces, N.
    slopes : (..., L, 2, harmonics + 1) array
        Series of the slopes, N/m.

    Returns
    -------
    (..., L, 4, 2, harmonics + 1) array
        N/m^k for the power k = 0 to 3.
    """
    spacing = np.diff(levels)[..., None, None]
    rise = np.diff(forces, axis=-3) / spacing
    begin, end = slopes[..., :-1, :, :], slopes[..., 1:, :, :]
    values = np.zeros((*forces.shape[:-2], 4, *forces.shape[-2:]))
    values[..., 0, :, :], values[..., 1, :, :] = forces, slopes
    values[..., :-1, 2, :, :] = (3.0 * rise - 2.0 * begin - end) / spacing
    values[..., :-1, 3, :, :] = (begin + end - 2.0 * rise) / spacing**2
    return values


def slope_bounds(levels: Array, coefficients: Array) -> Array:
    """Return the series between whose extremes all slopes lie.

    They are the slopes at the levels, and between two of them the middle coefficient of the slope in
    Bernstein form.

    Parameters
    ----------
    levels : (..., L) array
        Levels, m.
    coefficients : (..., L, 4, 2, harmonics + 1) array
        Coefficients of `hermite`, N/m^k for the power k.

    Returns
    -------
    (..., 2 L - 1, 2, harmonics + 1) array
        N/m.
    """
    spacing, slopes = np.diff(levels)[..., None, None], coefficients[..., 1, :, :]
    middle = slopes[..., :-1, :, :] + spacing * coefficients[..., :-1, 2, :, :]
    return np.concatenate([slopes, middle], axis=-3)


def amplitudes(series: Array) -> Array:
    """Return the amplitudes of Fourier series.

    Parameters
    ----------
    series : (..., 2, harmonics + 1) array
        Sine part first, any unit.

    Returns
    -------
    (..., harmonics + 1) array
        In the same unit.
    """
    return np.asarray(np.hypot(series[..., 0, :], series[..., 1, :]))


def values_at(series: Array, cycles: Array) -> Array:
    """Return the values of Fourier series at phases.

    Parameters
    ----------
    series : (..., 2, harmonics + 1) array
        Sine part first, any unit.
    cycles : (K,) array
        Phases, mesh periods.

    Returns
    -------
    (K, ...) array
        In the same unit.
    """
    angle = 2.0 * np.pi * np.outer(cycles, np.arange(series.shape[-1]))
    return np.asarray(
        np.tensordot(np.sin(angle), series[..., 0, :], axes=(1, -1))
        + np.tensordot(np.cos(angle), series[..., 1, :], axes=(1, -1))
    )
