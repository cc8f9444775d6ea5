"""Unloaded contact of flanks without modifications, in closed form for every assembly.

The pinion is a cylinder, so that conjugate action survives any displacement of it: all contact stands on one
normal, at one place y along the pinion's axis, with one slope psi, and the transmission error is constant.
With c the place of the middle of the pinion's face in the gear's frame, e the turn of the normal about the
gear's axis and h = m (N_s - N_1) / 2, psi solves the condition that the normal touches the pinion's base
cylinder; the transmission error is stationary there. For parallel planes of the axes (no error of the shaft
angle) it reads cos psi (h - dq) - sin psi dE = h cos a0. Derived for this project from the generated flank of
`face_gear`; confirmed against rigid displacements of either body.

Derivatives of transmission error and path of the exact unloaded contact by the pose of a pair. The
transmission error is stationary in the slope psi of the common normal, so that its derivatives are those at
constant psi: by offset and axial shift they are the normal itself. The path follows psi, whose derivatives
come from the condition that this module solves.
"""

from dataclasses import astuple, dataclass
from functools import lru_cache
from math import acos, asin, atan2, cos, hypot, isfinite, pi, sin, tan
from typing import Self

import numpy as np

from facegear.arrays import Array
from facegear.teeth import pinion
from facegear.teeth.design import AssemblyErrors, GearModifications, PairDesign

STEPS = 60
"""Largest number of Newton steps; a search that needs more has no solution."""
ROUNDING = 1e-12
"""Step of psi (rad) by which differences for the slope are off."""


@dataclass(frozen=True)
class PairNumbers:
    """Numbers of a pair that the closed form and the ends of the faces need; m and rad.

    first_end, last_end: ends of the common face, distances from the gear's axis along the pinion's.
    """

    pressure_angle: float
    pinion_teeth: float
    pinion_base_radius: float
    pinion_half_base_angle: float
    shaper_base_radius: float
    shaper_half_space_angle: float
    shaper_lift: float
    gear_base_radius: float
    mean_radius: float
    first_end: float
    last_end: float

    @classmethod
    def of_design(cls, design: PairDesign) -> Self:
        """Return the numbers of a design.

        Parameters
        ----------
        design : PairDesign
            Pair of gears.

        Returns
        -------
        PairNumbers
            Numbers in m and rad.
        """
        half, face = design.pinion.width / 2, design.face_gear
        return cls(
            pressure_angle=design.pressure_angle,
            pinion_teeth=float(design.pinion.teeth),
            pinion_base_radius=design.pinion_base_radius,
            pinion_half_base_angle=design.pinion_half_base_angle,
            shaper_base_radius=design.shaper_base_radius,
            shaper_half_space_angle=design.shaper_half_space_angle,
            shaper_lift=design.shaper_lift,
            gear_base_radius=design.gear_base_radius,
            mean_radius=design.mean_radius,
            first_end=max(face.inner_radius, design.mean_radius - half),
            last_end=min(face.outer_radius, design.mean_radius + half),
        )

    @classmethod
    def of_array(cls, values: Array) -> Self:
        """Rebuild the numbers from `array`.

        Parameters
        ----------
        values : (11,) array
            Numbers in m and rad, in the order of the fields.

        Returns
        -------
        PairNumbers
            The numbers.
        """
        return cls(*(float(value) for value in values))

    @property
    def array(self) -> Array:
        """All numbers of the pair as one array (11,), as it is stored."""
        return np.array(astuple(self))


@dataclass(frozen=True)
class ConjugateContact:
    """Contact of the drive flanks, extended beyond their edges; it is the same at every pinion angle.

    Attributes
    ----------
    psi
        Slope of the common normal against the plane of the gear (rad), the pressure angle there.
    turn
        Of that normal about the gear's axis (rad).
    transmission_error
        m, as in `UnloadedContact`.
    y
        Place along the pinion's axis, counted on the pinion (m).
    normal_roll
        Roll angle (rad) of the contact of pair 0 on the pinion at phi1 = 0.
    """

    psi: float
    turn: float
    transmission_error: float
    y: float
    normal_roll: float


def conjugate_contact(design: PairDesign) -> ConjugateContact | None:
    """Compute `contact_at` in the assembly of a design.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    ConjugateContact, optional
        Contact in m and rad, or None.
    """
    return contact_at(PairNumbers.of_design(design), design.assembly)


