"""Tables of loss and heat of a machine: by mesh, by body and in all."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
import pandas as pd

from facegear.lubrication.columns import BODY_COLUMNS, MACHINE_COLUMNS, MESH_COLUMNS
from facegear.lubrication.film import temperature_safety
from facegear.lubrication.machine_loss import MachineLoss, MeshLoads
from facegear.lubrication.request import BorrowedBulk, Cooling, GivenBulk, Limits, Lubrication


@dataclass(frozen=True, eq=False)
class MachineState:
    """Loss of a machine in one state: bin 0 is the nominal load, `hours` nan there.

    `meshes` and `flanks` name the loaded flanks, `bodies` all bodies; `speed_rpm` of the pinions.
    """

    bin: int
    hours: float
    speed_rpm: float
    power_in: float
    meshes: Sequence[str]
    flanks: Sequence[str]
    bodies: Sequence[str]
    loads: MeshLoads
    losses: MachineLoss

    @property
    def power(self) -> np.ndarray:
        """Power (n,) W that every loaded flank carries: mean pinion torque times pinion speed."""
        return self.loads.torque * self.speed_rpm * pi / 30


def mesh_loss_table(states: Sequence[MachineState], lubrication: Lubrication, limits: Limits) -> pd.DataFrame:
    """Tabulate loss, heat, temperature, film and safeties of every loaded flank.

    Parameters
    ----------
    states : Sequence[MachineState]
        States of the machine: bin 0 is the nominal load, others are bins of the duty cycle.
    lubrication : Lubrication
        How the flanks are lubricated.
    limits : Limits
        Limits of temperatures and films.

    Returns
    -------
    pd.DataFrame
        One row for each state and loaded flank, columns MESH_COLUMNS, units in the names.
        `loss_in_motion_w` is nan here; the friction stage fills it in.
    """
    allowed_contact = limits.allowed_contact(lubrication.oil, lubrication.oil_temperature)
    frames = []
    for state in states:
        losses = state.losses
        contact = losses.contact_temperature
        columns = {
            "bin": state.bin,
            "speed_rpm": state.speed_rpm,
            "mesh": list(state.meshes),
            "flank": list(state.flanks),
            "pinion_torque_n_m": state.loads.torque,
            "largest_torque_n_m": state.loads.peak,
            "power_w": state.power,
            "loss_w": losses.loss,
            "loss_percent": 100 * losses.loss / state.power,
            "loss_in_motion_w": np.nan,
            "pinion_heat_w": losses.pinion_heat,
            "face_gear_heat_w": losses.loss - losses.pinion_heat,
            "pinion_bulk_c": losses.bulk[:, 0],
            "face_gear_bulk_c": losses.bulk[:, 1],
            "largest_flash_k": losses.flash,
            "contact_temperature_c": contact,
            "scuffing_safety": temperature_safety(allowed_contact, lubrication.oil_temperature, contact),
            "scuffing_margin_k": allowed_contact - contact,
            "smallest_film_ratio": losses.film_ratio,
            "smallest_micropitting_film_ratio": losses.micropitting,
            "micropitting_safety": [
                limits.micropitting_safety(float(ratio)) for ratio in losses.micropitting
            ],
            "within_torques_solved": losses.within,
        }
        frames.append(pd.DataFrame(columns))
    return pd.concat(frames, ignore_index=True)[list(MESH_COLUMNS)]


def body_heat_table(states: Sequence[MachineState], lubrication: Lubrication) -> pd.DataFrame:
    """Tabulate the heat that friction brings to every body, and its bulk temperature.

    Parameters
    ----------
    states : Sequence[MachineState]
        States of the machine.
    lubrication : Lubrication
        Source of the rule of the bulk temperature.

    Returns
    -------
    pd.DataFrame
        One row for each state and body, columns BODY_COLUMNS; `bulk_c` is nan with a borrowed rule, where
        it differs from mesh to mesh of a body.
    """
    rows = [
        (state.bin, state.speed_rpm, name, heat, _bulk(lubrication, heat, body < state.loads.pinions))
        for state in states
        for body, (name, heat) in enumerate(zip(state.bodies, state.losses.heat.tolist(), strict=True))
    ]
    return pd.DataFrame(rows, columns=list(BODY_COLUMNS))


def _bulk(lubrication: Lubrication, heat: float, pinion: bool) -> float:
    """Return the bulk temperature (C) of a body that receives `heat` (W): given, by cooling, or nan if
    borrowed.
    """
    match lubrication.bulk:
        case GivenBulk(temperature):
            return temperature
        case Cooling(of_pinion, of_gear):
            return lubrication.oil_temperature + heat / (of_pinion if pinion else of_gear)
        case BorrowedBulk():
            return np.nan


def machine_loss_table(states: Sequence[MachineState]) -> pd.DataFrame:
    """Tabulate power, loss, efficiency and lost energy of the machine.

    Parameters
    ----------
    states : Sequence[MachineState]
        States of the machine: bin 0 is the nominal load, others are bins of the duty cycle.

    Returns
    -------
    pd.DataFrame
        One row for each state, columns MACHINE_COLUMNS. With a duty cycle a last row, bin -1, holds the
        means of its bins weighted by hours, and the sum of their lost energy.
    """
    rows = [_row(state) for state in states]
    bins = [row for row, state in zip(rows, states, strict=True) if state.bin > 0]
    if bins:
        rows.append(_whole(pd.DataFrame(bins)))
    return pd.DataFrame(rows, columns=list(MACHINE_COLUMNS))


def _row(state: MachineState) -> dict[str, object]:
    """Return one row of `machine_loss_table`, keyed by MACHINE_COLUMNS, for one state of the machine."""
    loss = state.losses.total
    return {
        "bin": state.bin,
        "hours": state.hours,
        "speed_rpm": state.speed_rpm,
        **_powers(state.power_in, float(state.power.sum()), loss),
        "energy_lost_kwh": 1e-3 * loss * state.hours,
        "within_torques_solved": bool(state.losses.within.all()),
    }


def _whole(bins: pd.DataFrame) -> dict[str, object]:
    """Return the row of the whole duty cycle, bin -1, from the rows of its bins (columns MACHINE_COLUMNS).

    Powers, loss and speed are means weighted by the hours; efficiency is that of the means, and energies
    are summed.
    """
    hours = bins["hours"].sum()

    def mean(values: pd.Series) -> float:
        """Average a column over the bins, weighted by their hours."""
        return float((values * bins["hours"]).sum() / hours)

    through = mean(bins["power_through_meshes"] * bins["power_in_w"])
    return {
        "bin": -1,
        "hours": hours,
        "speed_rpm": mean(bins["speed_rpm"]),
        **_powers(mean(bins["power_in_w"]), through, mean(bins["loss_w"])),
        "energy_lost_kwh": bins["energy_lost_kwh"].sum(),
        "within_torques_solved": bool(bins["within_torques_solved"].all()),
    }


def _powers(power_in: float, through: float, loss: float) -> dict[str, float]:
    """Return five cells of a row of MACHINE_COLUMNS from power in, power through all meshes and loss, all
    in W.

    `power_through_meshes` is a ratio to the power in; ratios are nan where no power goes in.
    """
    over = power_in if power_in > 0 else np.nan
    return {
        "power_in_w": power_in,
        "power_through_meshes": through / over,
        "loss_w": loss,
        "loss_percent": 100 * loss / over,
        "efficiency": 1 - loss / over,
    }
