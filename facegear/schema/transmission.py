"""Config section `transmission`: bodies, bearings, damping, backlash, errors, periodic torques."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from facegear.schema.base import Section, refuse, require_all
from facegear.schema.bodies import LIKE_ALL_PINIONS, GearBody, PinionBody, SingleGear, SinglePinion
from facegear.schema.casing import CasingSection
from facegear.schema.shafts import OUTPUT, ShaftSection, TurningMassSection
from facegear.schema.transmission_error import TransmissionError


class ExcitationSection(Section):
    """A periodic torque beside the mean torque of a body, where that acts: a propeller or an engine."""

    body: str = Field(min_length=1, max_length=40, description="a pinion's name, or lower or upper")
    order: float = Field(
        gt=0, le=1e5, description="vibrations in one turn of the body; in motion a multiple of its teeth"
    )
    torque_n_m: float = Field(gt=0, le=1e7, description="amplitude; a duty cycle does not scale it")
    phase_deg: float = Field(0.0, ge=-360, le=360, description="of the cosine, at the start")


MAX_PINIONS = 60
"""Largest number of pinions of a config."""

GEAR_NAMES = ("lower face gear", "upper face gear")
"""Names of the face gears among the bodies of every table; no pinion may share one of them."""


class PinionPlace(Section):
    """One pinion: where it stands, what it does, and its torque if not the role's."""

    name: str = Field(min_length=1, max_length=40, description="names the pinion in tables and keys")
    role: Literal["input", "idler", "tail"] = Field(
        description="input: brings torque in; tail: takes its share out; idler: passes power on"
    )
    angle_pitches: float | None = Field(
        None, ge=-2000, le=2000, description="distribution angle in angular pitches of the face gear"
    )
    angle_deg: float | None = Field(None, ge=-360, le=360, description="distribution angle in degrees")
    torque_n_m: float | None = Field(None, ge=-1e6, le=1e6, description="overrides the torque of the role")

    @model_validator(mode="after")
    def _one_angle(self) -> "PinionPlace":
        """Refuse an angle that is given twice or not at all."""
        if (self.angle_pitches is None) == (self.angle_deg is None):
            refuse("angle_pitches", self.angle_pitches, "given, or else angle_deg, but not both")
        return self


class DampingSection(Section):
    """Damping of meshes, equation (20) of the paper, and of bodies and bearings, its equation (21)."""

    mesh_n_s_per_m: float = Field(ge=0, le=1e7, description="damper along the line of action of each mesh")
    mass_per_s: float = Field(
        ge=0,
        le=1e6,
        description="lambda: resists the vibration of every body against the ground, lambda times its mass; "
        "a stand-in for losses elsewhere",
    )
    bearing_s: float = Field(ge=0, le=1e-2, description="damping of each bearing over its stiffness")
    open_flanks: Literal["always", "contact_only", "push_only", "mesh_deflection"] = Field(
        "contact_only",
        description="where the mesh damper acts: always, across open flanks too (equation (20)); "
        "contact_only; push_only: in contact, and spring and damper together never pull parting flanks; "
        "mesh_deflection: always and whole along the drive flank (Kahraman and Singh 1990)",
    )


class SingleMesh(Section):
    """Values of one mesh that differ from the others; null keeps what all meshes have."""

    error_um: float = Field(
        0.0, ge=-5000, le=5000, description="constant, positive where the drive flank comes late"
    )
    backlash_um: float | None = Field(
        None, ge=0, le=1e5, description="2b along the line of action; null: that of all meshes"
    )
    stiffness_factor: float = Field(1.0, ge=1e-6, le=100, description="on the mesh stiffness k(t)")
    transmission_error: TransmissionError | None = Field(
        None, description="e(t) of this mesh; null: that of all meshes"
    )


LIKE_ALL_MESHES = SingleMesh()
"""A mesh in which nothing is different."""


