"""Config section `transmission`: bodies, bearings, damping, backlash, transmission error, torques."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from facegear.config.base import Section, refuse
from facegear.config.bodies import GearBody, PinionBody, RunoutSection, SingleGear, SinglePinion
from facegear.errors import ConfigError
from facegear.harmonics.series import Harmonics
from facegear.transmission.imperfections import Imperfections, Runout
from facegear.transmission.layout import Body, FaceGear, Layout, MeshKinematics, Pinion, Role, Side, Tilt
from facegear.transmission.machine import Damping, Machine, OpenFlanks, balanced_torques, pinion_torques
from facegear.transmission.phases import PhaseConvention

MAX_PINIONS = 60
FROM_CONTACT = "numbers, where mesh_stiffness.source is harmonics: no contact analysis gives e(t)"

TEETH = ("pinion_teeth", "face_gear_teeth", "module_mm", "pressure_angle_deg")
"""Keys of tooth_pair that the lumped model needs; its other data must not rerun modes or dynamics."""


class PinionPlace(Section):
    """One pinion: where it stands, what it does, and its torque if not the role's."""

    name: str = Field(min_length=1, max_length=40)
    role: Literal["input", "idler", "tail"]
    angle_pitches: float | None = Field(
        None, ge=-2000, le=2000, description="distribution angle in angular pitches of the face gear"
    )
    angle_deg: float | None = Field(None, ge=-360, le=360, description="distribution angle in degrees")
    torque_n_m: float | None = Field(None, ge=-1e6, le=1e6, description="overrides the torque of the role")

    @model_validator(mode="after")
    def _one_angle(self) -> "PinionPlace":
        if (self.angle_pitches is None) == (self.angle_deg is None):
            refuse("angle_pitches", self.angle_pitches, "give either angle_pitches or angle_deg")
        return self


class DampingSection(Section):
    """Equation (21) and the mesh damping of equation (20)."""

    mesh_n_s_per_m: float = Field(ge=0, le=1e7)
    mass_per_s: float = Field(ge=0, le=1e6)
    bearing_s: float = Field(ge=0, le=1e-2)
    open_flanks: Literal["always", "contact_only"] = "contact_only"


class ErrorHarmonic(Section):
    """One harmonic of the transmission error, amplitude * cos(order * angle + phase)."""

    order: int = Field(ge=1, le=64)
    amplitude_um: float = Field(ge=0, le=5000)
    phase_deg: float = Field(0.0, ge=-360, le=360)


class TransmissionError(Section):
    """Static transmission error e(t) of the reference mesh; others lag by their phase or not at all.

    `transmission_error: from_contact` is short for source from_contact.
    """

    source: Literal["given", "from_contact"] = Field(
        "given",
        description="from_contact: that of the unloaded pair's contact analysis, less its mean",
    )
    amplitude_um: float | None = Field(
        None, ge=0, le=5000, description="required where source is given, else left out"
    )
    meaning: Literal["amplitude", "range"] = "amplitude"
    phase_deg: float = Field(0.0, ge=-360, le=360)
    phasing: Literal["mesh", "in_step"] = "mesh"
    more_harmonics: tuple[ErrorHarmonic, ...] = ()

    @model_validator(mode="before")
    @classmethod
    def _short(cls, values: Any) -> Any:
        if values == "from_contact":
            return {"source": "from_contact"}
        if isinstance(values, Mapping) and isinstance(more := values.get("more_harmonics"), list):
            return {**values, "more_harmonics": tuple(more)}
        return values

    @model_validator(mode="after")
    def _one_source(self) -> "TransmissionError":
        if self.source == "given":
            if self.amplitude_um is None:
                refuse("amplitude_um", None, "required, unless transmission_error is from_contact")
            return self
        plain = TransmissionError.model_fields
        for key in ("amplitude_um", "meaning", "phase_deg", "phasing", "more_harmonics"):
            if (value := getattr(self, key)) != plain[key].default:
                refuse(key, value, "left out where e(t) is from_contact")
        return self


