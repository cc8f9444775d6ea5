"""Modes of the machine at its nominal speed with its damping, and the waves of its face gears in them."""

import numpy as np

from facegear.errors import ConfigError
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import mean_equilibrium
from facegear.transmission.turning_modes import GROWS, machine_at_speeds, wave_table
from facegear.transmission.waves_over_speed import campbell_crossings, campbell_table

SPEEDS = 21
"""Speeds of the Campbell diagram from rest to the last one of the sweep, beside the nominal one."""


def gear_waves(
    machine: Machine,
    speed_rpm: float,
    last_rpm: float,
) -> Outcome:
    """Compute the modes of the machine about its static load, with meshes at their mean stiffness.

    The modes are those at the nominal speed; the Campbell diagram goes from rest to `last_rpm`.

    Parameters
    ----------
    machine : Machine
        The machine.
    speed_rpm : float
        Nominal speed of the pinions, rpm.
    last_rpm : float
        Last speed of the Campbell diagram, rpm.

    Returns
    -------
    Outcome
        Tables `waves`, `campbell` and `campbell_crossings`.

    Raises
    ------
    ConfigError
        Where all face gears are rigid.
    NotConverged
        Where the static load does not converge.
    """
    if machine.bodies is None:
        raise ConfigError("transmission.face_gear.body", None, "given: all face gears are rigid")
    speeds = sorted({*np.linspace(0.0, last_rpm, SPEEDS).tolist(), float(speed_rpm)})
    all_modes = machine_at_speeds(machine, speeds)
    modes = all_modes[speeds.index(float(speed_rpm))]
    growing = modes.frequencies[modes.damping_ratios < -GROWS]
    summary = f"{count_noun(modes.frequencies.size, 'mode')} at {speed_rpm:g} rpm"
    if growing.size:
        frequencies = ", ".join(f"{frequency:.1f}" for frequency in growing)
        summary = f"{summary}; the damping that turns with the gears makes those grow at {frequencies} Hz"
    summary += _left_out(machine)
    layout, linear = machine.layout, machine.linear
    campbell = campbell_table(layout, linear, speeds, all_modes)
    tables = {
        "waves": wave_table(layout, linear, modes),
        "campbell": campbell,
        "campbell_crossings": campbell_crossings(
            campbell, (layout.pinion_teeth, layout.gear_teeth), layout.angles
        ),
    }
    return Outcome(tables, summary)


def _left_out(machine: Machine) -> str:
    """Return what motion leaves out between flanks, as a force at rest and a change of frequencies."""
    reduced_forces, full_forces = (
        mean_equilibrium(variant).forces[0] for variant in (machine, at_rest(machine))
    )
    off, largest = float(np.abs(reduced_forces - full_forces).max()), float(np.abs(full_forces).max())
    return (
        f"; the compliance between meshes that they leave out moves mesh forces at rest by up to {off:.3g} N "
        f"of {largest:.5g} N"
    )
