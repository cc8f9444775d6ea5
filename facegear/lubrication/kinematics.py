"""Sliding and rolling velocities of the flanks, in the mesh frame of `facegear.teeth.design`.

The flanks' velocities are those of the unloaded angles; load moves a contact line by some 0.01 mm.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.contact.lines import ContactLines
from facegear.teeth import pinion
from facegear.teeth.design import PairDesign
from facegear.teeth.placement import AXIS, RigidMotion, pinion_angle, pinion_to_gear
from facegear.teeth.surfaces import flank_points

FILLET_SAMPLES = 4001
"""Number of points of the fillet between which its normal is interpolated."""


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

    A point of the involute lies on a tangent of the base circle, and so it does where a relief moved it
    along that tangent; the normal is the tangent. Below the end of the involute it is the normal of the
    trochoid at the same radius, interpolated between FILLET_SAMPLES points.

    Parameters
    ----------
    design : PairDesign
        Geometry of the pair.
    points : (n, 3) array
        Points in the pinion's body frame, y along its axis, m.

    Returns
    -------
    (n, 3) array
        Unit normals in the body frame, without a y component, dimensionless.
    """
    x, z = points[..., 0], points[..., 2]
    radius, angle = np.hypot(x, z), np.arctan2(x, -z)
    roll = np.sqrt(np.maximum((radius / design.pinion_base_radius) ** 2 - 1.0, 0.0))
    tangent = angle - np.arctan(roll)
    nx, nz = np.cos(tangent), np.sin(tangent)
    end, _ = pinion.involute_point(
        design, max(float(pinion.junction_roll(design, design.middle)), 0.0), design.middle
    )
    below = radius < end * (1 - 1e-12)
    if below.any():
        gamma = np.linspace(design.pressure_angle, 0.5 * pi, FILLET_SAMPLES)
        radii, _ = pinion.trochoid_point(design, gamma, design.middle)
        angles = np.interp(radius[below], radii[::-1], gamma[::-1])
        nx[below], _, nz[below] = pinion.trochoid_normal(design, angles, design.middle).T
    return np.stack([nx, np.zeros_like(nx), nz], axis=-1)


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

    On the pinion's flank t points across the profile towards its axis and e along that axis. The line is
    l = cos(slope) e + sin(slope) t, and across it stands p = cos(slope) t - sin(slope) e. Sliding is that
    of the pinion over the gear.

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
    nx, nz = surface.normal[..., 0], surface.normal[..., 2]
    profile = stands.directions(np.stack([-nz, np.zeros_like(nx), nx], axis=-1))
    axial = stands.directions(np.broadcast_to([0.0, 1.0, 0.0], surface.normal.shape))
    down, beside = (np.einsum("...i,...i->...", sliding, way) for way in (profile, axial))
    cosine, sine = np.cos(lines.slope), np.sin(lines.slope)
    across, along = cosine * down - sine * beside, sine * down + cosine * beside
    rho = design.pinion_base_radius * lines.roll
    u1 = rho * cosine
    return LineKinematics(
        sliding=np.hypot(down, beside),
        across=across,
        along=along,
        u1=u1,
        u2=u1 - across,
        line_entrainment=rho * sine - 0.5 * along,
    )
