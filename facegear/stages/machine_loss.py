"""Loss and heat of the machine's meshes and bodies, at its nominal load and over its duty cycle."""

from collections.abc import Iterator
from dataclasses import replace
from math import pi

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays
from facegear.config.lubrication import LubricationSection, limits_of
from facegear.config.machines import MachineInputs
from facegear.config.strength import Strength
from facegear.config.tooth_pair import ToothPair
from facegear.dynamics.response_tables import losses_in_motion
from facegear.lubrication import machine_loss as losses
from facegear.lubrication.machine_loss import LoadedPair, MeshLoads
from facegear.lubrication.machine_tables import (
    MachineState,
    body_heat_table,
    machine_loss_table,
    mesh_loss_table,
)
from facegear.stages.lubrication import loaded_pair, lubrication_section
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine
from facegear.transmission.ratings import compute_ratings, mesh_table


def machine_loss(
    ltca: pd.DataFrame,
    pressure: Arrays,
    inputs: MachineInputs,
    duty_loads: pd.DataFrame | None = None,
    response: pd.DataFrame | None = None,
    *,
    tooth_pair: ToothPair,
    lubrication: LubricationSection | None,
    strength: Strength | None,
    speed_rpm: float,
) -> Outcome:
    """Compute loss and heat at the nominal load at rest and in every bin of the duty cycle.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.
    pressure : Arrays
        Arrays `pressure` of stage contact.
    inputs : MachineInputs
        What the machine is built from.
    duty_loads : pd.DataFrame or None
        Table of stage duty_loads, where the loads of the duty cycle are the machine's.
    response : pd.DataFrame or None
        Table of stage dynamics_response, where friction acts on the motion.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    lubrication : LubricationSection or None
        Section `lubrication` of the config, None if it has none.
    strength : Strength or None
        Section `strength` of the config, None if it has none.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Tables `meshes`, `bodies` and `machine`.

    Raises
    ------
    ConfigError
        Without section lubrication.
    TooHot
        Where a body passes the oil's flash point.
    NotConverged
        Where bulk temperatures do not settle.
    """
    section = lubrication_section(lubrication)
    pair_under_load = loaded_pair(ltca, pressure, section, tooth_pair)
    states = list(_states(pair_under_load, replace(inputs, friction=None), duty_loads, strength, speed_rpm))
    content = {
        "meshes": mesh_loss_table(states, pair_under_load.lubrication, limits_of(section)),
        "bodies": body_heat_table(states, pair_under_load.lubrication),
        "machine": machine_loss_table(states),
    }
    if inputs.friction is not None and response is not None:
        rest = content["meshes"]["bin"] == 0
        losses_by_mesh = losses_in_motion(inputs.build(), response, speed_rpm)
        content["meshes"].loc[rest, "loss_in_motion_w"] = (
            content["meshes"].loc[rest, "mesh"].map(losses_by_mesh)
        )
    whole, hottest = content["machine"].iloc[0], content["meshes"]["contact_temperature_c"].max()
    beyond = content["meshes"].loc[~content["meshes"]["within_torques_solved"], "bin"].unique()
    summary = (
        f"the machine loses {whole['loss_w']:.0f} W, {whole['loss_percent']:.3f} % of its power; "
        f"contact up to {hottest:.0f} C"
    )
    if beyond.size:
        bins = ", ".join(str(number) for number in beyond)
        summary = f"{summary}; bins with loads outside the torques of the contact analysis: {bins}"
    return Outcome(content, summary)


def _states(
    pair_under_load: LoadedPair,
    inputs: MachineInputs,
    duty_loads: pd.DataFrame | None,
    strength: Strength | None,
    speed_rpm: float,
) -> Iterator[MachineState]:
    """The machine at its nominal load at rest, then in every bin of its duty cycle."""
    machine = inputs.build()
    table = mesh_table(machine, speed_rpm)
    table = table[table["flank"] != "open"]
    torque = table["pinion_torque_n_m"].abs().to_numpy()
    names = table["mesh"].tolist(), table["flank"].tolist()
    yield _state(pair_under_load, machine, (0, np.nan, speed_rpm), names, torque, torque)
    if duty_loads is None or strength is None:
        return
    for number, load in enumerate(strength.duty, start=1):
        rows = duty_loads[duty_loads["bin"] == number]
        machine = inputs.at_torque(load.torque_n_m).build()
        arm = machine.layout.pinion_arm
        mean = arm * rows["mean_force_n"].to_numpy()
        peak = arm * strength.application_factor * rows["largest_force_n"].to_numpy()
        names = rows["mesh"].tolist(), rows["flank"].tolist()
        yield _state(pair_under_load, machine, (number, load.hours, load.speed_rpm), names, mean, peak)


def _state(
    pair_under_load: LoadedPair,
    machine: Machine,
    key: tuple[int, float, float],
    names: tuple[list[str], list[str]],
    torque: Array,
    peak: Array,
) -> MachineState:
    layout = machine.layout
    number, hours, speed_rpm = key
    of = [layout.meshes[layout.mesh_names.index(name)] for name in names[0]]
    loads = MeshLoads(
        pinion=np.array([i for i, _ in of]),
        gear=np.array([g for _, g in of]),
        torque=torque,
        peak=np.maximum(peak, torque),
        pinions=len(layout.pinions),
        bodies=len(layout.bodies),
    )
    return MachineState(
        bin=number,
        hours=hours,
        speed_rpm=speed_rpm,
        power_in=compute_ratings(machine, speed_rpm).power_in,
        meshes=names[0],
        flanks=names[1],
        bodies=layout.body_names,
        loads=loads,
        losses=losses.machine_loss(pair_under_load, loads, speed_rpm * pi / 30),
    )