def contact_at(pair: PairNumbers, errors: AssemblyErrors) -> ConjugateContact | None:
    """Compute the unloaded contact of flanks continued without end, in an assembly.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.
    errors : AssemblyErrors
        Errors of the assembly.

    Returns
    -------
    ConjugateContact, optional
        Contact in m and rad; None where no normal of the flanks touches, and where teeth touch along lines
        that an assembly error turns into an edge (as many teeth of the shaper as of the pinion).
    """
    if pair.shaper_lift <= 0.0:
        return None
    psi = pair.pressure_angle if errors == AssemblyErrors() else _slope(pair, errors)
    if psi is None:
        return None
    turn = _turn(errors, psi)
    height, base = pair.shaper_lift, pair.shaper_base_radius
    x, y, z = _face_middle(pair, errors)
    tilt = errors.shaft_angle_error
    on_pinion = acos(cos(psi) * cos(turn))
    half_tooth = pair.pinion_half_base_angle - pi / pair.pinion_teeth
    error = (
        _dot(_rotate((cos(psi), 0.0, -sin(psi)), turn), (x, y, z))
        + pair.pinion_base_radius * (on_pinion + half_tooth)
        + height * sin(psi)
        - base * (psi - pair.shaper_half_space_angle)
        - pair.gear_base_radius * turn
    )
    point = _rotate((-base * sin(psi), pair.gear_base_radius / cos(psi), height - base * cos(psi)), turn)
    along = pair.mean_radius + cos(tilt) * (point[1] - y) + sin(tilt) * (point[2] - z)
    return ConjugateContact(psi, turn, error, along, on_pinion + half_tooth)


@lru_cache(maxsize=256)
def exact_contact(design: PairDesign) -> ConjugateContact | None:
    """Return `conjugate_contact` where it is the contact of the teeth.

    It holds where a whole pitch of the contact path lies on both flanks, within both faces.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    ConjugateContact, optional
        Contact in m and rad; None where a flank is modified or ends before.
    """
    if not without_modifications(design):
        return None
    contact = conjugate_contact(design)
    if contact is None:
        return None
    first, last = _rolls(design, contact)
    if last - first < 2 * pi / design.pinion.teeth:
        return None
    if abs(contact.y - design.mean_radius) > design.pinion.width / 2:
        return None
    radii = [hypot(*_point(design, contact, roll)[:2]) for roll in (first, last)]
    nearest = _nearest(design, contact)
    inside = design.face_gear.inner_radius <= nearest and max(radii) <= design.face_gear.outer_radius
    return contact if inside else None


def offset_for(pair: PairNumbers, path: float, errors: AssemblyErrors) -> float | None:
    """Compute the offset with which contact occurs at a position along the pinion, other errors as given.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.
    path : float
        Position of the contact along the pinion, m.
    errors : AssemblyErrors
        Errors of the assembly, whose offset is not used.

    Returns
    -------
    float, optional
        Offset, m; None where there is none.
    """
    psi, tilt = acos(pair.gear_base_radius / path), errors.shaft_angle_error
    lift, step = pair.shaper_lift, 1e-7
    offset = ((lift - errors.axial_shift) * cos(psi) - lift * cos(pair.pressure_angle)) / sin(psi)
    for _ in range(STEPS):
        near = [
            contact_at(pair, AssemblyErrors(at, tilt, errors.axial_shift)) for at in (offset, offset + step)
        ]
        if near[0] is None or near[1] is None:
            return None
        path_error = near[0].y - path
        if abs(path_error) < 1e-12:
            return offset
        offset -= path_error * step / (near[1].y - near[0].y)
    return None


def _slope(pair: PairNumbers, errors: AssemblyErrors) -> float | None:
    """Solve for the angle psi of the contact normal by Newton's method; None where there is no conjugate
    contact.

    It starts from the pressure angle, with difference quotients for the slope.
    """
    psi, width = pair.pressure_angle, 1e-5
    for _ in range(STEPS):
        if not abs(psi) < 0.5 * pi - width:
            return None
        below, middle, above = (_condition(pair, errors, psi + step) for step in (-width, 0.0, width))
        rise = (above - below) / (2 * width)
        step = middle / rise if rise else float("nan")
        if not isfinite(step):
            return None
        psi -= max(-0.2, min(0.2, step))
        if abs(step) < ROUNDING:
            return psi if psi > 0.0 else None
    return None


