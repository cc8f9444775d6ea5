"""Unloaded contact of any family at any pose: one straight line in space, from two equations.

All normals of the gear at gear angle 0 are the lines of `generated_flank`, whatever turns, and those of the
pinion are all lines that touch its base cylinder under the base helix. So pinion and gear run conjugate in
every assembly, and contact runs along one line at equal steps. Two equations give its slope psi and its turn
e about the gear's axis. Derived for this project; confirmed by whole flanks turned until they touch.
"""

from dataclasses import dataclass
from functools import cached_property
from math import atan2, copysign, cos, hypot, isfinite, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.generated_flank import GearFlank, flank_end, gear_flank, tip_distance
from facegear.teeth.helicoid import pinion_start
from facegear.teeth.tooth_family import Helicoid, RelativeMotion, ToothFamily, turn_about_axis

STEPS = 60
"""Newton steps before no line counts as found."""
CLOSE = 1e-14
"""Newton step (rad) that ends the search."""
NOMINAL = AssemblyErrors()


@dataclass(frozen=True)
class PinionPose:
    """Where the pinion stands: errors of assembly, and by how much it is outwards along its own axis (m)."""

    errors: AssemblyErrors = NOMINAL
    outwards: float = 0.0

    def frame(self, family: ToothFamily) -> tuple[RelativeMotion, tuple[float, float, float]]:
        """Return the motion with the pose's shaft angle, and the middle of the pinion's face.

        Parameters
        ----------
        family : ToothFamily
            Pair of gears.

        Returns
        -------
        tuple of RelativeMotion and tuple[float, float, float]
            The motion, and the middle's place in the mesh frame, m.
        """
        nominal, errors, w = family.motion, self.errors, self.outwards
        posed_motion = nominal
        if errors.shaft_angle_error != 0.0:
            angle = family.shaft_angle + errors.shaft_angle_error
            posed_motion = RelativeMotion(nominal.ratio, angle, nominal.offset)
        return posed_motion, (
            family.offset + errors.offset,
            family.middle * nominal.sine + w * posed_motion.sine,
            errors.axial_shift - family.middle * nominal.cosine - w * posed_motion.cosine,
        )


