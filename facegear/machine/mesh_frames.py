"""Where the flanks of a mesh press: one line for each flank of either gear, as pinion and gear feel it.

Unmodified flanks of every kind touch on one line, their common normal (`facegear.teeth.family_contact`), so
that a mesh acts on its bodies by one constant wrench for each flank: a force along that normal n and its
moment about a body's centre, the same from every point of the line. Loads may wander along the line without
any effect on a body.

Axes. A pinion has x along the tangent, as the upper gear's teeth move, z outwards along its own axis, and y
square to both; where the axes cross at right angles, y is the gears' axis, from the lower to the upper gear.
At a mesh a gear has the tangent, its axis from the lower to the upper gear, and outwards, in this order.
"""

from dataclasses import dataclass
from functools import cached_property
from math import atan2, cos, hypot, pi, sin

import numpy as np

from facegear.arrays import Array
from facegear.parts.reduced_body import RimForces
from facegear.teeth.family_contact import contact_line
from facegear.teeth.tooth_family import SIDES, Rack, RelativeMotion, ToothFamily

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class FlankFrame:
    """Line of contact of one flank of a mesh.

    Attributes
    ----------
    normal
        Unit normal from pinion to gear along the pinion's x, y, z.
    moment
        Moment of that normal about the middle of the pinion's face, along the same axes, m.
    gear_normal
        The same normal along tangent, gear axis and outwards.
    gear_point
        A point of the line along these axes, m: from the gear's axis, and over the pitch plane.
    arm
        Torque on the pinion over the force along the normal, over that of the drive flank: 1 for the drive
        flank, negative for the back flank, as it turns the pinion back.
    """

    normal: Vector
    moment: Vector
    gear_normal: Vector
    gear_point: Vector
    arm: float

    @property
    def turn_by_place(self) -> float:
        """Way along the drive flank's line of action by a turn of the pinion that does to this flank what a
        motion of the pinion outwards does, m/m.
        """
        return self.normal[2] / self.arm

    def gear_moment(self, centre: float) -> Vector:
        """Return the moment of the normal about a point of the gear's axis.

        Parameters
        ----------
        centre : float
            Height of the point over the pitch plane of the meshes, along the gears' axis, m.

        Returns
        -------
        tuple of float
            About tangent, gear axis and the direction outwards, m.
        """
        (across, height, outwards), (n_across, n_height, n_outwards) = self.gear_point, self.gear_normal
        height -= centre
        return (
            height * n_outwards - outwards * n_height,
            outwards * n_across - across * n_outwards,
            across * n_height - height * n_across,
        )


def rim_forces(frames: tuple[FlankFrame, FlankFrame], sign: float, middle: float = 0.0) -> RimForces:
    """Return unit forces of the flanks of a mesh on the rim of the gear, where their lines of contact cross
    the pitch plane.

    A force has the same moments from every point of its line.

    Parameters
    ----------
    frames : pair of FlankFrame
        Lines of contact of drive and back flank.
    sign : float
        1 for the upper, -1 for the lower gear, dimensionless.
    middle : float
        Angle past that of the pinion at which the middle of its face stands, rad.

    Returns
    -------
    RimForces
        Heights count towards the teeth, against the axis of the upper gear.
    """
    directions, (turns, radii) = np.zeros((len(frames), 3)), np.zeros((2, len(frames)))
    for flank, frame in enumerate(frames):
        (n_across, n_height, n_outwards), (across, height, outwards) = frame.gear_normal, frame.gear_point
        way = -height / n_height
        crossing = across + way * n_across, outwards + way * n_outwards
        turn = atan2(*crossing)
        directions[flank] = (
            -sign * n_height,
            cos(turn) * n_across - sin(turn) * n_outwards,
            sin(turn) * n_across + cos(turn) * n_outwards,
        )
        turns[flank], radii[flank] = turn, hypot(*crossing)
    return RimForces(directions, turns, radii, middle)


