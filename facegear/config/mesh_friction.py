"""Friction of the machine's meshes from the table of the tooth pair, at the torque that each mesh carries."""

from dataclasses import replace

import numpy as np
import pandas as pd
from scipy.interpolate import PchipInterpolator

from facegear.arrays import Array
from facegear.harmonics.fit import fit_harmonics
from facegear.harmonics.series import stack_series
from facegear.lubrication.columns import EXCITATION_COLUMNS
from facegear.transmission.machine import Machine
from facegear.transmission.mesh_friction import MeshFriction
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import mean_equilibrium

ORDERS = 8
"""Harmonics of the mesh frequency that friction excites; the mean is exact."""


def with_friction(machine: Machine, table: pd.DataFrame) -> Machine:
    """Add friction in motion to a machine.

    Each mesh has the friction of the torque that it carries at rest. Between the torques of the contact
    analysis it is interpolated over the logarithm of the torque, outside them it is that of the nearest.

    Parameters
    ----------
    machine : Machine
        The lumped machine.
    table : pd.DataFrame
        Table `excitation` of stage lubrication, columns EXCITATION_COLUMNS.

    Returns
    -------
    Machine
        The machine with friction.

    Raises
    ------
    NotConverged
        If the machine has no rest.
    """
    torques = machine.layout.pinion_arm * np.abs(mean_equilibrium(at_rest(machine)).forces[0])
    table_torques, ratios = _ratios(table)
    ratios[..., 3] /= 1e3 * machine.layout.pinion_arm
    ratios[..., 4] /= 1e3 * machine.layout.gear_arm
    return replace(
        machine,
        friction=MeshFriction(np.stack([_series(table_torques, ratios, torque) for torque in torques])),
    )


def _ratios(table: pd.DataFrame) -> tuple[Array, Array]:
    """Torques (t,) and the ratios (t, positions, parts) at each of them."""
    names = list(EXCITATION_COLUMNS[2:])
    by_torque = table.sort_values(["torque_n_m", "position"]).groupby("torque_n_m")
    ratios = np.stack([rows[names].to_numpy() for _, rows in by_torque])
    return np.array(list(by_torque.groups), float), ratios


def _series(torques: Array, ratios: Array, torque: float) -> Array:
    """Fourier series (parts, 2, orders) of the ratios at a torque, N m."""
    clipped_torque = np.clip(torque, torques[0], torques[-1])
    at = (
        ratios[0] if torques.size == 1 else PchipInterpolator(np.log(torques), ratios)(np.log(clipped_torque))
    )
    return stack_series([fit_harmonics(column).series.truncate(ORDERS) for column in at.T])
