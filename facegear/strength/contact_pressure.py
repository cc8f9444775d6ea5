"""Pressure inside the flanks, load on tip edges and in fillets at any torque, from the contact analysis."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from facegear.arrays import Array, Mask
from facegear.strength.between_torques import SMALLEST, scale

if TYPE_CHECKING:
    import pandas as pd


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
    def known(self) -> bool:
        """Whether a pressure away from edges is known at any torque."""
        return bool(np.isfinite(self.pressure).any())

    def at(self, torque: float) -> float:
        """Pressure (Pa), nan where none is known.

        A power of the torque between those solved and below them; beyond its root, as of line contact.
        """
        if not self.known:
            return np.nan
        on = np.isfinite(self.pressure)
        growth = scale(self.torques[on], self.pressure[on], SMALLEST, 0.5)
        return float(growth.at(self.pressure[on], torque))

    def within(self, torque: Array) -> Mask:
        """Whether torques (n,) lie within those solved."""
        return (torque >= self.torques[0]) & (torque <= self.torques[-1])

    def error_at(self, torque: float) -> float:
        """Error (Pa) of `at`: the relative one is linear between the torques solved."""
        on = np.isfinite(self.pressure)
        relative = self.error[on] / self.pressure[on]
        return self.at(torque) * float(np.interp(torque, self.torques[on], relative))

    def edge_at(self, torque: float) -> tuple[float, float]:
        """Line load (N/m) on tip edges and the length (m) of them that carries any.

        The load goes as a power of the torque between those solved and below them, and in proportion beyond;
        the length is linear between them and constant beyond.
        """
        growth = scale(self.torques, self.edge_load, 0.5, 1.0)
        length = np.interp(torque, np.append(0.0, self.torques), np.append(0.0, self.edge_length))
        return float(growth.at(self.edge_load, torque)), float(length)

    def fillet_at(self, torque: Array) -> Array:
        """Share of torques (n,) that fillets carry: linear between those solved, constant outside them."""
        return np.interp(torque, self.torques, self.fillet_share)


def contact_pressure(by_torque: "pd.DataFrame") -> ContactPressure:
    """From the table by torque of stage contact."""
    scales = {
        "torque_n_m": 1.0,
        "pressure_mpa": 1e6,
        "pressure_error_mpa": 1e6,
        "tip_line_load_n_per_mm": 1e3,
        "tip_length_mm": 1e-3,
        "fillet_share": 1.0,
    }
    return ContactPressure(*(scale * by_torque[name].to_numpy(float) for name, scale in scales.items()))
