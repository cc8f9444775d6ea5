"""Config of the bodies: what all pinions or face gears share, and what is different in a single one."""

from typing import Annotated, ClassVar

from pydantic import BeforeValidator, Field, model_validator

from facegear.schema.base import Section, refuse
from facegear.schema.gear_body import BodySection

LIGHTEST_KG, SMALLEST_KG_M2 = 1e-6, 1e-12
"""Less belongs to no gear: a steel pinion of 2 mm has 5e-5 kg and 2e-11 kg m2."""


class BearingStiffness(Section):
    """Bearing stiffness along a body's axes."""

    x: float = Field(ge=0, le=1e14, description="along x: of a pinion tangential to the face gear")
    y: float = Field(ge=0, le=1e14, description="along y: of a pinion along the face gear's axis")
    z: float = Field(ge=0, le=1e14, description="along z, the body's own axis")
    xy: float = Field(0.0, ge=-1e14, le=1e14, description="couples x and y; below sqrt(x y) in size")

    @model_validator(mode="after")
    def _holds(self) -> "BearingStiffness":
        """Refuse a coupling with which the stiffness matrix would not be positive definite."""
        if self.xy != 0.0 and self.xy**2 >= self.x * self.y:
            refuse("xy", self.xy, f"less than sqrt(x y) = {(self.x * self.y) ** 0.5:g} in size")
        return self


class RunoutSection(Section):
    """Eccentricity of a body's teeth, once a turn."""

    eccentricity_um: float = Field(ge=0, le=1e4, description="half of the dial gauge's reading")
    phase_deg: float = Field(
        0.0,
        ge=-360,
        le=360,
        description="high point at the start, as the body turns: a pinion's from the upper gear, a face "
        "gear's from the first pinion",
    )


DIAMETRAL = (
    "clearance from side to side, as catalogues give it (radial internal clearance, ISO 5753): "
    "twice clearance_um"
)
"""Description of the keys of a diametral clearance."""


def _one_sided(one_side: float | None, diametral: float | None) -> float | None:
    """Return the clearance of a bearing to each side of its centre, um: half the diametral one where that
    is given.
    """
    return one_side if diametral is None else 0.5 * diametral


def _refuse_both(one_side: float | None, diametral: float | None) -> None:
    """Refuse a clearance that is given both one-sided and diametral."""
    if one_side and diametral is not None:
        refuse("clearance_diametral_um", diametral, f"left out where clearance_um = {one_side:g} is given")


class PinionBody(Section):
    """Data shared by all pinions; x is tangential to the face gear, y along the face gear's axis."""

    mass_kg: float = Field(ge=LIGHTEST_KG, le=1e5, description="mass of each pinion with its shaft")
    inertia_kg_m2: float = Field(ge=SMALLEST_KG_M2, le=1e5, description="about its own axis")
    bearing_stiffness_n_per_m: BearingStiffness | None = Field(
        None, description="null only where each pinion has a shaft or a bearing stiffness of its own"
    )
    base_radius_mm: float | None = Field(
        None,
        ge=1e-3,
        le=1e4,
        description="for mesh_kinematics printed; null: module * teeth / 2 * cos(pressure angle)",
    )
    clearance_um: float = Field(
        0.0, ge=0, le=1e4, description="clearance of the bearings to each side of their centre"
    )
    clearance_diametral_um: float | None = Field(None, ge=0, le=2e4, description=DIAMETRAL)
    runout: RunoutSection | None = None
    tilt: ClassVar[None] = None
    hub_tilt: ClassVar[None] = None
    body: ClassVar[None] = None

    @property
    def bearing_clearance_um(self) -> float:
        """Clearance of the bearings to each side of their centre, um; 0 if not given."""
        return _one_sided(self.clearance_um, self.clearance_diametral_um) or 0.0

    @model_validator(mode="after")
    def _single_clearance(self) -> "PinionBody":
        """Refuse a clearance that is given twice."""
        _refuse_both(self.clearance_um, self.clearance_diametral_um)
        return self


class TiltSection(Section):
    """Rocking of a face gear about its diameters."""

    inertia_kg_m2: float = Field(ge=SMALLEST_KG_M2, le=1e6, description="about a diameter")
    stiffness_n_m_per_rad: float = Field(
        ge=1e-6, le=1e14, description="of the bearings against rocking about a diameter"
    )
    centre_below_pitch_plane_mm: float = Field(
        0.0,
        ge=-1e4,
        le=1e4,
        description="how far from the pitch plane of the meshes, away from the pinions, lies the point that "
        "stays in place, as the bearings have it",
    )


def _elastic(value: object) -> object:
    """Return None for `rigid`, any other value as it is."""
    return None if value == "rigid" else value


Bending = Annotated[BodySection | None, BeforeValidator(_elastic)]


