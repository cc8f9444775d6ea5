"""Points and normals of flanks in space: the pinion's surface, and nominal points for measuring machines."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array, Integers
from facegear.quantities import Body
from facegear.teeth import face_gear, pinion
from facegear.teeth.design import PairDesign
from facegear.teeth.helicoid import pinion_fillet
from facegear.teeth.modifications import depth_below_tip, flank_end
from facegear.teeth.placement import mirror_teeth


@dataclass(frozen=True)
class SurfacePoints:
    """Points of the right side of pinion tooth 0 in the body frame: position (..., 3) in m, unit normal."""

    position: Array
    normal: Array

    def flat(self) -> "SurfacePoints":
        """Return the points and normals as (n, 3) arrays.

        Returns
        -------
        SurfacePoints
            All points in one row.
        """
        return SurfacePoints(self.position.reshape(-1, 3), self.normal.reshape(-1, 3))

    def only(self, index: Integers | slice) -> "SurfacePoints":
        """Return the points, with normals, at some indices.

        Parameters
        ----------
        index : (k,) array
            Numbers or slice along the first axis.

        Returns
        -------
        SurfacePoints
            Chosen points.
        """
        return SurfacePoints(self.position[index], self.normal[index])

    @property
    def lever_arm(self) -> Array:
        """Lever arm (...), m, of the normals about the pinion's axis: way along the normal per positive
        rotation, `PairDesign.normal_arm` on the drive flank.
        """
        x, z = self.position[..., 0], self.position[..., 2]
        return x * self.normal[..., 2] - z * self.normal[..., 0]


def flank_points(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Compute points of the right flank as made, modifications included; roll and y are broadcast together.

    Modifications move points along the unmodified normal; the normal's own change (1e-3 rad) is left out.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Roll angle, rad.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    SurfacePoints
        Points (..., 3), m.
    """
    flank = pinion.pinion_flank(design)
    length = design.pinion_base_radius * np.asarray(roll, float)
    normal = flank.normal(length, y)
    depth = pinion.removed_depth(design, roll, y)
    return SurfacePoints(flank.point(length, y) - depth[..., None] * normal, normal)


def fillet_points(design: PairDesign, gamma: ArrayLike, y: ArrayLike) -> SurfacePoints:
    """Compute points of the right root fillet as made: the trochoid less what is taken off at the flank's
    end.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gamma : (...) array_like
        Slope of the normal, rad, see `pinion.trochoid_point`.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    SurfacePoints
        Points (..., 3), m.
    """
    root = pinion_fillet(design.family, 1)
    normal = root.normal(gamma, y)
    depth = pinion.removed_depth(design, pinion.junction_roll(design, y), y)
    return SurfacePoints(root.point(gamma, y) - depth[..., None] * normal, normal)


@dataclass(frozen=True)
class Face:
    """The drive flank of a body in the coordinates of `DeviationGrid`: its ends (m) along face and profile.

    `middle`: the place at the middle of the face and on the pitch cylinder or datum surface, where pitch and
    thickness are measured.
    """

    design: PairDesign
    body: Body
    face: tuple[float, float]
    profile: tuple[float, float]
    middle: tuple[float, float]


def flank_face(design: PairDesign, body: Body) -> Face:
    """Return the extent of a body's drive flank; it counts as high and deep everywhere as at either end.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    body : Body
        `pinion` or `face_gear`.

    Returns
    -------
    Face
        Ends and middle, m.
    """
    if body == "pinion":
        base, half = design.pinion_base_radius, design.pinion.width / 2
        y = design.middle + np.array([-half, half])
        ends = (
            base * float(pinion.junction_roll(design, y).min()),
            base * float(pinion.tip_roll(design, y).max()),
        )
        middle = 0.0, base * float(np.tan(design.transverse_pressure_angle))
        return Face(design, body, (-half, half), ends, middle)
    gear = design.face_gear
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 33)
    deepest = float(depth_below_tip(design, flank_end(design, radius)).max())
    ends = gear.inner_radius, gear.outer_radius
    middle = design.mean_radius, face_gear.pitch_depth(design)
    return Face(design, body, ends, (0.0, deepest), middle)


def nominal_points(face: Face, side: str, along: Array, across: Array) -> tuple[Array, Array]:
    """Compute nominal points and outward unit normals of a flank of tooth 0 in its body frame.

    Modifications and deviations are left out.

    Parameters
    ----------
    face : Face
        Flank of a body.
    side : str
        `right` or `left`.
    along : (n,) array
        Distances along the face, m, as in `DeviationGrid`.
    across : (m,) array
        Distances along the profile, m.

    Returns
    -------
    tuple of (n, m, 3) arrays
        Points, m, and normals out of the tooth, in the order of `along` and `across`.

    Raises
    ------
    NotConverged
        Beside the gear's flank.
    """
    # functions of a design describe the pinion's right flank, and the gear's left one in a mirror
    is_described = (side == "right") is (face.body == "pinion")
    design = face.design if is_described else mirror_teeth(face.design)
    if face.body == "pinion":
        flank, y = pinion.pinion_flank(design), design.middle + along[:, None]
        roll = np.broadcast_to(across, (along.size, across.size))
        points, normals = flank.point(roll, y), flank.normal(roll, y)
    else:
        radius = along[:, None]
        height = face_gear.tip_height(design, radius) - across
        coordinates = face_gear.roll_and_psi_at_height(design, radius, height)
        points, normals = (
            face_gear.flank_point(design, *coordinates),
            face_gear.flank_normal(design, *coordinates),
        )
    if side == "left":
        points, normals = (part * np.array([-1.0, 1.0, 1.0]) for part in (points, normals))
    return points, normals
