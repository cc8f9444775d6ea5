"""Sliding and rolling velocities of the flanks, in the mesh frame of `facegear.teeth.design`.

The flanks' velocities are those of the unloaded angles; load moves a contact line by some 0.01 mm.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.contact.lines import ContactLines
from facegear.teeth.design import PairDesign
from facegear.teeth.helicoid import pinion_fillet, pinion_start
from facegear.teeth.placement import AXIS, RigidMotion, pinion_angle, pinion_to_gear
from facegear.teeth.surfaces import flank_points
from facegear.teeth.tooth_family import stack_vectors

HALVINGS = 40
"""Bisections of the slope of the root's normal, which leave 1e-12 rad of it."""


@dataclass(frozen=True, eq=False)
class Spin:
    """Rotation of a body about the unit vector `axis` (3,) through a point (3,) m at `speed` rad/s."""

    axis: Array
    through: Array
    speed: float

    def velocity(self, points: Array) -> Array:
        """Compute the velocity of points of the body.

        Parameters
        ----------
        points : (..., 3) array
            Points, m.

        Returns
        -------
        (..., 3) array
            Velocities, m/s.
        """
        return self.speed * np.cross(self.axis, points - self.through)

    def torque(self, points: Array, forces: Array) -> float:
        """Compute the total moment of forces about the axis, positive in the sense of rotation about
        `axis`.

        Parameters
        ----------
        points : (n, 3) array
            Points where the forces act, m.
        forces : (n, 3) array
            Forces at the points, N.

        Returns
        -------
        float
            Sum of the moments, N m.
        """
        return float((np.cross(points - self.through, forces) @ self.axis).sum())


def slip(first: Spin, second: Spin, points: Array, normals: Array) -> tuple[Array, Array]:
    """Compute the velocity of the first body relative to the second, split into sliding and normal parts.

    Parameters
    ----------
    first : Spin
        Rotation of the first body.
    second : Spin
        Rotation of the second body.
    points : (..., 3) array
        Contact points, m.
    normals : (..., 3) array
        Common unit normals at the points, dimensionless.

    Returns
    -------
    (..., 3) array and (...) array
        Sliding velocity in the tangent plane, m/s, and velocity along the normal, m/s, which is not 0
        only where the teeth open or close.
    """
    relative = first.velocity(points) - second.velocity(points)
    along = np.einsum("...i,...i->...", relative, normals)
    return relative - along[..., None] * normals, along


def spins(design: PairDesign, speed: float = 1.0) -> tuple[Spin, Spin]:
    """Return the rotations of pinion and face gear about their axes in the mesh frame.

    The gear turns at the exact tooth ratio. The pinion's axis stands with its assembly errors; the gear's
    is the z axis through the origin.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    speed : float
        Pinion speed, rad/s.

    Returns
    -------
    tuple[Spin, Spin]
        Rotations of pinion and face gear.
    """
    stands = pinion_pose(design, 0.5 * 2 * pi / design.pinion.teeth, 0)
    ratio = design.pinion.teeth / design.face_gear.teeth
    return (
        Spin(stands.directions(AXIS["pinion"]), stands.shift, speed),
        Spin(AXIS["face_gear"], np.zeros(3), ratio * speed),
    )


def pinion_pose(design: PairDesign, phi1: ArrayLike, tooth: ArrayLike) -> RigidMotion:
    """Return the rigid motion from the pinion's body frame to the mesh frame, for one of its teeth.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    phi1 : ArrayLike
        Pinion angle, rad.
    tooth : ArrayLike
        Number of the tooth pair, broadcast with `phi1`: the pinion is turned on by so many pitches, so that
        tooth 0 of the body frame stands where this pair's tooth is.

    Returns
    -------
    RigidMotion
        Rotation matrices and shifts in m, in the shape of angles and teeth.
    """
    rotation = np.asarray(phi1, float) + np.asarray(tooth, float) * 2 * pi / design.pinion.teeth
    return pinion_to_gear(design, rotation, np.zeros_like(rotation), np.zeros_like(rotation))


