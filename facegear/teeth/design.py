"""The tooth pair in SI units, and the frames every geometry and mesh module uses.

Frames
------
Mesh frame (fixed): origin at the foot of the common perpendicular of both axes on the gear's axis, z along
that axis (gear teeth point to +z, the pinion lies above the gear), x tangential. The pinion's axis passes
through (offset, 0, 0) along a = (0, sin shaft angle, -cos shaft angle): along y if the axes cross at 90
degrees, when the gear's datum (pitch) plane is at z = -(pitch radius + profile shift) of the pinion. Places y
of the pinion count along a.

Gear body frame: the mesh frame at gear angle 0; reference tooth 0 is centred on the half plane x = 0, y > 0.
Pinion body frame: reference tooth 0 is centred on the half plane x = 0, z < 0; y along the axis as above.

Rotations are positive when the teeth in mesh move towards +x (about -y for the pinion, -z for the gear).
Tooth j of the pinion stands at phi1 + (j - 1/2) 2 pi / N1, tooth j of the gear at phi2 + j 2 pi / N2, so at
phi1 = phi2 = 0 gear tooth 0 fills the space between pinion teeth 0 and 1. The conjugate motion is
phi2 = phi1 N1 / N2. "Right" is the +x side of a tooth in the mesh zone, "left" the -x side.
The drive side is pinion right against gear left, pair j being tooth j of both; it carries load when the
pinion drives towards +x. Functions of a design describe its drive side: of the pinion the right flank, of the
gear the left flank, which `face_gear` and all that builds on it show in a mirror x -> -x. The back side
(pinion tooth j left, gear tooth j - 1 right) is the drive side of `placement.mirror_design`, seen in that
mirror: the same teeth where `PairDesign.is_symmetric`, others where teeth are helical, offset or have two
pressure angles.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import cos, pi, sqrt, tan

from facegear.teeth.flank_shapes import Flanks, GearModifications, Relief
from facegear.teeth.tooth_family import Rack, ToothFamily

BACKLASH_DIFFERS_UM = 1.0
"""Difference between a backlash that is given and that of the teeth as assembled that is worth a note."""


def involute(angle: float) -> float:
    """Compute the involute function inv a = tan a - a.

    Parameters
    ----------
    angle : float
        rad.

    Returns
    -------
    float
        rad.
    """
    return tan(angle) - angle


@dataclass(frozen=True)
class PinionGeometry:
    """Pinion cut by a rack (lengths in m; radial ones in transverse sections)."""

    teeth: int
    width: float
    addendum: float
    dedendum: float
    rack_tip_radius: float
    bore_radius: float
    profile_shift: float = 0.0
    thinning: float = 0.0
    """Normal thickness taken off the tooth, both flanks together: the pair's nominal normal backlash."""
    tip_chamfer: float = 0.0
    tip_relief: Relief = field(default_factory=Relief)
    root_relief: Relief = field(default_factory=Relief)
    lead_crowning: Relief = field(default_factory=Relief)
    flanks: Flanks = field(default_factory=Flanks)
    middle: float | None = None
    """Place y of the middle of the face along the axis; None: the gear's mean radius."""


@dataclass(frozen=True)
class FaceGearGeometry:
    """Face gear blank (m): ends are coaxial cylinders, tip and root lands are planes."""

    teeth: int
    inner_radius: float
    outer_radius: float
    addendum: float
    rim_thickness: float
    modifications: GearModifications = field(default_factory=GearModifications)
    flanks: Flanks = field(default_factory=Flanks)


@dataclass(frozen=True)
class Shaper:
    """The tool that generates the face gear; it carries the pinion's profile shift (lengths in m).

    tip_rounding: radius between its flank and its tip land, 0 for a sharp edge.
    """

    teeth: int
    addendum: float
    tip_rounding: float = 0.0


@dataclass(frozen=True)
class AssemblyErrors:
    """Errors of assembly: where the pinion stands against its nominal place in the gear's frame.

    offset dE moves the pinion along +x (m); shaft_angle_error dgamma tilts it about x through the point of
    its axis at the middle of the face, outer end away from the gear if positive (rad); gear_axial dq moves
    the gear away from the pinion along the gear's axis (m); pinion_axial w moves the pinion outwards along
    its own axis (m).
    """

    offset: float = 0.0
    shaft_angle_error: float = 0.0
    gear_axial: float = 0.0
    pinion_axial: float = 0.0


