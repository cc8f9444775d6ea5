"""The layout that section `transmission` describes: bodies, angles and meshes, in SI.

The one place where that section and the tooth numbers of section `tooth_pair` meet.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Self

import numpy as np

from facegear.config.bodies import (
    LIKE_ALL_GEARS,
    LIKE_ALL_PINIONS,
    GearBody,
    PinionBody,
    SingleGear,
    SinglePinion,
    TiltSection,
)
from facegear.config.changes import TEETH
from facegear.config.shafts import stepped_shaft
from facegear.config.transmission import PinionPlace, Transmission
from facegear.shafts.condensed_shaft import condense_shaft
from facegear.transmission.kinematics import KINEMATICS
from facegear.transmission.layout import Body, FaceGear, Layout, Pinion, Role, Side, Tilt


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


def single_parts(section: Transmission, shape: Layout) -> tuple[list[SinglePinion], list[SingleGear]]:
    """What each pinion and each face gear has of its own, in the order of the layout."""
    return (
        [section.single_pinions.get(pinion.name, LIKE_ALL_PINIONS) for pinion in shape.pinions],
        [section.single_gears.get(gear.side.value, LIKE_ALL_GEARS) for gear in shape.gears],
    )


def _pinion_body(section: Transmission, pinion: PinionPlace) -> Body:
    """A pinion on its bearing stiffness, or on what its shaft is where no moment acts."""
    own = section.single_pinions.get(pinion.name)
    if (shaft := section.shaft_of(pinion)) is None:
        return _body(section.pinion, own)
    compliance = condense_shaft(stepped_shaft(shaft)).compliance
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


def _pitches(pinion: PinionPlace, gear_teeth: int) -> float:
    if pinion.angle_pitches is not None:
        return pinion.angle_pitches
    return float(pinion.angle_deg or 0.0) / 360.0 * gear_teeth
