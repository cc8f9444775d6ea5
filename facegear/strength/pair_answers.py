"""Transmission error, pressure and root stress of a tooth pair in contact at any load."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.strength.contact_pressure import ContactPressure


@dataclass(frozen=True, eq=False)
class PairAnswers:
    """Largest values over a pitch.

    `error` (p,) m: the loaded transmission error at evenly spaced positions under the operating load;
    `pressure` on the flanks; `roots`, Pa in the fillets by body at a torque (N m), where they carry gauges.
    """

    error: Array
    pressure: ContactPressure
    roots: Mapping[str, Callable[[float], float]]

    @property
    def error_range(self) -> float:
        """Peak-to-peak transmission error at the operating load, m: of the positions solved."""
        return float(np.ptp(self.error))

    @property
    def error_harmonic(self) -> float:
        """Amplitude of the transmission error at mesh frequency, m."""
        return float(2.0 * np.abs(np.fft.rfft(self.error)[1]) / self.error.size)