class Torque(Section):
    """Torque of each input pinion and the share of the input power that leaves at the tail pinions."""

    per_input_n_m: float = Field(ge=-1e6, le=1e6, description="of each input pinion")
    tail_share: float = Field(ge=0, le=1, description="part of the input power that the tails take out")


class Transmission(Section):
    """The lumped model of any number of pinions between one or two face gears."""

    pinions: tuple[PinionPlace, ...] = Field(
        min_length=1, max_length=MAX_PINIONS, description="the pinions, each between all face gears"
    )
    face_gears: tuple[Literal["lower", "upper"], ...] = Field(
        ("lower", "upper"), min_length=1, max_length=2, description="which of the two gears there are"
    )
    pinion: PinionBody
    face_gear: GearBody
    shafts: dict[str, ShaftSection] = Field(
        {}, description="by the pinions' role (input, idler, tail) or a pinion's name, which goes before"
    )
    torsion: dict[str, Annotated[tuple[TurningMassSection, ...], Field(max_length=20)]] = Field(
        {},
        description="turning masses on torsional springs, from the gear outwards, the torque on the last: by "
        "the pinions' role, a pinion's name, or output for the face gear that gives the power out",
    )
    casing: CasingSection | None = Field(
        None, description="a casing by finite elements below the bearings; null: seats that stand still"
    )
    excitations: tuple[ExcitationSection, ...] = Field(
        (), max_length=50, description="periodic torques on bodies, at orders of their turns"
    )
    damping: DampingSection
    backlash_um: float | None = Field(
        None, ge=0, le=1e5, description="2b along the line of action; null: that of the teeth as assembled"
    )
    transmission_error: TransmissionError
    mesh_kinematics: Literal["geometric", "printed"] = Field(
        "geometric", description="printed: equation (13) of the paper to the letter, not what gears do"
    )
    operating_pose: Literal["none", "static"] = Field(
        "none",
        description="static: every mesh has the contact of its teeth where bearings, tilts and loads put "
        "them at rest; none: that of the pair as assembled",
    )
    phase_convention: Literal["geometric", "printed"] = Field(
        "geometric",
        description="geometric: the half turn between both sides of a pinion counts for every pinion; "
        "printed: for the first alone, as in equation (11) of the paper",
    )
    mesh_place: Literal["even", "moving"] = Field(
        "even",
        description="place of the teeth in the mesh cycle, in motion: even: by the mean speed alone; moving: "
        "a pinion that turns or floats ahead of it carries its meshes along",
    )
    torque: Torque
    single_meshes: dict[str, SingleMesh] = Field({}, description="by `pinion/lower` or `pinion/upper`")
    single_pinions: dict[str, SinglePinion] = Field({}, description="by the pinion's name")
    single_gears: dict[str, SingleGear] = Field({}, description="by `lower` or `upper`")

    @model_validator(mode="after")
    def _possible(self) -> "Transmission":
        """Check names, lags, kinematics, bearings and masses; all mistakes are reported together."""
        require_all(
            self._check_names,
            self._lags,
            self._kinematics,
            self._held_once,
            self._clearance_in_round_bearings,
            self._masses_named_apart,
            self._distinct,
        )
        return self

    def shaft_of(self, pinion: PinionPlace) -> ShaftSection | None:
        """Return the shaft of a pinion, by its name, or else by its role.

        Parameters
        ----------
        pinion : PinionPlace
            The pinion.

        Returns
        -------
        ShaftSection or None
            Section of the shaft; None for a pinion on a bearing stiffness.
        """
        return self.shafts.get(pinion.name) or self.shafts.get(pinion.role)

    def at_speed(self, speed_rpm: float) -> "Transmission":
        """Return the section with the speed filled in where rolling elements feel centrifugal force.

        Parameters
        ----------
        speed_rpm : float
            Speed of the pinions, rpm.

        Returns
        -------
        Transmission
            The section itself where none do.
        """
        shafts = {name: shaft.at_speed(speed_rpm) for name, shaft in self.shafts.items()}
        return self if shafts == self.shafts else self.model_copy(update={"shafts": shafts})

    def _check_names(self) -> None:
        """Refuse settings of single parts that the machine does not have."""
        names = [pinion.name for pinion in self.pinions]
        meshes = [f"{name}/{side}" for side in self.face_gears for name in names]
        pinion_keys = [*names, *dict.fromkeys(pinion.role for pinion in self.pinions)]
        for key, entries, known_names in (
            ("shafts", self.shafts, pinion_keys),
            ("torsion", self.torsion, [*pinion_keys, OUTPUT]),
            ("single_meshes", self.single_meshes, meshes),
            ("single_pinions", self.single_pinions, names),
            ("single_gears", self.single_gears, list(self.face_gears)),
        ):
            for name in entries:
                if name not in known_names:
                    refuse(f"{key}.{name}", name, f"one of {', '.join(known_names)}")
        bodies = [*names, *self.face_gears]
        for number, excitation in enumerate(self.excitations):
            if excitation.body not in bodies:
                refuse(f"excitations[{number}].body", excitation.body, f"one of {', '.join(bodies)}")

    def _lags(self) -> None:
        """Refuse lags of the transmission error for meshes that do not exist."""
        phasing = self.transmission_error.phasing
        names = [
            *(pinion.name for pinion in self.pinions),
            *dict.fromkeys(pinion.role for pinion in self.pinions),
        ]
        known_names = [f"{name}/{side}" for side in self.face_gears for name in names]
        for name in phasing if isinstance(phasing, dict) else ():
            if name not in known_names:
                refuse(f"transmission_error.phasing.{name}", name, f"one of {', '.join(known_names)}")
        for name, mesh in self.single_meshes.items():
            if mesh.transmission_error and isinstance(mesh.transmission_error.phasing, dict):
                key = f"single_meshes.{name}.transmission_error.phasing"
                refuse(key, mesh.transmission_error.phasing, "left out: one mesh has no pattern")

    def _kinematics(self) -> None:
        """Refuse keys that the chosen kinematics do not use or lack."""
        radius = self.face_gear.mesh_radius_mm
        if self.mesh_kinematics == "geometric":
            for key, radius_mm in (
                ("face_gear.mesh_radius_mm", radius),
                ("pinion.base_radius_mm", self.pinion.base_radius_mm),
            ):
                if radius_mm is not None:
                    refuse(key, radius_mm, "left out: it belongs to mesh_kinematics printed")
            return
        if radius is None:
            refuse("face_gear.mesh_radius_mm", None, "given, as required by mesh_kinematics printed")
        for key in ("single_meshes", "single_pinions", "single_gears"):
            if names := list(getattr(self, key)):
                refuse(key, names, "none where mesh_kinematics is printed: it knows no errors of one part")
        for key in ("shafts", "torsion", "excitations"):
            if names := list(getattr(self, key)):
                refuse(key, names, "none where mesh_kinematics is printed")
        if self.operating_pose != "none":
            refuse("operating_pose", self.operating_pose, "none where mesh_kinematics is printed")
        if self.mesh_place != "even":
            refuse("mesh_place", self.mesh_place, "even where mesh_kinematics is printed")
        for key, value in (
            ("pinion.clearance_um", self.pinion.bearing_clearance_um or None),
            ("pinion.runout", self.pinion.runout),
            ("face_gear.runout", self.face_gear.runout),
            ("face_gear.tilt", self.face_gear.tilt),
        ):
            if value is not None:
                shown_value = value if isinstance(value, float) else value.model_dump()
                refuse(key, shown_value, "none where mesh_kinematics is printed")

    def _held_once(self) -> None:
        """Refuse a pinion with neither a shaft nor a bearing stiffness, and a stiffness that has
        no effect.
        """
        key, common = "pinion.bearing_stiffness_n_per_m", self.pinion.bearing_stiffness_n_per_m
        by_common = []
        for pinion in self.pinions:
            own_stiffness = self.single_pinions.get(pinion.name, LIKE_ALL_PINIONS).bearing_stiffness_n_per_m
            shaft = self.shaft_of(pinion)
            if own_stiffness is not None and shaft is not None:
                requirement = "left out: the pinion has a shaft, which its bearings hold"
                refuse(
                    f"single_pinions.{pinion.name}.bearing_stiffness_n_per_m",
                    own_stiffness.model_dump(),
                    requirement,
                )
            if own_stiffness is None and shaft is None:
                by_common.append(pinion.name)
        if common is None and by_common:
            refuse(key, None, f"given: {by_common[0]!r} has no shaft and no bearing stiffness of its own")
        if common is not None and self.shafts and all(self.shaft_of(pinion) for pinion in self.pinions):
            refuse(key, common.model_dump(), "null: every pinion has a shaft, which its bearings hold")

    def _masses_named_apart(self) -> None:
        """Refuse turning masses of one shaft with equal names."""
        for name, chain in self.torsion.items():
            if not chain:
                refuse(f"torsion.{name}", [], "one turning mass or more")
            for number in range(len(chain)):
                if chain[number].name in [mass.name for mass in chain[:number]]:
                    requirement = "a name that no other mass of the chain has"
                    refuse(f"torsion.{name}[{number}].name", chain[number].name, requirement)

    def _clearance_in_round_bearings(self) -> None:
        """Refuse clearance in a bearing whose radial stiffness depends on the direction."""
        for pinion in self.pinions:
            single = self.single_pinions.get(pinion.name, LIKE_ALL_PINIONS)
            has_own_clearance = single.bearing_clearance_um is not None
            clearance = single.bearing_clearance_um if has_own_clearance else self.pinion.bearing_clearance_um
            key = f"single_pinions.{pinion.name}.clearance_um" if has_own_clearance else "pinion.clearance_um"
            if (shaft := self.shaft_of(pinion)) is not None:
                if clearance and not (shaft.is_round and shaft.tilt_inertia_kg_m2 is None):
                    requirement = (
                        "0 beside a shaft with tilt_inertia_kg_m2 or with a bearing given by its matrix"
                    )
                    if shaft.is_rolling:
                        requirement = "0 beside rolling, whose clearance_diametral_um is its own"
                    refuse(key, clearance, requirement)
                continue
            bearing = single.bearing_stiffness_n_per_m or self.pinion.bearing_stiffness_n_per_m
            if bearing is None:
                continue
            if clearance and (bearing.x <= 0.0 or bearing.x != bearing.y or bearing.xy != 0.0):
                refuse(key, clearance, "0 unless the bearing is round: x = y above 0, without xy")

    def _distinct(self) -> None:
        """Refuse pinions with equal names or with the name of a gear."""
        names = [pinion.name for pinion in self.pinions]
        if len(set(names)) < len(names):
            refuse("pinions", names, "names that differ from pinion to pinion")
        for number, name in enumerate(names):
            if name in GEAR_NAMES:
                refuse(f"pinions.{number}.name", name, f"another name than {' or '.join(GEAR_NAMES)}")
        if len(set(self.face_gears)) < len(self.face_gears):
            refuse("face_gears", list(self.face_gears), "lower, upper, or both once")
        output = "upper" if "upper" in self.face_gears else self.face_gears[0]
        if (output_gear := self.single_gears.get(output)) and output_gear.torque_n_m != 0.0:
            refuse(
                f"single_gears.{output}.torque_n_m",
                output_gear.torque_n_m,
                "left out: it follows from the balance",
            )
        has_tail = any(pinion.role == "tail" for pinion in self.pinions)
        if self.torque.tail_share > 0 and not has_tail:
            refuse("torque.tail_share", self.torque.tail_share, "0 where no pinion has the role tail")
