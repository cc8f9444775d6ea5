"""Pressure inside the flanks and load on their tip edges at any torque, from the contact analysis."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ContactPressure:
    """Largest values over a pitch at t torques (N m), all (t,).

    `pressure` and its `error` (Pa), away from edges; nan where edges carry all. `edge_load` (N/m) along tip
    edges and `edge_length` (m) that carries any: pressure there has no limit.
    """

    torques: Array
    pressure: Array
    error: Array
    edge_load: Array
    edge_length: Array

    @property
    def known(self) -> bool:
        """Whether a pressure away from edges is known at any torque."""
        return bool(np.isfinite(self.pressure).any())

    def at(self, torque: float) -> float:
        """Pressure (Pa): of line contact, with the root of the torque beyond those solved.

        Between them the load on a line contact, p squared, is linear. nan where none is known.
        """
        if not self.known:
            return np.nan
        on = np.isfinite(self.pressure)
        torques = np.concatenate([[0.0], self.torques[on]])
        squares = np.concatenate([[0.0], self.pressure[on] ** 2])
        within = float(np.interp(torque, torques, squares))
        return float(np.sqrt(within * max(torque / torques[-1], 1.0)))

    def error_at(self, torque: float) -> float:
        """Error (Pa) of `at`: the relative one is linear between the torques solved."""
        on = np.isfinite(self.pressure)
        relative = self.error[on] / self.pressure[on]
        return self.at(torque) * float(np.interp(torque, self.torques[on], relative))

    def edge_at(self, torque: float) -> tuple[float, float]:
        """Line load (N/m) on tip edges and the length (m) of them that carries any.

        Both linear between the torques solved; beyond them the load goes on in proportion.
        """
        beyond = max(torque / self.torques[-1], 1.0)
        load, length = (
            float(np.interp(torque, np.append(0.0, self.torques), np.append(0.0, values)))
            for values in (self.edge_load, self.edge_length)
        )
        return beyond * load, length


def contact_pressure(by_torque: "pd.DataFrame") -> ContactPressure:
    """From the table by torque of stage contact."""
    scales = {
        "torque_n_m": 1.0,
        "pressure_mpa": 1e6,
        "pressure_error_mpa": 1e6,
        "tip_line_load_n_per_mm": 1e3,
        "tip_length_mm": 1e-3,
    }
    return ContactPressure(*(scale * by_torque[name].to_numpy(float) for name, scale in scales.items()))
