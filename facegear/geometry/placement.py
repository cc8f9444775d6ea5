"""Where the pinion stands against the gear: rotations, tooth numbers and assembly errors."""

from dataclasses import replace
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.geometry.design import PairDesign

Array = NDArray[np.float64]


def conjugate_angle(design: PairDesign, phi1: ArrayLike) -> Array:
    """Gear angle (rad) of the exact ratio."""
    return np.asarray(phi1, float) * design.pinion.teeth / design.face_gear.teeth


def to_left_flank(
    design: PairDesign, vectors: Array, phi1: Array, phi2: Array, tooth: Array, directions: bool
) -> Array:
    """Points or directions of pinion tooth 0's body frame seen from the gear's tooth `tooth`.

    vectors: (n, 3), the same for all placements, or (p, n, 3).

    phi1, phi2 (rad) and tooth have shape (p,); the pinion's tooth is the one of the same number. The
    result (p, n, 3) is in the gear's body frame with that tooth as reference, mirrored x -> -x so that the
    gear's left flank appears as the right flank of `face_gear`.
    """
    turn = phi1 + (tooth - 0.5) * 2 * pi / design.pinion.teeth
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    x, z = c * x - s * z, s * x + c * z
    errors = design.assembly
    tilt_c, tilt_s = np.cos(errors.shaft_angle_error), np.sin(errors.shaft_angle_error)
    pivot = 0.0 if directions else design.mean_radius
    y, z = pivot + (y - pivot) * tilt_c - z * tilt_s, (y - pivot) * tilt_s + z * tilt_c
    if not directions:
        x, z = x + errors.offset, z + errors.axial_shift
    turn = phi2 + tooth * 2 * pi / design.face_gear.teeth
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    return np.stack([-(c * x - s * y), s * x + c * y, z], axis=-1)


def mirrored(design: PairDesign) -> PairDesign:
    """The pair seen in a mirror x -> -x: its drive side is this pair's back side.

    Angles change sign; the back pair of pinion tooth j and gear tooth j - 1 becomes pair 1 - j.
    """
    return replace(design, assembly=replace(design.assembly, offset=-design.assembly.offset))


def to_pinion_section(design: PairDesign, points: Array, phi1: Array, phi2: Array, teeth: Array) -> Array:
    """Gear points (n, 3) of tooth 0's body frame in the pinion's tooth section.

    For p placements and t tooth numbers, gear tooth j against pinion tooth j: (p, t, n, 3), x, -z, y of the
    pinion tooth's body frame.
    """
    turn = (phi2[:, None] + teeth * 2 * pi / design.face_gear.teeth)[..., None]
    c, s = np.cos(turn), np.sin(turn)
    x, y, z = points[:, 0], points[:, 1], points[:, 2]
    x, y, z = c * x + s * y, c * y - s * x, np.broadcast_to(z, (*turn.shape[:2], len(points)))
    errors = design.assembly
    x, z = x - errors.offset, z - errors.axial_shift
    tilt_c, tilt_s = np.cos(errors.shaft_angle_error), np.sin(errors.shaft_angle_error)
    along = y - design.mean_radius
    y, z = design.mean_radius + along * tilt_c + z * tilt_s, z * tilt_c - along * tilt_s
    turn = (phi1[:, None] + (teeth - 0.5) * 2 * pi / design.pinion.teeth)[..., None]
    c, s = np.cos(turn), np.sin(turn)
    return np.stack([c * x + s * z, s * x - c * z, y], axis=-1)