@dataclass(frozen=True)
class ToothKind:
    """Teeth that are not spur teeth at right angles, as rows of a machine need to know them.

    Attributes
    ----------
    pinion_teeth, gear_teeth
        Numbers of teeth.
    rack
        Module, pressure angles of both flanks, helix and taper.
    shaft_angle, offset
        Of the pinion's axis against the upper gear's, rad and m, as `tooth_family` counts them.
    middle
        Place of the middle of the pinion's face along its axis, m; None: where its pitch radius and that of
        the upper gear roll on each other.
    """

    pinion_teeth: int
    gear_teeth: int
    rack: Rack
    shaft_angle: float = pi / 2
    offset: float = 0.0
    middle: float | None = None

    @cached_property
    def family(self) -> ToothFamily:
        """The upper gear's teeth, with the size of every land and face left 0, as no line of contact needs
        them; nor does it depend on the shaper, which is the pinion itself.
        """
        return ToothFamily(
            rack=self.rack,
            pinion_teeth=self.pinion_teeth,
            gear_teeth=self.gear_teeth,
            shaper_teeth=self.pinion_teeth,
            middle=self._rolling_place(1.0) if self.middle is None else self.middle,
            width=0.0,
            inner_radius=0.0,
            outer_radius=0.0,
            pinion_addendum=0.0,
            pinion_dedendum=0.0,
            gear_addendum=0.0,
            shaper_addendum=0.0,
            shaft_angle=self.shaft_angle,
            offset=self.offset,
        )

    @property
    def pitch_radius(self) -> float:
        """Pitch radius of the pinion, m."""
        return self.pinion_teeth * self.rack.transverse_module / 2

    @property
    def normal_arms(self) -> tuple[float, float]:
        """Torque on the pinion over the force of its drive and of its coast flank along the normal, m."""
        first, second = (cos(angle) * cos(self.rack.helix_angle) for angle in self.rack.pressure_angles)
        return self.pitch_radius * first, self.pitch_radius * second

    def _rolling_place(self, sign: float) -> float:
        """Return the place y along the pinion's axis at which its pitch radius and that of the upper (sign 1)
        or lower (-1) gear roll on each other without offset, m.
        """
        motion = self._motion
        gear_radius = self.gear_teeth * self.rack.transverse_module / 2
        return (gear_radius + sign * self.pitch_radius * motion.cosine) / motion.sine

    @property
    def _motion(self) -> RelativeMotion:
        """Motion of the pinion against the upper gear."""
        return RelativeMotion(self.pinion_teeth / self.gear_teeth, self.shaft_angle, self.offset)

    def motion(self, sign: float) -> RelativeMotion:
        """Return the motion of the pinion against a gear, in the mesh frame of that gear.

        Parameters
        ----------
        sign : float
            1 for the upper, -1 for the lower gear.

        Returns
        -------
        RelativeMotion
            Ratio, shaft angle and offset.
        """
        return self._motion if sign > 0.0 else self.family.below.motion

    @property
    def middle_turn(self) -> float:
        """Angle round the gears' axis by which the offset moves the middle of the pinion's face, rad."""
        return atan2(self.offset, self.family.middle * sin(self.shaft_angle))

    @property
    def lean(self) -> Array:
        """Rotation (3, 3) from tangent, gear axis and outwards to the pinion's x, y, z."""
        sine, cosine = self._motion.sine, self._motion.cosine
        return np.array([[1.0, 0.0, 0.0], [0.0, sine, -cosine], [0.0, cosine, sine]])

    def pitch_height(self, sign: float) -> float:
        """Return how far the pitch plane of a gear's meshes lies from where the pinions' axes pass the
        gear's, towards the gear.

        Parameters
        ----------
        sign : float
            1 for the upper, -1 for the lower gear.

        Returns
        -------
        float
            Through the pitch circle that rolls on the pinion's without offset, m.
        """
        motion = self._motion
        return self.pitch_radius * motion.sine + sign * self._rolling_place(sign) * motion.cosine

    def face_middle(self, sign: float) -> Vector:
        """Return the middle of the pinion's face at a gear's mesh.

        Parameters
        ----------
        sign : float
            1 for the upper, -1 for the lower gear.

        Returns
        -------
        tuple of float
            Along tangent, gear axis and outwards, from the gear's axis and over the pitch plane, m.
        """
        family = self.family if sign > 0.0 else self.family.below
        middle = np.array([family.motion.offset, 0.0, 0.0]) + family.middle * family.motion.basis[1]
        x, y, z = middle.tolist()
        return sign * x, -sign * z - sign * self.pitch_height(sign), y

    def frames(self, sign: float) -> tuple[FlankFrame, FlankFrame]:
        """Return the lines of contact of the drive and the back flank of a gear's meshes.

        Parameters
        ----------
        sign : float
            1 for the upper, -1 for the lower gear.

        Returns
        -------
        pair of FlankFrame
            Drive and back flank.
        """
        drive, back = (self._frame(sign, side) for side in SIDES)
        return drive, back

    def _frame(self, sign: float, side: int) -> FlankFrame:
        """Return the line of contact of the drive (side 1) or the back flank (-1) of a gear, from the line in
        the mesh frame of that gear (sign 1 upper, -1 lower).
        """
        family = self.family if sign > 0.0 else self.family.below
        line = contact_line(family, side)
        assert line is not None  # without errors of assembly there always is one
        motion = family.motion
        axes = motion.basis  # x, a, u of the mesh frame
        middle = np.array([motion.offset, 0.0, 0.0]) + family.middle * axes[1]
        to_pinion = np.array([[sign, 0.0, 0.0], [0.0, 0.0, -sign], [0.0, 1.0, 0.0]]) @ axes
        to_gear = np.array([[sign, 0.0, 0.0], [0.0, 0.0, -sign], [0.0, 1.0, 0.0]])
        # the point at which the line passes the pinion's pitch line
        up = axes[2]
        along = (-self.pitch_radius - up @ line.foot) / (up @ line.normal)
        point = line.foot + along * line.normal
        height = np.array([0.0, sign * self.pitch_height(sign), 0.0])
        arms = self.normal_arms
        return FlankFrame(
            normal=_vector(to_pinion @ line.normal),
            moment=_vector(np.cross(to_pinion @ (point - middle), to_pinion @ line.normal)),
            gear_normal=_vector(to_gear @ line.normal),
            gear_point=_vector(to_gear @ point - height),
            arm=1.0 if side > 0 else -arms[1] / arms[0],
        )


