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
from facegear.teeth.conjugate import PairNumbers, exact_contact
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.placement import FLANKS, RigidMotion, errors_at, mirror_design, pinion_angle, rotation
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


def pose_of(pinion: RigidMotion, gear: RigidMotion, mean_radius: float) -> Pose:
    """Return the pose of a pinion and a gear that have moved in the mesh frame from their nominal places.

    It is exact: the motion of the pinion relative to the gear is split into a turn of the gear, an
    offset, an axial shift, a tilt of the pinion's axis, a shift along it and a turn about it.

    Parameters
    ----------
    pinion : RigidMotion
        Rigid motion of any size, m; the error of the shaft angle stays within a quarter turn.
    gear : RigidMotion
        Rigid motion of any size, m.
    mean_radius : float
        Position of the middle of the pinion's face on its axis, m.

    Returns
    -------
    Pose
        m and rad.
    """
    back = gear.inverse()
    turn = back.matrix @ pinion.matrix
    middle = back.points(pinion.points(np.array([[0.0, mean_radius, 0.0]])))[0]
    axis = turn @ np.array([0.0, 1.0, 0.0])
    around = float(np.arctan2(-axis[0], axis[1]))
    tilt = float(np.arcsin(axis[2]))
    unturned = _about_z(-around)
    middle, turn = unturned @ middle, unturned @ turn
    outward = (middle[1] - mean_radius) / np.cos(tilt)
    errors = AssemblyErrors(
        offset=float(middle[0]),
        shaft_angle_error=tilt,
        gear_axial=float(middle[2] - outward * np.sin(tilt)),
    )
    # What is left of the turn is about the pinion's own axis, -y, before the tilt about x.
    return Pose(errors, float(outward), float(np.arctan2(-turn[0, 2], turn[0, 0])), -around)


