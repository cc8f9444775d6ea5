"""Placement of the pinion against the gear: rotations, tooth numbers and assembly errors of each flank.

The pair that each flank of each face gear is part of: its assembly errors, of a pinion displaced as the
config says, and its deviations. The errors of a design are those that the upper gear's drive flank meets. The
lower gear sees the same pinion turned half round its axis: its offset and its tilt change sign, while a shift
of a gear leads away from the pinion on either side. The back flank is the drive flank of the pair in a
mirror, whose offset changes sign; what drives, turned half round, is the pinion's right flank again.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import AnyArray, Array, Integers
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.flank_shapes import Flanks

AXIS = {"pinion": np.array([0.0, -1.0, 0.0]), "face_gear": np.array([0.0, 0.0, -1.0])}
"""Axes about which a positive turn moves the teeth in mesh towards +x, see `design`."""


def body_rotation(body: str, angle: ArrayLike) -> Array:
    """Return rotation matrices of a body about its axis, positive where its teeth in mesh move towards +x.

    Parameters
    ----------
    body : str
        `pinion` or `face_gear`.
    angle : (...) array_like
        rad.

    Returns
    -------
    (..., 3, 3) array
        Matrices, dimensionless.
    """
    return rotation(AXIS[body], angle)


def rotation(axis: Array, angle: ArrayLike) -> Array:
    """Return rotation matrices about an axis, by Rodrigues' formula.

    Every start of the workflow places gears, and SciPy's rotations take 0.3 s of CPU time to import.

    Parameters
    ----------
    axis : (3,) array
        Unit vector, dimensionless.
    angle : (...) array_like
        rad.

    Returns
    -------
    (..., 3, 3) array
        Matrices, dimensionless.
    """
    angle = np.asarray(angle, float)[..., None, None]
    still, across, along = _rotation_parts(tuple(axis.tolist()))
    return np.cos(angle) * still + np.sin(angle) * across + along


@lru_cache(maxsize=16)
def _rotation_parts(axis: tuple[float, ...]) -> tuple[Array, Array, Array]:
    """Return the matrices that cosine, sine and 1 multiply in a rotation about an axis: shared, only read."""
    along = np.outer(axis, axis)
    return np.eye(3) - along, np.cross(axis, np.eye(3)).T, along


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """Rigid motion from one frame to another: a point x becomes `matrix` x + `shift`; (..., 3, 3) and (...,
    3) in m.
    """

    matrix: Array
    shift: Array

    def points(self, points: Array) -> Array:
        """Transform points to the other frame.

        Parameters
        ----------
        points : (n, 3) array
            m; (..., n, 3) for separate points of each motion.

        Returns
        -------
        (..., n, 3) array
            m.
        """
        return self.directions(points) + self.shift[..., None, :]

    def directions(self, vectors: Array) -> Array:
        """Rotate directions to the other frame.

        Parameters
        ----------
        vectors : (n, 3) array
            Any unit; (..., n, 3) for separate vectors of each motion.

        Returns
        -------
        (..., n, 3) array
            Same unit.
        """
        return vectors @ np.swapaxes(self.matrix, -1, -2)

    def only(self, rows: AnyArray | slice) -> "RigidMotion":
        """Return some of many motions.

        Parameters
        ----------
        rows : (k,) array
            Numbers, mask or slice of the n motions.

        Returns
        -------
        RigidMotion
            Motions of these rows.
        """
        return RigidMotion(self.matrix[rows], self.shift[rows])

    def inverse(self) -> "RigidMotion":
        """Return the motion back to the first frame.

        Returns
        -------
        RigidMotion
            Inverse of each motion.
        """
        matrix = np.swapaxes(self.matrix, -1, -2)
        return RigidMotion(matrix, -np.einsum("...ij,...j->...i", matrix, self.shift))

    def then(self, matrix: Array) -> "RigidMotion":
        """Return this motion followed by a rotation or a reflection about the other frame's origin.

        Parameters
        ----------
        matrix : (..., 3, 3) array
            Orthogonal, dimensionless.

        Returns
        -------
        RigidMotion
            Combined motion.
        """
        return RigidMotion(matrix @ self.matrix, np.einsum("...ij,...j->...i", matrix, self.shift))


def pinion_angle(design: PairDesign, position: ArrayLike) -> Array:
    """Compute the pinion angle at a position of a pitch.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    position : (...) array_like
        0..1 of a pitch, in pitches; the angle is 0 in its middle.

    Returns
    -------
    (...) array
        rad.
    """
    return (np.asarray(position, float) - 0.5) * 2 * pi / design.pinion.teeth


def conjugate_angle(design: PairDesign, phi1: ArrayLike) -> Array:
    """Compute the gear angle of the exact ratio.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (...) array_like
        Pinion angle, rad.

    Returns
    -------
    (...) array
        rad.
    """
    return np.asarray(phi1, float) * design.pinion.teeth / design.face_gear.teeth


def pinion_to_gear(design: PairDesign, phi1: ArrayLike, phi2: ArrayLike, tooth: ArrayLike) -> RigidMotion:
    """Return the motion from the body frame of pinion tooth 0, placed as tooth `tooth`, to that of the gear's
    tooth 0.

    The arguments are broadcast together. Assembly errors are the design's.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (...) array_like
        Pinion angle, rad.
    phi2 : (...) array_like
        Gear angle, rad.
    tooth : (...) array_like
        Number of the pinion's and of the gear's tooth, dimensionless.

    Returns
    -------
    RigidMotion
        Motions (...).
    """
    phi1, phi2, tooth = np.broadcast_arrays(*(np.asarray(part, float) for part in (phi1, phi2, tooth)))
    errors, motion = design.assembly, design.family.motion
    tilt = rotation(np.array([1.0, 0.0, 0.0]), errors.shaft_angle_error)
    pivot = design.middle * motion.basis[1]
    shift = pivot - tilt @ pivot + errors.pinion_axial * (tilt @ motion.basis[1])
    shift += np.array([design.offset + errors.offset, 0.0, errors.gear_axial])
    spun = body_rotation("pinion", phi1 + (tooth - 0.5) * 2 * pi / design.pinion.teeth)
    pinion_rotation = tilt @ motion.basis.T @ spun
    back = body_rotation("face_gear", -(phi2 + tooth * 2 * pi / design.face_gear.teeth))
    return RigidMotion(pinion_rotation, np.broadcast_to(shift, (*phi1.shape, 3))).then(back)


def to_left_flank(design: PairDesign, phi1: ArrayLike, phi2: ArrayLike, tooth: ArrayLike) -> RigidMotion:
    """Return `pinion_to_gear`, mirrored x -> -x: the gear's left flank appears as the right one of
    `face_gear`.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (...) array_like
        Pinion angle, rad.
    phi2 : (...) array_like
        Gear angle, rad.
    tooth : (...) array_like
        Number of both teeth, dimensionless.

    Returns
    -------
    RigidMotion
        Motions (...).
    """
    return pinion_to_gear(design, phi1, phi2, tooth).then(np.diag([-1.0, 1.0, 1.0]))


def mirror_design(design: PairDesign) -> PairDesign:
    """Return the pair seen in a mirror x -> -x: its drive side is this pair's back side.

    Angles change sign; the back pair of pinion tooth j and gear tooth j - 1 becomes pair 1 - j.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    PairDesign
        Mirrored pair.
    """
    errors = replace(design.assembly, offset=-design.assembly.offset)
    return replace(mirror_teeth(design), assembly=errors)


def mirror_teeth(design: PairDesign) -> PairDesign:
    """Return the teeth seen in a mirror x -> -x, with the errors of assembly unchanged.

    Hand and offset change sign, and the flanks with their pressure angles change places; shaft angle, taper
    and profile shift stay.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    PairDesign
        Pair whose drive flanks are this pair's coast flanks in the mirror.
    """
    swapped = design.with_swapped_flanks
    if design.is_symmetric:
        return swapped
    drive, coast = design.pressure_angles
    coast_angle = None if drive == coast else drive
    return replace(
        swapped,
        pressure_angle=coast,
        coast_pressure_angle=coast_angle,
        helix_angle=-design.helix_angle,
        offset=-design.offset,
    )


def to_pinion_section(design: PairDesign, phi1: Array, phi2: Array, teeth: Array) -> RigidMotion:
    """Return the motion from the body frame of gear tooth 0 to the pinion's tooth section: x, -z, y of its
    body frame.

    Gear tooth j is placed against pinion tooth j.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : (p,) array
        Pinion angle, rad.
    phi2 : (p,) array
        Gear angle, rad.
    teeth : (t,) array
        Tooth numbers, dimensionless; (p, 1) for one number in each placement.

    Returns
    -------
    RigidMotion
        Motions (p, t).
    """
    section = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    motion = pinion_to_gear(design, phi1[:, None], phi2[:, None], teeth)
    return motion.inverse().then(section)


GEARS = ("upper", "lower")
"""Face gears of a machine."""
FLANKS = ("drive", "back")
"""Flanks of a mesh."""


def errors_at(errors: AssemblyErrors, gear: str, flank: str) -> AssemblyErrors:
    """Return the errors that one flank of a gear meets, in the signs of an upper gear's drive flank.

    Parameters
    ----------
    errors : AssemblyErrors
        Errors at the upper gear's drive flank.
    gear : str
        `upper` or `lower`.
    flank : str
        `drive` or `back`.

    Returns
    -------
    AssemblyErrors
        Errors of the flank.
    """
    side = 1.0 if gear == "upper" else -1.0
    mirror = 1.0 if flank == "drive" else -1.0
    return replace(
        errors,
        offset=side * mirror * errors.offset,
        shaft_angle_error=side * errors.shaft_angle_error,
    )


def pair_at(design: PairDesign, gear: str, flank: str) -> PairDesign:
    """Return the pair whose drive flank is a flank of the upper or lower gear.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gear : str
        `upper` or `lower`.
    flank : str
        `drive` or `back`.

    Returns
    -------
    PairDesign
        The pair with errors by `errors_at`, mirrored for a back flank. The lower gear has the opposite offset
        and the supplementary shaft angle.
    """
    faced = design
    if gear == "lower" and not (design.offset == 0.0 and design.shaft_angle == pi / 2):
        faced = replace(design, shaft_angle=pi - design.shaft_angle, offset=-design.offset)
    drive_design = faced if flank == "drive" else mirror_teeth(faced)
    return replace(drive_design, assembly=errors_at(design.assembly, gear, flank))


def distinct_pairs(design: PairDesign, gears: Sequence[str] = GEARS) -> tuple[list[PairDesign], Integers]:
    """Return the pairs of both gears' both flanks without repetitions, so that each is computed once.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gears : Sequence[str]
        Gears that there are, of `upper` and `lower`; a missing one has the pairs of the other.

    Returns
    -------
    tuple
        The pairs, those of the first gear first, and the index of each flank's pair in them, (2, 2) by GEARS
        and FLANKS.
    """
    present = [gear if gear in gears else gears[0] for gear in GEARS]
    pairs = [pair_at(design, gear, flank) for gear in present for flank in FLANKS]
    different = list(dict.fromkeys(pairs))
    return different, np.array([different.index(pair) for pair in pairs]).reshape(len(GEARS), len(FLANKS))


def nominal_teeth(design: PairDesign) -> PairDesign:
    """Return the pair without what moves no node of its bodies: errors of assembly and deviations of flanks.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    PairDesign
        Pair by which bodies with the same nodes are known.
    """
    pinion, gear = design.pinion, design.face_gear
    if pinion.flanks != Flanks() or gear.flanks != Flanks():
        pinion, gear = replace(pinion, flanks=Flanks()), replace(gear, flanks=Flanks())
    return replace(design, pinion=pinion, face_gear=gear, assembly=AssemblyErrors())


def nominal_pairs(design: PairDesign, gears: Sequence[str] = GEARS) -> list[PairDesign]:
    """Return the different pairs of bodies that both gears' both flanks need, the design's own first.

    Teeth that are symmetric and meet two equal gears need one; the coast flanks of others are the drive
    flanks of another pair, and so are those of a lower gear that differs from the upper one.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gears : Sequence[str]
        Gears that there are, of `upper` and `lower`.

    Returns
    -------
    list[PairDesign]
        Pairs by `nominal_teeth`, in the order in which `distinct_pairs` needs them.
    """
    return list(dict.fromkeys(nominal_teeth(pair) for pair in distinct_pairs(design, gears)[0]))
