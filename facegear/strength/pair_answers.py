"""What a tooth pair in contact answers for at a load between those solved: error, pressure, root stress."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.strength.root_stress import RootStress, down_the_fillet

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PairAnswers:
    """Largest values over a pitch.

    `torques` (t,) N m on the pinion; `pressure` (t,) Pa, nan where none is inside the flanks; `error` (p,) m
    the loaded transmission error at evenly spaced positions under the operating load; `roots` by body.
    """

    torques: Array
    pressure: Array
    error: Array
    roots: Mapping[str, RootStress]

    @property
    def error_range(self) -> float:
        """Peak-to-peak transmission error at the operating load, m: of the positions solved."""
        return float(np.ptp(self.error))

    @property
    def error_harmonic(self) -> float:
        """Amplitude of the transmission error at mesh frequency, m."""
        return float(2.0 * np.abs(np.fft.rfft(self.error)[1]) / self.error.size)

    def largest_pressure(self, torque: float) -> float:
        """Pa at a torque (N m): its square linear between those solved, and beyond them in proportion.

        Hertz' pressure of a line contact goes with the root of the load.
        """
        squares = self.pressure**2
        if torque <= self.torques[0]:
            return float(np.sqrt(squares[0] * torque / self.torques[0]))
        if torque >= self.torques[-1]:
            return float(np.sqrt(squares[-1] * torque / self.torques[-1]))
        return float(np.sqrt(np.interp(torque, self.torques, squares)))

    def largest_root_stress(self, body: str, torque: float) -> float:
        """Pa in the fillets of a body at a torque (N m), as `RootStress.at_torque` has it."""
        return float(down_the_fillet(self.roots[body].at_torque(torque)).max())


def pair_answers(ltca: pd.DataFrame, error: Array, roots: Mapping[str, RootStress]) -> PairAnswers:
    """From the contact table, the loaded transmission error (p,) m and the root stress by body, if any."""
    largest = ltca.groupby("torque_n_m", sort=True)["pressure_mpa"].max()
    return PairAnswers(largest.index.to_numpy(float), 1e6 * largest.to_numpy(float), error, roots)
