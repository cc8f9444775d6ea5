"""Lumped model that section `transmission` describes: its layout, its errors, its machine, in SI.

`facegear.build.machine` adds the mesh stiffness as its stage has stored it.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from facegear.arrays import Array, Arrays
from facegear.build.casing import machine_casing
from facegear.build.machine_layout import layout, nominal_force, single_parts, stepped_shaft, torsional_spring
from facegear.build.rolling import nominal_state, rolling_shaft
from facegear.build.tooth_numbers import ToothNumbers
from facegear.errors import ConfigError
from facegear.harmonics import Harmonics
from facegear.machine.disturbances import Excitation
from facegear.machine.drive_line import DriveLine, Seat, TurningMass
from facegear.machine.imperfections import Imperfections, Runout
from facegear.machine.layout import Layout
from facegear.machine.machine import Damping, FlankTables, Machine, OpenFlanks
from facegear.machine.mesh_phases import PhaseConvention, mesh_phases, place_lags
from facegear.machine.rolling_seats import rolling_seat
from facegear.machine.torques import balanced_torques, pinion_torques
from facegear.parts.shafts import condense_shaft
from facegear.schema.bodies import RunoutSection, SingleGear, SinglePinion
from facegear.schema.shafts import OUTPUT, ShaftSection, TurningMassSection
from facegear.schema.transmission import LIKE_ALL_MESHES, Transmission
from facegear.schema.transmission_error import error_series


def imperfections(
    section: Transmission, shape: Layout, unloaded_error: Harmonics | None = None
) -> Imperfections:
    """Return the errors of single meshes and bodies in SI units.

    A part that is not named in the section has no error of its own. Runout and bearing clearance are then
    those of all parts of the kind.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.
    unloaded_error : Harmonics or None
        Transmission error e(t) of the unloaded pair, m; needed where a single mesh takes its error from
        contact.

    Returns
    -------
    Imperfections
        Errors in m and rad, clocking in pitches; meshes and bodies in the order of the layout.

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
        outwards=1e-6 * np.array([single_part.position_um.z for single_part in pinions]),
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
        If `backlash_um` of the section was not filled in.
    """
    if section.backlash_um is None:
        raise ConfigError(
            "transmission.backlash_um", None, "a number, as facegear.build.config.resolved_values gives"
        )
    meshes = [section.single_meshes.get(name, LIKE_ALL_MESHES).backlash_um for name in shape.mesh_names]
    return 0.5e-6 * np.array([section.backlash_um if single is None else single for single in meshes])


def error_lags(section: Transmission, shape: Layout) -> Array | None:
    """Return by how much the transmission error of each mesh lags behind that of the reference mesh.

    The key `transmission_error.phasing` decides: `mesh` gives None, `in_step` gives 0 for all meshes. A
    mapping gives lags by mesh name, or by role and gear, such as `input/upper`.

    A mesh that is named itself has its own lag, another one that of its pinion's role, if that is named.
    A mesh that is not named has none.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (meshes,) array or None
        Lags in mesh periods; None where e(t) lags as the stiffness does, `stiffness_lags`.
    """
    phasing = section.transmission_error.phasing
    if phasing == "mesh":
        return None
    lags: Mapping[str, float] = {} if phasing == "in_step" else phasing
    roles = [f"{shape.pinions[i].role}/{shape.gears[g].side}" for i, g in shape.meshes]
    pairs = zip(shape.mesh_names, roles, strict=True)
    return np.array([lags.get(mesh, lags.get(role, 0.0)) for mesh, role in pairs])


def _runout(section: RunoutSection | None) -> Runout:
    """Return the eccentricity (m) and the angle of its high point at the start (rad); zero where there is
    no section.
    """
    if section is None:
        return Runout()
    return Runout(1e-6 * section.eccentricity_um, float(np.radians(section.phase_deg)))


def _pitch_curves(bodies: Sequence[SinglePinion | SingleGear]) -> dict[int, Array]:
    """Return cumulative pitch deviations (teeth,) in m by the number of the pinion or gear in its list.

    Bodies without deviations are left out.
    """
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
        Transmission error e(t) of the unloaded pair, m; None if the config does not ask for it.

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
    casing: Arrays | None = None,
    flank_stiffness: Mapping[str, tuple[Harmonics, Harmonics]] | None = None,
) -> Machine:
    """Build the lumped machine that a config describes: rigid gears, contact as assembled, no friction.

    `facegear.build.machine.MachineInputs.build` adds elastic gears, poses, friction and errors of single
    teeth.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.
    stiffness : Harmonics
        Stiffness of the reference mesh over a mesh cycle, N/m; meshes differ from it by phase and factor.
    unloaded_error : Harmonics or None
        Transmission error e(t) of the unloaded pair, m; None if the config does not ask for it.
    parts : LumpedParts or None
        Result of `lumped_parts` with the same section, teeth and error, computed here if None.
    tables : tuple[FlankTables, ...] or None
        Force tables of the flanks at each gear, where mesh forces depend on the load; None for a force
        that is stiffness times compression.
    casing : mapping of arrays or None
        Arrays of stage casing; None to reduce the casing of the section here, where it has one.
    flank_stiffness : mapping of str to pair of Harmonics, or None
        Stiffness of drive and back flank by gear, N/m; None where all are `stiffness`.

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
    damping, flanks = section.damping, flank_stiffness or {}
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
        casing=machine_casing(section, shape, casing),
        tables=tables,
        excitations=excitations(section, shape),
        flank_stiffness=tuple(flanks[gear] for gear in shape.contact_gears) if flanks else None,
        has_phase_shifts=section.mesh_place == "moving",
    )


