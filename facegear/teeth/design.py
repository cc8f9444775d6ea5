"""The tooth pair in SI units, and the frames every geometry and mesh module uses.

Frames
------
Mesh frame (fixed): origin where the nominal axes cross, z the gear's axis (gear teeth point to +z, the pinion
lies above the gear), y the pinion's axis (radially outward), x tangential. The pinion axis is at z = 0, the
gear's datum (pitch) plane at z = -(pitch radius + profile shift) of the pinion.

Gear body frame: the mesh frame at gear angle 0; reference tooth 0 is centred on the half plane x = 0, y > 0.
Pinion body frame: reference tooth 0 is centred on the half plane x = 0, z < 0; y along the axis as above.

Rotations are positive when the teeth in mesh move towards +x (about -y for the pinion, -z for the gear).
Tooth j of the pinion stands at phi1 + (j - 1/2) 2 pi / N1, tooth j of the gear at phi2 + j 2 pi / N2, so at
phi1 = phi2 = 0 gear tooth 0 fills the space between pinion teeth 0 and 1. The conjugate motion is
phi2 = phi1 N1 / N2. "Right" is the +x side of a tooth in the mesh zone, "left" the -x side.
The drive side is pinion right against gear left, pair j being tooth j of both; it carries load when the
pinion drives towards +x. The back side (pinion tooth j left, gear tooth j - 1 right) is its mirror image.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import cos, pi, sqrt, tan

import numpy as np

from facegear.arrays import Array
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
class Relief:
    """A flank modification removed along the normal: `amount` (m) over `length` (m) beyond `start` (m).

    Tip, root and end relief measure from an end of the flank inwards: the full amount holds within `start` of
    the end and falls linearly to zero over the next `length`. Crownings measure from a middle: nothing within
    `start`, then a parabola reaching `amount` after `length`. Across the pinion's profile lengths are roll
    lengths along the line of action, across the gear's they are depths below the tip plane.
    """

    amount: float = 0.0
    start: float = 0.0
    length: float = 0.0


@dataclass(frozen=True)
class DeviationGrid:
    """Deviations (m) from a nominal flank on a grid of places, along its outward normal, material positive.

    face: of the pinion from its middle outwards, of the face gear the radius (m); profile: of the pinion the
    length of roll r_b th, of the face gear the depth below the tip plane (m); both rise. deviation: one row
    for each place along the face.
    """

    face: tuple[float, ...]
    profile: tuple[float, ...]
    deviation: tuple[tuple[float, ...], ...]

    @cached_property
    def zero(self) -> bool:
        """Whether the flank is as designed."""
        return not any(map(any, self.deviation))

    @cached_property
    def _hash(self) -> int:
        """Hash of the grid, computed once."""
        return hash((self.face, self.profile, self.deviation))

    def __hash__(self) -> int:
        """Return the hash of the grid, by which designs are keys of caches."""
        return self._hash


@dataclass(frozen=True)
class Flanks:
    """Deviations of both flanks of all teeth of a gear; None for a flank as it is designed."""

    right: DeviationGrid | None = None
    left: DeviationGrid | None = None

    @property
    def mirror_image(self) -> "Flanks":
        """Deviations of the gear seen in a mirror: left and right flank exchanged, values unchanged."""
        return Flanks(self.left, self.right)


@dataclass(frozen=True)
class PinionGeometry:
    """Spur pinion cut by a rack (lengths in m)."""

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


@dataclass(frozen=True)
class GearModifications:
    """Modifications that take material off both flanks of the face gear along the normal; see
    `facegear.teeth.modifications`.

    lead_slope: amount (m) at the outer end of the face, added at the inner end. profile_slope: amount (m)
    at the tip plane, added as far below the pitch plane. bias: amount (m) at the outer end of the tip,
    with the sign of the product of both.
    """

    tip_relief: Relief = field(default_factory=Relief)
    root_relief: Relief = field(default_factory=Relief)
    end_relief: Relief = field(default_factory=Relief)
    profile_crowning: Relief = field(default_factory=Relief)
    lead_crowning: Relief = field(default_factory=Relief)
    lead_slope: float = 0.0
    profile_slope: float = 0.0
    bias: float = 0.0


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
    its axis at the middle of the face, outer end away from the gear if positive (rad); axial_shift dq moves
    the gear away from the pinion along its axis (m).
    """

    offset: float = 0.0
    shaft_angle_error: float = 0.0
    axial_shift: float = 0.0


