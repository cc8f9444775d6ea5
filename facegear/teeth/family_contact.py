"""Unloaded contact of any family at any pose: one straight line in space, from two equations.

All normals of the gear at gear angle 0 are the lines of `generated_flank`, whatever turns, and those of the
pinion are all lines that touch its base cylinder under the base helix. So pinion and gear run conjugate in
every assembly, and contact runs along one line at equal steps. Two equations give its slope psi and its turn
e about the gear's axis. Derived for this project; confirmed by whole flanks turned until they touch.
"""

from dataclasses import dataclass
from functools import cached_property
from math import atan2, cos, isfinite, sin

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.generated_flank import GearFlank, gear_flank
from facegear.teeth.tooth_family import Helicoid, RelativeMotion, ToothFamily, turn_about_axis

STEPS = 60
"""Newton steps before no line counts as found."""
CLOSE = 1e-10
"""Newton step (rad) that ends the search: the next one, its square, is below rounding."""
NOMINAL = AssemblyErrors()
"""Assembly without errors."""

Vector = tuple[float, float, float]
X, Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


def posed_frame(
    errors: AssemblyErrors, nominal: RelativeMotion, middle: float
) -> tuple[RelativeMotion, Vector]:
    """Return the motion with the assembled shaft angle, and where the middle of the pinion's face stands.

    Parameters
    ----------
    errors : AssemblyErrors
        Errors of assembly.
    nominal : RelativeMotion
        Motion of the pinion at its nominal place.
    middle : float
        Place y of the middle of the pinion's face, m.

    Returns
    -------
    tuple of RelativeMotion and tuple[float, float, float]
        The motion, and the middle's place in the mesh frame, m.
    """
    w, posed_motion = errors.pinion_axial, nominal
    if errors.shaft_angle_error != 0.0:
        angle = nominal.shaft_angle + errors.shaft_angle_error
        posed_motion = RelativeMotion(nominal.ratio, angle, nominal.offset)
    return posed_motion, (
        nominal.offset + errors.offset,
        middle * nominal.sine + w * posed_motion.sine,
        errors.gear_axial - middle * nominal.cosine - w * posed_motion.cosine,
    )


