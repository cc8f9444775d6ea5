"""The errors of single meshes and bodies that section `transmission` describes, in SI.

Lumped model that section `transmission` describes: its layout, its errors, its machine, in SI.
`facegear.build.machine` adds the mesh stiffness as its stage has stored it.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from facegear.arrays import Array
from facegear.build.machine_layout import ToothNumbers, layout, single_parts, stepped_shaft, torsional_spring
from facegear.errors import ConfigError
from facegear.harmonics import Harmonics
from facegear.machine.disturbances import Excitation
from facegear.machine.drive_line import DriveLine, Seat, TurningMass
from facegear.machine.imperfections import Imperfections, Runout
from facegear.machine.layout import Layout, PhaseConvention, mesh_phases
from facegear.machine.machine import (
    Damping,
    FlankTables,
    Machine,
    OpenFlanks,
    balanced_torques,
    pinion_torques,
)
from facegear.parts.shafts import condense_shaft
from facegear.schema.bodies import RunoutSection, SingleGear, SinglePinion
from facegear.schema.shafts import OUTPUT, TurningMassSection
from facegear.schema.transmission import LIKE_ALL_MESHES, Transmission
from facegear.schema.transmission_error import error_series


def imperfections(
    section: Transmission, shape: Layout, unloaded_error: Harmonics | None = None
) -> Imperfections:
    """Return the errors of single meshes and bodies.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.
    unloaded_error : Harmonics or None
        Transmission error e(t) of the unloaded pair, m, where a mesh takes it.

    Returns
    -------
    Imperfections
        Errors in m and rad.

    Raises
    ------
    ConfigError
        If a mesh takes e(t) from contact and there is none.
    """
    meshes = [section.single_meshes.get(name, LIKE_ALL_MESHES) for name in shape.mesh_names]
    pinions, gears = single_parts(section, shape)
    clearances = [
        section.pinion.bearing_clearance_um
        if single_part.bearing_clearance_um is None
        else single_part.bearing_clearance_um
        for single_part in pinions
    ]
    return Imperfections(
        error=1e-6 * np.array([single_part.error_um for single_part in meshes]),
        stiffness=np.array([single_part.stiffness_factor for single_part in meshes]),
        series={
            mesh: error_series(single_part.transmission_error, unloaded_error)
            for mesh, single_part in enumerate(meshes)
            if single_part.transmission_error is not None
        },
        position=1e-6
        * np.array([(single_part.position_um.x, single_part.position_um.y) for single_part in pinions]),
        bearing_clearance=1e-6 * np.array(clearances),
        clocking=np.array([single_part.clocking_deg for single_part in pinions]) / 360.0 * shape.pinion_teeth,
        pinion_runout=tuple(_runout(single_part.runout or section.pinion.runout) for single_part in pinions),
        gear_runout=tuple(_runout(single_part.runout or section.face_gear.runout) for single_part in gears),
        pinion_pitch=_pitch_curves(pinions),
        gear_pitch=_pitch_curves(gears),
    )


def half_backlash(section: Transmission, shape: Layout) -> Array:
    """Return half the backlash of each mesh: its own, or that of all meshes.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (meshes,) array
        Half the backlash, m.

    Raises
    ------
    ConfigError
        If the backlash of all meshes was not filled in.
    """
    if section.backlash_um is None:
        raise ConfigError(
            "transmission.backlash_um", None, "a number, as facegear.build.config.resolved_values gives"
        )
    meshes = [section.single_meshes.get(name, LIKE_ALL_MESHES).backlash_um for name in shape.mesh_names]
    return 0.5e-6 * np.array([section.backlash_um if single is None else single for single in meshes])


def error_lags(section: Transmission, shape: Layout) -> Array | None:
    """Return the lag of the transmission error at each mesh.

    A mesh that is named itself has its own lag, another one that of its pinion's role, if that is named. A
    mesh that is not named has none.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (meshes,) array or None
        Lags in mesh periods; None where e(t) lags as the stiffness does.
    """
    phasing = section.transmission_error.phasing
    if phasing == "mesh":
        return None
    lags: Mapping[str, float] = {} if phasing == "in_step" else phasing
    roles = [f"{shape.pinions[i].role}/{shape.gears[g].side}" for i, g in shape.meshes]
    pairs = zip(shape.mesh_names, roles, strict=True)
    return np.array([lags.get(mesh, lags.get(role, 0.0)) for mesh, role in pairs])


def _runout(section: RunoutSection | None) -> Runout:
    """Return a runout, m and rad, from its section; zero without one."""
    if section is None:
        return Runout()
    return Runout(1e-6 * section.eccentricity_um, float(np.radians(section.phase_deg)))


def _pitch_curves(bodies: Sequence[SinglePinion | SingleGear]) -> dict[int, Array]:
    """Return cumulative pitch deviations, m, by number of the body that has them."""
    return {
        body: 1e-6 * np.array(single_part.cumulative_pitch_um)
        for body, single_part in enumerate(bodies)
        if single_part.cumulative_pitch_um
    }


LumpedParts = tuple[Layout, Imperfections]
"""Layout of a section `transmission`, and its errors."""


def lumped_parts(
    section: Transmission, teeth: ToothNumbers, unloaded_error: Harmonics | None = None
) -> LumpedParts:
    """Return layout and errors, made once for all functions that need them.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.
    unloaded_error : Harmonics or None
        Transmission error e(t) of the unloaded pair, m; as in `machine`.

    Returns
    -------
    LumpedParts
        Layout and errors in SI units.

    Raises
    ------
    ConfigError
        If the config asks for e(t) from contact and there is none.
    """
    shape = layout(section, teeth)
    return shape, imperfections(section, shape, unloaded_error)


def machine(
    section: Transmission,
    teeth: ToothNumbers,
    stiffness: Harmonics,
    unloaded_error: Harmonics | None = None,
    parts: LumpedParts | None = None,
    tables: tuple[FlankTables, ...] | None = None,
) -> Machine:
    """Build the machine that a config describes, with the reference mesh stiffness from its own stage.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.
    stiffness : Harmonics
        Reference mesh stiffness, N/m.
    unloaded_error : Harmonics or None
        Transmission error e(t) of the unloaded pair, m; None if the config does not ask for it.
    parts : LumpedParts or None
        Result of `lumped_parts` with the same arguments, computed here if None.
    tables : tuple[FlankTables, ...] or None
        Tables of the flanks at each gear, where their stiffness depends on the load.

    Returns
    -------
    Machine
        The machine in SI units.

    Raises
    ------
    ConfigError
        If the config asks for e(t) from contact and there is none.
    """
    shape, flaws = parts or lumped_parts(section, teeth, unloaded_error)
    damping = section.damping
    return Machine(
        layout=shape,
        torques=balanced_torques(shape, given_torques(section, shape), other_gear_torque(section)),
        stiffness=stiffness,
        error=error_series(section.transmission_error, unloaded_error),
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
    """Return the lag of the stiffness of each mesh.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.

    Returns
    -------
    (meshes,) array
        Lags in mesh periods.
    """
    shape = layout(section, teeth)
    clocking = imperfections(section, shape).clocking
    return mesh_phases(shape, PhaseConvention(section.phase_convention), clocking)


def external_forces(section: Transmission, shape: Layout) -> Array:
    """Return the external force on each body.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (bodies, 3) array
        Forces along x, y and z of each body, N.
    """
    pinions, gears = single_parts(section, shape)
    on_pinions = [(single_part.force_n.x, single_part.force_n.y, 0.0) for single_part in pinions]
    return np.array(
        on_pinions
        + [(single_part.force_n.x, single_part.force_n.y, single_part.force_n.z) for single_part in gears]
    )


def given_torques(section: Transmission, shape: Layout) -> Array:
    """Return the torque on each pinion: its own where it has one, else that of its role.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (pinions,) array
        Torques, N m.
    """
    by_role = pinion_torques(shape, section.torque.per_input_n_m, section.torque.tail_share)
    single_torques = np.array(
        [np.nan if pinion.torque_n_m is None else pinion.torque_n_m for pinion in section.pinions]
    )
    return np.where(np.isnan(single_torques), by_role, single_torques)


def other_gear_torque(section: Transmission) -> float:
    """Return the torque on the face gear that is not the output.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.

    Returns
    -------
    float
        Torque, N m.
    """
    return float(sum(gear.torque_n_m for gear in section.single_gears.values()))


def drive_line(section: Transmission, shape: Layout) -> DriveLine | None:
    """Return the shafts and turning masses of section `transmission`.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    DriveLine or None
        Shafts and masses in SI units; None where there are neither.
    """
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
    """Return the turning masses of a shaft in SI units, in the order of the chain."""
    return tuple(
        TurningMass(part.name, torsional_spring(part), part.inertia_kg_m2, part.damping_ratio)
        for part in chain
    )
