"""Exact pose and unloaded contact of a pair whose two bodies stand displaced.

Unloaded contact of a pair with displaced bodies: where its flanks meet, and how far they close. The pinion's
displacement is given in the machine's frame at the pinion: x along the tangent as the upper gear's teeth
move, y along the gears' axis towards the upper gear, z outwards along the pinion. The gear's displacement is
given in the frame of the gears: x towards azimuth 0, y a quarter turn further, z from the lower to the upper
gear.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.machine.poses.mesh_poses import middle_place, to_mesh_frame, to_pinion
from facegear.teeth.conjugate import PairNumbers, exact_contact, pitch_roll
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.family_contact import contact_line
from facegear.teeth.placement import FLANKS, RigidMotion, mirror_design, pair_at, pinion_angle, rotation
from facegear.teeth.tooth_family import SIDES, RelativeMotion
from facegear.teeth.unloaded_contact import unloaded_contact


@dataclass(frozen=True)
class Pose:
    """Pose of a pinion against its gear in the mesh frame, and how far both have turned.

    Attributes
    ----------
    errors
        Assembly errors that put the pinion there: offset along x, axial shift along z (m), and the error
        of the shaft angle (rad).
    outward
        Shift of the pinion along its axis, away from the gear's axis (m): it moves no normal of the
        flanks, only the ends of the face and what is taken off along it.
    ahead
        Turn of the pinion about its axis, ahead as it drives (rad).
    behind
        Turn of the gear about its axis, against its motion (rad).
    """

    errors: AssemblyErrors
    outward: float
    ahead: float
    behind: float


def pose_of(pinion: RigidMotion, gear: RigidMotion, middle: float, axes: RelativeMotion) -> Pose:
    """Return the pose of a pinion and a gear that have moved in the mesh frame from their nominal places.

    It is exact: the motion of the pinion relative to the gear is split into a turn of the gear, an
    offset, an axial shift, a tilt of the pinion's axis, a shift along it and a turn about it.

    Parameters
    ----------
    pinion : RigidMotion
        Rigid motion of any size, m; the error of the shaft angle stays within a quarter turn.
    gear : RigidMotion
        Rigid motion of any size, m.
    middle : float
        Position of the middle of the pinion's face on its axis, m.
    axes : RelativeMotion
        Shaft angle and offset of the nominal axes.

    Returns
    -------
    Pose
        m and rad.
    """
    back, (across, along, up) = gear.inverse(), axes.basis
    turn = back.matrix @ pinion.matrix
    middle_point = back.points(pinion.points(middle_place(middle, axes)[None]))[0]
    axis = turn @ along
    around = float(np.arctan2(-axis[0], axis[1]))
    # Turned back into the plane of y and z, the pinion's axis is (level, axis[2]) = (sine, -cosine).
    level = float(np.hypot(axis[0], axis[1]))
    tilt = float(
        np.arctan2(level * axes.cosine + axis[2] * axes.sine, level * axes.sine - axis[2] * axes.cosine)
    )
    unturned = _about_z(-around)
    middle_point, turn = unturned @ middle_point, unturned @ turn
    outward = float((middle_point[1] - middle * axes.sine) / level)
    errors = AssemblyErrors(
        offset=float(middle_point[0] - axes.offset),
        shaft_angle_error=tilt,
        gear_axial=float(middle_point[2] + middle * axes.cosine - outward * axis[2]),
    )
    # What is left of the turn is about the pinion's own axis, before the tilt about x.
    ahead = float(np.arctan2(-turn[0] @ up, turn[0] @ across))
    return Pose(errors, outward, ahead, -around)


def _about_z(angle: float) -> Array:
    """Return the matrix (3, 3) of a rotation about z by an angle, rad."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def body_motion(shift: ArrayLike, turn: ArrayLike, pivot: ArrayLike) -> RigidMotion:
    """Return a turn about a point, followed by a shift, all in one frame.

    Parameters
    ----------
    shift : (3,) array
        Shift, m.
    turn : (3,) array
        Rotation vector, rad.
    pivot : (3,) array
        The point, m.

    Returns
    -------
    RigidMotion
        m.
    """
    vector, point = np.asarray(turn, float), np.asarray(pivot, float)
    angle = float(np.linalg.norm(vector))
    matrix = rotation(vector / angle, angle) if angle else np.eye(3)
    return RigidMotion(matrix, np.asarray(shift, float) + point - matrix @ point)