@dataclass(frozen=True, eq=False)
class ContactFrame:
    """Contact points (m) and unit normals from pinion to gear, (..., 3) each, in the mesh frame."""

    points: Array
    normals: Array

    def wrench(self, about: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
        """Return force and moment of the pinion on the gear per unit of mesh force.

        Parameters
        ----------
        about : (3,) array_like
            Point of the moment, m.

        Returns
        -------
        (..., 6) array
            Force (first three, dimensionless) and moment about that point (m) in the mesh frame.
        """
        moment = np.cross(self.points - np.asarray(about, float), self.normals)
        return np.concatenate([self.normals, moment], axis=-1)


@dataclass(frozen=True, eq=False)
class ContactLine:
    """The line on which all contact of a flank runs in a pose; the same at every pinion angle.

    Points of the line are named by s, the distance (m) on the gear's normal from the shaper's base cylinder.

    Attributes
    ----------
    gear, helicoid, motion, errors
        Flanks of gear and pinion, their nominal motion, and the errors of assembly.
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

    gear: GearFlank
    helicoid: Helicoid
    motion: RelativeMotion
    errors: AssemblyErrors
    psi: float
    turn: float
    transmission_error: float
    foot: Array
    normal: Array
    pinion_slope: float
    pinion_lead: float
    pinion_place: float

    @cached_property
    def posed_frame(self) -> tuple[RelativeMotion, Vector]:
        """`posed_frame` of this line: motion with the assembled shaft angle, and the face's middle (m)."""
        return posed_frame(self.errors, self.motion, self.helicoid.middle)

    @cached_property
    def base_pitch(self) -> float:
        """Way of the contact along the normal per radian of the pinion's turn, r_b C, m/rad."""
        return self.helicoid.base_radius * self.helicoid.cosine

    def point(self, s: ArrayLike) -> Array:
        """Return points of the line, foot + s normal.

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
        """Return where points of the line are along the pinion, counted on its face.

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
        """Return points of the line with the common normal, which is the same at all of them.

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
        """Compute the magnitude of the sliding velocity per rotational speed of the pinion.

        Parameters
        ----------
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        (...) array
            Speed of the pinion's point against the gear's, m/rad, never negative.
        """
        points, (motion, middle) = self.point(s), self.posed_frame
        pinion = np.cross(points - np.array(middle), motion.basis[1])
        gear = np.cross(points, np.array([0.0, 0.0, self.motion.ratio]))
        return np.linalg.norm(pinion - gear, axis=-1)

    def curvatures(self, s: ArrayLike) -> tuple[Array, Array, Array]:
        """Compute the principal relative curvatures of pinion and gear at the contact.

        Parameters
        ----------
        s : (...) array_like
            Distance along the normal, m.

        Returns
        -------
        tuple of (...) arrays
            Relative curvature of larger and of smaller magnitude, 1/m, convex positive, and the angle of
            the smaller one's direction from the pinion's generator, rad.
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

    def error_slopes(self) -> tuple[Array, Array]:
        """Compute the derivatives of the contact by the pose of the pinion, at this pose.

        Returns
        -------
        tuple of (4,) arrays
            Derivatives of transmission error and of `pinion_place`, each by offset, axial shift of the gear,
            error of the shaft angle and axial shift of the pinion, m/m and m/rad.
        """
        side, eta, outwards = self.helicoid.side, self.helicoid.sine, self.errors.pinion_axial
        motion, middle = self.posed_frame
        axis, up = (0.0, motion.sine, -motion.cosine), (0.0, motion.cosine, motion.sine)
        parts = self.gear.line_components(cos(self.psi), sin(self.psi))
        foot, foot_psi, normal, normal_psi = (_turn_back(parts[i : i + 3], self.turn) for i in (0, 3, 6, 9))
        arm = (foot[0] - middle[0], foot[1] - middle[1], foot[2] - middle[2])
        foot_turn, normal_turn = (foot[1], -foot[0], 0.0), (normal[1], -normal[0], 0.0)
        first_psi, first_turn = _product(normal_psi, axis), _product(normal_turn, axis)
        second_psi = -side * (_triple(axis, foot_psi, normal) + _triple(axis, arm, normal_psi))
        second_turn = -side * (_triple(axis, foot_turn, normal) + _triple(axis, arm, normal_turn))
        scale = first_psi * second_turn - first_turn * second_psi
        tilt_change = outwards * _triple(axis, up, normal) - _triple(up, arm, normal)
        # changes of both equations by the pose, of the place along the axis, and of that along the normal
        changes = (
            (0.0, _triple(axis, X, normal), 0.0, -normal[0]),
            (0.0, _triple(axis, Z, normal), -axis[2], -normal[2]),
            (_product(up, normal), tilt_change, _product(up, arm), -outwards * _product(up, normal)),
            (0.0, 0.0, -1.0, -_product(axis, normal)),
        )
        along_psi, along_turn = _product(foot_psi, axis), _product(foot_turn, axis)
        onto_psi = _product(foot_psi, normal) + _product(normal_psi, arm)
        onto_turn = _product(foot_turn, normal) + _product(normal_turn, arm)
        place_slopes = []
        for first, second, along, onto in changes:
            psi = -(first * second_turn - first_turn * side * second) / scale
            turn = -(first_psi * side * second - first * second_psi) / scale
            along += psi * along_psi + turn * along_turn
            onto += psi * onto_psi + turn * onto_turn
            place_slopes.append((along - eta * onto) / self.helicoid.cosine**2)
        tilt = _triple(X, arm, normal) + outwards * _triple(X, axis, normal)
        return side * np.array([normal[0], normal[2], tilt, eta]), np.array(place_slopes)

    @cached_property
    def _radial(self) -> Array:
        """Direction (3,) from the pinion's axis to the place where the line touches its base cylinder."""
        parts = np.array([-self.helicoid.side * sin(self.pinion_slope), 0.0, -cos(self.pinion_slope)])
        return parts @ self.posed_frame[0].basis


def contact_line(family: ToothFamily, side: int, errors: AssemblyErrors = NOMINAL) -> ContactLine | None:
    """Compute the line of unloaded contact of a flank, continued beyond its edges, in an assembly.

    Parameters
    ----------
    family : ToothFamily
        Pair of gears.
    side : int
        Sign of the flank: +1 drive, -1 coast.
    errors : AssemblyErrors
        Errors of assembly; none by default.

    Returns
    -------
    ContactLine, optional
        The line; None where no normal of the gear touches the pinion's base cylinder, and where teeth touch
        along lines (as many teeth of the shaper as of the pinion) that an error turns into an edge.
    """
    helicoid = family.pinion_flanks[0 if side > 0 else 1]
    return find_line(gear_flank(family, side), helicoid, family.motion, errors)


def find_line(
    flank: GearFlank, helicoid: Helicoid, nominal: RelativeMotion, errors: AssemblyErrors
) -> ContactLine | None:
    """Compute `contact_line` from the flanks themselves: solve for slope and turn, then `place_line`.

    Parameters
    ----------
    flank : GearFlank
        Flank of the gear.
    helicoid : Helicoid
        Flank of the pinion.
    nominal : RelativeMotion
        Motion of the pinion at its nominal place.
    errors : AssemblyErrors
        Errors of assembly.

    Returns
    -------
    ContactLine, optional
        The line; None as `contact_line` says.
    """
    is_displaced = (errors.offset, errors.shaft_angle_error, errors.gear_axial) != (0.0, 0.0, 0.0)
    if flank.lift <= 0.0 and is_displaced:
        return None
    solution: tuple[float, float] | None = helicoid.pressure_angle, 0.0
    if is_displaced:
        motion, middle = posed_frame(errors, nominal, helicoid.middle)
        axis = (0.0, motion.sine, -motion.cosine)
        solution = _solve(flank, helicoid, axis, middle, helicoid.pressure_angle)
    return None if solution is None else place_line(flank, helicoid, nominal, errors, *solution)


def place_line(
    flank: GearFlank,
    helicoid: Helicoid,
    nominal: RelativeMotion,
    errors: AssemblyErrors,
    psi: float,
    turn: float,
) -> ContactLine:
    """Compute all numbers of the contact line in an assembly from its known slope and turn.

    Parameters
    ----------
    flank : GearFlank
        Flank of the gear.
    helicoid : Helicoid
        Flank of the pinion.
    nominal : RelativeMotion
        Motion of the pinion at its nominal place.
    errors : AssemblyErrors
        Errors of assembly.
    psi : float
        Slope of the line, rad.
    turn : float
        Turn of the line about the gear's axis, rad.

    Returns
    -------
    ContactLine
        The line.
    """
    side = helicoid.side
    motion, middle = posed_frame(errors, nominal, helicoid.middle)
    axis = (0.0, motion.sine, -motion.cosine)
    parts = flank.line_components(cos(psi), sin(psi))
    foot, normal = _turn_back(parts[0:3], turn), _turn_back(parts[6:9], turn)
    x, v, w = (foot[i] - middle[i] for i in range(3))
    along, up = v * axis[1] + w * axis[2], v * motion.cosine + w * motion.sine
    slope = atan2(-(normal[1] * motion.cosine + normal[2] * motion.sine), side * normal[0])
    roll = side * x * cos(slope) - up * sin(slope)
    rolled_angle = (roll + helicoid.lead * along) / helicoid.base_radius
    pinion_angle = side * (rolled_angle - slope - helicoid.phase)
    gear_angle = float(flank.turn(psi, 0.0, parts[12])) + turn
    angle = gear_angle - pinion_angle * nominal.ratio
    lead = roll / helicoid.cosine
    return ContactLine(
        gear=flank,
        helicoid=helicoid,
        motion=nominal,
        errors=errors,
        psi=psi,
        turn=turn,
        transmission_error=angle / nominal.ratio * helicoid.base_radius * helicoid.cosine,
        foot=np.array(foot),
        normal=np.array(normal),
        pinion_slope=slope,
        pinion_lead=lead,
        pinion_place=along + helicoid.middle - helicoid.sine * lead,
    )


def _solve(
    flank: GearFlank, helicoid: Helicoid, axis: Vector, middle: Vector, psi: float
) -> tuple[float, float] | None:
    """Return slope and turn (rad) of the gear's normal that touches the pinion's base cylinder, or None.

    Newton's method from (psi, 0): the normal has the component sin(base helix) along the pinion's unit `axis`
    and the moment r_b cos(base helix) about it; `middle` (m) is a point of the axis.
    """
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
    """Return a vector turned by -turn (rad) about the gear's axis +z."""
    c, s = cos(turn), sin(turn)
    return vector[0] * c + vector[1] * s, vector[1] * c - vector[0] * s, vector[2]


def _product(first: Vector, second: Vector) -> float:
    """Return the scalar product of two vectors."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


def _triple(first: Vector, second: Vector, third: Vector) -> float:
    """Return the first vector times the cross product of the others."""
    return (
        first[0] * (second[1] * third[2] - second[2] * third[1])
        + first[1] * (second[2] * third[0] - second[0] * third[2])
        + first[2] * (second[0] * third[1] - second[1] * third[0])
    )
