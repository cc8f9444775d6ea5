"""The lumped model that section `transmission` describes: its layout, its errors, its machine, in SI.

`config.machines` adds the mesh stiffness as its stage has stored it.
"""

from collections.abc import Sequence

import numpy as np

from facegear.arrays import Array
from facegear.config.machine_errors import error_lags, half_backlash, imperfections
from facegear.config.machine_layout import ToothNumbers, layout, single_parts
from facegear.config.shafts import OUTPUT, TurningMassSection, stepped_shaft, torsional_spring
from facegear.config.transmission import Transmission
from facegear.config.transmission_error import error_series
from facegear.harmonics.series import Harmonics
from facegear.shafts.condensed_shaft import condense_shaft
from facegear.transmission.drive_line import DriveLine, Seat, TurningMass
from facegear.transmission.excitation import Excitation
from facegear.transmission.imperfections import Imperfections
from facegear.transmission.layout import Layout
from facegear.transmission.machine import (
    Damping,
    FlankTables,
    Machine,
    OpenFlanks,
    balanced_torques,
    pinion_torques,
)
from facegear.transmission.phases import PhaseConvention, mesh_phases

Described = tuple[Layout, Imperfections]
"""The layout of a section `transmission` and its errors."""


def described(section: Transmission, teeth: ToothNumbers, unloaded: Harmonics | None = None) -> Described:
    """Layout and errors, made once for all that looks at them; `unloaded` as of machine()."""
    shape = layout(section, teeth)
    return shape, imperfections(section, shape, unloaded)


def machine(
    section: Transmission,
    teeth: ToothNumbers,
    stiffness: Harmonics,
    unloaded: Harmonics | None = None,
    made: Described | None = None,
    tables: tuple[FlankTables, ...] | None = None,
) -> Machine:
    """The machine that a config describes, with the reference mesh stiffness from its own stage.

    `unloaded` is the pair's own e(t), m; made: described(section, teeth, unloaded), where the caller has it;
    tables: of the flanks at each gear, where their stiffness depends on the load.
    Raises ConfigError where the config asks for e(t) and there is none.
    """
    shape, flaws = made or described(section, teeth, unloaded)
    damping = section.damping
    return Machine(
        layout=shape,
        torques=balanced_torques(shape, given_torques(section, shape), other_gear_torque(section)),
        stiffness=stiffness,
        error=error_series(section.transmission_error, unloaded),
        half_backlash=half_backlash(section, shape),
        damping=Damping(
            damping.mesh_n_s_per_m, damping.mass_per_s, damping.bearing_s, OpenFlanks(damping.open_flanks)
        ),
        phase_convention=PhaseConvention(section.phase_convention),
        error_lags=error_lags(section, shape),
        imperfections=flaws,
        forces=external_forces(section, shape),
        drive_line=drive_line(section, shape),
        tables=tables,
        excitations=excitations(section, shape),
    )


def excitations(section: Transmission, shape: Layout) -> tuple[Excitation, ...]:
    """Return the periodic torques of section `transmission`.

    Parameters
    ----------
    section : Transmission
        As given.
    shape : Layout
        Its bodies.

    Returns
    -------
    tuple of Excitation
        In N m and rad.
    """
    pinions = [pinion.name for pinion in section.pinions]
    bodies = [*pinions, *(gear.side.value for gear in shape.gears)]
    numbers = [bodies.index(torque.body) for torque in section.excitations]
    return tuple(
        Excitation(
            body=number,
            order=torque.order,
            teeth=shape.pinion_teeth if number < len(pinions) else shape.gear_teeth,
            amplitude=torque.torque_n_m,
            phase=float(np.radians(torque.phase_deg)),
        )
        for number, torque in zip(numbers, section.excitations, strict=True)
    )


def stiffness_phases(section: Transmission, teeth: ToothNumbers) -> Array:
    """Lag of each mesh in mesh periods, (meshes,)."""
    shape = layout(section, teeth)
    clocking = imperfections(section, shape).clocking
    return mesh_phases(shape, PhaseConvention(section.phase_convention), clocking)


def external_forces(section: Transmission, shape: Layout) -> Array:
    """External force on each body along its x, y, z, shape (bodies, 3), N."""
    pinions, gears = single_parts(section, shape)
    on_pinions = [(own.force_n.x, own.force_n.y, 0.0) for own in pinions]
    return np.array(on_pinions + [(own.force_n.x, own.force_n.y, own.force_n.z) for own in gears])


def given_torques(section: Transmission, shape: Layout) -> Array:
    """Torque on each pinion by its role, or its own where it has one; shape (pinions,), N m."""
    by_role = pinion_torques(shape, section.torque.per_input_n_m, section.torque.tail_share)
    own = np.array([np.nan if pinion.torque_n_m is None else pinion.torque_n_m for pinion in section.pinions])
    return np.where(np.isnan(own), by_role, own)


def other_gear_torque(section: Transmission) -> float:
    """Torque on the face gear that is not the output, N m."""
    return float(sum(gear.torque_n_m for gear in section.single_gears.values()))


def drive_line(section: Transmission, shape: Layout) -> DriveLine | None:
    """Shafts and turning masses of section `transmission`; None where it has neither."""
    seats, masses = {}, {}
    for number, pinion in enumerate(section.pinions):
        if (shaft := section.shaft_of(pinion)) is not None:
            seats[number] = Seat(condense_shaft(stepped_shaft(shaft)), shaft.tilt_inertia_kg_m2)
        if chain := section.torsion.get(pinion.name) or section.torsion.get(pinion.role):
            masses[number] = _turning_masses(chain)
    if chain := section.torsion.get(OUTPUT):
        masses[len(section.pinions) + shape.output] = _turning_masses(chain)
    return DriveLine(shape, seats, masses) if seats or masses else None


def _turning_masses(chain: Sequence[TurningMassSection]) -> tuple[TurningMass, ...]:
    return tuple(
        TurningMass(part.name, torsional_spring(part), part.inertia_kg_m2, part.damping_ratio)
        for part in chain
    )
