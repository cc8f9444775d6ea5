"""Interpolate values between solved torques, by power laws of the torque."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers

SMALLEST, LARGEST = 1.0 / 3.0, 1.0
"""Exponents that a stress can have: pressure of a point contact, and a linear one."""
FALLS = 0.1
"""Decrease of the exponent below the solved torques, dimensionless: it falls with the load, by 0.05 from 800
to 450 N m on the paper's pair, so that stress at small torques would be underestimated."""


@dataclass(frozen=True, eq=False)
class Scale:
    """Rule by which values at the torques `torques` (t,), N m, rising, continue to others.

    `exponents` (t + 1,): below the first torque, between each two neighbours, beyond the last.
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
    """Derive the exponents from largest values, between SMALLEST and LARGEST.

    Below the first torque the exponent is FALLS less than that of the first two torques.

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
