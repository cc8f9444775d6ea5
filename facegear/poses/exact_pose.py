"""Exact pose of a pair: the assembly errors that it meets when both of its bodies have moved."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.geometry.design import AssemblyErrors
from facegear.geometry.placement import RigidMotion, rotation


@dataclass(frozen=True)
class Pose:
    """Pose of a pinion against its gear, and how far both have turned.

    Attributes
    ----------
    errors
        Assembly errors.
    outward
        Shift of the pinion along its axis, away from the gear's axis (m): it moves no normal of the flanks,
        only the ends of the face and what is taken off along it.
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
        axial_shift=float(middle[2] - outward * np.sin(tilt)),
    )
    # What is left of the turn is about the pinion's own axis, -y, before the tilt about x.
    return Pose(errors, float(outward), float(np.arctan2(-turn[0, 2], turn[0, 0])), -around)


def _about_z(angle: float) -> Array:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def to_mesh_frame(sign: float) -> Array:
    """Return the matrix from the machine's frame at a pinion to that of its mesh.

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
    return RigidMotion(motion.matrix, motion.shift + np.array([errors.offset, 0.0, errors.axial_shift]))


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
