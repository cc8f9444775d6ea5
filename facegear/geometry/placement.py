"""Where the pinion stands against the gear: rotations, tooth numbers and assembly errors."""

from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import AnyArray, Array
from facegear.geometry.design import PairDesign

AXIS = {"pinion": np.array([0.0, -1.0, 0.0]), "face_gear": np.array([0.0, 0.0, -1.0])}
"""Axes about which a positive turn moves the teeth in mesh towards +x, see `design`."""


def body_rotation(body: str, angle: ArrayLike) -> Array:
    """Matrices (..., 3, 3) of turns of the pinion or the face gear by `angle` (rad)."""
    return rotation(AXIS[body], angle)


def rotation(axis: Array, angle: ArrayLike) -> Array:
    """Matrices (..., 3, 3) of turns by `angle` (rad) about a unit vector, by Rodrigues' formula.

    Every start of the workflow places gears, and SciPy's rotations take 0.3 s of CPU time to import.
    """
    angle = np.asarray(angle, float)[..., None, None]
    still, across, along = _turned(tuple(axis.tolist()))
    return np.cos(angle) * still + np.sin(angle) * across + along


@lru_cache(maxsize=16)
def _turned(axis: tuple[float, ...]) -> tuple[Array, Array, Array]:
    """What cosine, sine and 1 stand before in a turn about an axis: shared, only read."""
    along = np.outer(axis, axis)
    return np.eye(3) - along, np.cross(axis, np.eye(3)).T, along


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """From one frame to another: a point x becomes `matrix` x + `shift`; (..., 3, 3) and (..., 3) in m."""

    matrix: Array
    shift: Array

    def points(self, points: Array) -> Array:
        """Points (n, 3), or (..., n, 3) for each motion its own, in the other frame: (..., n, 3)."""
        return self.directions(points) + self.shift[..., None, :]

    def directions(self, vectors: Array) -> Array:
        """The same for directions, which are turned only."""
        return vectors @ np.swapaxes(self.matrix, -1, -2)

    def only(self, rows: AnyArray | slice) -> "RigidMotion":
        """Some of many motions (n,)."""
        return RigidMotion(self.matrix[rows], self.shift[rows])

    def inverse(self) -> "RigidMotion":
        matrix = np.swapaxes(self.matrix, -1, -2)
        return RigidMotion(matrix, -np.einsum("...ij,...j->...i", matrix, self.shift))

    def then(self, matrix: Array) -> "RigidMotion":
        """This motion followed by a turn or a mirror about the other frame's origin."""
        return RigidMotion(matrix @ self.matrix, np.einsum("...ij,...j->...i", matrix, self.shift))


def pinion_angle(design: PairDesign, position: ArrayLike) -> Array:
    """Pinion angle (rad) at a position 0..1 of a pitch, 0 in its middle."""
    return (np.asarray(position, float) - 0.5) * 2 * pi / design.pinion.teeth


def conjugate_angle(design: PairDesign, phi1: ArrayLike) -> Array:
    """Gear angle (rad) of the exact ratio."""
    return np.asarray(phi1, float) * design.pinion.teeth / design.face_gear.teeth


def pinion_to_gear(design: PairDesign, phi1: ArrayLike, phi2: ArrayLike, tooth: ArrayLike) -> RigidMotion:
    """From the body frame of pinion tooth 0, standing as tooth `tooth`, to that of the gear's tooth 0.

    phi1, phi2 (rad) and the number of both teeth, broadcast together. Assembly errors are the design's.
    """
    phi1, phi2, tooth = np.broadcast_arrays(*(np.asarray(part, float) for part in (phi1, phi2, tooth)))
    errors = design.assembly
    tilt = rotation(np.array([1.0, 0.0, 0.0]), errors.shaft_angle_error)
    pivot = np.array([0.0, design.mean_radius, 0.0])
    moved = pivot - tilt @ pivot + np.array([errors.offset, 0.0, errors.axial_shift])
    turned = tilt @ body_rotation("pinion", phi1 + (tooth - 0.5) * 2 * pi / design.pinion.teeth)
    back = body_rotation("face_gear", -(phi2 + tooth * 2 * pi / design.face_gear.teeth))
    return RigidMotion(turned, np.broadcast_to(moved, (*phi1.shape, 3))).then(back)


def to_left_flank(design: PairDesign, phi1: ArrayLike, phi2: ArrayLike, tooth: ArrayLike) -> RigidMotion:
    """`pinion_to_gear`, mirrored x -> -x: the gear's left flank appears as the right one of `face_gear`."""
    return pinion_to_gear(design, phi1, phi2, tooth).then(np.diag([-1.0, 1.0, 1.0]))


def mirrored(design: PairDesign) -> PairDesign:
    """The pair seen in a mirror x -> -x: its drive side is this pair's back side.

    Angles change sign; the back pair of pinion tooth j and gear tooth j - 1 becomes pair 1 - j.
    """
    return replace(design.exchanged, assembly=replace(design.assembly, offset=-design.assembly.offset))


def to_pinion_section(design: PairDesign, phi1: Array, phi2: Array, teeth: Array) -> RigidMotion:
    """From the body frame of gear tooth 0 to the pinion's tooth section: x, -z, y of its body frame.

    For p placements and t tooth numbers, gear tooth j against pinion tooth j: motions (p, t).
    """
    section = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    motion = pinion_to_gear(design, phi1[:, None], phi2[:, None], teeth)
    return motion.inverse().then(section)
