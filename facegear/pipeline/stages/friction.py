"""Stages of friction: loss, heat and film of the pair, and of the machine."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import pi

import numpy as np
import pandas as pd

from facegear.arrays import Array, Arrays, Integers
from facegear.build.lubrication import contacts_of, designs_of_contacts, limits_of, lubrication_of, map_speeds
from facegear.build.machine import MachineInputs
from facegear.build.tooth_pair import ToothPair
from facegear.errors import ConfigError
from facegear.lubrication import machine_loss as losses
from facegear.lubrication.assessment import (
    RubbingContact,
    by_torque_table,
    excitation_table,
    limit_table,
    local_arrays,
    map_table,
    position_table,
)
from facegear.lubrication.columns import FRICTION_STUDY_COLUMNS
from facegear.lubrication.machine_loss import MeshLoads
from facegear.lubrication.machine_tables import (
    MachineState,
    body_heat_table,
    machine_loss_table,
    mesh_loss_table,
)
from facegear.lubrication.pairs import FlankPairs, LoadedPair
from facegear.machine.machine import Machine
from facegear.machine.ratings import compute_ratings, mesh_table
from facegear.motion.response_tables import losses_in_motion
from facegear.number_format import count_noun
from facegear.pipeline.outcome import Outcome
from facegear.schema.lubrication import LubricationSection
from facegear.schema.strength import Strength
from facegear.studies.lubricated_teeth import pair_of_meshes


def lubrication(
    ltca: pd.DataFrame,
    pressure: Arrays,
    tooth_pair: ToothPair,
    lubrication: LubricationSection | None,
    speed_rpm: float,
) -> Outcome:
    """Compute sliding, loss, heat, film and scuffing of one mesh from its stored contact, at the
    nominal speed.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact: contact by torque and position.
    pressure : Arrays
        Arrays `pressure` of stage contact: loads and pressures of contact lines.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    lubrication : LubricationSection or None
        Section `lubrication` of the config, None if it has none.
    speed_rpm : float
        Nominal speed of the pinions, rpm.

    Returns
    -------
    Outcome
        Tables `by_torque`, `positions`, `limits` and `map` (over torque and speed), described by
        `FrictionResult`, of the upper gear's drive flank. Table `excitation`: force and moments of friction
        over the mesh force by torque and position, with which the motion is excited, of all flanks for
        teeth other than spur ones. Arrays `local` (LOCAL_ARRAYS): quantities of every loaded plane.

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
    pairs, numbers = loaded_pairs(ltca, pressure, section, tooth_pair)
    limits, speed = limits_of(section), speed_rpm * pi / 30
    states_of_pairs = [pair.states(speed) for pair in pairs]
    designs = designs_of_contacts(tooth_pair, len(pairs))
    rubbing = [RubbingContact(*of_pair) for of_pair in zip(designs, pairs, states_of_pairs, strict=True)]
    pair_under_load, states = pairs[0], states_of_pairs[0]
    table = by_torque_table(pair_under_load, states, speed, limits)
    content = {
        "by_torque": table,
        "positions": position_table(pair_under_load, states),
        "limits": limit_table(pair_under_load, states),
        "map": map_table(pair_under_load, map_speeds(section, speed_rpm)),
        "local": local_arrays(pair_under_load, states, speed),
        "excitation": excitation_table(rubbing, numbers),
    }
    last = table.iloc[-1]
    summary = (
        f"mesh efficiency {last['efficiency']:.4f} at {last['torque_n_m']:g} N m and {speed_rpm:g} rpm, "
        f"contact up to {last['contact_temperature_c']:.0f} C ({last['friction_model']} friction)"
    )
    return Outcome(content, summary)


def lubrication_section(section: LubricationSection | None) -> LubricationSection:
    """Return section `lubrication`, or refuse a config without it.

    Parameters
    ----------
    section : LubricationSection or None
        The section, None if the config has none.

    Returns
    -------
    LubricationSection
        The section.

    Raises
    ------
    ConfigError
        Without section lubrication.
    """
    if section is None:
        raise ConfigError("lubrication", None, "given, for friction and heat")
    return section


def loaded_pairs(
    ltca: pd.DataFrame,
    pressure: Arrays,
    section: LubricationSection,
    tooth_pair: ToothPair,
) -> tuple[tuple[LoadedPair, ...], Integers]:
    """Join the stored contacts of the pair's flanks with how they are lubricated; `states(speed)` of each
    solves friction at a speed in rad/s.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.
    pressure : Arrays
        Arrays `pressure` of stage contact.
    section : LubricationSection
        Section `lubrication` of the config.
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    tuple of LoadedPair
        Every contact at the solved torques, that of the upper gear's drive flank first, and its lubrication.
    (2, 2) array of int
        Number of the contact of each gear (upper, lower) and flank (drive, back).
    """
    contacts, numbers = contacts_of(ltca, pressure, tooth_pair)
    request = lubrication_of(section, tooth_pair)
    return tuple(LoadedPair(contact, request) for contact in contacts), numbers