def _about_z(angle: float) -> Array:
    """Return the matrix (3, 3) of a rotation about z by an angle, rad."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def to_mesh_frame(sign: float) -> Array:
    """Return the matrix from the machine's frame at a pinion to that of its mesh.

    With s = `sign`, the mesh's x, y, z are s x, z and -s y of the machine: along the tangent, outwards
    along the pinion, and along the gears' axis.

    Parameters
    ----------
    sign : float
        1 for a mesh with the upper gear, -1 with the lower, dimensionless.

    Returns
    -------
    (3, 3) array
        Dimensionless, a rotation in units of 1.
    """
    return np.array([[sign, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -sign, 0.0]])


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


def assembled_motion(errors: AssemblyErrors, mean_radius: float) -> RigidMotion:
    """Return the motion of a pinion in the mesh frame, from its nominal place, that assembly errors are.

    Parameters
    ----------
    errors : AssemblyErrors
        The assembly errors.
    mean_radius : float
        Position of the middle of the pinion's face on its axis, m.

    Returns
    -------
    RigidMotion
        m.
    """
    motion = body_motion((0.0, 0.0, 0.0), (errors.shaft_angle_error, 0.0, 0.0), (0.0, mean_radius, 0.0))
    return RigidMotion(motion.matrix, motion.shift + np.array([errors.offset, 0.0, errors.gear_axial]))


def in_mesh_frame(motion: RigidMotion, sign: float) -> RigidMotion:
    """Return a motion given in the machine's frame at a pinion, in the frame of its mesh.

    Parameters
    ----------
    motion : RigidMotion
        The motion, m.
    sign : float
        1 for a mesh with the upper gear, -1 with the lower, dimensionless.

    Returns
    -------
    RigidMotion
        m.
    """
    frame = to_mesh_frame(sign)
    return RigidMotion(frame @ motion.matrix @ frame.T, frame @ motion.shift)


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
        Height over the pinion's axis, towards the gear, of the point about which the gear tilts, m.
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
        Place of the contact along the pinion's axis, as `ConjugateContact.y`.
    slope
        Slope of the common normal (the pressure angle there); NaN where the contact was searched.
    approach
        How far the flanks have come together along the line of action, from as assembled.
    deflection
        The part of `approach` that is of first order: what a lumped mesh counts as its deflection.
    backlash
        Normal backlash of the displaced pair at this place of the mesh cycle.
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
    motions = _motions(design, mesh, pinion, gear)
    nominal = errors_at(design.assembly, mesh.gear, FLANKS[0])
    assembled_pinion = assembled_motion(nominal, design.mean_radius)
    whole = RigidMotion(
        motions[0].matrix @ assembled_pinion.matrix, motions[0].points(assembled_pinion.shift[None])[0]
    )
    pose = pose_of(whole, motions[1], design.mean_radius)
    contacts = [
        _contact(_pair_of_flank(design, pose.errors, flank), pose, flank, position) for flank in FLANKS
    ]
    still = Pose(nominal, 0.0, 0.0, 0.0)
    rest = [_contact(_pair_of_flank(design, nominal, flank), still, flank, position)[0] for flank in FLANKS]
    ends = PairNumbers.of_design(design)
    return {
        flank: DisplacedFlank(
            design=_pair_of_flank(design, pose.errors, flank),
            outward=pose.outward,
            path=path,
            slope=slope,
            approach=error - at_rest,
            deflection=_first_order(design, mesh, pinion, gear, flank),
            backlash=-contacts[0][0] - contacts[1][0],
            to_inner_end=path - ends.first_end,
            to_outer_end=ends.last_end - path,
        )
        for flank, (error, path, slope), at_rest in zip(FLANKS, contacts, rest, strict=True)
    }


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
    rotation_error = sign * (design.pinion_base_radius * pose.ahead + design.gear_base_radius * pose.behind)
    exact = exact_contact(design)
    if exact is not None:
        return exact.transmission_error + rotation_error, exact.y, exact.psi
    phi1 = sign * (float(pinion_angle(design, position)) + pose.ahead)
    contact = unloaded_contact(design, phi1)
    return float(contact.transmission_error[0]) + rotation_error, float(contact.path[1][0]), float("nan")


def _motions(
    design: PairDesign, mesh: MeshPlace, pinion: Displacement, gear: Displacement
) -> tuple[RigidMotion, RigidMotion]:
    """Return the motions of pinion and gear in the mesh frame, from where they were assembled, m."""
    pinion_turn, gear_turn = _turns(design, mesh, pinion, gear)
    return in_mesh_frame(body_motion(*pinion_turn), mesh.sign), in_mesh_frame(
        body_motion(*gear_turn), mesh.sign
    )


def _turns(
    design: PairDesign, mesh: MeshPlace, pinion: Displacement, gear: Displacement
) -> tuple[tuple[Array, Array, Array], tuple[Array, Array, Array]]:
    """Return shift (m), rotation vector (rad) and pivot (m), (3,) each, of pinion and gear.

    All are in the machine's frame at the pinion; the gear's displacement is turned into it by the
    azimuth. A pinion that drives turns against z there, and the lower gear against the gears' z.
    """
    cosine, sine = np.cos(mesh.azimuth), np.sin(mesh.azimuth)
    to_pinion = np.array([[cosine, sine, 0.0], [0.0, 0.0, 1.0], [sine, -cosine, 0.0]])
    pinion_parts = np.array(pinion.shift), np.array(pinion.turn) * [1.0, 1.0, -1.0]
    gear_parts = np.array(gear.shift), np.array(gear.turn) * [1.0, 1.0, mesh.sign]
    middle = np.array([0.0, 0.0, design.mean_radius])
    height = np.array([0.0, mesh.sign * mesh.tilt_height, 0.0])
    return (*pinion_parts, middle), (to_pinion @ gear_parts[0], to_pinion @ gear_parts[1], height)


def _first_order(
    design: PairDesign, mesh: MeshPlace, pinion: Displacement, gear: Displacement, flank: str
) -> float:
    """Return the approach of a flank (m) to first order, positive where it closes: the motion of the
    pinion less that of the gear at the pitch point, along the ideal normal.
    """
    point = np.array([0.0, mesh.sign * design.pinion_pitch_radius, design.gear_pitch_radius])
    displacements = [
        shift + np.cross(turn, point - pivot) for shift, turn, pivot in _turns(design, mesh, pinion, gear)
    ]
    angle, sign = design.pressure_angle, 1.0 if flank == FLANKS[0] else -1.0
    normal = mesh.sign * np.array([sign * np.cos(angle), np.sin(angle), 0.0])
    return float(normal @ (displacements[0] - displacements[1]))