@dataclass(frozen=True)
class PairDesign:
    """A spur pinion and the face gear generated for it."""

    module: float
    pressure_angle: float
    pinion: PinionGeometry
    face_gear: FaceGearGeometry
    shaper: Shaper
    assembly: AssemblyErrors = field(default_factory=AssemblyErrors)

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
            rack=Rack(self.module, (self.pressure_angle, self.pressure_angle)),
            pinion_teeth=pinion.teeth,
            gear_teeth=gear.teeth,
            shaper_teeth=shaper.teeth,
            middle=self.mean_radius,
            width=pinion.width,
            inner_radius=gear.inner_radius,
            outer_radius=gear.outer_radius,
            pinion_addendum=pinion.addendum,
            pinion_dedendum=pinion.dedendum,
            gear_addendum=gear.addendum,
            shaper_addendum=shaper.addendum,
            profile_shift=pinion.profile_shift,
            thinning=pinion.thinning,
            rack_tip_radius=pinion.rack_tip_radius,
            shaper_tip_rounding=shaper.tip_rounding,
            pinion_tip_chamfer=pinion.tip_chamfer,
        )

    @cached_property
    def pinion_pitch_radius(self) -> float:
        """Pitch radius of the pinion, m."""
        return self.module * self.pinion.teeth / 2

    @cached_property
    def pinion_base_radius(self) -> float:
        """Base radius of the pinion, m."""
        return self.pinion_pitch_radius * cos(self.pressure_angle)

    @cached_property
    def pinion_tip_radius(self) -> float:
        """Tip radius of the pinion, profile shift included, m."""
        return self.pinion_pitch_radius + self.pinion.addendum + self.pinion.profile_shift

    @cached_property
    def pinion_root_radius(self) -> float:
        """Root radius of the pinion, profile shift included, m."""
        return self.pinion_pitch_radius - self.pinion.dedendum + self.pinion.profile_shift

    @cached_property
    def pinion_half_base_angle(self) -> float:
        """Half the angle of the pinion's tooth on its base circle (rad), thinning taken off."""
        teeth, shift = self.pinion.teeth, self.pinion.profile_shift / self.module
        nominal = pi / (2 * teeth) + 2 * shift * tan(self.pressure_angle) / teeth
        return nominal + involute(self.pressure_angle) - self.pinion.thinning / (2 * self.pinion_base_radius)

    @cached_property
    def pinion_tip_roll(self) -> float:
        """Roll angle (rad) where the involute ends: at the tip circle or at the chamfer."""
        ratio = (self.pinion_tip_radius - self.pinion.tip_chamfer) / self.pinion_base_radius
        return sqrt(max(ratio**2 - 1, 0.0))

    @cached_property
    def shaper_pitch_radius(self) -> float:
        """Pitch radius of the shaper, m."""
        return self.module * self.shaper.teeth / 2

    @cached_property
    def shaper_base_radius(self) -> float:
        """Base radius of the shaper, m."""
        return self.shaper_pitch_radius * cos(self.pressure_angle)

    @cached_property
    def shaper_tip_radius(self) -> float:
        """Tip radius of the shaper, m."""
        return self.shaper_pitch_radius + self.shaper.addendum + self.pinion.profile_shift

    @cached_property
    def shaper_rounding_centre(self) -> float:
        """Distance (m) of the centre of the shaper's tip rounding, or of a sharp edge, from its axis."""
        return self.shaper_tip_radius - self.shaper.tip_rounding

    @cached_property
    def shaper_rounding_roll(self) -> float:
        """Roll angle (rad) of an involute through the tip rounding's centre: the tangent of its pressure
        angle.
        """
        return sqrt(max((self.shaper_rounding_centre / self.shaper_base_radius) ** 2 - 1, 0.0))

    @cached_property
    def shaper_tip_roll(self) -> float:
        """Roll angle th* (rad) where the shaper's involute ends: at its tip circle or at the rounding."""
        return self.shaper_rounding_roll + self.shaper.tip_rounding / self.shaper_base_radius

    @cached_property
    def shaper_half_space_angle(self) -> float:
        """th_os (rad): half the shaper's space angle on its base circle."""
        teeth, shift = self.shaper.teeth, self.pinion.profile_shift / self.module
        return (pi / 2 - 2 * shift * tan(self.pressure_angle)) / teeth - involute(self.pressure_angle)

    @cached_property
    def shaper_ratio(self) -> float:
        """m2s = N_s / N2, gear angle per shaper angle."""
        return self.shaper.teeth / self.face_gear.teeth

    @cached_property
    def shaper_lift(self) -> float:
        """Height (m) of the shaper's axis above the pinion's nominal axis."""
        return self.shaper_pitch_radius - self.pinion_pitch_radius

    @cached_property
    def pitch_plane(self) -> float:
        """z (m) of the datum plane, where the gear tooth is as thick as its space."""
        return -self.pinion_pitch_radius - self.pinion.profile_shift

    @cached_property
    def gear_tip_plane(self) -> float:
        """Height z of the face gear's tip plane, m."""
        return self.pitch_plane + self.face_gear.addendum

    @cached_property
    def gear_root_plane(self) -> float:
        """Height z of the face gear's root plane, which the shaper's tip generates, m."""
        return self.shaper_lift - self.shaper_tip_radius

    @cached_property
    def gear_back_plane(self) -> float:
        """Height z of the back of the face gear's rim, m."""
        return self.gear_root_plane - self.face_gear.rim_thickness

    @cached_property
    def gear_base_radius(self) -> float:
        """r_b2 = m N2 cos a0 / 2 (m): the radius where the local pressure angle vanishes."""
        return self.module * self.face_gear.teeth * cos(self.pressure_angle) / 2

    @cached_property
    def gear_pitch_radius(self) -> float:
        """m N2 / 2 (m): the radius of the point contact path of the nominal assembly."""
        return self.module * self.face_gear.teeth / 2

    @cached_property
    def mean_radius(self) -> float:
        """Middle of the face (m): where the pinion's face is centred."""
        return (self.face_gear.inner_radius + self.face_gear.outer_radius) / 2


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


