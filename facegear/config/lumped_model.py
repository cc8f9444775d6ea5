"""The lumped model that section `transmission` describes: its layout, its errors, its machine, in SI.

The one place where that section and the tooth numbers of section `tooth_pair` meet. `config.machines`
adds the mesh stiffness as its stage has stored it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Self

import numpy as np

from facegear.arrays import Array
from facegear.config.bodies import (
    LIKE_ALL_GEARS,
    LIKE_ALL_PINIONS,
    GearBody,
    PinionBody,
    RunoutSection,
    SingleGear,
    SinglePinion,
    TiltSection,
)
from facegear.config.changes import TEETH
from facegear.config.shafts import OUTPUT, TurningMassSection
from facegear.config.transmission import LIKE_ALL_MESHES, PinionPlace, Transmission
from facegear.config.transmission_error import error_series
from facegear.errors import ConfigError
from facegear.harmonics.series import Harmonics
from facegear.shafts.condensed import condensed
from facegear.transmission.drive_line import DriveLine, Seat, TurningMass
from facegear.transmission.imperfections import Imperfections, Runout
from facegear.transmission.kinematics import KINEMATICS
from facegear.transmission.layout import Body, FaceGear, Layout, Pinion, Role, Side, Tilt
from facegear.transmission.machine import (
    Damping,
    FlankTables,
    Machine,
    OpenFlanks,
    balanced_torques,
    pinion_torques,
)
from facegear.transmission.phases import PhaseConvention, mesh_phases


@dataclass(frozen=True)
class ToothNumbers:
    """What the lumped model takes from the tooth pair; radii in m, angle in rad."""

    pinion_teeth: int
    gear_teeth: int
    pinion_base_radius: float
    pressure_angle: float

    @classmethod
    def of_config(cls, values: Mapping[str, Any]) -> Self:
        """From the keys TEETH of section `tooth_pair`, or all of it."""
        return cls.of_teeth(*(values[key] for key in TEETH))

    @classmethod
    def of_teeth(
        cls, pinion_teeth: int, face_gear_teeth: int, module_mm: float, pressure_angle_deg: float
    ) -> Self:
        """SI values from those of the keys TEETH."""
        angle = float(np.radians(pressure_angle_deg))
        base_radius = 0.5e-3 * module_mm * pinion_teeth * float(np.cos(angle))
        return cls(pinion_teeth, face_gear_teeth, base_radius, angle)


def lumped_sections(
    transmission: Mapping[str, Any], teeth: Mapping[str, Any]
) -> tuple[Transmission, ToothNumbers]:
    """Section `transmission` and the tooth numbers from plain values of a config that was validated."""
    return Transmission.of_config(transmission), ToothNumbers.of_config(teeth)


def wired_layout(transmission: Mapping[str, Any], teeth: Mapping[str, Any]) -> Layout:
    """Bodies, angles and meshes of the machine of section `transmission`, with its tooth numbers."""
    return layout(*lumped_sections(transmission, teeth))


Described = tuple[Layout, Imperfections]
"""The layout of a section `transmission` and its errors."""


def described(section: Transmission, teeth: ToothNumbers, unloaded: Harmonics | None = None) -> Described:
    """Layout and errors, made once for all that looks at them; `unloaded` as of machine()."""
    shape = layout(section, teeth)
    return shape, imperfections(section, shape, unloaded)


def layout(section: Transmission, teeth: ToothNumbers) -> Layout:
    """The layout that a config describes; those that are alike are one, which keeps what follows from it."""
    return _shared(_layout(section, teeth))


@lru_cache(maxsize=16)
def _shared(shape: Layout) -> Layout:
    return shape


def _layout(section: Transmission, teeth: ToothNumbers) -> Layout:
    radius_mm, given_mm = section.pinion.base_radius_mm, section.face_gear.mesh_radius_mm
    sides = [side for side in Side if side.value in section.face_gears]
    pinion_radius = teeth.pinion_base_radius if radius_mm is None else 1e-3 * radius_mm
    conjugate = pinion_radius * teeth.gear_teeth / teeth.pinion_teeth
    return Layout(
        pinions=tuple(
            Pinion(
                pinion.name,
                Role(pinion.role),
                _pitches(pinion, teeth.gear_teeth),
                _pinion_body(section, pinion),
            )
            for pinion in section.pinions
        ),
        gears=tuple(
            FaceGear(side, _body(section.face_gear, section.single_gears.get(side.value))) for side in sides
        ),
        pinion_teeth=teeth.pinion_teeth,
        gear_teeth=teeth.gear_teeth,
        pressure_angle=teeth.pressure_angle,
        pinion_radius=pinion_radius,
        gear_radius=conjugate if given_mm is None else 1e-3 * given_mm,
        kinematics=KINEMATICS[section.mesh_kinematics],
    )


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
        half_backlash=half_backlash(section),
        damping=Damping(
            damping.mesh_n_s_per_m, damping.mass_per_s, damping.bearing_s, OpenFlanks(damping.open_flanks)
        ),
        phase_convention=PhaseConvention(section.phase_convention),
        error_lags=error_lags(section, shape),
        imperfections=flaws,
        forces=external_forces(section, shape),
        drive_line=drive_line(section, shape),
        tables=tables,
    )


def stiffness_phases(section: Transmission, teeth: ToothNumbers) -> Array:
    """Lag of each mesh in mesh periods, (meshes,)."""
    shape = layout(section, teeth)
    clocking = imperfections(section, shape).clocking
    return mesh_phases(shape, PhaseConvention(section.phase_convention), clocking)


def half_backlash(section: Transmission) -> float:
    """Half the backlash (m) common to all meshes. Raises ConfigError where it was not filled in."""
    if section.backlash_um is None:
        raise ConfigError(
            "transmission.backlash_um", None, "a number, as facegear.config.model.resolved gives"
        )
    return 0.5e-6 * section.backlash_um


def imperfections(section: Transmission, shape: Layout, unloaded: Harmonics | None = None) -> Imperfections:
    """Errors of single meshes and bodies, in m."""
    meshes = [section.single_meshes.get(name, LIKE_ALL_MESHES) for name in shape.mesh_names]
    pinions, gears = _singles(section, shape)
    clearances = [
        section.pinion.bearing_clearance_um if own.bearing_clearance_um is None else own.bearing_clearance_um
        for own in pinions
    ]
    backlash = [np.nan if own.backlash_um is None else own.backlash_um for own in meshes]
    return Imperfections(
        error=1e-6 * np.array([own.error_um for own in meshes]),
        half_backlash=0.5e-6 * np.array(backlash),
        stiffness=np.array([own.stiffness_factor for own in meshes]),
        series={
            mesh: error_series(own.transmission_error, unloaded)
            for mesh, own in enumerate(meshes)
            if own.transmission_error is not None
        },
        position=1e-6 * np.array([(own.position_um.x, own.position_um.y) for own in pinions]),
        bearing_clearance=1e-6 * np.array(clearances),
        clocking=np.array([own.clocking_deg for own in pinions]) / 360.0 * shape.pinion_teeth,
        pinion_runout=tuple(_runout(own.runout or section.pinion.runout) for own in pinions),
        gear_runout=tuple(_runout(own.runout or section.face_gear.runout) for own in gears),
        pinion_pitch=_pitch_curves(pinions),
        gear_pitch=_pitch_curves(gears),
    )


def external_forces(section: Transmission, shape: Layout) -> Array:
    """External force on each body along its x, y, z, shape (bodies, 3), N."""
    pinions, gears = _singles(section, shape)
    on_pinions = [(own.force_n.x, own.force_n.y, 0.0) for own in pinions]
    return np.array(on_pinions + [(own.force_n.x, own.force_n.y, own.force_n.z) for own in gears])


def given_torques(section: Transmission, shape: Layout) -> Array:
    """Torque on each pinion by its role, or its own where it has one; shape (pinions,), N m."""
    by_role = pinion_torques(shape, section.torque.per_input_n_m, section.torque.tail_share)
    own = np.array([np.nan if pinion.torque_n_m is None else pinion.torque_n_m for pinion in section.pinions])
    return np.where(np.isnan(own), by_role, own)


def error_lags(section: Transmission, shape: Layout) -> Array | None:
    """Lag of e(t) at each mesh in mesh periods, shape (meshes,); None where it is that of the stiffness.

    A mesh named itself keeps its own lag, then that of its pinion's role; one not named has none.
    """
    phasing = section.transmission_error.phasing
    if phasing == "mesh":
        return None
    named: Mapping[str, float] = {} if phasing == "in_step" else phasing
    roles = [f"{shape.pinions[i].role}/{shape.gears[g].side}" for i, g in shape.meshes]
    pairs = zip(shape.mesh_names, roles, strict=True)
    return np.array([named.get(mesh, named.get(role, 0.0)) for mesh, role in pairs])


def other_gear_torque(section: Transmission) -> float:
    """Torque on the face gear that is not the output, N m."""
    return float(sum(gear.torque_n_m for gear in section.single_gears.values()))


def _singles(section: Transmission, shape: Layout) -> tuple[list[SinglePinion], list[SingleGear]]:
    """What each pinion and each face gear has of its own, in the order of the layout."""
    return (
        [section.single_pinions.get(pinion.name, LIKE_ALL_PINIONS) for pinion in shape.pinions],
        [section.single_gears.get(gear.side.value, LIKE_ALL_GEARS) for gear in shape.gears],
    )


def drive_line(section: Transmission, shape: Layout) -> DriveLine | None:
    """Shafts and turning masses of section `transmission`; None where it has neither."""
    seats, masses = {}, {}
    for number, pinion in enumerate(section.pinions):
        if (shaft := section.shaft_of(pinion)) is not None:
            seats[number] = Seat(condensed(shaft.shaft()), shaft.tilt_inertia_kg_m2)
        if chain := section.torsion.get(pinion.name) or section.torsion.get(pinion.role):
            masses[number] = _turning_masses(chain)
    if chain := section.torsion.get(OUTPUT):
        masses[len(section.pinions) + shape.output] = _turning_masses(chain)
    return DriveLine(shape, seats, masses) if seats or masses else None


def _turning_masses(chain: Sequence[TurningMassSection]) -> tuple[TurningMass, ...]:
    return tuple(
        TurningMass(part.name, part.spring(), part.inertia_kg_m2, part.damping_ratio) for part in chain
    )


def _pinion_body(section: Transmission, pinion: PinionPlace) -> Body:
    """A pinion on its bearing stiffness, or on what its shaft is where no moment acts."""
    own = section.single_pinions.get(pinion.name)
    if (shaft := section.shaft_of(pinion)) is None:
        return _body(section.pinion, own)
    compliance = condensed(shaft.shaft()).compliance
    (x, xy), (_, y) = np.linalg.inv(compliance[:2, :2]).tolist()
    mass, inertia = _inertias(section.pinion, own)
    return Body(mass, inertia, (x, y, 1.0 / float(compliance[2, 2])), xy)


def _body(section: PinionBody | GearBody, own: SinglePinion | SingleGear | None) -> Body:
    """A body from what all have and what it has of its own."""
    stiffness = (own and own.bearing_stiffness_n_per_m) or section.bearing_stiffness_n_per_m
    assert stiffness is not None
    if ((own and own.body) or section.body) is None:
        tilt = (own and own.tilt) or section.tilt
    else:
        tilt = (own and own.hub_tilt) or section.hub_tilt
    return Body(
        *_inertias(section, own),
        (stiffness.x, stiffness.y, stiffness.z),
        stiffness.xy,
        _tilt(tilt) if tilt else None,
    )


def _tilt(section: TiltSection) -> Tilt:
    below = 1e-3 * section.centre_below_pitch_plane_mm
    return Tilt(section.inertia_kg_m2, section.stiffness_n_m_per_rad, below)


def _inertias(section: PinionBody | GearBody, own: SinglePinion | SingleGear | None) -> tuple[float, float]:
    """Mass and inertia."""
    own = own or LIKE_ALL_PINIONS
    return (
        section.mass_kg if own.mass_kg is None else own.mass_kg,
        section.inertia_kg_m2 if own.inertia_kg_m2 is None else own.inertia_kg_m2,
    )


def _runout(section: RunoutSection | None) -> Runout:
    if section is None:
        return Runout()
    return Runout(1e-6 * section.eccentricity_um, float(np.radians(section.phase_deg)))


def _pitch_curves(bodies: Sequence[SinglePinion | SingleGear]) -> dict[int, Array]:
    return {
        body: 1e-6 * np.array(own.cumulative_pitch_um)
        for body, own in enumerate(bodies)
        if own.cumulative_pitch_um
    }


def _pitches(pinion: PinionPlace, gear_teeth: int) -> float:
    if pinion.angle_pitches is not None:
        return pinion.angle_pitches
    return float(pinion.angle_deg or 0.0) / 360.0 * gear_teeth