def _condition(pair: PairNumbers, errors: AssemblyErrors, psi: float) -> float:
    """Return by how much (m) the normal of slope psi misses the pinion's base cylinder."""
    tilt, turn = errors.shaft_angle_error, _turn(errors, psi)
    across = cos(turn) * cos(tilt)
    from_axis = _rotate((across * sin(psi), -sin(tilt) / cos(psi), across * cos(psi)), turn)
    return (
        across * (pair.shaper_lift * cos(psi) - pair.shaper_base_radius)
        - sin(tilt) * pair.gear_base_radius / cos(psi) ** 2
        - _dot(from_axis, _face_middle(pair, errors))
        + pair.pinion_base_radius
    )


def _turn(errors: AssemblyErrors, psi: float) -> float:
    """Return the rotation of the contact normal about the gear's axis, rad, by which it is square to the
    pinion's axis.
    """
    return asin(max(-1.0, min(1.0, tan(psi) * tan(errors.shaft_angle_error))))


def _face_middle(pair: PairNumbers | PairDesign, errors: AssemblyErrors) -> tuple[float, float, float]:
    """The middle of the pinion's face in the gear's frame (m)."""
    return errors.offset, pair.mean_radius, errors.axial_shift


def without_modifications(design: PairDesign) -> bool:
    """Whether both flanks are as generated.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    bool
        True without modifications and deviations.
    """
    pinion_part = design.pinion
    reliefs = (pinion_part.tip_relief, pinion_part.root_relief, pinion_part.lead_crowning)
    on_pinion = any(relief.amount != 0.0 for relief in reliefs)
    return not (on_pinion or design.face_gear.modifications != GearModifications() or design.deviates)


def _rolls(design: PairDesign, contact: ConjugateContact) -> tuple[float, float]:
    """Return the first and last roll angle (rad) of the pinion at which the contact lies on both flanks."""
    start, slope = (_point(design, contact, roll)[2] for roll in (0.0, 1.0))
    slope -= start
    base, lift = design.shaper_base_radius, design.shaper_lift
    deepest = lift - base * (cos(contact.psi) + design.shaper_tip_roll * sin(contact.psi))
    first, last = ((height - start) / slope for height in (design.gear_tip_plane, deepest))
    return max(first, pinion.junction_roll(design), 0.0), min(last, design.pinion_tip_roll)


def _point(design: PairDesign, contact: ConjugateContact, roll: float) -> tuple[float, float, float]:
    """Return the contact point (m) in the gear's frame at a roll angle of the pinion."""
    base, on_pinion = design.pinion_base_radius, acos(cos(contact.psi) * cos(contact.turn))
    x = base * (roll * cos(on_pinion) - sin(on_pinion))
    z = -base * (roll * sin(on_pinion) + cos(on_pinion))
    tilt, along = design.assembly.shaft_angle_error, contact.y - design.mean_radius
    face_middle = _face_middle(design, design.assembly)
    return (
        face_middle[0] + x,
        face_middle[1] + cos(tilt) * along - sin(tilt) * z,
        face_middle[2] + sin(tilt) * along + cos(tilt) * z,
    )


def _nearest(design: PairDesign, contact: ConjugateContact) -> float:
    """Return the smallest distance (m) of the way of contact from the gear's axis."""
    x, y, _ = _point(design, contact, 0.0)
    second_point = _point(design, contact, 1.0)
    direction = atan2(second_point[1] - y, second_point[0] - x)
    return abs(y * cos(direction) - x * sin(direction))


def _rotate(vector: tuple[float, float, float], angle: float) -> tuple[float, float, float]:
    """Rotate a vector about z by an angle, rad."""
    x, y, z = vector
    return x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle), z


def _dot(first: tuple[float, float, float], second: tuple[float, float, float]) -> float:
    """Return the dot product of two vectors."""
    return first[0] * second[0] + first[1] * second[1] + first[2] * second[2]


@dataclass(frozen=True, eq=False)
class ConjugateSlopes:
    """Derivatives by offset, axial shift (m/m) and the error of the shaft angle (m/rad), (3,) each.

    transmission_error, path: of `ConjugateContact.transmission_error` and `ConjugateContact.y`.
    """

    transmission_error: Array
    path: Array


