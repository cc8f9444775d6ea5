"""Config section `transmission`: bodies, bearings, damping, backlash, transmission error, torques."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.harmonics.series import Harmonics
from facegear.transmission.layout import Body, FaceGear, Layout, Pinion, Role, Side
from facegear.transmission.machine import Damping, Machine, OpenFlanks, balanced_torques, pinion_torques
from facegear.transmission.phases import PhaseConvention

MAX_PINIONS = 60


class PinionPlace(Section):
    """One pinion: where it stands, what it does, and its torque if not the role's."""

    name: str = Field(min_length=1, max_length=40)
    role: Literal["input", "idler", "tail"]
    angle_pitches: float | None = Field(
        None, description="distribution angle in angular pitches of the face gear"
    )
    angle_deg: float | None = Field(None, description="distribution angle in degrees")
    torque_n_m: float | None = Field(None, ge=-1e6, le=1e6, description="overrides the torque of the role")

    @model_validator(mode="after")
    def _one_angle(self) -> "PinionPlace":
        if (self.angle_pitches is None) == (self.angle_deg is None):
            refuse("angle_pitches", self.angle_pitches, "give either angle_pitches or angle_deg")
        return self


class BearingStiffness(Section):
    """Bearing stiffness along a body's axes."""

    x: float = Field(ge=0, le=1e14)
    y: float = Field(ge=0, le=1e14)
    z: float = Field(ge=0, le=1e14)


class PinionBody(Section):
    """Data shared by all pinions; x is tangential to the face gear, y along the face gear's axis."""

    mass_kg: float = Field(gt=0, le=1e5)
    inertia_kg_m2: float = Field(gt=0, le=1e5)
    bearing_stiffness_n_per_m: BearingStiffness
    base_radius_mm: float | None = Field(
        None, gt=0, le=1e4, description="null: module * teeth / 2 * cos(pressure angle)"
    )


class GearBody(Section):
    """Data shared by the face gears; z is their axis."""

    mass_kg: float = Field(gt=0, le=1e6)
    inertia_kg_m2: float = Field(gt=0, le=1e6)
    bearing_stiffness_n_per_m: BearingStiffness
    mesh_radius_mm: float = Field(gt=0, le=1e4, description="where the mesh force acts")


class DampingSection(Section):
    """Equation (21) and the mesh damping of equation (20)."""

    mesh_n_s_per_m: float = Field(ge=0, le=1e7)
    mass_per_s: float = Field(ge=0, le=1e6)
    bearing_s: float = Field(ge=0, le=1e-2)
    open_flanks: Literal["always", "contact_only"] = "always"


class ErrorHarmonic(Section):
    """One harmonic of the transmission error, amplitude * cos(order * angle + phase)."""

    order: int = Field(ge=1, le=64)
    amplitude_um: float = Field(ge=0, le=5000)
    phase_deg: float = Field(0.0, ge=-360, le=360)


class TransmissionError(Section):
    """Static transmission error e(t) of the reference mesh; others lag by their phase or not at all."""

    amplitude_um: float = Field(ge=0, le=5000)
    meaning: Literal["amplitude", "range"] = "amplitude"
    phase_deg: float = Field(0.0, ge=-360, le=360)
    phasing: Literal["mesh", "in_step"] = "mesh"
    more_harmonics: tuple[ErrorHarmonic, ...] = ()


class Torque(Section):
    """Torque of each input pinion and the share of the input power that leaves at the tail pinions."""

    per_input_n_m: float = Field(ge=-1e6, le=1e6)
    tail_share: float = Field(ge=0, le=1)


class Transmission(Section):
    """The lumped model of any number of pinions between one or two face gears."""

    pinions: tuple[PinionPlace, ...] = Field(min_length=1, max_length=MAX_PINIONS)
    face_gears: tuple[Literal["lower", "upper"], ...] = Field(("lower", "upper"), min_length=1, max_length=2)
    pinion: PinionBody
    face_gear: GearBody
    damping: DampingSection
    backlash_um: float = Field(ge=0, le=1e5, description="2b along the line of action")
    transmission_error: TransmissionError
    phase_convention: Literal["geometric", "printed"] = "geometric"
    torque: Torque

    @model_validator(mode="after")
    def _distinct(self) -> "Transmission":
        names = [place.name for place in self.pinions]
        if len(set(names)) < len(names):
            refuse("pinions", names, "each pinion needs a name of its own")
        if len(set(self.face_gears)) < len(self.face_gears):
            refuse("face_gears", list(self.face_gears), "lower, upper, or both once")
        has_tail = any(place.role == "tail" for place in self.pinions)
        if self.torque.tail_share > 0 and not has_tail:
            refuse("torque.tail_share", self.torque.tail_share, "0 where no pinion has the role tail")
        return self