@dataclass(frozen=True, eq=False)
class ContactFrame:
    """Points and unit normals (..., 3) of a mesh in the mesh frame; points in m."""

    points: Array
    normals: Array

    def wrench(self, about: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
        """Return force and moment per unit of mesh force.

        Parameters
        ----------
        about : (3,) array_like
            Point of the moment, m.

        Returns
        -------
        (..., 6) array
            Force, dimensionless, and moment, m.
        """
        moment = np.cross(self.points - np.asarray(about, float), self.normals)
        return np.concatenate([self.normals, moment], axis=-1)


@dataclass(frozen=True, eq=False)
class ContactLine:
    """The line on which all contact of a flank runs in a pose; the same at every pinion angle.

    Points of the line are named by s, the distance (m) on the gear's normal from the shaper's base cylinder.

    Attributes
    ----------
    psi, turn
        Slope of the normal on the gear, and turn e of the line about the gear's axis (rad).
    transmission_error
        Of the gear, along the normal (m), positive ahead.
    foot, normal
        Place (3,) of s = 0 in the mesh frame (m), and direction (3,) of the line, from pinion to gear.
    pinion_slope
        Slope psi of the normal in the posed pinion's transverse section (rad).
    pinion_lead
        Distance (m) of s = 0 from the pinion's base cylinder along the normal.
    pinion_place
        y (m) on the pinion where the line touches its base cylinder.
    """

    family: ToothFamily
    pose: PinionPose
    side: int
    psi: float
    turn: float
    transmission_error: float
    foot: Array
    normal: Array
    pinion_slope: float
    pinion_lead: float
    pinion_place: float

    @property
    def helicoid(self) -> Helicoid:
        """Flank of the pinion."""
        return self.family.pinion_flanks[0 if self.side > 0 else 1]

    @property
    def gear(self) -> GearFlank:
        """Flank of the gear."""
        return gear_flank(self.family, self.side)

    @cached_property
    def motion(self) -> RelativeMotion:
        """Motion of the posed pinion against the gear."""
        return self.pose.frame(self.family)[0]

    def point(self, s: ArrayLike) -> Array:
        """Return points of the line.

        Parameters
        ----------
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        (..., 3) array
            Places in the mesh frame, m.
        """
        return self.foot + np.asarray(s, float)[..., None] * self.normal

    def pinion_y(self, s: ArrayLike) -> Array:
        """Return places along the pinion's axis, counted on the pinion.

        Parameters
        ----------
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        (...) array
            y, m.
        """
        return self.pinion_place + self.helicoid.sine * (np.asarray(s, float) + self.pinion_lead)

    def frame(self, s: ArrayLike) -> ContactFrame:
        """Return the contact frame of points of the line.

        Parameters
        ----------
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        ContactFrame
            Points and normals in the mesh frame.
        """
        points = self.point(s)
        return ContactFrame(points, np.broadcast_to(self.normal, points.shape))

    def sliding(self, s: ArrayLike) -> Array:
        """Compute the sliding speed per speed of the pinion.

        Parameters
        ----------
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        (...) array
            Speed of the pinion's point against the gear's, m/rad.
        """
        points, (motion, middle) = self.point(s), self.pose.frame(self.family)
        pinion = np.cross(points - np.array(middle), motion.basis[1])
        gear = np.cross(points, np.array([0.0, 0.0, self.family.motion.ratio]))
        return np.linalg.norm(pinion - gear, axis=-1)

    def curvatures(self, s: ArrayLike) -> tuple[Array, Array, Array]:
        """Compute the relative curvatures of pinion and gear.

        Parameters
        ----------
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        tuple of (...) arrays
            Larger and smaller relative curvature, 1/m, and the angle of the smaller one's direction from the
            pinion's generator, rad.
        """
        s = np.asarray(s, float)
        lines = self.gear.lines(self.psi)
        back = -(self.gear.turn(self.psi, s, lines.y) + self.turn)
        tangents = np.stack(
            [turn_about_axis(back, part) for part in self.gear.tangents(self.psi, s)], axis=-1
        )
        changes = np.stack(
            [turn_about_axis(back, part) for part in self.gear.normal_tangents(self.psi, s)], axis=-1
        )
        basis = np.stack([np.cross(self.normal, self._radial), self._radial])
        shape = (basis @ changes) @ np.linalg.inv(basis @ tangents)
        shape = (shape + np.swapaxes(shape, -1, -2)) / 2
        shape[..., 1, 1] += 1.0 / (s + self.pinion_lead)
        values, vectors = np.linalg.eigh(shape)
        order = np.argsort(np.abs(values), axis=-1)
        small, large = (np.take_along_axis(values, order[..., i : i + 1], -1)[..., 0] for i in (0, 1))
        long = np.take_along_axis(vectors, order[..., None, :1], -1)[..., 0]
        return large, small, np.arctan(long[..., 1] / long[..., 0])

    @cached_property
    def _radial(self) -> Array:
        """Direction (3,) from the pinion's axis to the place where the line touches its base cylinder."""
        parts = np.array([-self.side * sin(self.pinion_slope), 0.0, -cos(self.pinion_slope)])
        return parts @ self.motion.basis


def contact_line(family: ToothFamily, side: int, pose: PinionPose | None = None) -> ContactLine | None:
    """Compute the unloaded contact of a flank, continued beyond its edges, in a pose.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank.
    pose : PinionPose, optional
        Where the pinion stands; the nominal place if None.

    Returns
    -------
    ContactLine, optional
        The line; None where no normal of the gear touches the pinion's base cylinder, and where teeth touch
        along lines (as many teeth of the shaper as of the pinion).
    """
    if family.shaper_teeth <= family.pinion_teeth:
        return None
    pose = pose or PinionPose()
    helicoid, flank = family.pinion_flanks[0 if side > 0 else 1], gear_flank(family, side)
    motion, middle = pose.frame(family)
    axis = (0.0, motion.sine, -motion.cosine)
    psi, turn = helicoid.pressure_angle, 0.0
    if pose.errors != NOMINAL:
        solution = _solve(flank, helicoid, axis, middle, psi)
        if solution is None:
            return None
        psi, turn = solution
    parts = flank.line_components(cos(psi), sin(psi))
    foot, normal = _turn_back(parts[0:3], turn), _turn_back(parts[6:9], turn)
    x, v, w = (foot[i] - middle[i] for i in range(3))
    along, up = v * axis[1] + w * axis[2], v * motion.cosine + w * motion.sine
    slope = atan2(-(normal[1] * motion.cosine + normal[2] * motion.sine), side * normal[0])
    roll = side * x * cos(slope) - up * sin(slope)
    rolled_angle = (roll + helicoid.lead * along) / helicoid.base_radius
    pinion_angle = side * (rolled_angle - slope - helicoid.phase)
    gear_angle = float(flank.turn(psi, 0.0, parts[12])) + turn
    angle = gear_angle - pinion_angle * family.motion.ratio
    lead = roll / helicoid.cosine
    return ContactLine(
        family=family,
        pose=pose,
        side=side,
        psi=psi,
        turn=turn,
        transmission_error=angle / family.motion.ratio * helicoid.base_radius * helicoid.cosine,
        foot=np.array(foot),
        normal=np.array(normal),
        pinion_slope=slope,
        pinion_lead=lead,
        pinion_place=along + family.middle - helicoid.sine * lead,
    )


Vector = tuple[float, float, float]


def _solve(
    flank: GearFlank, helicoid: Helicoid, axis: Vector, middle: Vector, psi: float
) -> tuple[float, float] | None:
    """Return slope and turn of the line that touches the pinion's base cylinder; None where there is none."""
    turn, side, target = 0.0, helicoid.side, helicoid.base_radius * helicoid.cosine
    for _ in range(STEPS):
        parts = flank.line_components(cos(psi), sin(psi))
        foot, foot_psi, normal, normal_psi = (_turn_back(parts[i : i + 3], turn) for i in (0, 3, 6, 9))
        arm = (foot[0] - middle[0], foot[1] - middle[1], foot[2] - middle[2])
        normal_turn, foot_turn = (normal[1], -normal[0], 0.0), (foot[1], -foot[0], 0.0)
        first = _product(normal, axis) - helicoid.sine
        second = -side * _triple(axis, arm, normal) - target
        first_psi, first_turn = _product(normal_psi, axis), _product(normal_turn, axis)
        second_psi = -side * (_triple(axis, foot_psi, normal) + _triple(axis, arm, normal_psi))
        second_turn = -side * (_triple(axis, foot_turn, normal) + _triple(axis, arm, normal_turn))
        scale = first_psi * second_turn - first_turn * second_psi
        if scale == 0.0 or not isfinite(scale):
            return None
        psi_step = (first * second_turn - first_turn * second) / scale
        turn_step = (first_psi * second - first * second_psi) / scale
        largest = max(abs(psi_step), abs(turn_step))
        if not isfinite(largest):
            return None
        shorter = min(1.0, 0.2 / largest) if largest > 0.0 else 1.0
        psi, turn = psi - shorter * psi_step, turn - shorter * turn_step
        if not abs(psi) < 1.55:
            return None
        if largest < CLOSE:
            return psi, turn
    return None


def _turn_back(vector: tuple[float, ...], turn: float) -> Vector:
    c, s = cos(turn), sin(turn)
    return vector[0] * c + vector[1] * s, vector[1] * c - vector[0] * s, vector[2]


def _product(first: Vector, second: Vector) -> float:
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def _triple(first: Vector, second: Vector, third: Vector) -> float:
    """Return the first vector times the cross product of the others."""
    return (
        first[0] * (second[1] * third[2] - second[2] * third[1])
        + first[1] * (second[2] * third[0] - second[0] * third[2])
        + first[2] * (second[0] * third[1] - second[1] * third[0])
    )


@dataclass(frozen=True)
class ContactPath:
    """Part of a contact line inside both flanks and both faces.

    first, last: ends s along the normal (m), from the gear's tip to its root. first_edge, last_edge: which
    edge ends it there.
    """

    line: ContactLine
    first: float
    last: float
    first_edge: str
    last_edge: str

    @property
    def contact_ratio(self) -> float:
        """Length over the base pitch; negative where no part of the line lies on both flanks."""
        helicoid = self.line.helicoid
        pitch = 2 * np.pi * helicoid.base_radius * helicoid.cosine / self.line.family.pinion_teeth
        return (self.last - self.first) / pitch

    @property
    def middle(self) -> float:
        """Mean of both ends, m."""
        return (self.first + self.last) / 2


def contact_path(line: ContactLine) -> ContactPath:
    """Cut a contact line with the edges of both flanks.

    Parameters
    ----------
    line : ContactLine
        The line of a pose.

    Returns
    -------
    ContactPath
        Its part on both flanks.
    """
    family, helicoid, lead = line.family, line.helicoid, line.pinion_lead
    foot_y, taper = line.pinion_place, family.taper
    tip_radius = family.pinion_tip_radius + (foot_y - family.middle) * taper
    start = float(pinion_start(family, line.side, foot_y))
    growth = helicoid.cosine - taper * helicoid.sine / sin(helicoid.pressure_angle)
    lower = [
        (_tip_crossing(line), "gear tip"),
        (0.0, "start of the gear's involute"),
        (max(start / growth, 0.0) - lead, "pinion root"),
    ]
    upper = [
        (float(flank_end(family, line.side, line.psi)), "gear root"),
        (float(tip_distance(helicoid, tip_radius, taper)) - lead, "pinion tip"),
    ]
    if helicoid.sine != 0.0:
        half = copysign(family.width / 2, helicoid.sine)
        names = ("pinion inner end", "pinion outer end")[:: 1 if half > 0 else -1]
        ends = ((family.middle + at - foot_y) / helicoid.sine - lead for at in (-half, half))
        lower.append((next(ends), names[0]))
        upper.append((next(ends), names[1]))
    elif abs(foot_y - family.middle) > family.width / 2:
        upper.append((-np.inf, "pinion inner end" if foot_y < family.middle else "pinion outer end"))
    first, last = max(lower), min(upper)
    outside = _radius_crossings(line, family.outer_radius)
    if outside is None:
        last = min(last, (-np.inf, "gear outer end"))
    else:
        first, last = max(first, (outside[0], "gear outer end")), min(last, (outside[1], "gear outer end"))
    inside = _radius_crossings(line, family.inner_radius)
    if inside is not None:
        # the line dives below the inner cylinder: keep the longer of the parts on either side
        before, after = min(last[0], inside[0]) - first[0], last[0] - max(first[0], inside[1])
        if before >= after:
            last = min(last, (inside[0], "gear inner end"))
        else:
            first = max(first, (inside[1], "gear inner end"))
    return ContactPath(line, first[0], last[0], first[1], last[1])


def _tip_crossing(line: ContactLine) -> float:
    """Return s (m) at which the line passes the gear's tip surface."""
    tip, foot, normal = line.family.gear_tip, line.foot, line.normal
    s = float(tip.height(line.family.inner_radius) - foot[2]) / normal[2]
    for _ in range(STEPS):
        x, y = foot[0] + s * normal[0], foot[1] + s * normal[1]
        radius = hypot(x, y)
        residual = foot[2] + s * normal[2] - float(tip.height(radius))
        step = residual / (normal[2] - tip.slope * (x * normal[0] + y * normal[1]) / radius)
        s -= step
        if abs(step) < 1e-16:
            break
    return s


def _radius_crossings(line: ContactLine, radius: float) -> tuple[float, float] | None:
    """Return both s (m) at which the line passes a cylinder about the gear's axis, None where it does not."""
    foot, normal = line.foot, line.normal
    square = normal[0] ** 2 + normal[1] ** 2
    half = (foot[0] * normal[0] + foot[1] * normal[1]) / square
    inside = half**2 - (foot[0] ** 2 + foot[1] ** 2 - radius**2) / square
    if inside <= 0.0:
        return None
    return -half - sqrt(inside), -half + sqrt(inside)
