"""Layout of a transmission: pinions around one or two face gears, and which of them mesh."""

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from typing import Protocol

import numpy as np

from facegear.arrays import Array
from facegear.errors import InvalidInput
from facegear.machine.mesh_frames import FlankFrame, ToothKind, spur_frames

DOF_PER_BODY = 4
"""Coordinates of each body: x, y, z and rotation about its own axis."""
DOF_LETTERS = ("x", "y", "z", "theta")
"""Names of the coordinates of a body, in their order."""
TILT_LETTERS = ("tilt_x", "tilt_y")
"""Names of the two tilts of a body that may tilt."""


class Role(StrEnum):
    """Role of a pinion in the power flow: `input` drives, `tail` takes power off, `idler` has no torque
    unless it is given one.
    """

    INPUT = "input"
    IDLER = "idler"
    TAIL = "tail"


class Side(StrEnum):
    """Face gear: `lower` (6 in the paper) or `upper` (7, the output)."""

    LOWER = "lower"
    UPPER = "upper"


@dataclass(frozen=True)
class Tilt:
    """Rocking of a face gear about its two diameters: moment of inertia (kg m2) and stiffness (N m/rad).

    below: distance (m) of the point that stays in place from the pitch plane of its meshes, away from the
    pinions.
    """

    inertia: float
    stiffness: float
    below: float = 0.0


@dataclass(frozen=True)
class Body:
    """Inertia and bearing of one body.

    Attributes
    ----------
    mass
        kg.
    inertia
        About the own axis, kg m2.
    bearing
        Stiffness along x, y, z, N/m.
    bearing_xy
        Stiffness that couples x and y, N/m.
    tilt
        Lets a face gear rock; without it the gear stays square.
    """

    mass: float
    inertia: float
    bearing: tuple[float, float, float]
    bearing_xy: float = 0.0
    tilt: Tilt | None = None


@dataclass(frozen=True)
class Pinion:
    """One pinion; `pitches` is its distribution angle in angular pitches of the face gear."""

    name: str
    role: Role
    pitches: float
    body: Body


@dataclass(frozen=True)
class FaceGear:
    """One face gear."""

    side: Side
    body: Body

    @property
    def name(self) -> str:
        """Name in tables and figures."""
        return f"{self.side.value} face gear"

    @property
    def sign(self) -> float:
        """1 for the upper gear, -1 for the lower gear.

        A pinion sees the lower gear as the upper one rotated by 180 degrees about the pinion's axis.
        """
        return -1.0 if self.side is Side.LOWER else 1.0


class Kinematics(Protocol):
    """Kinematics of the meshes: deflections by motions of the bodies, and arms at which mesh forces turn
    the bodies.

    It also says what the radii of a `Layout` are. `facegear.machine.kinematics` has two: geometric and
    printed.
    """

    @property
    def name(self) -> str:
        """Name that a config gives to these kinematics."""

    @property
    def flanks_apart(self) -> bool:
        """Whether each flank is a contact with a normal and a gap of its own. If not, both flanks of a
        mesh share one line of action and are one contact, as in equation (13) as printed.
        """

    @property
    def follows_rotation(self) -> bool:
        """Whether the teeth of a lower face gear that is alone pass the pinions the other way round."""

    def require(self, layout: "Layout") -> None:
        """Raise InvalidInput for radii that do not fit the teeth.

        Parameters
        ----------
        layout : Layout
            The layout to check.
        """

    def arm(self, radius: float, pressure_angle: float) -> float:
        """Return the torque over the mesh force that balances it.

        Parameters
        ----------
        radius : float
            Radius that a layout gives to a body, m.
        pressure_angle : float
            Pressure angle, rad.

        Returns
        -------
        float
            m.
        """

    def mesh_radius(self, layout: "Layout") -> float:
        """Return the distance of the meshes from the face gears' axis.

        Parameters
        ----------
        layout : Layout
            The layout.

        Returns
        -------
        float
            m.
        """

    def gear_radius(self, base_radius: float, pressure_angle: float) -> float:
        """Return the radius that a layout gives to a face gear with a base radius.

        Parameters
        ----------
        base_radius : float
            Base radius, m.
        pressure_angle : float
            Pressure angle, rad.

        Returns
        -------
        float
            m.
        """

    def flank_rows(self, layout: "Layout") -> Array:
        """Return the derivative of the flanks' deflections by the degrees of freedom q.

        The deflection of a flank is its row times q, less its error; positive closes the flank.

        Parameters
        ----------
        layout : Layout
            The layout.

        Returns
        -------
        (2 meshes, dof) array
            Drive flanks first; m/m, and m/rad for rotations.
        """


