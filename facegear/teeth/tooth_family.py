"""Parameters of the whole family of teeth: helical, tapered, any shaft angle, offset, asymmetric.

Frames
------
The origin is the foot of the common perpendicular of both axes on the gear's axis. z is the gear's axis, and
the gear's teeth point to +z. The pinion's axis passes through (offset, 0, 0) along
a = (0, sin shaft angle, -cos shaft angle); u = x cross a. For spur teeth at ninety degrees and without offset
this is the mesh frame of `design`. y is the distance along the pinion's axis from the common perpendicular.

A flank is named by its sign: +1 is the drive flank (pinion right, gear left), -1 the coast flank. The coast
flank of a pair is no mirror image of its drive flank, but the drive flank of `mirror_image` seen in a mirror.
Source: Litvin and Fuentes 2004, chapters 10 and 18.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, pi, sin, sqrt, tan
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array

SIDES = (1, -1)
"""Signs of the drive and the coast flank."""


class ToothSurface(Protocol):
    """A part of a tooth, in the body frame of its gear, by two parameters (u, v) that each class names."""

    def point(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute points of the surface.

        Parameters
        ----------
        u : (...) array_like
            First parameter, rad or m.
        v : (...) array_like
            Second parameter, m or a fraction.

        Returns
        -------
        (..., 3) array
            m.
        """

    def normal(self, u: ArrayLike, v: ArrayLike) -> Array:
        """Compute unit normals of the surface, pointing out of the tooth.

        Parameters
        ----------
        u : (...) array_like
            First parameter, rad or m.
        v : (...) array_like
            Second parameter, m or a fraction.

        Returns
        -------
        (..., 3) array
            Unit vectors, dimensionless.
        """

    def tangents(self, u: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
        """Compute the exact derivatives of `point` by its two parameters.

        Parameters
        ----------
        u : (...) array_like
            First parameter, rad or m.
        v : (...) array_like
            Second parameter, m or a fraction.

        Returns
        -------
        tuple of (..., 3) arrays
            Derivatives by u and by v, m per their units.
        """


@dataclass(frozen=True)
class Rack:
    """The rack that makes pinion and shaper; lengths in m, angles in rad.

    pressure_angles: normal pressure angles of the drive and the coast flank. helix_angle: on the datum plane,
    positive for a right-hand pinion. taper_angle: tilt of the datum plane about x, positive where the pinion
    grows outwards.
    """

    normal_module: float
    pressure_angles: tuple[float, float]
    helix_angle: float = 0.0
    taper_angle: float = 0.0

    @property
    def transverse_module(self) -> float:
        """Module in the pinion's transverse section, m."""
        return self.normal_module / cos(self.helix_angle)

    def pressure_angle(self, side: int) -> float:
        """Return the normal pressure angle of the flank of a sign.

        Parameters
        ----------
        side : int
            Sign of the flank: +1 drive, -1 coast.

        Returns
        -------
        float
            rad.
        """
        return self.pressure_angles[0 if side > 0 else 1]


@dataclass(frozen=True)
class RelativeMotion:
    """Motion of a pinion or shaper against the gear.

    ratio: gear turn over pinion turn. shaft_angle: between the axes, as for bevel gears (rad). offset: place
    of the pinion's axis along x (m).
    """

    ratio: float
    shaft_angle: float = pi / 2
    offset: float = 0.0

    @cached_property
    def sine(self) -> float:
        """Sine of the shaft angle, exactly 1 at a right angle."""
        return sin(self.shaft_angle)

    @cached_property
    def cosine(self) -> float:
        """Cosine of the shaft angle, exactly 0 at a right angle."""
        return 0.0 if self.shaft_angle == pi / 2 else cos(self.shaft_angle)

    @cached_property
    def basis(self) -> Array:
        """Rotation (3, 3) with rows x, a, u: components (..., 3) along these, times it, are in the mesh
        frame.
        """
        return np.array([[1.0, 0.0, 0.0], [0.0, self.sine, -self.cosine], [0.0, self.cosine, self.sine]])


@dataclass(frozen=True)
class Helicoid:
    """One flank of pinion or shaper: an involute helicoid; lengths in m, angles in rad.

    side: sign of the flank. sine: signed sine of the base helix. phase: angle from the middle of the space
    between teeth 0 and 1 to the involute's start in the section `middle`, counted to the flank's own side.
    """

    side: int
    pitch_radius: float
    base_radius: float
    pressure_angle: float
    sine: float
    half_base_angle: float
    phase: float
    middle: float

    @cached_property
    def cosine(self) -> float:
        """Cosine C of the base helix angle, whose sine is `sine`."""
        return sqrt(1.0 - self.sine**2)

    @cached_property
    def lead(self) -> float:
        """Tangent of the base helix: transverse length of roll per length of face."""
        return self.sine / self.cosine


@dataclass(frozen=True)
class ToothFamily:
    """A pinion of the family and the face gear that a shaper cuts for it; lengths in m, angles in rad.

    Radial lengths (addenda, dedendum, shift, roundings' places) lie in transverse sections. middle: y of the
    middle of the pinion's face. thinning: normal thickness taken off the pinion's tooth, half from either
    flank. pinion_tip_chamfer: by how much the pinion's flanks end below its tip.
    """

    rack: Rack
    pinion_teeth: int
    gear_teeth: int
    shaper_teeth: int
    middle: float
    width: float
    inner_radius: float
    outer_radius: float
    pinion_addendum: float
    pinion_dedendum: float
    gear_addendum: float
    shaper_addendum: float
    shaft_angle: float = pi / 2
    offset: float = 0.0
    profile_shift: float = 0.0
    thinning: float = 0.0
    rack_tip_radius: float = 0.0
    shaper_tip_rounding: float = 0.0
    pinion_tip_chamfer: float = 0.0

    @cached_property
    def motion(self) -> RelativeMotion:
        """Motion of the pinion against the gear: ratio N1 / N2, shaft angle and offset."""
        return RelativeMotion(self.pinion_teeth / self.gear_teeth, self.shaft_angle, self.offset)

    @cached_property
    def cutting_motion(self) -> RelativeMotion:
        """Motion of the shaper against the gear."""
        return RelativeMotion(self.shaper_teeth / self.gear_teeth, self.shaft_angle, self.offset)

    @cached_property
    def pinion_pitch_radius(self) -> float:
        """Radius of the pinion's rolling cylinder, m."""
        return self.pinion_teeth * self.rack.transverse_module / 2

    @cached_property
    def shaper_pitch_radius(self) -> float:
        """Radius of the shaper's rolling cylinder, m."""
        return self.shaper_teeth * self.rack.transverse_module / 2

    @cached_property
    def gear_pitch_radius(self) -> float:
        """Radius of the gear at which backlash counts, m."""
        return self.gear_teeth * self.rack.transverse_module / 2

    @cached_property
    def lift(self) -> float:
        """Height of the shaper's axis above the pinion's along u, m; 0 with equal tooth numbers."""
        return self.shaper_pitch_radius - self.pinion_pitch_radius

    @cached_property
    def taper(self) -> float:
        """Growth of the profile shift per length of face, tan(taper angle), dimensionless."""
        return tan(self.rack.taper_angle)

    @cached_property
    def pinion_tip_radius(self) -> float:
        """Tip radius of the pinion in the middle of its face, m."""
        return self.pinion_pitch_radius + self.profile_shift + self.pinion_addendum

    @cached_property
    def pinion_flank_radius(self) -> float:
        """Radius at which the pinion's flanks end, in the middle of its face, m."""
        return self.pinion_tip_radius - self.pinion_tip_chamfer

    @cached_property
    def shaper_tip_radius(self) -> float:
        """Tip radius of the shaper in the middle of the pinion's face, m."""
        return self.shaper_pitch_radius + self.profile_shift + self.shaper_addendum

    @cached_property
    def rounding_centre(self) -> float:
        """Radius of the centre of the shaper's tip rounding in the middle of the pinion's face, m."""
        return self.shaper_tip_radius - self.shaper_tip_rounding / cos(self.rack.taper_angle)

    @cached_property
    def gear_tip(self) -> "Meridian":
        """Meridian of the gear's tip surface, a cone or plane about its axis."""
        depth = self.pinion_pitch_radius + self.profile_shift - self.gear_addendum
        return Meridian(self.motion, depth, self.taper, self.middle)

    def shift(self, y: ArrayLike) -> Array:
        """Return the profile shift of the pinion's transverse section at a place.

        Parameters
        ----------
        y : (...) array_like
            Place along the pinion's axis, m.

        Returns
        -------
        (...) array
            m.
        """
        return self.profile_shift + (np.asarray(y, float) - self.middle) * self.taper

    @cached_property
    def pinion_flanks(self) -> tuple[Helicoid, Helicoid]:
        """Drive and coast flank of the pinion, thinning included."""
        first, second = (_helicoid(self, side, self.pinion_teeth, self.thinning) for side in SIDES)
        return first, second

    @cached_property
    def shaper_flanks(self) -> tuple[Helicoid, Helicoid]:
        """Drive and coast flank of the shaper."""
        first, second = (_helicoid(self, side, self.shaper_teeth, 0.0) for side in SIDES)
        return first, second

    @property
    def mirror_image(self) -> "ToothFamily":
        """The pair seen in the mirror x -> -x, where drive and coast flank have changed places.

        Hand and offset change sign, and the pressure angles change places; shaft angle, taper and shift stay.
        """
        rack = self.rack
        mirror_rack = replace(rack, pressure_angles=rack.pressure_angles[::-1], helix_angle=-rack.helix_angle)
        return replace(self, rack=mirror_rack, offset=-self.offset)

    @property
    def below(self) -> "ToothFamily":
        """The lower of two coaxial gears that the pinion meets, in the frame turned half round the pinion's
        axis: with an offset, or a shaft angle other than 90 degrees, it is another gear than the upper one.
        """
        return replace(self, shaft_angle=pi - self.shaft_angle, offset=-self.offset)


@dataclass(frozen=True)
class Meridian:
    """A straight meridian: points y a - q u of the plane through both axes, had they no offset.

    q is `depth` (m) at y = `middle` and grows by `taper` per length.
    """

    motion: RelativeMotion
    depth: float
    taper: float
    middle: float

    def y_at(self, radius: ArrayLike) -> Array:
        """Return where along the pinion's axis the meridian has a gear radius.

        Parameters
        ----------
        radius : (...) array_like
            Gear radius, m.

        Returns
        -------
        (...) array
            y, m.
        """
        sine, cosine = self.motion.sine, self.motion.cosine
        start = self.depth - self.middle * self.taper
        return (np.asarray(radius, float) + start * cosine) / (sine - self.taper * cosine)

    def height(self, radius: ArrayLike) -> Array:
        """Return the meridian's height z in the mesh frame at a gear radius.

        Parameters
        ----------
        radius : (...) array_like
            Gear radius, m.

        Returns
        -------
        (...) array
            z, m.
        """
        y = self.y_at(radius)
        depth = self.depth + (y - self.middle) * self.taper
        return -y * self.motion.cosine - depth * self.motion.sine

    @cached_property
    def slope(self) -> float:
        """Growth of the height per gear radius, the same everywhere."""
        sine, cosine = self.motion.sine, self.motion.cosine
        return -(cosine + self.taper * sine) / (sine - self.taper * cosine)


def _helicoid(family: ToothFamily, side: int, teeth: int, thinning: float) -> Helicoid:
    """Return a flank of a pinion or shaper by the rack, half of the thinning (m) taken off."""
    rack, helix, taper = family.rack, family.rack.helix_angle, family.rack.taper_angle
    angle, module = rack.pressure_angle(side), rack.transverse_module
    pitch_radius = teeth * module / 2
    sine = side * cos(angle) * sin(helix) * cos(taper) - sin(angle) * sin(taper)
    slope = tan(angle) * cos(taper) / cos(helix) + side * tan(helix) * sin(taper)
    transverse = angle if helix == taper == 0.0 else float(np.arctan(slope))
    base_radius = pitch_radius * cos(transverse)
    half = pi / (2 * teeth) + family.profile_shift * slope / pitch_radius + slope - transverse
    half -= thinning / (2 * base_radius * sqrt(1.0 - sine**2))
    return Helicoid(side, pitch_radius, base_radius, transverse, sine, half, half - pi / teeth, family.middle)


def turn_about_axis(turn: ArrayLike, vectors: Array) -> Array:
    """Turn vectors about the gear's axis, right-handed about +z.

    Parameters
    ----------
    turn : (...) array_like
        Angle about +z, rad.
    vectors : (..., 3) array
        Components x, y, z, any unit.

    Returns
    -------
    (..., 3) array
        The unit of `vectors`.
    """
    c, s = np.cos(turn), np.sin(turn)
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    return stack_vectors(x * c - y * s, x * s + y * c, z)


def across_axis(vectors: Array) -> Array:
    """Return the cross product z x v of the gear's axis with vectors: their change per turn about +z.

    Parameters
    ----------
    vectors : (..., 3) array
        Any unit.

    Returns
    -------
    (..., 3) array
        The unit of `vectors`.
    """
    return stack_vectors(-vectors[..., 1], vectors[..., 0], np.zeros(vectors.shape[:-1]))


def dot(first: Array, second: Array) -> Array:
    """Return scalar products along the last axis.

    Parameters
    ----------
    first : (..., n) array
        Any unit.
    second : (..., n) array
        Any unit.

    Returns
    -------
    (...) array
        Product of both units.
    """
    return np.einsum("...i,...i->...", first, second)


def stack_vectors(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """Return vectors from their components, broadcast together.

    Parameters
    ----------
    x : (...) array_like
        Any unit.
    y : (...) array_like
        The unit of `x`.
    z : (...) array_like
        The unit of `x`.

    Returns
    -------
    (..., 3) array
        The unit of `x`.
    """
    vectors = np.empty((*np.broadcast(x, y, z).shape, 3))
    vectors[..., 0], vectors[..., 1], vectors[..., 2] = x, y, z
    return vectors
