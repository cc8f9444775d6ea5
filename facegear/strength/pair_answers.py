"""What a tooth pair in contact answers for at any load: transmission error, pressure, root stress."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.strength.contact_pressure import ContactPressure
from facegear.strength.root_stress import RootStress, down_the_fillet


@dataclass(frozen=True, eq=False)
class PairAnswers:
    """Largest values over a pitch.

    `error` (p,) m: the loaded transmission error at evenly spaced positions under the operating load;
    `pressure` on the flanks; `roots`, the stress in the fillets by body, where they carry gauges.
    """

    error: Array
    pressure: ContactPressure
    roots: Mapping[str, RootStress]

    @property
    def error_range(self) -> float:
        """Peak-to-peak transmission error at the operating load, m: of the positions solved."""
        return float(np.ptp(self.error))

    @property
    def error_harmonic(self) -> float:
        """Amplitude of the transmission error at mesh frequency, m."""
        return float(2.0 * np.abs(np.fft.rfft(self.error)[1]) / self.error.size)

    def largest_root_stress(self, body: str, torque: float) -> float:
        """Pa in the fillets of a body at a torque (N m), as `RootStress.at_torque` has it."""
        return float(down_the_fillet(self.roots[body].at_torque(torque)).max())
