"""Values solved at some torques, taken to others: power laws of the torque between those solved."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array, Integers

SMALLEST, LARGEST = 1.0 / 3.0, 1.0
"""Exponents that a stress can have: pressure of a point contact, and a linear one."""
FALLS = 0.1
"""What the exponent is less below the torques solved: it falls with the load, by 0.05 from 800 to 450 N m on
the paper's pair, so that stress at small torques would be taken for less than it is."""


@dataclass(frozen=True, eq=False)
class Scale:
    """How values at the torques `torques` (t,), N m, rising, go on to others.

    `exponents` (t + 1,): below the first torque, between each two neighbours, beyond the last.
    """

    torques: Array
    exponents: Array

    def parts(self, torque: Array) -> tuple[Integers, Array, Array]:
        """Rows i (n,), and factors (n,) of rows i and i + 1 whose sum is the value at torques (n,).

        In proportion to a power of the torque from both rows, weighted by the logarithm of the torque: exact
        where values have that exponent. Below the first torque and beyond the last the second factor is 0.
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
        """Values (t, ...) at a torque, (...)."""
        (row,), (own,), (above,) = self.parts(np.array([torque]))
        return np.asarray(own * values[row] + (above * values[row + 1] if above > 0.0 else 0.0))

    def solved(self, torque: float) -> bool:
        """Whether a torque lies within those solved, or is none."""
        return bool(torque == 0.0 or self.torques[0] <= torque <= self.torques[-1])


def scale(torques: Array, largest: Array, lone: float, beyond: float) -> Scale:
    """Exponents from the `largest` values (t,) at the torques (t,), between SMALLEST and LARGEST.

    `beyond` that above the last torque. Below the first it is FALLS less than that of the first two, and
    `lone` where one torque alone was solved.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        exponents = np.diff(np.log(largest)) / np.diff(np.log(torques))
    between = np.clip(
        np.nan_to_num(exponents, nan=LARGEST, posinf=LARGEST, neginf=LARGEST), SMALLEST, LARGEST
    )
    below = max(between[0] - FALLS, SMALLEST) if between.size else lone
    return Scale(torques, np.concatenate([[below], between, [beyond]]))