def friction_studies(
    points: Sequence[Sequence[str]], meshes: Sequence[pd.DataFrame], machine: Sequence[pd.DataFrame]
) -> Outcome:
    """Collect loss, temperature and film of the studies' cases side by side, each at its nominal load
    at rest (bin 0).

    Parameters
    ----------
    points : Sequence[Sequence[str]]
        Study, point and label of each case; the machine itself (`nominal`) first.
    meshes : Sequence[pd.DataFrame]
        Table `meshes` of stage machine_loss of each case.
    machine : Sequence[pd.DataFrame]
        Table `machine` of stage machine_loss of each case.

    Returns
    -------
    Outcome
        `table`, a row for each case: study, point, label, speed, power, loss of the machine, its
        hottest mesh with contact temperature and scuffing safety, smallest film ratio of all meshes,
        and whether all torques lie within those solved. Columns are FRICTION_STUDY_COLUMNS.
    """
    rows = []
    for point, by_mesh, whole in zip(points, meshes, machine, strict=True):
        nominal = whole[whole["bin"] == 0].iloc[0]
        at_rest = by_mesh[by_mesh["bin"] == 0]
        hottest = at_rest.loc[at_rest["contact_temperature_c"].idxmax()]
        of_machine = [nominal[key] for key in ("speed_rpm", "power_in_w", "loss_w", "loss_percent")]
        of_mesh = [hottest[key] for key in ("mesh", "contact_temperature_c", "scuffing_safety")]
        is_within_torques = bool(at_rest["within_torques_solved"].all())
        rows.append((*point, *of_machine, *of_mesh, at_rest["smallest_film_ratio"].min(), is_within_torques))
    table = pd.DataFrame(rows, columns=list(FRICTION_STUDY_COLUMNS))
    min_loss, max_loss = table["loss_percent"].min(), table["loss_percent"].max()
    return Outcome(
        {"table": table},
        f"{count_noun(len(table) - 1, 'case')}; loss from {min_loss:.3f} to {max_loss:.3f} %",
    )


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
    """Compute friction loss and heat of the machine at the nominal load at rest and in every bin of the
    duty cycle.

    Mesh loads decide losses; friction itself is left out of the equilibrium that gives these loads.

    Parameters
    ----------
    ltca : pd.DataFrame
        Table `ltca` of stage contact.
    pressure : Arrays
        Arrays `pressure` of stage contact.
    inputs : MachineInputs
        Everything that a machine is built from.
    duty_loads : pd.DataFrame or None
        Table `duty_loads` of stage duty_loads, where the loads of the duty cycle are the machine's;
        without it bin 0 is all.
    response : pd.DataFrame or None
        Table `response` of stage dynamics_response, where friction acts on the motion; it gives column
        loss_in_motion_w of bin 0.
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
        Tables `meshes` (a row a bin and loaded flank), `bodies` (a row a bin and body) and `machine` (a
        row a bin); bin 0 is the nominal load at rest, -1 the whole duty cycle. `MachineLossResult`
        lists the columns.

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
    pairs = FlankPairs(*loaded_pairs(ltca, pressure, section, tooth_pair))
    states = list(_states(pairs, replace(inputs, friction=None), duty_loads, strength, speed_rpm))
    request = pairs.pairs[0].lubrication
    content = {
        "meshes": mesh_loss_table(states, request, limits_of(section)),
        "bodies": body_heat_table(states, request),
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
    pairs: FlankPairs,
    inputs: MachineInputs,
    duty_loads: pd.DataFrame | None,
    strength: Strength | None,
    speed_rpm: float,
) -> Iterator[MachineState]:
    """Yield the loss of the machine at its nominal load at rest (bin 0), then in bins 1, 2, ... of its
    duty cycle.

    The bins follow only where `duty_loads` and `strength` are given. Torques on the pinion by each
    loaded flank are the mean ones; peaks are the largest forces of the bin times the application
    factor, at rest the mean again.
    """
    machine = inputs.build()
    table = mesh_table(machine, speed_rpm)
    table = table[table["flank"] != "open"]
    torque = table["pinion_torque_n_m"].abs().to_numpy()
    names = table["mesh"].tolist(), table["flank"].tolist()
    yield _state(pairs, machine, (0, np.nan, speed_rpm), names, torque, torque)
    if duty_loads is None or strength is None:
        return
    for number, load in enumerate(strength.duty, start=1):
        rows = duty_loads[duty_loads["bin"] == number]
        machine = inputs.at_torque(load.torque_n_m, load.speed_rpm).build()
        layout = machine.layout
        arm = np.where(rows["flank"] == "back", layout.back_arm, 1.0) * layout.pinion_arm
        mean = arm * rows["mean_force_n"].to_numpy()
        peak = arm * strength.application_factor * rows["largest_force_n"].to_numpy()
        names = rows["mesh"].tolist(), rows["flank"].tolist()
        yield _state(pairs, machine, (number, load.hours, load.speed_rpm), names, mean, peak)


def _state(
    pairs: FlankPairs,
    machine: Machine,
    key: tuple[int, float, float],
    names: tuple[list[str], list[str]],
    torque: Array,
    peak: Array,
) -> MachineState:
    """Return losses and temperatures of the machine in one bin.

    `key` holds number of the bin, hours (nan for bin 0) and pinion speed, rpm. `names` hold mesh and
    flank of each of the n loaded flanks; `torque` and `peak` (n,) are mean and largest torque of each
    on the pinion, N m, not negative.
    """
    layout = machine.layout
    number, hours, speed_rpm = key
    meshes = np.array([layout.mesh_names.index(name) for name in names[0]])
    of = np.array(layout.meshes)[meshes]
    pair = pair_of_meshes(pairs, layout, meshes, np.array(names[1]) == "back")
    loads = MeshLoads(
        pinion=of[:, 0],
        gear=of[:, 1],
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
        losses=losses.machine_loss(pair, loads, speed_rpm * pi / 30),
    )
