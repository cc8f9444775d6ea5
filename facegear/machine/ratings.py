"""Gear ratio, speeds, mesh frequency, torques and powers of a machine, from statics and rigid rotation."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.machine.layout import Layout
from facegear.machine.machine import Machine, mesh_frequency
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import static_equilibrium

ROUNDING = 1e-9
"""Share of the largest mesh force below which a force counts as none."""


@dataclass(frozen=True)
class Ratings:
    """Gear ratio, speeds and powers of a machine at one pinion speed.

    Attributes
    ----------
    ratio
        Gear teeth over pinion teeth, the pinion's speed over the gear's.
    pinion_speed, gear_speed
        rpm.
    mesh_frequency
        Hz.
    power_in, power_out
        W, brought by the bodies that drive and taken by those that are driven; they differ by rounding alone
        unless the lever arms are not those of the teeth.
    """

    ratio: float
    pinion_speed: float
    gear_speed: float
    mesh_frequency: float
    power_in: float
    power_out: float

    @property
    def imbalance(self) -> float:
        """Power in less power out over the larger of the two; 0 for a machine without load."""
        largest = max(self.power_in, self.power_out)
        return (self.power_in - self.power_out) / largest if largest > 0.0 else 0.0


def compute_ratings(machine: Machine, speed_rpm: float) -> Ratings:
    """Compute speeds, torques, powers and frequencies of the machine at a pinion speed.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    Ratings
        rpm, Hz and W.
    """
    layout = machine.layout
    powers = body_powers(machine, speed_rpm)
    return Ratings(
        ratio=layout.gear_teeth / layout.pinion_teeth,
        pinion_speed=speed_rpm,
        gear_speed=speed_rpm * layout.pinion_teeth / layout.gear_teeth,
        mesh_frequency=mesh_frequency(layout, speed_rpm),
        power_in=float(powers[powers > 0.0].sum()),
        power_out=float(-powers[powers < 0.0].sum()),
    )


def number_table(ratings: Ratings) -> pd.DataFrame:
    """Return the ratings as a table.

    Parameters
    ----------
    ratings : Ratings
        The ratings.

    Returns
    -------
    pd.DataFrame
        Columns quantity and value; rows gear_ratio, pinion_speed_rpm, gear_speed_rpm, mesh_frequency_hz,
        power_in_kw, power_out_kw and power_imbalance.
    """
    rows = {
        "gear_ratio": ratings.ratio,
        "pinion_speed_rpm": ratings.pinion_speed,
        "gear_speed_rpm": ratings.gear_speed,
        "mesh_frequency_hz": ratings.mesh_frequency,
        "power_in_kw": 1e-3 * ratings.power_in,
        "power_out_kw": 1e-3 * ratings.power_out,
        "power_imbalance": ratings.imbalance,
    }
    return pd.DataFrame(list(rows.items()), columns=["quantity", "value"])


def body_powers(machine: Machine, speed_rpm: float) -> Array:
    """Return the power that each body's torque brings in (positive) or takes out.

    All bodies turn in step as their teeth say, whatever the lever arms of the model.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    (bodies,) array
        W.
    """
    return machine.torques * _body_speeds(machine.layout, speed_rpm) * np.pi / 30.0


def body_table(machine: Machine, speed_rpm: float) -> pd.DataFrame:
    """Return role, torque, speed and power of each body.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    pd.DataFrame
        One row a body: body, role, torque_n_m, speed_rpm, power_kw (positive: brought in),
        share_of_input_percent.
    """
    layout = machine.layout
    powers = body_powers(machine, speed_rpm)
    power_in = powers[powers > 0.0].sum()
    return pd.DataFrame(
        {
            "body": layout.body_names,
            "role": [pinion.role.value for pinion in layout.pinions] + ["face gear"] * len(layout.gears),
            "torque_n_m": machine.torques,
            "speed_rpm": _body_speeds(layout, speed_rpm),
            "power_kw": 1e-3 * powers,
            "share_of_input_percent": 100.0 * powers / power_in if power_in > 0.0 else np.zeros_like(powers),
        }
    )


def mesh_table(machine: Machine, speed_rpm: float) -> pd.DataFrame:
    """Return flank, force and power of each mesh at rest with mean stiffness.

    The force acts along the line of action, negative on the back flank. A force below ROUNDING of the largest
    counts as none, its mesh as open.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    pd.DataFrame
        One row a mesh: mesh, flank, force_n, pinion_torque_n_m on the pinion, power_kw to the gear.

    Raises
    ------
    NotConverged
        If no equilibrium is found.
    """
    layout = machine.layout
    mesh_forces = static_equilibrium(at_rest(machine)).forces
    forces = np.where(np.abs(mesh_forces) > ROUNDING * np.abs(mesh_forces).max(), mesh_forces, 0.0)
    torque = layout.mesh_torques(forces)
    flank = np.select([forces > 0.0, forces < 0.0], ["drive", "back"], "open")
    return pd.DataFrame(
        {
            "mesh": layout.mesh_names,
            "flank": flank,
            "force_n": forces,
            "pinion_torque_n_m": torque,
            "power_kw": 1e-3 * torque * speed_rpm * np.pi / 30.0,
        }
    )


def _body_speeds(layout: Layout, speed_rpm: float) -> Array:
    """Return the speed of each body (bodies,), rpm, all positive: pinions, then gears slower by the tooth
    numbers.
    """
    gear = speed_rpm * layout.pinion_teeth / layout.gear_teeth
    return np.concatenate([np.full(len(layout.pinions), speed_rpm), np.full(len(layout.gears), gear)])
