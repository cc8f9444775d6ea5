"""Modes of the machine at its nominal speed with its damping, and the waves of its face gears in them."""

import numpy as np
import pandas as pd

from facegear.arrays import Arrays
from facegear.config.lumped_model import ToothNumbers
from facegear.config.machines import wired_machine
from facegear.config.transmission import Transmission
from facegear.errors import ConfigError
from facegear.stages.outcome import Outcome
from facegear.transmission.machine import Machine
from facegear.transmission.static_gears import at_rest
from facegear.transmission.statics import mean_equilibrium
from facegear.transmission.turning_modes import GROWS, machine_at_speed, wave_table


def gear_waves(
    harmonics: pd.DataFrame,
    transmission: Transmission,
    teeth: ToothNumbers,
    speed_rpm: float,
    bodies: Arrays | None = None,
    law: Arrays | None = None,
    poses: Arrays | None = None,
) -> Outcome:
    """`waves` (table) of the machine about its static load, meshes at their mean stiffness.

    Raises ConfigError where all face gears are rigid, NotConverged.
    """
    if bodies is None:
        raise ConfigError("transmission.face_gear.body", None, "given: all face gears are rigid")
    machine = wired_machine(transmission, teeth, harmonics, law=law, poses=poses, bodies=bodies)
    modes = machine_at_speed(machine, speed_rpm)
    growing = modes.frequencies[modes.damping_ratios < -GROWS]
    summary = f"{modes.frequencies.size} modes at {speed_rpm:g} rpm"
    if growing.size:
        named = ", ".join(f"{frequency:.1f}" for frequency in growing)
        summary = f"{summary}; the damping that turns with the gears makes those grow at {named} Hz"
    summary += _left_out(machine)
    return Outcome({"waves": wave_table(machine.layout, machine.linear, modes)}, summary)


def _left_out(machine: Machine) -> str:
    """What the modes of motion leave out between meshes, as a force at rest."""
    moving, whole = (mean_equilibrium(each).forces[0] for each in (machine, at_rest(machine)))
    off, largest = float(np.abs(moving - whole).max()), float(np.abs(whole).max())
    return (
        f"; the compliance between meshes that they leave out moves mesh forces at rest by up to {off:.3g} N "
        f"of {largest:.5g} N"
    )