def assembled_motion(errors: AssemblyErrors, middle: float, axes: RelativeMotion) -> RigidMotion:
    """Return the motion of a pinion in the mesh frame, from its nominal place, that assembly errors are.

    Parameters
    ----------
    errors : AssemblyErrors
        The assembly errors.
    middle : float
        Position of the middle of the pinion's face on its axis, m.
    axes : RelativeMotion
        Shaft angle and offset of the nominal axes.

    Returns
    -------
    RigidMotion
        m.
    """
    motion = body_motion((0.0, 0.0, 0.0), (errors.shaft_angle_error, 0.0, 0.0), middle_place(middle, axes))
    along = errors.pinion_axial * (motion.matrix @ axes.basis[1])
    return RigidMotion(
        motion.matrix, motion.shift + np.array([errors.offset, 0.0, errors.gear_axial]) + along
    )


@dataclass(frozen=True)
class Displacement:
    """Displacement of a body from where it was assembled.

    Attributes
    ----------
    shift
        Along x, y and z, m.
    turn
        Tilts about x and y, and the turn about the body's axis as it turns when it drives or is driven, rad.
    """

    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class MeshPlace:
    """Place of a mesh in a machine.

    Attributes
    ----------
    gear
        Upper or lower.
    azimuth
        Angle of the pinion about the gears' axis, rad.
    tilt_height
        Height over where the pinion's axis passes the gear's, towards the gear, of the point about which the
        gear tilts, m.
    """

    gear: str
    azimuth: float
    tilt_height: float

    @property
    def sign(self) -> float:
        """1 for the upper, -1 for the lower gear."""
        return 1.0 if self.gear == "upper" else -1.0


@dataclass(frozen=True)
class DisplacedFlank:
    """Unloaded contact of one flank of a displaced pair; m and rad.

    Attributes
    ----------
    design
        The pair whose drive flank this flank is, its assembly that of the pose.
    outward
        Shift of the pinion along its axis, away from the gears' axis.
    path
        Place of the contact along the pinion's axis, as `ConjugateContact.path`, counted where the pinion
        was assembled.
    slope
        Slope of the common normal (the pressure angle there); NaN where the contact was searched.
    approach
        How far the flanks have come together along the line of action, from as assembled.
    deflection
        The part of `approach` that is of first order: what a lumped mesh counts as its deflection.
    backlash
        Backlash of the displaced pair at this place of the mesh cycle, along the drive flank's normal.
    to_inner_end, to_outer_end
        From the path to the ends of the common face.
    """

    design: PairDesign
    outward: float
    path: float
    slope: float
    approach: float
    deflection: float
    backlash: float
    to_inner_end: float
    to_outer_end: float

    @property
    def closure(self) -> float:
        """Approach of the flanks beyond its linear part in the displacements, m."""
        return self.approach - self.deflection


def displaced_flanks(
    design: PairDesign, mesh: MeshPlace, pinion: Displacement, gear: Displacement, position: float = 0.5
) -> dict[str, DisplacedFlank]:
    """Return the unloaded contact of the drive and the back flank by name.

    Parameters
    ----------
    design : PairDesign
        Pair as assembled.
    mesh : MeshPlace
        Where the mesh is in its machine.
    pinion : Displacement
        Displacement of the pinion, of any size for which flanks face each other.
    gear : Displacement
        Displacement of the gear, of any such size.
    position : float
        Place of a pitch (0 to 1) at which flanks with modifications are searched; the others have the same
        contact everywhere. Dimensionless.

    Returns
    -------
    dict of str to DisplacedFlank
        By names of FLANKS, m and rad.

    Raises
    ------
    NotConverged
        If the flanks do not face each other.
    """
    assembled_design = pair_at(design, mesh.gear, FLANKS[0])
    nominal, middle = assembled_design.assembly, assembled_design.middle
    axes = assembled_design.family.motion
    turns = _turns(assembled_design, mesh, pinion, gear)
    motions = [body_motion(*turn) for turn in turns]
    assembled_pinion = assembled_motion(nominal, middle, axes)
    whole = RigidMotion(
        motions[0].matrix @ assembled_pinion.matrix, motions[0].points(assembled_pinion.shift[None])[0]
    )
    pose = pose_of(whole, motions[1], middle, axes)
    # The face of a spur pinion keeps its ends when it moves along its axis, which nothing else would feel.
    outward = nominal.pinion_axial if design.is_spur else pose.outward
    errors = replace(pose.errors, pinion_axial=outward)
    posed_pairs = [_pair_of_flank(assembled_design, errors, flank) for flank in FLANKS]
    contacts = [
        _contact(pair, pose, flank, position) for pair, flank in zip(posed_pairs, FLANKS, strict=True)
    ]
    still = Pose(nominal, nominal.pinion_axial, 0.0, 0.0)
    rest = [
        _contact(_pair_of_flank(assembled_design, nominal, flank), still, flank, position)[0]
        for flank in FLANKS
    ]
    arms = [pair.gear_normal_arm for pair in posed_pairs]
    flanks = {}
    for number, (flank, pair) in enumerate(zip(FLANKS, posed_pairs, strict=True)):
        (error, path, slope), ends = contacts[number], PairNumbers.of_design(pair)
        along = pair.assembly.pinion_axial - nominal.pinion_axial
        flanks[flank] = DisplacedFlank(
            design=pair,
            outward=pose.outward,
            path=path + along,
            slope=slope,
            approach=error - rest[number],
            deflection=_first_order(assembled_design, turns, SIDES[number]),
            backlash=-contacts[0][0] - contacts[1][0] * (arms[0] / arms[1]),
            to_inner_end=path - ends.first_end,
            to_outer_end=ends.last_end - path,
        )
    return flanks


