"""The layout that section `transmission` describes: bodies, angles and meshes, in SI.

The one place where that section and the tooth numbers of section `tooth_pair` meet.
"""

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from facegear.build.rolling import nominal_state
from facegear.build.tooth_numbers import ToothNumbers
from facegear.machine.kinematics import KINEMATICS
from facegear.machine.layout import Body, FaceGear, Layout, Pinion, Role, Side, Tilt
from facegear.machine.rolling_seats import body_on_tangent
from facegear.parts.shafts import Bearing, Elasticity, Segment, Shaft, condense_shaft
from facegear.schema.bodies import (
    LIKE_ALL_GEARS,
    LIKE_ALL_PINIONS,
    GearBody,
    PinionBody,
    SingleGear,
    SinglePinion,
    TiltSection,
)
from facegear.schema.gear_body import MaterialSection
from facegear.schema.shafts import SegmentSection, ShaftSection, TurningMassSection
from facegear.schema.transmission import PinionPlace, Transmission
from facegear.sharing.groups import load_groups, split_groups

LEAST_FORCE = 100.0
"""Force at which the rolling bearings of a machine without torque are taken at first, N."""


def lumped_sections(
    transmission: Mapping[str, Any], teeth: Mapping[str, Any]
) -> tuple[Transmission, ToothNumbers]:
    """Return the two arguments of `layout`: section `transmission` and tooth numbers, from plain config
    values.

    Parameters
    ----------
    transmission : Mapping[str, Any]
        Plain values of section `transmission`.
    teeth : Mapping[str, Any]
        Plain values of section `tooth_pair`, or of its keys TEETH with `middle_mm`.

    Returns
    -------
    tuple[Transmission, ToothNumbers]
        The parsed section, and the tooth numbers in SI units.
    """
    return Transmission.of_config(transmission), ToothNumbers.of_config(teeth)


def wired_layout(transmission: Mapping[str, Any], teeth: Mapping[str, Any]) -> Layout:
    """Return the layout of a machine from plain config values.

    Parameters
    ----------
    transmission : Mapping[str, Any]
        Plain values of section `transmission`.
    teeth : Mapping[str, Any]
        Plain values of section `tooth_pair`, or of its keys TEETH with `middle_mm`.

    Returns
    -------
    Layout
        Bodies, angles and meshes in SI units.
    """
    return layout(*lumped_sections(transmission, teeth))


def layout(section: Transmission, teeth: ToothNumbers) -> Layout:
    """Return the layout that a config describes: bodies with inertia and bearings, angles of the pinions,
    meshes.

    Equal layouts are one object, so that results cached on it are reused.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    teeth : ToothNumbers
        Tooth numbers of the pair.

    Returns
    -------
    Layout
        Bodies, angles and meshes in SI units.
    """
    return _intern_layout(_layout(section, teeth))


@lru_cache(maxsize=16)
def _intern_layout(shape: Layout) -> Layout:
    """Return the same object for equal layouts, so that caches by identity find it."""
    return shape