def linear(relief: Relief, from_end: Array) -> Array:
    """Compute the removed depth of a tip, root or end relief: `amount` at the end, falling linearly to 0.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_end : (...) array
        Distance from the end, m.

    Returns
    -------
    (...) array
        m.
    """
    if relief.amount == 0:
        return 0.0 * from_end
    part = (relief.start + relief.length - from_end) / relief.length
    return relief.amount * np.minimum(np.maximum(part, 0.0), 1.0)


def parabola(relief: Relief, from_middle: Array) -> Array:
    """Compute the removed depth of a crowning, amount ((from_middle - start) / length)^2 beyond the start.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_middle : (...) array
        Distance from the middle, m.

    Returns
    -------
    (...) array
        m.
    """
    if relief.amount == 0:
        return 0.0 * from_middle
    return relief.amount * np.maximum((from_middle - relief.start) / relief.length, 0.0) ** 2


def parabola_curvature(relief: Relief, from_middle: Array) -> Array:
    """Compute the second derivative of `parabola` by the distance.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_middle : (...) array
        Distance from the middle, m.

    Returns
    -------
    (...) array
        1/m.
    """
    if relief.amount == 0:
        return np.zeros_like(from_middle)
    return np.where(from_middle > relief.start, 2.0 * relief.amount / relief.length**2, 0.0)
