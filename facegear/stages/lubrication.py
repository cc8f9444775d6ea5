"""Sliding, loss, heat, film and scuffing of the meshes under load, and of the machine."""

from collections.abc import Iterator, Mapping
from math import pi
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.config.base import parse
from facegear.config.lubrication import LubricationSection, limits_of, lubrication_request, map_speeds
from facegear.config.lumped_model import at_mesh_torque
from facegear.config.machines import wired_machine
from facegear.config.strength import Strength
from facegear.config.tooth_pair import pair
from facegear.errors import ConfigError
from facegear.lubrication.assessment import (
    by_torque_table,
    limit_table,
    local_arrays,
    map_table,
    position_table,
)
from facegear.lubrication.loss import hat_slip
from facegear.lubrication.machine_loss import LoadedPair, MeshLoads, machine_loss
from facegear.lubrication.machine_tables import (
    MachineState,
    body_heat_table,
    machine_loss_table,
    mesh_loss_table,
)
from facegear.lubrication.places import loaded_contacts, places, stored_lines
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine
from facegear.transmission.ratings import mesh_table, rated


def lubrication(
    ltca: pd.DataFrame,
    pressure: Mapping[str, NDArray],
    harmonics: pd.DataFrame | None = None,
    duty_loads: pd.DataFrame | None = None,
    *,
    tooth_pair: Mapping[str, Any],
    lubrication: Mapping[str, Any] | None,
    speed_rpm: float,
    transmission: Mapping[str, Any] | None = None,
    teeth: Mapping[str, Any] | None = None,
    strength: Mapping[str, Any] | None = None,
) -> Outcome:
    """`by_torque`, `positions`, `limits`, `map` (tables) and `local` (arrays) from stored contact.

    ltca, pressure: of stage contact. With `harmonics`, the table of stage stiffness, and a transmission also
    `meshes`, `bodies` and `machine` (tables): at the nominal load at rest and, with `duty_loads`, the table
    of that stage, in every bin of the duty cycle. Raises ConfigError without section lubrication, TooHot
    where a body passes the oil's flash point, NotConverged where bulk temperatures do not settle.
    """
    if lubrication is None:
        raise ConfigError("lubrication", None, "given, for friction and heat")
    section = parse(LubricationSection, lubrication)
    loaded = loaded_pair(ltca, pressure, section, tooth_pair)
    limits, speed = limits_of(section), speed_rpm * pi / 30
    states = loaded.states(speed)
    table = by_torque_table(loaded, states, speed, limits)
    content: dict[str, Any] = {
        "by_torque": table,
        "positions": position_table(loaded, states),
        "limits": limit_table(loaded, states),
        "map": map_table(loaded, map_speeds(section, speed_rpm)),
        "local": local_arrays(loaded, states, speed),
    }
    last = table.iloc[-1]
    told = (
        f"mesh efficiency {last['efficiency']:.4f} at {last['torque_n_m']:g} N m and {speed_rpm:g} rpm, "
        f"contact up to {last['contact_temperature_c']:.0f} C ({last['friction_model']} friction)"
    )
    if transmission is None or teeth is None or harmonics is None:
        return Outcome(content, told)
    found = list(machine_states(loaded, harmonics, duty_loads, transmission, teeth, strength, speed_rpm))
    content |= {
        "meshes": mesh_loss_table(found, loaded.known, limits),
        "bodies": body_heat_table(found, loaded.known),
        "machine": machine_loss_table(found),
    }
    whole = content["machine"].iloc[0]
    told = f"{told}; machine loses {whole['loss_w']:.0f} W, {whole['loss_percent']:.3f} % of its power"
    return Outcome(content, told)


def loaded_pair(
    ltca: pd.DataFrame,
    pressure: Mapping[str, NDArray],
    section: LubricationSection,
    tooth_pair: Mapping[str, Any],
) -> LoadedPair:
    """The stored contact of the pair with its sliding, by torque."""
    teeth = pair(tooth_pair)
    known = lubrication_request(section, teeth)
    unloaded = dict(zip(ltca["position"], 1e-6 * ltca["unloaded_ste_um"], strict=True))
    lines = stored_lines(teeth.design, pressure, unloaded)
    where = places(teeth.design, pressure, lines, 0.5 * known.reduced_modulus)
    hats = hat_slip(teeth.design, pressure)
    return LoadedPair(loaded_contacts(where, hats), known)


def machine_states(
    loaded: LoadedPair,
    harmonics: pd.DataFrame,
    duty_loads: pd.DataFrame | None,
    transmission: Mapping[str, Any],
    teeth: Mapping[str, Any],
    strength: Mapping[str, Any] | None,
    speed_rpm: float,
) -> Iterator[MachineState]:
    """The machine at its nominal load at rest, then in every bin of its duty cycle."""
    machine = wired_machine(transmission, teeth, harmonics)
    table = mesh_table(machine, speed_rpm)
    table = table[table["flank"] != "open"]
    torque = table["pinion_torque_n_m"].abs().to_numpy()
    names = table["mesh"].tolist(), table["flank"].tolist()
    yield _state(loaded, machine, (0, np.nan, speed_rpm), names, torque, torque)
    if duty_loads is None or strength is None:
        return
    section = parse(Strength, strength)
    for number, one in enumerate(section.duty, start=1):
        rows = duty_loads[duty_loads["bin"] == number]
        machine = wired_machine(at_mesh_torque(transmission, one.torque_n_m), teeth, harmonics)
        arm = machine.layout.pinion_arm
        mean = arm * rows["mean_force_n"].to_numpy()
        peak = arm * section.application_factor * rows["largest_force_n"].to_numpy()
        names = rows["mesh"].tolist(), rows["flank"].tolist()
        yield _state(loaded, machine, (number, one.hours, one.speed_rpm), names, mean, peak)


def _state(
    loaded: LoadedPair,
    machine: Machine,
    place: tuple[int, float, float],
    names: tuple[list[str], list[str]],
    torque: NDArray[np.float64],
    peak: NDArray[np.float64],
) -> MachineState:
    layout = machine.layout
    number, hours, speed_rpm = place
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
        power_in=rated(machine, speed_rpm).power_in,
        meshes=names[0],
        flanks=names[1],
        bodies=layout.body_names,
        loads=loads,
        found=machine_loss(loaded, loads, speed_rpm * pi / 30),
    )