class SingleMesh(Section):
    """What is different in one mesh; null keeps what all meshes have."""

    error_um: float = Field(
        0.0, ge=-5000, le=5000, description="constant, positive where the drive flank comes late"
    )
    backlash_um: float | None = Field(None, ge=0, le=1e5)
    stiffness_factor: float = Field(1.0, gt=0, le=100)
    transmission_error: TransmissionError | None = None


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
    backlash_um: float | None = Field(
        None, ge=0, le=1e5, description="2b along the line of action; null: that of the teeth as assembled"
    )
    transmission_error: TransmissionError
    mesh_kinematics: Literal["geometric", "printed"] = Field(
        "geometric", description="printed: equation (13) of the paper to the letter, not what gears do"
    )
    phase_convention: Literal["geometric", "printed"] = "geometric"
    torque: Torque
    single_meshes: dict[str, SingleMesh] = Field({}, description="by `pinion/lower` or `pinion/upper`")
    single_pinions: dict[str, SinglePinion] = Field({}, description="by the pinion's name")
    single_gears: dict[str, SingleGear] = Field({}, description="by `lower` or `upper`")

    @model_validator(mode="after")
    def _known(self) -> "Transmission":
        names = [place.name for place in self.pinions]
        meshes = [f"{name}/{side}" for side in self.face_gears for name in names]
        for key, given, known in (
            ("single_meshes", self.single_meshes, meshes),
            ("single_pinions", self.single_pinions, names),
            ("single_gears", self.single_gears, list(self.face_gears)),
        ):
            for name in given:
                if name not in known:
                    refuse(f"{key}.{name}", name, f"one of {', '.join(known)}")
        return self

    @model_validator(mode="after")
    def _kinematics(self) -> "Transmission":
        radius = self.face_gear.mesh_radius_mm
        if self.mesh_kinematics == "geometric":
            for key, given in (
                ("face_gear.mesh_radius_mm", radius),
                ("pinion.base_radius_mm", self.pinion.base_radius_mm),
            ):
                if given is not None:
                    refuse(key, given, "belongs to mesh_kinematics printed; geometric follows the teeth")
            return self
        if radius is None:
            refuse("face_gear.mesh_radius_mm", None, "required by mesh_kinematics printed")
        for key in ("single_meshes", "single_pinions", "single_gears"):
            if named := list(getattr(self, key)):
                refuse(key, named, "none where mesh_kinematics is printed: it knows no errors of one part")
        for key, value in (
            ("pinion.clearance_um", self.pinion.clearance_um or None),
            ("pinion.runout", self.pinion.runout),
            ("face_gear.runout", self.face_gear.runout),
            ("face_gear.tilt", self.face_gear.tilt),
        ):
            if value is not None:
                told = value if isinstance(value, float) else value.model_dump()
                refuse(key, told, "none where mesh_kinematics is printed")
        return self

    @model_validator(mode="after")
    def _play(self) -> "Transmission":
        for place in self.pinions:
            one = self.single_pinions.get(place.name, SinglePinion())
            bearing = one.bearing_stiffness_n_per_m or self.pinion.bearing_stiffness_n_per_m
            own = one.clearance_um is not None
            play = one.clearance_um if own else self.pinion.clearance_um
            key = f"single_pinions.{place.name}.clearance_um" if own else "pinion.clearance_um"
            if play and (bearing.x <= 0.0 or bearing.x != bearing.y or bearing.xy != 0.0):
                refuse(key, play, "0 unless the bearing is round: x = y above 0, without xy")
        return self

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
    printed = section.mesh_kinematics == "printed"
    radius_mm = section.pinion.base_radius_mm
    sides = [side for side in Side if side.value in section.face_gears]
    pinion_radius = teeth.pinion_base_radius if radius_mm is None else 1e-3 * radius_mm
    conjugate = pinion_radius * teeth.gear_teeth / teeth.pinion_teeth
    return Layout(
        pinions=tuple(
            Pinion(
                place.name,
                Role(place.role),
                _pitches(place, teeth.gear_teeth),
                _body(section.pinion, section.single_pinions.get(place.name)),
            )
            for place in section.pinions
        ),
        gears=tuple(
            FaceGear(side, _body(section.face_gear, section.single_gears.get(side.value))) for side in sides
        ),
        pinion_teeth=teeth.pinion_teeth,
        gear_teeth=teeth.gear_teeth,
        pressure_angle=teeth.pressure_angle,
        pinion_radius=pinion_radius,
        gear_radius=1e-3 * (section.face_gear.mesh_radius_mm or 0.0) if printed else conjugate,
        kinematics=MeshKinematics(section.mesh_kinematics),
    )


def machine(
    section: Transmission, teeth: ToothNumbers, stiffness: Harmonics, unloaded: Harmonics | None = None
) -> Machine:
    """The machine that a config describes, with the reference mesh stiffness from its own stage.

    `unloaded` is the pair's own e(t), m. Raises ConfigError where the config asks for it and there is none.
    """
    shape = layout(section, teeth)
    damping = section.damping
    return Machine(
        layout=shape,
        torques=balanced_torques(shape, given_torques(section, shape)),
        stiffness=stiffness,
        error=error_series(section.transmission_error, unloaded),
        half_backlash=half_backlash(section),
        damping=Damping(
            damping.mesh_n_s_per_m, damping.mass_per_s, damping.bearing_s, OpenFlanks(damping.open_flanks)
        ),
        phase_convention=PhaseConvention(section.phase_convention),
        error_in_step=section.transmission_error.phasing == "in_step",
        imperfections=imperfections(section, shape, unloaded),
    )