def spur_frames(
    sign: float, pressure_angle: float, pitch_radius: float, mesh_radius: float, middle: float
) -> tuple[FlankFrame, FlankFrame]:
    """Return the lines of contact of spur teeth at right angles: both flanks in the section of the pitch
    point, which tilt a pinion unless the middle of its face stands there.

    Parameters
    ----------
    sign : float
        1 for the upper, -1 for the lower gear.
    pressure_angle : float
        Pressure angle, rad.
    pitch_radius : float
        Pitch radius of the pinion, m.
    mesh_radius : float
        Distance of the meshes from the gear's axis, m.
    middle : float
        Place of the middle of the pinion's face along its axis, from the gear's axis, m.

    Returns
    -------
    pair of FlankFrame
        Drive and back flank.
    """
    cosine, sine = float(np.cos(pressure_angle)), float(np.sin(pressure_angle))
    outwards = mesh_radius - middle
    drive, back = (
        FlankFrame(
            normal=(side * sign * cosine, sign * sine, 0.0),
            moment=(-outwards * sign * sine, outwards * side * sign * cosine, -side * cosine * pitch_radius),
            gear_normal=(side * sign * cosine, sign * sine, 0.0),
            gear_point=(0.0, 0.0, mesh_radius),
            arm=float(side),
        )
        for side in SIDES
    )
    return drive, back


def _vector(values: Array) -> Vector:
    """Return three numbers of an array as plain numbers, so that frames can be compared and hashed."""
    x, y, z = (float(value) for value in values)
    return x, y, z
