"""Vibration of a casing by the meshes: acceleration of its sensors over speed, by orders of the mesh.

The machine is linear about its mean load. Order h of the mesh excites it by the error e(t) of each flank,
and by what its varying stiffness changes of the force at the mean compression; products of both are left out.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.arrays import Array, ComplexArray
from facegear.harmonics import stack_series, stacked_values
from facegear.machine.casing_coordinates import CASING, casing_motion
from facegear.machine.casing_tables import casing_energy_fractions
from facegear.machine.flank_errors import error_series
from facegear.machine.flanks import flank_edges, flank_law
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.machine import Machine, mesh_frequency
from facegear.machine.shaft_orders import LoadedMachine, loaded_machine
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium

ORDERS = 8
"""Largest order of the mesh whose vibration is told."""
CROSSING_ORDERS = 3
"""Largest order of the mesh whose crossings with modes are told."""
ROUNDING = 1e-9
"""Amplitude of an excitation over the largest of all orders and flanks that counts as rounding."""
SAMPLES = 64
"""Positions of a mesh cycle at which excitations are taken; orders up to 31 are exact where none are
higher.
"""


def mesh_excitations(machine: Machine) -> tuple[ComplexArray, ComplexArray]:
    """Return errors and forces by which the meshes excite the machine, by orders of the mesh.

    Parameters
    ----------
    machine : Machine
        A machine whose meshes have two flanks each.

    Returns
    -------
    tuple of two (ORDERS, 2 meshes) complex arrays
        Amplitudes of the flanks' errors, m, and of their forces at the mean compression, N; zero for flanks
        without load.

    Raises
    ------
    NotConverged
        Where the equilibrium is not found.
    """
    cycles = np.arange(SAMPLES) / SAMPLES
    equilibrium = mean_equilibrium(at_rest(machine))
    linear = at_rest(machine).linear
    is_loaded = equilibrium.flank_forces[0] > 0.0
    compression = equilibrium.displacements[0] @ linear.rows.T - flank_edges(machine)
    if machine.own_softening is not None:
        compression = compression + np.tile(machine.own_softening, 2) * equilibrium.flank_forces[0]
    compression = np.where(is_loaded, np.maximum(compression, 0.0), 0.0)
    forces = flank_law(machine).force(cycles, np.tile(compression, (SAMPLES, 1)))
    errors = stacked_values(stack_series(error_series(machine)), cycles)
    amplitudes = [
        2.0 / SAMPLES * np.fft.rfft(np.where(is_loaded, curves, 0.0), axis=0)[1 : ORDERS + 1]
        for curves in (errors, forces)
    ]
    for amplitude in amplitudes:
        amplitude[np.abs(amplitude) <= ROUNDING * np.abs(amplitude).max()] = 0.0
    return amplitudes[0], amplitudes[1]


def sensor_accelerations(
    machine: Machine, model: LoadedMachine, excitations: tuple[ComplexArray, ComplexArray], speed_rpm: float
) -> ComplexArray:
    """Return the accelerations of the sensors by orders of the mesh.

    Parameters
    ----------
    machine : Machine
        A machine on a casing.
    model : LoadedMachine
        Its linear model about the mean load.
    excitations : tuple of two (ORDERS, 2 meshes) complex arrays
        Errors and forces of `mesh_excitations`.
    speed_rpm : float
        Speed of the pinions, rpm.

    Returns
    -------
    (ORDERS, sensors) complex array
        Amplitudes, m/s2.
    """
    assert machine.casing is not None
    sensors = machine.casing.mounted.sensors
    omega = 2.0 * np.pi * mesh_frequency(machine.layout, speed_rpm)
    accelerations = np.zeros((ORDERS, len(sensors)), complex)
    for number, (error, force) in enumerate(zip(*excitations, strict=True)):
        frequency = (number + 1) * omega
        motion = model.motion(error, force, speed_rpm * np.pi / 30.0, frequency)
        accelerations[number] = -(frequency**2) * sensors @ casing_motion(model.linear, motion)
    return accelerations


def sensor_table(machine: Machine, speeds: Sequence[float]) -> pd.DataFrame:
    """Return the acceleration of every sensor over speed, by orders of the mesh.

    Parameters
    ----------
    machine : Machine
        A machine on a casing with sensors.
    speeds : sequence of float
        Speeds of the pinions, rpm.

    Returns
    -------
    pd.DataFrame
        A row a speed, order and sensor: speed_rpm, order, frequency_hz, sensor, acceleration_m_per_s2, and
        is_valid, whether the modes that were kept of the casing reach as far; orders that nothing excites are
        left out.

    Raises
    ------
    NotConverged
        Where the equilibrium is not found.
    """
    assert machine.casing is not None
    model, excitations, rows = loaded_machine(machine), mesh_excitations(machine), []
    names = machine.casing.mounted.sensor_names.tolist()
    for speed in speeds:
        accelerations = np.abs(sensor_accelerations(machine, model, excitations, speed))
        for order, of_sensors in enumerate(accelerations, start=1):
            if not any(part[order - 1].any() for part in excitations):
                continue
            frequency = order * mesh_frequency(machine.layout, speed)
            is_valid = frequency <= machine.casing.mounted.valid_up_to
            rows += [
                (speed, order, frequency, name, value, is_valid)
                for name, value in zip(names, of_sensors, strict=True)
            ]
    columns = ("speed_rpm", "order", "frequency_hz", "sensor", "acceleration_m_per_s2", "is_valid")
    return pd.DataFrame(rows, columns=list(columns))


def campbell_table(machine: Machine, speeds: Sequence[float]) -> pd.DataFrame:
    """Return the modes of the machine over speed, with those of the casing marked.

    Parameters
    ----------
    machine : Machine
        A machine on a casing.
    speeds : sequence of float
        Speeds of the pinions, rpm, rising; turning bodies move the modes.

    Returns
    -------
    pd.DataFrame
        A row a mode and speed: line, speed_rpm, frequency_hz, casing_energy_fraction.
    """
    spins = machine.linear.spin is not None
    rows = []
    for speed in speeds if spins else (speeds[0], speeds[-1]):
        modes = loaded_modes(machine, speed if spins else 0.0)
        fractions = casing_energy_fractions(machine.linear, modes)
        rows += [
            (line, speed, frequency, fraction)
            for line, (frequency, fraction) in enumerate(
                zip(modes.frequencies.tolist(), fractions.tolist(), strict=True), start=1
            )
        ]
    return pd.DataFrame(rows, columns=["line", "speed_rpm", "frequency_hz", f"{CASING}_energy_fraction"])


def crossing_speeds(frequencies: Array, machine: Machine, first: float, last: float) -> pd.DataFrame:
    """Return the speeds at which orders of the mesh meet frequencies.

    Parameters
    ----------
    frequencies : (k,) array
        Hz.
    machine : Machine
        The machine.
    first, last : float
        Range of speeds of the pinions, rpm.

    Returns
    -------
    pd.DataFrame
        A row a crossing: order, frequency_hz, speed_rpm.
    """
    per_rpm = mesh_frequency(machine.layout, 1.0)
    rows = [
        (order, frequency, frequency / (order * per_rpm))
        for order in range(1, CROSSING_ORDERS + 1)
        for frequency in frequencies.tolist()
        if first <= frequency / (order * per_rpm) <= last
    ]
    return pd.DataFrame(rows, columns=["order", "frequency_hz", "speed_rpm"])