def _pair_of_flank(design: PairDesign, errors: AssemblyErrors, flank: str) -> PairDesign:
    """Return the pair, with its assembly, whose drive flank is the given flank; `errors` are those that
    the drive flank meets. It is the mirrored design for the back flank.
    """
    design_at_pose = replace(design, assembly=errors)
    return design_at_pose if flank == FLANKS[0] else mirror_design(design_at_pose)


def _contact(design: PairDesign, pose: Pose, flank: str, position: float) -> tuple[float, float, float]:
    """Return the unloaded contact of a flank of a displaced pair.

    design: of `_pair_of_flank`; flank: from FLANKS; position: place in a pitch, 0 to 1, used only where
    there is no closed form. Returns the transmission error (m) with the turns of both bodies, positive
    where the flanks come together; the path (m); and the slope of the normal (rad), nan where the contact
    was searched.
    """
    sign = 1.0 if flank == FLANKS[0] else -1.0
    rotation_error = sign * (design.normal_arm * pose.ahead + design.gear_normal_arm * pose.behind)
    exact = exact_contact(design)
    if exact is not None:
        return exact.transmission_error + rotation_error, exact.path, exact.psi
    phi1 = sign * (float(pinion_angle(design, position)) + pose.ahead)
    contact = unloaded_contact(design, phi1)
    helicoid, (roll, y) = design.family.pinion_flanks[0], (float(part[0]) for part in contact.path)
    path = y + helicoid.lead * (pitch_roll(helicoid) - helicoid.base_radius * roll)
    return float(contact.transmission_error[0]) + rotation_error, path, float("nan")


Turn = tuple[Array, Array, Array]
"""Shift (m), rotation vector (rad) and pivot (m) of a body, (3,) each, in the mesh frame."""


def _turns(
    design: PairDesign, mesh: MeshPlace, pinion: Displacement, gear: Displacement
) -> tuple[Turn, Turn]:
    """Return the displacements of pinion and gear from where they were assembled, in the mesh frame.

    design: of the mesh's gear. A pinion that drives turns against its z, and the lower gear against the
    gears' z.
    """
    axes, to_mesh = design.family.motion, to_mesh_frame(mesh.sign)
    of_pinion = axes.basis.T @ to_mesh
    of_gear = to_mesh @ to_pinion(mesh.azimuth)
    pinion_turn = np.array(pinion.turn) * [1.0, 1.0, -1.0]
    gear_turn = np.array(gear.turn) * [1.0, 1.0, mesh.sign]
    middle, centre = middle_place(design.middle, axes), np.array([0.0, 0.0, -mesh.tilt_height])
    return (
        (of_pinion @ np.array(pinion.shift), of_pinion @ pinion_turn, middle),
        (of_gear @ np.array(gear.shift), of_gear @ gear_turn, centre),
    )


def _first_order(design: PairDesign, turns: tuple[Turn, Turn], side: int) -> float:
    """Return the approach of a flank (m) to first order, positive where it closes: the motion of the
    pinion less that of the gear on the line of contact of the ideal assembly, along its normal.

    design: of the mesh's gear; turns: of `_turns`; side: of the flank, 1 drive and -1 back.
    """
    line = contact_line(design.family, side)
    assert line is not None  # without errors of assembly there always is one
    displacements = [shift + np.cross(turn, line.foot - pivot) for shift, turn, pivot in turns]
    return float(line.normal @ (displacements[0] - displacements[1]))
