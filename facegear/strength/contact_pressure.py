"""Pressure, load on tip edges and in fillets at any torque, from the contact analysis."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from facegear.arrays import Array, Integers, Mask

if TYPE_CHECKING:
    import pandas as pd

SMALLEST, LARGEST = 1.0 / 3.0, 1.0
"""Exponents that a stress can have: pressure of a point contact, and a linear one."""
FALLS = 0.1
"""Decrease of the exponent below the solved torques, dimensionless: it falls with the load, by 0.05 from 800
to 450 N m on the paper's pair, so that stress at small torques would be underestimated."""


@dataclass(frozen=True, eq=False)
class Scale:
    """Rule by which values at the torques `torques` (t,), N m, rising, continue to others.

    `exponents` (t + 1,), dimensionless: power of the torque that values go with below the first torque,
    between each two neighbours, and beyond the last.
    """

    torques: Array
    exponents: Array

    def parts(self, torque: Array) -> tuple[Integers, Array, Array]:
        """Return the rows and factors that interpolate values.

        Values go in proportion to a power of the torque from both rows, weighted by the logarithm of the
        torque: exact where values have that exponent.

        Parameters
        ----------
        torque : (n,) array
            Torques, N m.

        Returns
        -------
        (n,) array of int, (n,) array, (n,) array
            Rows i, and dimensionless factors of rows i and i + 1 whose sum is the value. Below the first
            torque and beyond the last the second factor is 0.
        """
        count = self.torques.size
        row = np.searchsorted(self.torques, torque, side="right")
        low, high = np.maximum(row - 1, 0), np.minimum(row, count - 1)
        power, first, last = self.exponents[row], self.torques[low], self.torques[high]
        inside = (row > 0) & (row < count)
        step = np.where(inside, np.log(last / first), 1.0)
        part = np.where(inside, np.log(np.where(inside, torque, first) / first) / step, 0.0)
        return low, (1.0 - part) * (torque / first) ** power, part * (torque / last) ** power

    def at(self, values: Array, torque: float) -> Array:
        """Interpolate values at a torque.

        Parameters
        ----------
        values : (t, ...) array
            Values at the solved torques, in any unit.
        torque : float
            Torque, N m.

        Returns
        -------
        (...) array
            Values at that torque, in their unit.
        """
        (row,), (below,), (above,) = self.parts(np.array([torque]))
        return np.asarray(below * values[row] + (above * values[row + 1] if above > 0.0 else 0.0))

    def is_solved(self, torque: float) -> bool:
        """Whether a torque lies within those solved, or is 0.

        Parameters
        ----------
        torque : float
            Torque, N m.

        Returns
        -------
        bool
            True from the first to the last solved torque, and for 0.
        """
        return bool(torque == 0.0 or self.torques[0] <= torque <= self.torques[-1])


