"""Nominal points and normals of a flank at places along its face and profile, for measuring machines."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Array
from facegear.geometry import face_gear, pinion
from facegear.geometry.bodies import Body
from facegear.geometry.design import PairDesign
from facegear.geometry.gear_modifications import flank_end


@dataclass(frozen=True)
class Face:
    """The flank of a body in the coordinates of `DeviationGrid`: its ends (m) along the face and the profile.

    `middle`: the place at the middle of the face and on the pitch circle or pitch plane, where pitch and
    thickness are measured.
    """

    design: PairDesign
    body: Body
    face: tuple[float, float]
    profile: tuple[float, float]
    middle: tuple[float, float]


def flank_face(design: PairDesign, body: Body) -> Face:
    """The flank of `pinion` or `face_gear`; that of the gear is as deep as at its deepest end."""
    if body == "pinion":
        base, half = design.pinion_base_radius, design.pinion.width / 2
        ends = base * pinion.junction_roll(design), base * design.pinion_tip_roll
        return Face(design, body, (-half, half), ends, (0.0, base * float(np.tan(design.pressure_angle))))
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 33)
    deepest = float(design.gear_tip_plane - flank_end(design, radius)[:, 2].min())
    ends = gear.inner_radius, gear.outer_radius
    return Face(design, body, ends, (0.0, deepest), (design.mean_radius, gear.addendum))


def nominal_points(face: Face, side: str, along: Array, across: Array) -> tuple[Array, Array]:
    """Points (n, m, 3) in m and outward unit normals of the right or left flank of tooth 0 in its body frame.

    along (n,): places along the face, across (m,): along the profile, both in m as in `DeviationGrid`.
    Modifications and deviations are left out. Raises NotConverged beside the gear's flank.
    """
    design = face.design
    if face.body == "pinion":
        roll = np.broadcast_to(across / design.pinion_base_radius, (along.size, across.size))
        points = pinion.cartesian(*pinion.involute_point(design, roll), design.mean_radius + along[:, None])
        nx, nz = pinion.involute_normal(design, roll)
        normals = np.stack([nx, np.zeros_like(nx), nz], axis=-1)
    else:
        places = face_gear.roll_and_psi_at_height(design, along[:, None], design.gear_tip_plane - across)
        points, normals = face_gear.flank_point(design, *places), face_gear.flank_normal(design, *places)
    if side == "left":
        points, normals = (part * np.array([-1.0, 1.0, 1.0]) for part in (points, normals))
    return points, normals