def _layout(section: Transmission, teeth: ToothNumbers) -> Layout:
    """Build the layout from section `transmission` and the tooth numbers.

    The base radius of pinions is that of the teeth, and the radius of the gears conjugate to it, unless
    the section gives them.
    """
    radius_mm, given_mm = section.pinion.base_radius_mm, section.face_gear.mesh_radius_mm
    sides = [side for side in Side if side.value in section.face_gears]
    pinion_radius = teeth.pinion_arm if radius_mm is None else 1e-3 * radius_mm
    conjugate = pinion_radius * teeth.gear_teeth / teeth.pinion_teeth
    return Layout(
        pinions=tuple(
            Pinion(
                pinion.name,
                Role(pinion.role),
                _pitches(pinion, teeth.gear_teeth),
                _pinion_body(section, pinion, pinion_radius),
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
        kind=teeth.kind,
        middle=teeth.middle,
    )


def single_parts(section: Transmission, shape: Layout) -> tuple[list[SinglePinion], list[SingleGear]]:
    """Return the sections of single pinions and face gears, which hold what differs from all of their
    kind.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    shape : Layout
        Layout of the machine.

    Returns
    -------
    tuple[list[SinglePinion], list[SingleGear]]
        A section for each pinion and each face gear, in the order of the layout; one without any
        difference for a part that is not named.
    """
    return (
        [section.single_pinions.get(pinion.name, LIKE_ALL_PINIONS) for pinion in shape.pinions],
        [section.single_gears.get(gear.side.value, LIKE_ALL_GEARS) for gear in shape.gears],
    )


def _pinion_body(section: Transmission, pinion: PinionPlace, radius: float) -> Body:
    """Return mass, inertia and bearing stiffness of a pinion, on its own bearings or on its shaft.

    With a shaft the stiffness is the inverse of the shaft's compliance at the pinion, for forces without
    moment, x and y coupled. Rolling bearings are taken at `nominal_force`; `radius`: base radius, m.
    """
    single_pinion = section.single_pinions.get(pinion.name)
    if (shaft := section.shaft_of(pinion)) is None:
        return _body(section.pinion, single_pinion)
    if shaft.is_rolling:
        state = nominal_state(shaft, nominal_force(section, radius))
        return body_on_tangent(Body(*_inertias(section.pinion, single_pinion), (0.0, 0.0, 0.0)), state)
    compliance = condense_shaft(stepped_shaft(shaft)).compliance
    (x, xy), (_, y) = np.linalg.inv(compliance[:2, :2]).tolist()
    mass, inertia = _inertias(section.pinion, single_pinion)
    return Body(mass, inertia, (x, y, 1.0 / float(compliance[2, 2])), xy)


def nominal_force(section: Transmission, radius: float) -> float:
    """Return the force at which rolling bearings are taken before a machine's statics are known.

    Parameters
    ----------
    section : Transmission
        Section `transmission` of the config.
    radius : float
        Base radius of the pinions, m.

    Returns
    -------
    float
        Largest torque of a pinion over the base radius, N, at least LEAST_FORCE.
    """
    torques = [section.torque.per_input_n_m, *(pinion.torque_n_m or 0.0 for pinion in section.pinions)]
    return max(LEAST_FORCE, max(abs(torque) for torque in torques) / radius)


def _body(section: PinionBody | GearBody, single_part: SinglePinion | SingleGear | None) -> Body:
    """Return mass, inertia, bearing stiffness and tilt of a body; values of the single part go before the
    shared.

    A face gear with a body that bends tilts as `hub_tilt` says, another one as `tilt` does. Pinions do
    not tilt.
    """
    stiffness = (single_part and single_part.bearing_stiffness_n_per_m) or section.bearing_stiffness_n_per_m
    assert stiffness is not None
    if ((single_part and single_part.body) or section.body) is None:
        tilt = (single_part and single_part.tilt) or section.tilt
    else:
        tilt = (single_part and single_part.hub_tilt) or section.hub_tilt
    return Body(
        *_inertias(section, single_part),
        (stiffness.x, stiffness.y, stiffness.z),
        stiffness.xy,
        _tilt(tilt) if tilt else None,
    )


def _tilt(section: TiltSection) -> Tilt:
    """Return inertia (kg m2), stiffness (N m/rad) and centre (m below the pitch plane) of a tilting gear."""
    below = 1e-3 * section.centre_below_pitch_plane_mm
    return Tilt(section.inertia_kg_m2, section.stiffness_n_m_per_rad, below)


def _inertias(
    section: PinionBody | GearBody, single_part: SinglePinion | SingleGear | None
) -> tuple[float, float]:
    """Return mass, kg, and inertia, kg m^2, of a body; values given for the single body go first."""
    single_part = single_part or LIKE_ALL_PINIONS
    return (
        section.mass_kg if single_part.mass_kg is None else single_part.mass_kg,
        section.inertia_kg_m2 if single_part.inertia_kg_m2 is None else single_part.inertia_kg_m2,
    )


def _pitches(pinion: PinionPlace, gear_teeth: int) -> float:
    """Return the distribution angle of a pinion in pitches of the gear."""
    if pinion.angle_pitches is not None:
        return pinion.angle_pitches
    return float(pinion.angle_deg or 0.0) / 360.0 * gear_teeth


def split_kinds(values: Mapping[str, Any]) -> list[str]:
    """Return the kinds of the groups of pinions that split a load among their meshes.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of a whole config.

    Returns
    -------
    list[str]
        Kinds, each once, as `facegear.sharing.groups` names them: inputs and idlers for the paper's
        machine.
    """
    groups = split_groups(wired_layout(values["transmission"], values["tooth_pair"]))
    return list(dict.fromkeys(group.kind.value for group in groups))


def has_groups(values: Mapping[str, Any]) -> bool:
    """Whether several meshes belong to pinions of one kind, inputs or others, whether or not they split a
    load.

    Parameters
    ----------
    values : Mapping[str, Any]
        Plain values of a whole config.

    Returns
    -------
    bool
        True if there is such a group.
    """
    return bool(load_groups(wired_layout(values["transmission"], values["tooth_pair"])))


def stepped_shaft(section: ShaftSection) -> Shaft:
    """Return the shaft of a section with its bearings, in SI units.

    Parameters
    ----------
    section : ShaftSection
        The section, validated.

    Returns
    -------
    Shaft
        Segments in order, elasticity, bearings with their place and stiffness, and place of the pinion
        along the shaft, m.
    """
    return Shaft(
        tuple(_segment(part) for part in section.segments),
        _elasticity(section.material),
        tuple(Bearing(1e-3 * bearing.at_mm, bearing.stiffness()) for bearing in section.bearings),
        1e-3 * section.pinion_mm,
    )


def torsional_spring(section: TurningMassSection) -> float:
    """Return the stiffness of the torsional spring before a turning mass.

    A given stiffness goes first. Else the segments of a shaft are springs in series.

    Parameters
    ----------
    section : TurningMassSection
        The section, validated.

    Returns
    -------
    float
        Torsional stiffness, N m/rad.
    """
    if section.stiffness_n_m_per_rad is not None:
        return section.stiffness_n_m_per_rad
    material = _elasticity(section.material)
    return 1.0 / sum(1.0 / _segment(part).torsional_stiffness(material) for part in section.segments)


def _segment(section: SegmentSection) -> Segment:
    """Return length, diameter and bore of a segment of a shaft in m."""
    return Segment(1e-3 * section.length_mm, 1e-3 * section.diameter_mm, 1e-3 * section.bore_mm)


def _elasticity(material: MaterialSection) -> Elasticity:
    """Return Young's modulus, Pa, and Poisson's ratio of a material."""
    return Elasticity(1e9 * material.young_modulus_gpa, material.poisson_ratio)
