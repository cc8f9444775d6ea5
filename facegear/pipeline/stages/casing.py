"""Stages of the casing: its reduction, and the machine on it at rest."""

import numpy as np

from facegear.build.casing import reduced_casing
from facegear.errors import ConfigError
from facegear.machine.casing_response import campbell_table, crossing_speeds, sensor_table
from facegear.machine.casing_tables import (
    foot_table,
    frequency_table,
    mode_table,
    seat_motion_table,
    seat_table,
    sharing_table,
)
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.machine import Machine
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium
from facegear.number_format import count_noun, format_number
from facegear.pipeline.outcome import Outcome
from facegear.schema.casing import CasingSection
from facegear.ties import first_largest_row

DOUBT = "half of the highest mode with seats and feet held: raise transmission.casing.modes"
"""Words of a summary on modes and vibration above the frequency up to which a reduced casing holds."""
SPEEDS = 121
"""Number of speeds at which the vibration of the casing is computed."""


def casing(section: CasingSection) -> Outcome:
    """Read and check the matrices of a casing, and reduce them to seats, feet, sensors and modes.

    Parameters
    ----------
    section : CasingSection
        Section `transmission.casing` of the config.

    Returns
    -------
    Outcome
        Tables `seats` (place and stiffness of each seat) and `modes` (of the casing alone). Arrays
        `reduced`, from which the machine is built.

    Raises
    ------
    ConfigError
        For a casing that cannot be used.
    """
    mounted = reduced_casing(section)
    modes = frequency_table(mounted)
    summary = f"{format_number(float(mounted.total_mass[0]), 4)} kg, {count_noun(len(mounted.seats), 'seat')}"
    if len(mounted.own_frequencies):
        summary += f", first mode on its feet at {mounted.own_frequencies[0]:.1f} Hz"
    if mounted.modes:
        summary += f"; valid up to {mounted.valid_up_to:.0f} Hz"
    content = {"seats": seat_table(mounted), "modes": modes, "reduced": mounted.to_arrays()}
    return Outcome(content, summary)


def casing_loads(machine: Machine, first_rpm: float, last_rpm: float) -> Outcome:
    """Compute what the casing does to the machine: seats, feet and mesh forces at rest, and modes.

    Parameters
    ----------
    machine : Machine
        A machine on a casing, with geometric meshes.
    first_rpm, last_rpm : float
        Range of the pinions' speeds over which modes are listed, rpm.

    Returns
    -------
    Outcome
        Tables `seats` (motions under the mean torques), `feet` (loads and their balance), `sharing` (mesh
        forces with and without the casing), `modes` (with those of the casing marked), `campbell` (modes over
        speed) and `crossings` (of modes of the casing with orders of the mesh).

    Raises
    ------
    ConfigError
        Without a casing.
    NotConverged
        Where the equilibrium does not converge.
    """
    if machine.casing is None:
        raise ConfigError("transmission.casing", None, "given")
    machine_at_rest = at_rest(machine)
    equilibrium = mean_equilibrium(machine_at_rest)
    motions, sharing = seat_motion_table(machine_at_rest, equilibrium), sharing_table(machine, equilibrium)
    modes = mode_table(machine, loaded_modes(machine))
    of_casing = modes.loc[modes["is_casing_mode"], "frequency_hz"].to_numpy()
    content = {
        "seats": motions,
        "feet": foot_table(machine_at_rest, equilibrium),
        "sharing": sharing,
        "modes": modes,
        "campbell": campbell_table(machine, np.linspace(0.0, last_rpm, SPEEDS).tolist()),
        "crossings": crossing_speeds(of_casing, machine, first_rpm, last_rpm),
    }
    distance = np.linalg.norm(motions[["x_um", "y_um", "z_um"]].to_numpy(), axis=1)
    seat = first_largest_row(motions.assign(distance=distance), "distance")
    mesh = first_largest_row(sharing.assign(size=sharing["change_percent"].abs()), "size")
    summary = (
        f"seats move by up to {seat['distance']:.4g} um ({seat['seat']}), the force of {mesh['mesh']} "
        f"changes by {mesh['change_percent']:.3g} %, {count_noun(of_casing.size, 'mode')} of the casing"
    )
    if beyond := int((~modes["is_valid"]).sum()):
        limit = f"{machine.casing.mounted.valid_up_to:.0f} Hz"
        summary += f"; {count_noun(beyond, 'mode')} above {limit}, {DOUBT}"
    return Outcome(content, summary)


def casing_response(machine: Machine, first_rpm: float, last_rpm: float) -> Outcome:
    """Compute the acceleration of the casing's sensors over speed, linear about the mean load.

    Parameters
    ----------
    machine : Machine
        A machine on a casing with sensors.
    first_rpm, last_rpm : float
        Range of the pinions' speeds, rpm.

    Returns
    -------
    Outcome
        Table `sensors`: speed_rpm, order of the mesh, frequency_hz, sensor, acceleration_m_per_s2
        (amplitude).

    Raises
    ------
    ConfigError
        Without sensors.
    NotConverged
        Where the equilibrium does not converge.
    """
    if machine.casing is None or not machine.casing.mounted.sensor_names.size:
        raise ConfigError("transmission.casing.sensors", [], "given")
    table = sensor_table(machine, np.linspace(first_rpm, last_rpm, SPEEDS).tolist())
    loudest = first_largest_row(table, "acceleration_m_per_s2")
    summary = (
        f"{loudest['sensor']} vibrates most, {loudest['acceleration_m_per_s2']:.4g} m/s2 at "
        f"{loudest['speed_rpm']:.0f} rpm and {loudest['order']:.0f} x mesh"
    )
    if not loudest["is_valid"]:
        summary += f"; above {machine.casing.mounted.valid_up_to:.0f} Hz, {DOUBT}"
    return Outcome({"sensors": table}, summary)