@dataclass(frozen=True)
class PairDesign:
    """A pinion and the face gear generated for it; lengths in m, angles in rad.

    module: normal module. pressure_angle: normal pressure angle of the drive flank. coast_pressure_angle:
    that of the coast flank, None where both are equal. helix_angle: positive for a right-hand pinion.
    taper_angle: positive where the pinion grows outwards. shaft_angle, offset: of the pinion's axis against
    the gear's, see `tooth_family`.
    """

    module: float
    pressure_angle: float
    pinion: PinionGeometry
    face_gear: FaceGearGeometry
    shaper: Shaper
    assembly: AssemblyErrors = field(default_factory=AssemblyErrors)
    helix_angle: float = 0.0
    taper_angle: float = 0.0
    shaft_angle: float = pi / 2
    offset: float = 0.0
    coast_pressure_angle: float | None = None

    @property
    def pressure_angles(self) -> tuple[float, float]:
        """Normal pressure angles of the drive and the coast flank, rad."""
        coast = self.coast_pressure_angle
        return self.pressure_angle, self.pressure_angle if coast is None else coast

    @property
    def is_symmetric(self) -> bool:
        """Whether coast flanks are mirror images of drive flanks: no helix, no offset, one pressure angle."""
        drive, coast = self.pressure_angles
        return self.helix_angle == 0.0 and self.offset == 0.0 and drive == coast

    @property
    def is_spur(self) -> bool:
        """Whether the teeth are symmetric and straight, and the axes cross at 90 degrees."""
        return self.is_symmetric and self.taper_angle == 0.0 and self.shaft_angle == pi / 2

    @property
    def with_swapped_flanks(self) -> "PairDesign":
        """The pair with the deviations of left and right flanks exchanged on both gears."""
        pinion, gear = self.pinion, self.face_gear
        return replace(
            self,
            pinion=replace(pinion, flanks=pinion.flanks.mirror_image),
            face_gear=replace(gear, flanks=gear.flanks.mirror_image),
        )

    @property
    def deviates(self) -> bool:
        """Whether a drive flank (pinion right, gear left) has deviations other than 0."""
        grids = self.pinion.flanks.right, self.face_gear.flanks.left
        return not all(grid is None or grid.zero for grid in grids)

    @cached_property
    def family(self) -> ToothFamily:
        """The pair's nominal teeth as members of the family of all kinds, without errors of assembly."""
        pinion, gear, shaper = self.pinion, self.face_gear, self.shaper
        return ToothFamily(
            rack=Rack(self.module, self.pressure_angles, self.helix_angle, self.taper_angle),
            pinion_teeth=pinion.teeth,
            gear_teeth=gear.teeth,
            shaper_teeth=shaper.teeth,
            middle=self.middle,
            width=pinion.width,
            inner_radius=gear.inner_radius,
            outer_radius=gear.outer_radius,
            pinion_addendum=pinion.addendum,
            pinion_dedendum=pinion.dedendum,
            gear_addendum=gear.addendum,
            shaper_addendum=shaper.addendum,
            shaft_angle=self.shaft_angle,
            offset=self.offset,
            profile_shift=pinion.profile_shift,
            thinning=pinion.thinning,
            rack_tip_radius=pinion.rack_tip_radius,
            shaper_tip_rounding=shaper.tip_rounding,
            pinion_tip_chamfer=pinion.tip_chamfer,
        )

    @cached_property
    def mirror_family(self) -> ToothFamily:
        """The pair's nominal teeth in a mirror x -> -x, where the gear's drive flank stands on the right."""
        return self.family.mirror_image

    @cached_property
    def transverse_module(self) -> float:
        """Module in the pinion's transverse section, m."""
        return self.family.rack.transverse_module

    @cached_property
    def pinion_pitch_radius(self) -> float:
        """Pitch radius of the pinion, m."""
        return self.family.pinion_pitch_radius

    @cached_property
    def pinion_base_radius(self) -> float:
        """Radius of the base cylinder of the pinion's drive flank, m."""
        return self.family.pinion_flanks[0].base_radius

    @cached_property
    def normal_arm(self) -> float:
        """Torque on the pinion over the force along the drive flank's normal, m: base radius times the cosine
        of the base helix.
        """
        return self.pinion_base_radius * self.family.pinion_flanks[0].cosine

    @cached_property
    def gear_normal_arm(self) -> float:
        """Torque on the gear over the force along the drive flank's normal, m."""
        return self.gear_base_radius * self.family.pinion_flanks[0].cosine

    @cached_property
    def transverse_pressure_angle(self) -> float:
        """Pressure angle of the drive flank in the pinion's transverse section, rad."""
        return self.family.pinion_flanks[0].pressure_angle

    @cached_property
    def pinion_tip_radius(self) -> float:
        """Tip radius of the pinion in the middle of its face, profile shift included, m."""
        return self.pinion_pitch_radius + self.pinion.addendum + self.pinion.profile_shift

    @cached_property
    def pinion_root_radius(self) -> float:
        """Root radius of the pinion in the middle of its face, profile shift included, m."""
        return self.pinion_pitch_radius - self.pinion.dedendum + self.pinion.profile_shift

    @cached_property
    def pinion_half_base_angle(self) -> float:
        """Half the angle (rad) of the pinion's tooth on its base circle in the middle of its face, to the
        drive flank, thinning taken off.
        """
        return self.family.pinion_flanks[0].half_base_angle

    @cached_property
    def pinion_tip_roll(self) -> float:
        """Roll angle (rad) where the involute ends in the middle of the face: at the tip or chamfer."""
        ratio = (self.pinion_tip_radius - self.pinion.tip_chamfer) / self.pinion_base_radius
        return sqrt(max(ratio**2 - 1, 0.0))

    @cached_property
    def shaper_pitch_radius(self) -> float:
        """Pitch radius of the shaper, m."""
        return self.family.shaper_pitch_radius

    @cached_property
    def shaper_base_radius(self) -> float:
        """Radius of the base cylinder of the shaper's drive flank, m."""
        return self.family.shaper_flanks[0].base_radius

    @cached_property
    def shaper_tip_radius(self) -> float:
        """Tip radius of the shaper in the middle of the pinion's face, m."""
        return self.family.shaper_tip_radius

    @cached_property
    def shaper_rounding_centre(self) -> float:
        """Distance (m) of the centre of the shaper's tip rounding, or of a sharp edge, from its axis, in the
        middle of the pinion's face.
        """
        return self.family.rounding_centre

    @cached_property
    def shaper_rounding_roll(self) -> float:
        """Roll angle (rad) of an involute through the tip rounding's centre, in the middle of the pinion's
        face: the tangent of its pressure angle.
        """
        return sqrt(max((self.shaper_rounding_centre / self.shaper_base_radius) ** 2 - 1, 0.0))

    @cached_property
    def shaper_tip_roll(self) -> float:
        """Distance along the normal over the shaper's base radius (rad) where the gear's flank ends, at the
        shaper's tip or its rounding; of tapered teeth where the normal's foot is in the middle of the face.
        """
        length = self.shaper_rounding_roll / self.family.shaper_flanks[0].cosine
        return length + self.shaper.tip_rounding / self.shaper_base_radius

    @cached_property
    def shaper_half_space_angle(self) -> float:
        """th_os (rad): half the shaper's space angle on its base circle, to the drive flank, in the middle of
        the pinion's face.
        """
        return -self.family.shaper_flanks[0].phase

    @cached_property
    def shaper_ratio(self) -> float:
        """m2s = N_s / N2, gear angle per shaper angle."""
        return self.shaper.teeth / self.face_gear.teeth

    @cached_property
    def shaper_lift(self) -> float:
        """Height (m) of the shaper's axis above the pinion's nominal axis."""
        return self.family.lift

    @cached_property
    def gear_base_radius(self) -> float:
        """Base radius (m) of the pinion's drive flank times the ratio; of spur teeth the gear radius at which
        the local pressure angle vanishes.
        """
        return self.transverse_module * self.face_gear.teeth * cos(self.transverse_pressure_angle) / 2

    @cached_property
    def gear_pitch_radius(self) -> float:
        """Transverse module times half the gear's teeth (m): of spur teeth the radius of the contact path of
        the nominal assembly.
        """
        return self.transverse_module * self.face_gear.teeth / 2

    @cached_property
    def mean_radius(self) -> float:
        """Middle of the gear's face, m."""
        return (self.face_gear.inner_radius + self.face_gear.outer_radius) / 2

    @cached_property
    def middle(self) -> float:
        """Place y of the middle of the pinion's face, m."""
        return self.mean_radius if self.pinion.middle is None else self.pinion.middle


@dataclass(frozen=True)
class Material:
    """Linear elastic material: Young's modulus (Pa) and Poisson's ratio."""

    young_modulus: float
    poisson_ratio: float


def as_cut(design: PairDesign) -> PairDesign:
    """Return the pair with flanks as generated, assembled without errors: a key for caches.

    Many designs share one such pair.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    PairDesign
        Pair without modifications, deviations and errors.
    """
    no_flanks = Relief()
    pinion = replace(
        design.pinion, tip_relief=no_flanks, root_relief=no_flanks, lead_crowning=no_flanks, flanks=Flanks()
    )
    gear = replace(design.face_gear, modifications=GearModifications(), flanks=Flanks())
    return replace(design, pinion=pinion, face_gear=gear, assembly=AssemblyErrors())
