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
    def is_known(self) -> bool:
        """Whether a pressure away from edges is known at any torque."""
        return bool(np.isfinite(self.pressure).any())

    def at(self, torque: float) -> float:
        """Interpolate the pressure at a torque.

        A power of the torque between those solved and below them; beyond them its root, as in line contact.

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
