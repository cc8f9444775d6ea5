"""The tooth pair in SI units with its materials, elements and contact analysis."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi, radians
from typing import Any

from pydantic import Field, model_validator

from facegear.build.flanks import Teeth, check_flanks, common_flanks, differences
from facegear.build.plans import contact_plan, mesh_sizes
from facegear.contact.options import ContactPlan
from facegear.contact.resolution import along_the_ellipse, estimated_memory
from facegear.errors import ConfigError, NotConverged
from facegear.quantities import BODIES, Body
from facegear.schema.base import Section, refuse, require_all
from facegear.schema.contact import Contact, Mesh
from facegear.schema.flanks import FlanksSection, Side, read_files
from facegear.schema.gear_body import MaterialSection
from facegear.schema.tooth_pair import (
    AssemblySection,
    FaceGearSection,
    FlankAngles,
    GearModificationsSection,
    PinionSection,
    PressureAngle,
    ReliefSection,
    ShaperSection,
    flank_angles_deg,
)
from facegear.teeth.design import (
    AssemblyErrors,
    FaceGearGeometry,
    Material,
    PairDesign,
    PinionGeometry,
    Shaper,
)
from facegear.teeth.flank_shapes import GearModifications, Relief
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.surfaces import flank_face
from facegear.teeth.validate import check


class ToothPair(Section):
    """A pinion and the face gear generated for it."""

    pinion_teeth: int = Field(ge=5, le=500, description="number of teeth of each pinion")
    face_gear_teeth: int = Field(ge=10, le=2000, description="number of teeth of each face gear")
    module_mm: float = Field(
        ge=0.1, le=100, description="normal module: of spur teeth the pinion's pitch diameter over its teeth"
    )
    pressure_angle_deg: PressureAngle | FlankAngles = Field(
        description="normal, at the pinion's pitch circle; of both flanks, or of each"
    )
    helix_angle_deg: float = Field(
        default=0.0,
        ge=-45,
        le=45,
        description="of the rack's datum plane, positive for a right-hand pinion",
    )
    taper_angle_deg: float = Field(
        default=0.0,
        ge=-20,
        le=20,
        description="tilt of the rack's datum plane, positive where the pinion grows outwards",
    )
    shaft_angle_deg: float = Field(
        default=90.0,
        ge=20,
        le=160,
        description="between the axes as of bevel gears; below 90 the pinion's outer end leans to the gear",
    )
    offset_mm: float = Field(
        default=0.0,
        ge=-1e4,
        le=1e4,
        description="distance of the axes, positive with the pinion's axis at +x of the gear's",
    )
    material: MaterialSection = Field(
        MaterialSection(young_modulus_gpa=206.0, poisson_ratio=0.3), description="of both gears"
    )
    pinion: PinionSection | None = Field(
        default=None, description="bodies are needed by geometry and contact"
    )
    face_gear: FaceGearSection | None = Field(
        default=None, description="blank of the face gear; goes with pinion and shaper"
    )
    shaper: ShaperSection | None = Field(
        default=None, description="tool that cuts the face gear; goes with both bodies"
    )
    assembly: AssemblySection = AssemblySection()

    @model_validator(mode="before")
    @classmethod
    def _read_flank_files(cls, values: Any) -> Any:
        """Read files of measured flanks into the values, so that a fault is reported before any work."""
        return read_files(values)

    @model_validator(mode="after")
    def _possible(self) -> "ToothPair":
        """Check numbers of teeth and bodies; all mistakes are reported together."""
        require_all(self._check_teeth, self._check_bodies)
        return self

    def _check_teeth(self) -> None:
        """Refuse a face gear that has no more teeth than the pinion."""
        if self.face_gear_teeth <= self.pinion_teeth:
            refuse("face_gear_teeth", self.face_gear_teeth, f"more than the pinion's {self.pinion_teeth}")

    def _check_bodies(self) -> None:
        """Refuse a pair of which only some of pinion, face gear and shaper are given, and geometry that
        cannot be.

        Measured flanks must belong to the bodies. A pair without any of the three is allowed.
        """
        bodies = {name: getattr(self, name) for name in ("pinion", "face_gear", "shaper")}
        absent_bodies = [name for name, body in bodies.items() if body is None]
        if len(absent_bodies) == len(bodies) or self.face_gear_teeth <= self.pinion_teeth:
            return
        if absent_bodies:
            refuse(absent_bodies[0], None, "given: pinion, face_gear and shaper go together")
        nominal = nominal_design(self)
        try:
            check(nominal)
        except NotConverged as error:
            refuse("face_gear", self.face_gear_teeth, f"other teeth or radii: {error}")
        for body, section, teeth in _measured_bodies(self):
            check_flanks(section, f"{body}.flanks", flank_face(nominal, body), teeth)


def pair_design(section: ToothPair) -> PairDesign:
    """Return the geometry of the pair, its measured flanks with the mean deviations of all teeth.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    PairDesign
        The pair in SI units.

    Raises
    ------
    ConfigError
        For a section without bodies.
    """
    design = nominal_design(section)
    for body, flanks_section, teeth in _measured_bodies(section):
        flanks = common_flanks(flanks_section, flank_face(design, body), teeth)
        design = replace(design, **{body: replace(getattr(design, body), flanks=flanks)})
    return design


def single_teeth(section: ToothPair, flank: str) -> dict[Body, Teeth]:
    """Return what measured deviations of each tooth have beyond the mean of all teeth, for the flanks in
    contact.

    The pinion's drive flank is its right one, and meets the gear's left one.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.
    flank : str
        Flanks that touch: `drive` or `back`.

    Returns
    -------
    dict[Body, Teeth]
        For `pinion` and `face_gear` one grid of differences (m) for each tooth; None for every tooth
        where all are alike.

    Raises
    ------
    ConfigError
        For a section without bodies.
    """
    sides: tuple[Side, Side] = ("right", "left") if flank == "drive" else ("left", "right")
    design = nominal_design(section)
    measured_bodies = {
        body: (measured_body, teeth) for body, measured_body, teeth in _measured_bodies(section)
    }
    counts = {"pinion": section.pinion_teeth, "face_gear": section.face_gear_teeth}
    by_body: dict[Body, Teeth] = {}
    for body, side in zip(BODIES, sides, strict=True):
        measured_body = measured_bodies.get(body)
        grids = measured_body and differences(
            measured_body[0], side, flank_face(design, body), measured_body[1]
        )
        by_body[body] = grids or (None,) * counts[body]
    return by_body


def _measured_bodies(section: ToothPair) -> Iterator[tuple[Body, FlanksSection, int]]:
    """Yield name, section `flanks` and number of teeth of each body that has grids of deviations."""
    teeth = section.pinion_teeth, section.face_gear_teeth
    for body, count in zip(BODIES, teeth, strict=True):
        body_section: PinionSection | FaceGearSection | None = getattr(section, body)
        if body_section is not None and body_section.flanks.grids:
            yield body, body_section.flanks, count


def nominal_design(section: ToothPair) -> PairDesign:
    """Return the design of a pair with modified but not measured flanks.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    PairDesign
        In SI units.

    Raises
    ------
    ConfigError
        For a section without bodies.
    """
    m = 1e-3 * section.module_mm
    pinion, gear, shaper = section.pinion, section.face_gear, section.shaper
    if pinion is None or gear is None or shaper is None:
        raise ConfigError("tooth_pair.pinion", None, "given, as geometry and contact need the bodies")
    drive, coast = flank_angles_deg(section.pressure_angle_deg)
    return PairDesign(
        module=m,
        pressure_angle=radians(drive),
        coast_pressure_angle=None if drive == coast else radians(coast),
        helix_angle=radians(section.helix_angle_deg),
        taper_angle=radians(section.taper_angle_deg),
        shaft_angle=radians(section.shaft_angle_deg),
        offset=1e-3 * section.offset_mm,
        pinion=PinionGeometry(
            teeth=section.pinion_teeth,
            width=1e-3 * pinion.width_mm,
            addendum=m * pinion.addendum_modules,
            dedendum=m * pinion.dedendum_modules,
            rack_tip_radius=m * pinion.rack_tip_radius_modules,
            bore_radius=1e-3 * pinion.bore_radius_mm,
            profile_shift=m * pinion.profile_shift_modules,
            thinning=1e-6 * pinion.thinning_um,
            tip_chamfer=1e-3 * pinion.tip_chamfer_mm,
            tip_relief=_relief(pinion.tip_relief),
            root_relief=_relief(pinion.root_relief),
            lead_crowning=_relief(pinion.lead_crowning),
            middle=None if pinion.middle_mm is None else 1e-3 * pinion.middle_mm,
        ),
        face_gear=FaceGearGeometry(
            teeth=section.face_gear_teeth,
            inner_radius=1e-3 * gear.inner_radius_mm,
            outer_radius=1e-3 * gear.outer_radius_mm,
            addendum=m * gear.addendum_modules,
            rim_thickness=1e-3 * gear.rim_thickness_mm,
            modifications=_modifications(gear.modifications),
        ),
        shaper=Shaper(shaper.teeth, m * shaper.addendum_modules, m * shaper.tip_rounding_modules),
        assembly=AssemblyErrors(
            offset=1e-6 * section.assembly.offset_um,
            shaft_angle_error=section.assembly.shaft_angle_error_deg * pi / 180,
            gear_axial=1e-6 * section.assembly.gear_axial_um,
            pinion_axial=1e-6 * section.assembly.pinion_axial_um,
        ),
    )


def materials(section: ToothPair) -> tuple[Material, Material]:
    """Return the materials of pinion and face gear: their own, else that of the pair.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    tuple[Material, Material]
        Young's modulus (Pa) and Poisson's ratio of pinion and face gear.
    """
    body_materials = [body.material if body else None for body in (section.pinion, section.face_gear)]
    pinion, gear = (_material(material or section.material) for material in body_materials)
    return pinion, gear


@dataclass(frozen=True)
class Pair:
    """A tooth pair in SI units; materials of pinion and face gear."""

    design: PairDesign
    materials: tuple[Material, Material]

    def material(self, body: str) -> Material:
        """Return the material of one gear.

        Parameters
        ----------
        body : str
            `pinion` or `face_gear`.

        Returns
        -------
        Material
            Young's modulus (Pa) and Poisson's ratio.
        """
        return self.materials[("pinion", "face_gear").index(body)]


def pair(section: ToothPair) -> Pair:
    """Return geometry and materials of the pair.

    Parameters
    ----------
    section : ToothPair
        Section `tooth_pair` of the config.

    Returns
    -------
    Pair
        The pair in SI units.

    Raises
    ------
    ConfigError
        For a section without bodies.
    """
    return Pair(pair_design(section), materials(section))


def _material(section: MaterialSection) -> Material:
    """Return a material with Young's modulus in Pa."""
    return Material(1e9 * section.young_modulus_gpa, section.poisson_ratio)