def excitations(section: Transmission, shape: Layout) -> tuple[Excitation, ...]:
    """Return the periodic torques that act on bodies beside their mean torques.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine, which numbers the bodies.

    Returns
    -------
    tuple of Excitation
        Body number, order (vibrations a turn of the body), amplitude (N m) and phase (rad) of each
        torque.
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


def stiffness_lags(section: Transmission, teeth: ToothNumbers) -> Array:
    """Return by how much the stiffness of each flank lags behind that of the reference mesh.

    The lag follows from tooth numbers, angles, clocking and axial places of the pinions, and the phase
    convention.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.

    Returns
    -------
    (2 meshes,) array
        Lags in mesh periods, drive flanks first; 0 for the first pinion and gear in its place, unless that
        gear is the lower of two.
    """
    shape = layout(section, teeth)
    flaws = imperfections(section, shape)
    phases = mesh_phases(shape, PhaseConvention(section.phase_convention), flaws.clocking)
    return np.tile(phases, 2) + place_lags(shape, flaws.outwards)


def external_forces(section: Transmission, shape: Layout) -> Array:
    """Return the external force on each body, pinions first, then face gears.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (bodies, 3) array
        Forces along x, y and z, N. Of a pinion x points as the teeth of the upper gear move and y towards
        the upper gear; z is 0. Of a face gear x points to angle 0, y to a quarter turn, z from lower to
        upper gear.
    """
    pinions, gears = single_parts(section, shape)
    on_pinions = [(single_part.force_n.x, single_part.force_n.y, 0.0) for single_part in pinions]
    return np.array(
        on_pinions
        + [(single_part.force_n.x, single_part.force_n.y, single_part.force_n.z) for single_part in gears]
    )


def given_torques(section: Transmission, shape: Layout) -> Array:
    """Return the torque on each pinion: its own `torque_n_m` where it has one, else that of its role.

    By role, an input has `per_input_n_m`, an idler none, and tail pinions carry out `tail_share` of the
    sum of the inputs, with negative sign.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    (pinions,) array
        Torques on the pinions, N m; positive drives the machine.
    """
    by_role = pinion_torques(shape, section.torque.per_input_n_m, section.torque.tail_share)
    single_torques = np.array(
        [np.nan if pinion.torque_n_m is None else pinion.torque_n_m for pinion in section.pinions]
    )
    return np.where(np.isnan(single_torques), by_role, single_torques)


def other_gear_torque(section: Transmission) -> float:
    """Return the external torque on the face gear that is not the output; the output balances all
    torques.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.

    Returns
    -------
    float
        Torque, N m; 0 where none is given.
    """
    return float(sum(gear.torque_n_m for gear in section.single_gears.values()))


def drive_line(section: Transmission, shape: Layout) -> DriveLine | None:
    """Return the shafts that pinions bend on, and the turning masses behind torsional springs.

    Masses of section `torsion` belong to a pinion by its name or role, or to the output gear.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    DriveLine or None
        Shafts condensed to the pinion's seat, and masses, by body number, in SI units; None where there
        are neither.
    """
    seats, masses = {}, {}
    for number, pinion in enumerate(section.pinions):
        if (shaft := section.shaft_of(pinion)) is not None:
            tilt_inertia = _tilt_inertia(shape, number, shaft)
            seats[number] = _seat(shaft, nominal_force(section, shape.pinion_radius), tilt_inertia)
        if chain := section.torsion.get(pinion.name) or section.torsion.get(pinion.role):
            masses[number] = _turning_masses(chain)
    if chain := section.torsion.get(OUTPUT):
        masses[len(section.pinions) + shape.output] = _turning_masses(chain)
    return DriveLine(shape, seats, masses) if seats or masses else None


def _tilt_inertia(shape: Layout, pinion: int, shaft: ShaftSection) -> float | None:
    """Return the moment of inertia of a pinion on a shaft about a diameter, kg m2; None if it does not tilt.

    A pinion whose teeth are not spur teeth at right angles tilts in any case. If its inertia is not given,
    it has half of that about its axis, as a thin disc.
    """
    if shaft.tilt_inertia_kg_m2 is None and shape.kind is not None:
        return 0.5 * shape.pinions[pinion].body.inertia
    return shaft.tilt_inertia_kg_m2


def _seat(shaft: ShaftSection, force: float, tilt_inertia: float | None) -> Seat:
    """Return the seat of a pinion with a moment of inertia about a diameter, kg m2, None without tilts;
    `force`, N, is that at which rolling bearings are taken.
    """
    if shaft.is_rolling:
        return rolling_seat(rolling_shaft(shaft), nominal_state(shaft, force), tilt_inertia)
    return Seat(condense_shaft(stepped_shaft(shaft)), tilt_inertia)


def _turning_masses(chain: Sequence[TurningMassSection]) -> tuple[TurningMass, ...]:
    """Return the turning masses behind one body in SI units, in the order of the config's chain.

    Each has its name, the stiffness of the spring before it (N m/rad), inertia (kg m2) and damping ratio.
    """
    return tuple(
        TurningMass(part.name, torsional_spring(part), part.inertia_kg_m2, part.damping_ratio)
        for part in chain
    )