def half_backlash(section: Transmission) -> float:
    """Half the backlash (m) common to all meshes. Raises ConfigError where it was not filled in."""
    if section.backlash_um is None:
        raise ConfigError(
            "transmission.backlash_um", None, "a number, as facegear.config.model.resolved gives"
        )
    return 0.5e-6 * section.backlash_um


def imperfections(section: Transmission, shape: Layout, unloaded: Harmonics | None = None) -> Imperfections:
    """Errors of single meshes and bodies, in m."""
    meshes = [section.single_meshes.get(name, SingleMesh()) for name in shape.mesh_names]
    pinions = [section.single_pinions.get(pinion.name, SinglePinion()) for pinion in shape.pinions]
    gears = [section.single_gears.get(gear.side.value, SingleGear()) for gear in shape.gears]
    play = [section.pinion.clearance_um if one.clearance_um is None else one.clearance_um for one in pinions]
    backlash = [np.nan if one.backlash_um is None else one.backlash_um for one in meshes]
    return Imperfections(
        error=1e-6 * np.array([one.error_um for one in meshes]),
        half_backlash=0.5e-6 * np.array(backlash),
        stiffness=np.array([one.stiffness_factor for one in meshes]),
        series={
            mesh: error_series(one.transmission_error, unloaded)
            for mesh, one in enumerate(meshes)
            if one.transmission_error is not None
        },
        position=1e-6 * np.array([(one.position_um.x, one.position_um.y) for one in pinions]),
        clearance=1e-6 * np.array(play),
        clocking=np.array([one.clocking_deg for one in pinions]) / 360.0 * shape.pinion_teeth,
        pinion_runout=tuple(_runout(one.runout or section.pinion.runout) for one in pinions),
        gear_runout=tuple(_runout(one.runout or section.face_gear.runout) for one in gears),
        pinion_pitch=_pitch_curves(pinions),
        gear_pitch=_pitch_curves(gears),
    )


def given_torques(section: Transmission, shape: Layout) -> NDArray[np.float64]:
    """Torque on each pinion by its role, or its own where it has one; shape (pinions,), N m."""
    by_role = pinion_torques(shape, section.torque.per_input_n_m, section.torque.tail_share)
    own = np.array([np.nan if place.torque_n_m is None else place.torque_n_m for place in section.pinions])
    return np.where(np.isnan(own), by_role, own)


def error_series(section: TransmissionError, unloaded: Harmonics | None = None) -> Harmonics:
    """Transmission error of the reference mesh as a Fourier series in m; `unloaded` if it is from contact.

    Raises ConfigError where it is and there is none.
    """
    if section.source == "from_contact":
        if unloaded is None:
            raise ConfigError("transmission.transmission_error", "from_contact", FROM_CONTACT)
        return unloaded
    factor = {"amplitude": 1.0, "range": 0.5}[section.meaning]
    amplitude = factor * (section.amplitude_um or 0.0)
    first = ErrorHarmonic(order=1, amplitude_um=amplitude, phase_deg=section.phase_deg)
    terms = (first, *section.more_harmonics)
    highest = max(term.order for term in terms)
    a, b = np.zeros(highest + 1), np.zeros(highest + 1)
    for term in terms:
        phase = np.radians(term.phase_deg)
        a[term.order] -= 1e-6 * term.amplitude_um * np.sin(phase)
        b[term.order] += 1e-6 * term.amplitude_um * np.cos(phase)
    return Harmonics(a, b)


def _body(section: PinionBody | GearBody, own: SinglePinion | SingleGear | None) -> Body:
    """A body from what all have and what it has of its own."""
    own = own or SinglePinion()
    stiffness = own.bearing_stiffness_n_per_m or section.bearing_stiffness_n_per_m
    tilt = getattr(own, "tilt", None) or getattr(section, "tilt", None)
    return Body(
        section.mass_kg if own.mass_kg is None else own.mass_kg,
        section.inertia_kg_m2 if own.inertia_kg_m2 is None else own.inertia_kg_m2,
        (stiffness.x, stiffness.y, stiffness.z),
        stiffness.xy,
        Tilt(tilt.inertia_kg_m2, tilt.stiffness_n_m_per_rad) if tilt else None,
    )


def _runout(section: RunoutSection | None) -> Runout:
    if section is None:
        return Runout()
    return Runout(1e-6 * section.eccentricity_um, float(np.radians(section.phase_deg)))


def _pitch_curves(bodies: Sequence[SinglePinion | SingleGear]) -> dict[int, NDArray[np.float64]]:
    return {
        body: 1e-6 * np.array(one.cumulative_pitch_um)
        for body, one in enumerate(bodies)
        if one.cumulative_pitch_um
    }


def _pitches(place: PinionPlace, gear_teeth: int) -> float:
    if place.angle_pitches is not None:
        return place.angle_pitches
    return float(place.angle_deg or 0.0) / 360.0 * gear_teeth