class GearBody(Section):
    """Data shared by the face gears; z is their axis."""

    mass_kg: float = Field(ge=LIGHTEST_KG, le=1e6, description="mass of each face gear")
    inertia_kg_m2: float = Field(ge=SMALLEST_KG_M2, le=1e6, description="about its own axis")
    bearing_stiffness_n_per_m: BearingStiffness
    mesh_radius_mm: float | None = Field(
        None, ge=1e-3, le=1e4, description="required by mesh_kinematics printed, refused by geometric"
    )
    tilt: TiltSection | None = Field(None, description="null: the gears stay square to their axis")
    hub_tilt: TiltSection | None = Field(
        None,
        description="beside a body: of its hub on the bearings, with the inertia of the whole gear; null: "
        "the hub stays square to its axis",
    )
    body: Bending = Field(None, description="hub, web and rim that bend; null or rigid: they do not")
    runout: RunoutSection | None = None


class Position(Section):
    """Position of a pinion's bearings relative to their nominal place."""

    x: float = Field(0.0, ge=-5000, le=5000, description="as the upper gear's teeth move")
    y: float = Field(0.0, ge=-5000, le=5000, description="towards the upper gear")
    z: float = Field(0.0, ge=-5000, le=5000, description="outwards along the pinion's axis")


class PinionForce(Section):
    """External force on a pinion, N: its weight, a pulley, a coupling."""

    x: float = Field(0.0, ge=-1e8, le=1e8, description="as the upper gear's teeth move")
    y: float = Field(0.0, ge=-1e8, le=1e8, description="towards the upper gear")


class GearForce(Section):
    """External force on a face gear, N, in the frame of the angles."""

    x: float = Field(0.0, ge=-1e8, le=1e8, description="towards angle 0")
    y: float = Field(0.0, ge=-1e8, le=1e8, description="towards a quarter turn")
    z: float = Field(0.0, ge=-1e8, le=1e8, description="along the axis, from the lower to the upper gear")


class SinglePinion(Section):
    """Values of one pinion that differ from the others; null keeps what all pinions have."""

    mass_kg: float | None = Field(None, ge=LIGHTEST_KG, le=1e5, description="mass; null: that of all pinions")
    inertia_kg_m2: float | None = Field(
        None, ge=SMALLEST_KG_M2, le=1e5, description="about its own axis; null: that of all pinions"
    )
    bearing_stiffness_n_per_m: BearingStiffness | None = None
    position_um: Position = Position()
    force_n: PinionForce = PinionForce()
    clearance_um: float | None = Field(
        None,
        ge=0,
        le=1e4,
        description="clearance of its bearings to each side of their centre; null: that of all pinions",
    )
    clearance_diametral_um: float | None = Field(None, ge=0, le=2e4, description=DIAMETRAL)
    clocking_deg: float = Field(
        0.0, ge=-360, le=360, description="lower rim of a compound pinion ahead of its upper rim"
    )
    runout: RunoutSection | None = None
    cumulative_pitch_um: tuple[Annotated[float, Field(ge=-1e5, le=1e5)], ...] = Field(
        (), description="of every tooth, ahead as it turns"
    )
    tilt: ClassVar[None] = None
    hub_tilt: ClassVar[None] = None
    body: ClassVar[None] = None

    @property
    def bearing_clearance_um(self) -> float | None:
        """Clearance of the bearings to each side of their centre, um; None: that of all pinions."""
        return _one_sided(self.clearance_um, self.clearance_diametral_um)

    @model_validator(mode="after")
    def _single_clearance(self) -> "SinglePinion":
        """Refuse a clearance that is given twice."""
        _refuse_both(self.clearance_um, self.clearance_diametral_um)
        return self


class SingleGear(Section):
    """Values of one face gear that differ from the other; null keeps what both have."""

    torque_n_m: float = Field(
        0.0,
        ge=-1e7,
        le=1e7,
        description="on the lower of two gears, negative where it is driven; the other's follows",
    )
    force_n: GearForce = GearForce()
    mass_kg: float | None = Field(None, ge=LIGHTEST_KG, le=1e6, description="mass; null: that of both gears")
    inertia_kg_m2: float | None = Field(
        None, ge=SMALLEST_KG_M2, le=1e6, description="about its own axis; null: that of both gears"
    )
    bearing_stiffness_n_per_m: BearingStiffness | None = None
    tilt: TiltSection | None = None
    hub_tilt: TiltSection | None = None
    body: BodySection | None = Field(None, description="hub, web and rim that bend")
    runout: RunoutSection | None = None
    cumulative_pitch_um: tuple[Annotated[float, Field(ge=-1e5, le=1e5)], ...] = Field(
        (), description="of every tooth, ahead as it turns"
    )


LIKE_ALL_PINIONS, LIKE_ALL_GEARS = SinglePinion(), SingleGear()
"""Single ones in which nothing is different."""