@dataclass(frozen=True)
class Layout:
    """Bodies and mesh geometry, in m and rad. Bodies are ordered pinions, then gears, as in equation (1).

    Meshes are ordered gear by gear and within a gear pinion by pinion: (1,6) .. (n,6), (1,7) .. (n,7).
    `kinematics` says what `pinion_radius` and `gear_radius` are. `kind` describes teeth other than spur teeth
    at right angles; `pressure_angle` is that of their drive flank in the normal section. `middle` is that of
    `pinion_middle` for spur teeth. Properties are computed once; their arrays must not be changed.
    """

    pinions: tuple[Pinion, ...]
    gears: tuple[FaceGear, ...]
    pinion_teeth: int
    gear_teeth: int
    pressure_angle: float
    pinion_radius: float
    gear_radius: float
    kinematics: Kinematics
    kind: ToothKind | None = None
    middle: float | None = None

    def __post_init__(self) -> None:
        if not self.pinions:
            raise InvalidInput("pinions", [], "at least one pinion")
        if not self.gears or len({gear.side for gear in self.gears}) != len(self.gears):
            raise InvalidInput("face gears", [g.side.value for g in self.gears], "lower, upper or both")
        names = [pinion.name for pinion in self.pinions]
        if len(set(names)) != len(names):
            raise InvalidInput("pinions", names, "names that differ from pinion to pinion")
        self.kinematics.require(self)

    @cached_property
    def pinion_arm(self) -> float:
        """Torque on a pinion over the force of its drive flank, m: the base radius of spur teeth."""
        return self.kinematics.arm(self.pinion_radius, self.pressure_angle)

    @cached_property
    def gear_arm(self) -> float:
        """Torque on a face gear over the force of a drive flank, m: the base radius of spur teeth."""
        return self.kinematics.arm(self.gear_radius, self.pressure_angle)

    @cached_property
    def mesh_radius(self) -> float:
        """Distance of the meshes from the face gears' axis, m: m N2 / 2, as teeth have it."""
        return self.kinematics.mesh_radius(self)

    @cached_property
    def pitch_radius(self) -> float:
        """Pitch radius of the pinions, m."""
        if self.kind is not None:
            return self.kind.pitch_radius
        return self.pinion_arm / float(np.cos(self.pressure_angle))

    @cached_property
    def pitch_slope(self) -> float:
        """Way along the drive flank's normal by an arc on the pitch circles: cosines of both angles."""
        return float(
            np.cos(self.pressure_angle) if self.kind is None else self.pinion_arm / self.pitch_radius
        )

    @cached_property
    def flank_frames(self) -> tuple[tuple[FlankFrame, FlankFrame], ...]:
        """Lines of contact of drive and back flank, by the number of the gear."""
        if self.kind is not None:
            return tuple(self.kind.frames(gear.sign) for gear in self.gears)
        distances = self.pitch_radius, self.mesh_radius, self.pinion_middle
        return tuple(spur_frames(gear.sign, self.pressure_angle, *distances) for gear in self.gears)

    @cached_property
    def meshes_tilt_pinions(self) -> bool:
        """Whether meshes tilt pinions or push them along their axes: all but spur teeth at their middles."""
        elsewhere = self.kind is not None or self.pinion_middle != self.mesh_radius
        return self.kinematics.flanks_apart and elsewhere

    @cached_property
    def back_arm(self) -> float:
        """Torque on a pinion over the force of its back flank, over that of its drive flank: 1 where both
        flanks have one pressure angle.
        """
        return -self.flank_frames[0][1].arm

    def mesh_torques(self, forces: Array) -> Array:
        """Return the torque that forces of the meshes put on the pinions.

        Parameters
        ----------
        forces : (...) array
            Forces of drive flanks, and negative ones of back flanks, N.

        Returns
        -------
        (...) array
            N m, of the sign of the force.
        """
        return np.asarray(forces * (self.pinion_arm * np.where(forces < 0.0, self.back_arm, 1.0)))

    @cached_property
    def pinion_middle(self) -> float:
        """Place of the middles of the pinions' faces along their axes, m; at the meshes if not known."""
        middle = self.middle if self.kind is None else self.kind.family.middle
        return self.mesh_radius if middle is None else middle

    @cached_property
    def base_pitch(self) -> float:
        """Distance along the line of action that flanks travel in a mesh period, m: 2 pi pinion_arm /
        pinion_teeth.
        """
        return 2.0 * np.pi * self.pinion_arm / self.pinion_teeth

    @cached_property
    def tilting(self) -> tuple[int, ...]:
        """Indices of the gears that may tilt."""
        return tuple(g for g, gear in enumerate(self.gears) if gear.body.tilt is not None)

    def tilt_distance(self, gear: int) -> float:
        """Return the distance along the gear's axis, towards the gear, from where the pinions' axes pass it
        to the point about which the gear tilts: the height of the pitch plane plus `Tilt.below`.

        Parameters
        ----------
        gear : int
            Number of the gear.

        Returns
        -------
        float
            m.
        """
        tilt = self.gears[gear].body.tilt
        height = self.pitch_radius if self.kind is None else self.kind.pitch_height(self.gears[gear].sign)
        return height + (0.0 if tilt is None else tilt.below)

    @cached_property
    def first_tilts(self) -> dict[int, int]:
        """Index of tilt_x of every gear that may tilt, by the gear's number; tilt_y is the next."""
        return {g: DOF_PER_BODY * len(self.bodies) + 2 * k for k, g in enumerate(self.tilting)}

    @cached_property
    def output(self) -> int:
        """Number of the gear that gives the power out, in `gears`: the upper one, else the only one."""
        sides = [gear.side for gear in self.gears]
        return sides.index(Side.UPPER) if Side.UPPER in sides else 0

    @cached_property
    def contact_gears(self) -> tuple[str, ...]:
        """Gear whose contact each gear has: its own, of a gear alone that of an upper one."""
        return tuple(g.side.value if len(self.gears) > 1 else Side.UPPER.value for g in self.gears)

    @cached_property
    def dof(self) -> int:
        """Degrees of freedom: 4 a body, then the two tilts of every gear that may rock."""
        return DOF_PER_BODY * len(self.bodies) + 2 * len(self.tilting)

    @property
    def spins(self) -> slice:
        """Slice of the degrees of freedom with the rotation of every body about its own axis."""
        return slice(3, DOF_PER_BODY * len(self.bodies), DOF_PER_BODY)

    @cached_property
    def bodies(self) -> tuple[Body, ...]:
        """All bodies in the order of the degrees of freedom."""
        return (*(pinion.body for pinion in self.pinions), *(gear.body for gear in self.gears))

    @cached_property
    def body_names(self) -> tuple[str, ...]:
        """Names of all bodies, pinions first."""
        return (*(pinion.name for pinion in self.pinions), *(gear.name for gear in self.gears))

    @cached_property
    def dof_names(self) -> tuple[str, ...]:
        """Names of degrees of freedom by body and letter: x, y, z, theta of each body, then tilt_x, tilt_y
        of tilting gears.
        """
        names = [f"{name}:{letter}" for name in self.body_names for letter in DOF_LETTERS]
        tilts = [f"{self.gears[g].name}:{letter}" for g in self.tilting for letter in TILT_LETTERS]
        return (*names, *tilts)

    @cached_property
    def meshes(self) -> tuple[tuple[int, int], ...]:
        """(pinion, gear) of each mesh, each counted from 0 in its own list."""
        return tuple((i, g) for g in range(len(self.gears)) for i in range(len(self.pinions)))

    @cached_property
    def contacts(self) -> int:
        """Number of contacts with a force of their own: both flanks of every mesh, drive flanks first. In
        equation (13) as printed the two flanks of a mesh share one line of action and are one contact.
        """
        return len(self.meshes) * (2 if self.kinematics.flanks_apart else 1)

    @cached_property
    def mesh_names(self) -> tuple[str, ...]:
        """`pinion/side` of each mesh."""
        return tuple(f"{self.pinions[i].name}/{self.gears[g].side.value}" for i, g in self.meshes)

    @cached_property
    def angles(self) -> Array:
        """Distribution angles p of the pinions about the gears' axis, (pinions,), rad.

        In the gears' frame a pinion lies towards (sin p, -cos p), and its x points along (cos p, sin p).
        """
        return 2.0 * np.pi * np.array([pinion.pitches for pinion in self.pinions]) / self.gear_teeth

    @cached_property
    def pitches_from_first(self) -> Array:
        """Distribution angles counted from the first pinion, shape (pinions,), pitches of the face gear."""
        return np.array([pinion.pitches - self.pinions[0].pitches for pinion in self.pinions])

    def half_turned(self, gear: int) -> bool:
        """Whether a gear meets a pinion half a turn of the pinion away from the reference mesh, the first
        pinion's with the upper gear, or with the only gear.

        Parameters
        ----------
        gear : int
            Number of the gear.

        Returns
        -------
        bool
            True for the lower of two gears.
        """
        return len(self.gears) > 1 and self.gears[gear].side is Side.LOWER

    def mesh_index(self, pinion: int, side: Side) -> int:
        """Return the position of a mesh in `meshes`.

        Parameters
        ----------
        pinion : int
            Number of the pinion.
        side : Side
            Side of the face gear.

        Returns
        -------
        int
            Index of the mesh.

        Raises
        ------
        KeyError
            If the layout has no such gear.
        """
        sides = [gear.side for gear in self.gears]
        if side not in sides:
            raise KeyError(side)
        return sides.index(side) * len(self.pinions) + pinion