def conjugate_slopes(pair: PairNumbers, errors: AssemblyErrors, contact: ConjugateContact) -> ConjugateSlopes:
    """Compute the derivatives of the contact of a pair by its errors.

    Parameters
    ----------
    pair : PairNumbers
        Numbers of the pair.
    errors : AssemblyErrors
        Errors of the assembly.
    contact : ConjugateContact
        Contact with these errors.

    Returns
    -------
    ConjugateSlopes
        Derivatives, m/m and m/rad.
    """
    psi, turn, tilt = contact.psi, contact.turn, errors.shaft_angle_error
    turn_by_tilt = tan(psi) / (cos(tilt) ** 2 * cos(turn))
    turn_by_psi = tan(tilt) / (cos(psi) ** 2 * cos(turn))
    by_turn = (
        cos(psi) * (cos(turn) * pair.mean_radius - sin(turn) * errors.offset)
        + pair.pinion_base_radius * cos(psi) * sin(turn) / sin(acos(cos(psi) * cos(turn)))
        - pair.gear_base_radius
    )
    missing_psi, missing_turn, condition_slopes = _condition_slopes(pair, errors, psi, turn)
    path_psi, path_turn, path = _path_slopes(pair, errors, psi, turn)
    by_errors = np.array([0.0, 0.0, turn_by_tilt])
    psi_by_errors = -(condition_slopes + missing_turn * by_errors) / (
        missing_psi + missing_turn * turn_by_psi
    )
    return ConjugateSlopes(
        np.array([cos(psi) * cos(turn), -sin(psi), by_turn * turn_by_tilt]),
        path + path_turn * by_errors + (path_psi + path_turn * turn_by_psi) * psi_by_errors,
    )


def _condition_slopes(
    pair: PairNumbers, errors: AssemblyErrors, psi: float, turn: float
) -> tuple[float, float, Array]:
    """Return derivatives of the condition on psi by psi, by the rotation of the normal, and by the errors
    (3,).
    """
    tilt, base = errors.shaft_angle_error, pair.gear_base_radius
    across = cos(turn) * cos(tilt)
    along = errors.offset * cos(turn) + pair.mean_radius * sin(turn)
    beside = pair.mean_radius * cos(turn) - errors.offset * sin(turn)
    by_across = (
        pair.shaper_lift * cos(psi)
        - pair.shaper_base_radius
        - sin(psi) * along
        - cos(psi) * errors.axial_shift
    )
    by_psi = (
        across * (sin(psi) * (errors.axial_shift - pair.shaper_lift) - cos(psi) * along)
        - 2.0 * sin(tilt) * base * sin(psi) / cos(psi) ** 3
        + sin(tilt) * sin(psi) / cos(psi) ** 2 * beside
    )
    by_turn = -by_across * sin(turn) * cos(tilt) - across * sin(psi) * beside - sin(tilt) / cos(psi) * along
    by_tilt = -by_across * cos(turn) * sin(tilt) + cos(tilt) / cos(psi) * (beside - base / cos(psi))
    by_offset = -across * sin(psi) * cos(turn) - sin(tilt) * sin(turn) / cos(psi)
    return by_psi, by_turn, np.array([by_offset, -across * cos(psi), by_tilt])


def _path_slopes(
    pair: PairNumbers, errors: AssemblyErrors, psi: float, turn: float
) -> tuple[float, float, Array]:
    """Return the derivatives of the position along the pinion's axis by psi, by the turn, and by the errors
    (3,).
    """
    tilt, base = errors.shaft_angle_error, pair.shaper_base_radius
    x, y = -base * sin(psi), pair.gear_base_radius / cos(psi)
    high = pair.shaper_lift - base * cos(psi) - errors.axial_shift
    far = x * sin(turn) + y * cos(turn) - pair.mean_radius
    by_psi = cos(tilt) * (-base * cos(psi) * sin(turn) + y * tan(psi) * cos(turn))
    by_psi += sin(tilt) * base * sin(psi)
    by_turn = cos(tilt) * (x * cos(turn) - y * sin(turn))
    return by_psi, by_turn, np.array([0.0, -sin(tilt), cos(tilt) * high - sin(tilt) * far])