def scale(torques: Array, largest: Array, lone: float, beyond: float) -> Scale:
    """Derive the exponents of torque from largest values: d log value / d log torque between neighbours.

    They are clipped to SMALLEST and LARGEST. Below the first torque the exponent is FALLS less than that
    of the first two torques, but not below SMALLEST.

    Parameters
    ----------
    torques : (t,) array
        Solved torques, rising, N m.
    largest : (t,) array
        Largest value at each torque, in any unit.
    lone : float
        Exponent below the first torque where one torque alone was solved, dimensionless.
    beyond : float
        Exponent above the last torque, dimensionless.

    Returns
    -------
    Scale
        The rule of interpolation.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        exponents = np.diff(np.log(largest)) / np.diff(np.log(torques))
    between = np.clip(
        np.nan_to_num(exponents, nan=LARGEST, posinf=LARGEST, neginf=LARGEST), SMALLEST, LARGEST
    )
    below = max(between[0] - FALLS, SMALLEST) if between.size else lone
    return Scale(torques, np.concatenate([[below], between, [beyond]]))


@dataclass(frozen=True, eq=False)
class ContactPressure:
    """Largest values over a pitch at t torques (N m), all (t,).

    `pressure` and its `error` (Pa), away from edges; nan where edges carry all. `edge_load` (N/m) along tip
    edges and `edge_length` (m) that carries any: pressure there has no limit. `fillet_share` of the torque
    that fillets carry, which is left out of pressure and root stress.
    """

    torques: Array
    pressure: Array
    error: Array
    edge_load: Array
    edge_length: Array
    fillet_share: Array

    @property
    def is_known(self) -> bool:
        """Whether a pressure away from edges is known at any torque."""
        return bool(np.isfinite(self.pressure).any())

    def at(self, torque: float) -> float:
        """Interpolate the pressure at a torque.

        A power of the torque between those solved and below them; beyond them its square root, as in line
        contact.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.

        Returns
        -------
        float
            Pressure away from edges, Pa; nan where none is known.
        """
        if not self.is_known:
            return np.nan
        on = np.isfinite(self.pressure)
        growth = scale(self.torques[on], self.pressure[on], SMALLEST, 0.5)
        return float(growth.at(self.pressure[on], torque))

    def within(self, torque: Array) -> Mask:
        """Whether torques lie within those solved.

        Parameters
        ----------
        torque : (n,) array
            Torques on the pinion, N m.

        Returns
        -------
        (n,) array of bool
            True from the first to the last solved torque.
        """
        return (torque >= self.torques[0]) & (torque <= self.torques[-1])

    def error_at(self, torque: float) -> float:
        """Interpolate the error of the pressure at a torque.

        The relative error is linear between the torques solved.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.

        Returns
        -------
        float
            Error of `at`, Pa.
        """
        on = np.isfinite(self.pressure)
        relative = self.error[on] / self.pressure[on]
        return self.at(torque) * float(np.interp(torque, self.torques[on], relative))

    def edge_at(self, torque: float) -> tuple[float, float]:
        """Interpolate the load on tip edges at a torque.

        The load goes as a power of the torque between those solved and below them, and in proportion beyond;
        the length is linear between them and constant beyond.

        Parameters
        ----------
        torque : float
            Torque on the pinion, N m.

        Returns
        -------
        float, float
            Line load on tip edges, N/m, and the length of them that carries any, m.
        """
        growth = scale(self.torques, self.edge_load, 0.5, 1.0)
        length = np.interp(torque, np.append(0.0, self.torques), np.append(0.0, self.edge_length))
        return float(growth.at(self.edge_load, torque)), float(length)

    def fillet_at(self, torque: Array) -> Array:
        """Interpolate the share of the torque that fillets carry.

        Linear between the torques solved, constant outside them.

        Parameters
        ----------
        torque : (n,) array
            Torques on the pinion, N m.

        Returns
        -------
        (n,) array
            Share of each torque, 0 to 1.
        """
        return np.interp(torque, self.torques, self.fillet_share)


def contact_pressure(by_torque: "pd.DataFrame") -> ContactPressure:
    """Read the contact pressure from the table by torque of stage contact.

    Parameters
    ----------
    by_torque : DataFrame
        Columns torque_n_m, pressure_mpa, pressure_error_mpa, tip_line_load_n_per_mm, tip_length_mm and
        fillet_share; rows by rising torque.

    Returns
    -------
    ContactPressure
        The same values in SI units.
    """
    scales = {
        "torque_n_m": 1.0,
        "pressure_mpa": 1e6,
        "pressure_error_mpa": 1e6,
        "tip_line_load_n_per_mm": 1e3,
        "tip_length_mm": 1e-3,
        "fillet_share": 1.0,
    }
    return ContactPressure(*(scale * by_torque[name].to_numpy(float) for name, scale in scales.items()))


@dataclass(frozen=True, eq=False)
class FlankAnswers:
    """Largest values over a pitch of the contact of one flank.

    `arm` (m) is the torque on the pinion over the force along the flank's normal; `pressure` is on the flank;
    `roots`, Pa in the fillets by body at a torque (N m), where they carry gauges.
    """

    arm: float
    pressure: ContactPressure
    roots: Mapping[str, Callable[[float], float]]


@dataclass(frozen=True, eq=False)
class PairAnswers:
    """Answers of the contact of a pair.

    `error` (p,) m: the loaded transmission error of the upper gear's drive flank at evenly spaced positions
    under the operating load; `flanks`: the contacts that differ, that of this flank first; `numbers` (2, 2):
    number of the contact of each gear (upper, lower) and flank (drive, back).
    """

    error: Array
    flanks: tuple[FlankAnswers, ...]
    numbers: Integers

    @property
    def error_range(self) -> float:
        """Peak-to-peak transmission error at the operating load, m: of the positions solved."""
        return float(np.ptp(self.error))

    @property
    def error_harmonic(self) -> float:
        """Amplitude of the transmission error at mesh frequency, m."""
        return float(2.0 * np.abs(np.fft.rfft(self.error)[1]) / self.error.size)