@dataclass(frozen=True)
class ToothNumbers:
    """What the lumped model takes from the tooth pair; radii in m, angle in rad."""

    pinion_teeth: int
    gear_teeth: int
    pinion_base_radius: float
    pressure_angle: float


def tooth_numbers(
    pinion_teeth: int, face_gear_teeth: int, module_mm: float, pressure_angle_deg: float
) -> ToothNumbers:
    """SI values from the keys of the same names in config section `tooth_pair`."""
    angle = float(np.radians(pressure_angle_deg))
    base_radius = 0.5e-3 * module_mm * pinion_teeth * float(np.cos(angle))
    return ToothNumbers(pinion_teeth, face_gear_teeth, base_radius, angle)


def layout(section: Transmission, teeth: ToothNumbers) -> Layout:
    """The layout that a config describes."""
    pinion_body = _body(section.pinion)
    gear_body = _body(section.face_gear)
    radius_mm = section.pinion.base_radius_mm
    sides = [side for side in Side if side.value in section.face_gears]
    return Layout(
        pinions=tuple(
            Pinion(place.name, Role(place.role), _pitches(place, teeth.gear_teeth), pinion_body)
            for place in section.pinions
        ),
        gears=tuple(FaceGear(side, gear_body) for side in sides),
        pinion_teeth=teeth.pinion_teeth,
        gear_teeth=teeth.gear_teeth,
        pressure_angle=teeth.pressure_angle,
        pinion_radius=teeth.pinion_base_radius if radius_mm is None else 1e-3 * radius_mm,
        gear_radius=1e-3 * section.face_gear.mesh_radius_mm,
    )


def machine(section: Transmission, teeth: ToothNumbers, stiffness: Harmonics) -> Machine:
    """The machine that a config describes, with the reference mesh stiffness from its own stage."""
    shape = layout(section, teeth)
    on_pinions = pinion_torques(shape, section.torque.per_input_n_m, section.torque.tail_share)
    given = np.array([np.nan if p.torque_n_m is None else p.torque_n_m for p in section.pinions])
    on_pinions = np.where(np.isnan(given), on_pinions, given)
    damping = section.damping
    return Machine(
        layout=shape,
        torques=balanced_torques(shape, on_pinions),
        stiffness=stiffness,
        error=error_series(section.transmission_error),
        half_backlash=0.5e-6 * section.backlash_um,
        damping=Damping(
            damping.mesh_n_s_per_m, damping.mass_per_s, damping.bearing_s, OpenFlanks(damping.open_flanks)
        ),
        phase_convention=PhaseConvention(section.phase_convention),
        error_in_step=section.transmission_error.phasing == "in_step",
    )


def error_series(section: TransmissionError) -> Harmonics:
    """Transmission error of the reference mesh as a Fourier series in m."""
    factor = {"amplitude": 1.0, "range": 0.5}[section.meaning]
    first = ErrorHarmonic(order=1, amplitude_um=factor * section.amplitude_um, phase_deg=section.phase_deg)
    terms = (first, *section.more_harmonics)
    highest = max(term.order for term in terms)
    a, b = np.zeros(highest + 1), np.zeros(highest + 1)
    for term in terms:
        phase = np.radians(term.phase_deg)
        a[term.order] -= 1e-6 * term.amplitude_um * np.sin(phase)
        b[term.order] += 1e-6 * term.amplitude_um * np.cos(phase)
    return Harmonics(a, b)


def _body(section: PinionBody | GearBody) -> Body:
    stiffness = section.bearing_stiffness_n_per_m
    return Body(section.mass_kg, section.inertia_kg_m2, (stiffness.x, stiffness.y, stiffness.z))


def _pitches(place: PinionPlace, gear_teeth: int) -> float:
    if place.angle_pitches is not None:
        return place.angle_pitches
    return float(place.angle_deg or 0.0) / 360.0 * gear_teeth