def surface_normals(design: PairDesign, points: Array) -> Array:
    """Compute the outward unit normals at points of the pinion's right flank or its fillet.

    In its section across the axis a point of the flank lies on a tangent of the base circle, and so it does
    where a relief moved it along that tangent; the normal leans from the tangent by the base helix. Below
    the end of the involute it is the normal of the root at the same radius and place.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    points : (n, 3) array
        Points in the pinion's body frame, y along its axis, m.

    Returns
    -------
    (n, 3) array
        Unit normals in the body frame, dimensionless.
    """
    x, y, z = np.moveaxis(points, -1, 0)
    flank, radius = design.family.pinion_flanks[0], np.hypot(x, z)
    roll = np.sqrt(np.maximum((radius / flank.base_radius) ** 2 - 1.0, 0.0))
    tangent = np.arctan2(x, -z) - np.arctan(roll)
    normals = stack_vectors(flank.cosine * np.cos(tangent), flank.sine, flank.cosine * np.sin(tangent))
    start = np.hypot(flank.base_radius, np.maximum(pinion_start(design.family, 1, y), 0.0))
    below = radius < start * (1 - 1e-12)
    if below.any():
        root, at = pinion_fillet(design.family, 1), y[below]
        low, high = np.full(at.shape, flank.pressure_angle), np.full(at.shape, 0.5 * pi)
        for _ in range(HALVINGS):
            gamma = 0.5 * (low + high)
            root_point = root.point(gamma, at)
            is_above = np.hypot(root_point[..., 0], root_point[..., 2]) > radius[below]
            low, high = np.where(is_above, gamma, low), np.where(is_above, high, gamma)
        normals[below] = root.normal(0.5 * (low + high), at)
    return normals


@dataclass(frozen=True, eq=False)
class LineKinematics:
    """Velocities at the points of contact lines for a pinion that turns by 1 rad/s: all (p, n), in m.

    `sliding` the magnitude of the sliding velocity, `across` and `along` its parts across the line and along
    it (pinion over gear). `u1` and `u2` the rolling velocities of pinion and gear across the line,
    `line_entrainment` half the sum of both along the line, relative to a point of the line in a plane that
    stands. nan where the line's slope is not known.
    """

    sliding: Array
    across: Array
    along: Array
    u1: Array
    u2: Array
    line_entrainment: Array


def line_kinematics(design: PairDesign, lines: ContactLines, position: Array, tooth: Array) -> LineKinematics:
    """Compute sliding and rolling velocities at the points of contact lines.

    On the pinion's flank t points across the profile towards its axis and e along its generator. The line
    is l = cos(slope) e + sin(slope) t, and across it stands p = cos(slope) t - sin(slope) e. Sliding is
    that of the pinion over the gear. Seen from the contact, which runs along the common normal, the pinion
    moves by s t - eta r_b e, s its transverse length of roll and eta the sine of its base helix.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    lines : ContactLines
        Contact lines (p, n): p placements of tooth pairs, n planes across the pinion's axis.
    position : (p,) array
        Position of each line, in pitches.
    tooth : (p,) array
        Number of the tooth pair of each line.

    Returns
    -------
    LineKinematics
        Velocities (p, n) for a pinion at 1 rad/s, in m (m/s per rad/s); nan where the line's slope is.
    """
    surface = flank_points(design, lines.roll, lines.y)
    stands = pinion_pose(design, pinion_angle(design, position), tooth)
    points, normals = stands.points(surface.position), stands.directions(surface.normal)
    sliding, _ = slip(*spins(design), points, normals)
    flank = design.family.pinion_flanks[0]
    nx, nz = surface.normal[..., 0] / flank.cosine, surface.normal[..., 2] / flank.cosine
    profile = stands.directions(np.stack([-nz, np.zeros_like(nx), nx], axis=-1))
    lean = np.stack([-flank.sine * nx, np.full_like(nx, flank.cosine), -flank.sine * nz], axis=-1)
    generator = stands.directions(lean)
    down, beside = (np.einsum("...i,...i->...", sliding, way) for way in (profile, generator))
    cosine, sine = np.cos(lines.slope), np.sin(lines.slope)
    across, along = cosine * down - sine * beside, sine * down + cosine * beside
    u1 = design.pinion_base_radius * (lines.roll * cosine + flank.sine * sine)
    return LineKinematics(
        sliding=np.hypot(down, beside),
        across=across,
        along=along,
        u1=u1,
        u2=u1 - across,
        line_entrainment=u1 * sine / cosine - 0.5 * along,
    )