def _modifications(section: GearModificationsSection) -> GearModifications:
    """Return the modifications of the face gear's flank, lengths in m."""
    return GearModifications(
        tip_relief=_relief(section.tip_relief),
        root_relief=_relief(section.root_relief),
        end_relief=_relief(section.end_relief),
        profile_crowning=_relief(section.profile_crowning),
        lead_crowning=_relief(section.lead_crowning),
        lead_slope=1e-6 * section.lead_slope_um,
        profile_slope=1e-6 * section.profile_slope_um,
        bias=1e-6 * section.bias_um,
    )


def _relief(section: ReliefSection) -> Relief:
    """Return amount, start and length of a relief in m."""
    return Relief(1e-6 * section.amount_um, 1e-3 * section.start_mm, 1e-3 * section.length_mm)


@dataclass(frozen=True)
class ContactSetup:
    """A pair, the sizes of its elements and what is asked of the contact analysis."""

    pair: Pair
    sizes: MeshSizes
    plan: ContactPlan

    @property
    def memory(self) -> float:
        """Estimated memory of the compliance of the larger body, bytes."""
        return estimated_memory(self.pair.design, self.sizes, self.plan)


def contact_setup(tooth_pair: ToothPair, mesh: Mesh, contact: Contact) -> ContactSetup:
    """Gather pair, element sizes and plan of a contact analysis, with enough cuts along the face for its
    ellipse.

    Parameters
    ----------
    tooth_pair : ToothPair
        Section `tooth_pair` of the config.
    mesh : Mesh
        Section `mesh` of the config.
    contact : Contact
        Section `contact` of the config.

    Returns
    -------
    ContactSetup
        The pair, the sizes of its elements and the plan, in SI units.

    Raises
    ------
    ConfigError
        For a pair without bodies, and for an ellipse that no cuts resolve.
    """
    teeth = pair(tooth_pair)
    sizes = mesh_sizes(mesh, teeth.design.module)
    plan = along_the_ellipse(teeth.design, teeth.materials, sizes, contact_plan(contact))
    return ContactSetup(teeth, sizes, plan)
