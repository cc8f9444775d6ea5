"""Mesh stiffness over a pitch at a load between those that were solved."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
import scipy

from facegear.arrays import Array
from facegear.errors import FacegearError, InvalidInput
from facegear.stiffness.request import Definition

COLUMN = {"average": "k_average_n_per_m", "local": "k_local_n_per_m"}


@dataclass(frozen=True, eq=False)
class LoadTable:
    """k(position, torque): torques (t,) N m, positions (p,) 0..1, `average` and `local` (t, p) N/m."""

    torques: Array
    positions: Array
    average: Array
    local: Array

    def at(self, torque: float, definition: Definition) -> Array:
        """Stiffness (p,) at a torque, monotone cubic in log torque at each position.

        Raises InvalidInput outside the torques solved: the curve is never extrapolated.
        """
        values = self.average if definition == "average" else self.local
        exact = np.flatnonzero(np.isclose(self.torques, torque, rtol=1e-12))
        if exact.size:
            return values[exact[0]]
        low, high = self.torques[0], self.torques[-1]
        if not low <= torque <= high:
            requirement = f"within `torques of the contact analysis`, {low:g} to {high:g}"
            raise InvalidInput("torque of the mesh stiffness", torque, requirement)
        return scipy.interpolate.PchipInterpolator(np.log(self.torques), values, axis=0)(np.log(torque))

    def interpolation_error(self, torque: float, definition: Definition) -> float:
        """Largest relative change of the curve if the nearest inner torque had not been solved; nan if there
        is none.
        """
        inner = np.arange(1, len(self.torques) - 1)
        if inner.size == 0 or np.isclose(self.torques, torque, rtol=1e-12).any():
            return 0.0 if inner.size else float("nan")
        left_out = inner[np.argmin(np.abs(np.log(self.torques[inner] / torque)))]
        other_torques = np.delete(np.arange(len(self.torques)), left_out)
        fewer = LoadTable(
            self.torques[other_torques],
            self.positions,
            self.average[other_torques],
            self.local[other_torques],
        )
        full = self.at(torque, definition)
        return float(np.abs(fewer.at(torque, definition) / full - 1.0).max())


def load_table(ltca: pd.DataFrame) -> LoadTable:
    """From the contact table: all positions at the torques whose average stiffness is known at every one.

    Raises FacegearError where the teeth interfere, so that there is none.
    """
    torques, row = np.unique(ltca["torque_n_m"].to_numpy(float), return_inverse=True)
    positions, column = np.unique(ltca["position"].to_numpy(float), return_inverse=True)
    average, local = np.full((2, torques.size, positions.size), np.nan)
    average[row, column], local[row, column] = (ltca[name].to_numpy(float) for name in COLUMN.values())
    is_known = ~np.isnan(average).any(axis=1)
    if not is_known.any():
        depth = ltca["interference_um"].max()
        raise FacegearError(
            "mesh_stiffness: there is none, as the teeth interfere: tips stand up to "
            f"{depth:.3g} um deep in fillets along the line of action (a smaller "
            "tooth_pair.pinion.rack_tip_radius_modules or more tooth_pair.shaper.teeth clears them)"
        )
    return LoadTable(torques[is_known], positions, average[is_known], local[is_known])
