"""The pinion's tooth section by section: involute, tip, the root cut by a rack with a rounded tip, reliefs.

Everything is for the right flank of tooth 0 in the pinion body frame (see `design`), in the section at a
place y along the axis: polar angle a from the half plane of the tooth's middle, so x = r sin a, z = -r cos a.
The left flank is the right one of `placement.mirror_teeth`, seen in a mirror a -> -a. Sections of spur teeth
are alike; a helix turns them, a taper changes them. The roll angle is the transverse length of roll over the
base radius. Involute and root are sections of the surfaces of `helicoid`.
"""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_shapes import linear, parabola
from facegear.teeth.helicoid import PinionFlank, pinion_fillet, pinion_start
from facegear.teeth.modifications import deviation


def involute_point(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Compute points of the right flank's involute in polar coordinates of the section.

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
    tuple of (...) arrays
        Radius, m, and polar angle, rad.
    """
    return _polar(pinion_flank(design).point(design.pinion_base_radius * np.asarray(roll, float), y))


def involute_normal(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> Array:
    """Compute unit normals of the right flank, out of the tooth, in the pinion's body frame.

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
    (..., 3) array
        Unit vectors, dimensionless.
    """
    return pinion_flank(design).normal(design.pinion_base_radius * np.asarray(roll, float), y)


def junction_roll(design: PairDesign, y: ArrayLike) -> Array:
    """Compute the roll angle where involute and root fillet meet.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    (...) array
        rad; negative when the rack undercuts the pinion. Only one number where teeth have no taper.
    """
    y = design.middle if design.taper_angle == 0.0 else y
    return np.asarray(pinion_start(design.family, 1, y)) / design.pinion_base_radius


def tip_radius(design: PairDesign, y: ArrayLike) -> Array:
    """Compute the radius of the pinion's tip, chamfer not taken off.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    (...) array
        m.
    """
    return design.pinion_tip_radius + (np.asarray(y, float) - design.middle) * design.family.taper


def root_radius(design: PairDesign, y: ArrayLike) -> Array:
    """Compute the radius of the pinion's root land.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    (...) array
        m.
    """
    return design.pinion_root_radius + (np.asarray(y, float) - design.middle) * design.family.taper


def tip_roll(design: PairDesign, y: ArrayLike) -> Array:
    """Compute the roll angle where the involute ends: at the tip or at the chamfer.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    (...) array
        rad. Only one number where teeth have no taper.
    """
    if design.taper_angle == 0.0:
        return np.asarray(design.pinion_tip_roll)
    ratio = (tip_radius(design, y) - design.pinion.tip_chamfer) / design.pinion_base_radius
    return np.sqrt(np.maximum(ratio**2 - 1, 0.0))


def roll_ends(design: PairDesign, y: ArrayLike) -> tuple[Array, Array]:
    """Compute the roll angles where the involute begins and ends, see `junction_roll` and `tip_roll`.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    tuple of (...) arrays
        Smallest and largest roll angle, rad.
    """
    shape = np.shape(y)
    return np.broadcast_to(junction_roll(design, y), shape), np.broadcast_to(tip_roll(design, y), shape)


def trochoid_point(design: PairDesign, gamma: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Compute points of the root fillet of the right side in polar coordinates of the section.

    gamma runs from the transverse pressure angle (the junction with the involute) to pi/2 (the root land).

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gamma : (...) array_like
        Slope of the normal to the rack's pitch line in the transverse projection, rad.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    tuple of (...) arrays
        Radius, m, and polar angle, rad.
    """
    return _polar(pinion_fillet(design.family, 1).point(gamma, y))


def trochoid_normal(design: PairDesign, gamma: ArrayLike, y: ArrayLike) -> Array:
    """Compute unit normals of the right side's root fillet, out of the material, in the pinion's body frame.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gamma : (...) array_like
        Slope of the normal to the rack's pitch line in the transverse projection, rad.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    (..., 3) array
        Unit vectors, dimensionless.
    """
    return pinion_fillet(design.family, 1).normal(gamma, y)


def pinion_flank(design: PairDesign) -> PinionFlank:
    """Return the pinion's right (drive) flank as a surface with parameters length of roll and y.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    PinionFlank
        The flank, without modifications.
    """
    return PinionFlank(design.family.pinion_flanks[0])


def _polar(points: Array) -> tuple[Array, Array]:
    """Return radius (m) and polar angle (rad) from the tooth's middle of body-frame points (..., 3)."""
    return np.hypot(points[..., 0], points[..., 2]), np.arctan2(points[..., 0], -points[..., 2])


def tip_half_angle(design: PairDesign, y: ArrayLike) -> Array:
    """Compute the polar angle at which the tip land ends on the right side, chamfer taken off.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    (...) array
        rad; a tooth is pointed where the angles of the design and of `placement.mirror_teeth` add up to less
        than 0.
    """
    _, angle = involute_point(design, tip_roll(design, y), y)
    return angle - design.pinion.tip_chamfer / tip_radius(design, y)


def root_half_angle(design: PairDesign) -> float:
    """Compute half the angle of the root land about the axis, the same in every section.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        rad; negative when the rack's tip circles overlap.
    """
    lateral = [pinion_fillet(design.family, side).lateral for side in (1, -1)]
    return sum(lateral) / 2 / design.pinion_pitch_radius


def root_angle(design: PairDesign, y: ArrayLike) -> Array:
    """Compute the polar angle of the middle of the root land on the right side of the tooth.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    (...) array
        rad; pi / N1 of symmetric teeth.
    """
    if design.is_symmetric:
        return np.full(np.shape(y), np.pi / design.pinion.teeth)
    return trochoid_point(design, np.pi / 2, y)[1] + root_half_angle(design)


def cartesian(radius: ArrayLike, angle: ArrayLike, y: ArrayLike) -> Array:
    """Convert polar coordinates to points of the pinion body frame.

    Parameters
    ----------
    radius : (...) array_like
        m.
    angle : (...) array_like
        rad.
    y : (...) array_like
        Axial position, m.

    Returns
    -------
    (..., 3) array
        m.
    """
    radius = np.asarray(radius)
    points = np.broadcast_arrays(radius * np.sin(angle), y, -radius * np.cos(angle))
    return np.stack(points, axis=-1)


def removed_depth(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> Array:
    """Compute the depth of material that modifications and deviations take off the right flank along the
    normal.

    Beyond the ends of the involute (in the fillet) the root relief keeps its full amount, and the
    deviation keeps its value at the end.

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
    (...) array
        m; negative where the right flank deviates towards more material.
    """
    part = design.pinion
    roll, y = np.asarray(roll, float), np.asarray(y, float)
    depth = np.zeros(np.broadcast_shapes(roll.shape, y.shape))
    reliefs = (part.tip_relief, linear), (part.root_relief, linear), (part.lead_crowning, parabola)
    if any(relief.amount != 0.0 for relief, _ in reliefs):
        for (relief, shape), distance in zip(reliefs, distances(design, roll, y), strict=True):
            if relief.amount != 0.0:
                depth += shape(relief, distance)
    if part.flanks.right is None:
        return depth
    return depth - deviation(part.flanks.right, *deviation_place(design, roll, y))


def distances(design: PairDesign, roll: Array, y: Array) -> tuple[Array, Array, Array]:
    """Compute the distances from where tip relief, root relief and lead crowning are measured.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array
        Roll angle, rad.
    y : (...) array
        Axial position, m.

    Returns
    -------
    tuple of (...) arrays
        Transverse length of roll below the tip, that above the root's junction, both in the section of y, and
        distance along the axis from the middle of the face, m.
    """
    base = design.pinion_base_radius
    return (
        base * (tip_roll(design, y) - roll),
        base * (roll - junction_roll(design, y)),
        abs(y - design.middle),
    )


def deviation_place(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Compute where a point of the flank is in the coordinates of the pinion's `DeviationGrid`.

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
    tuple of (...) arrays
        Distance along the axis from the middle of the face, and transverse length of roll within the
        involute's ends, m.
    """
    on_flank = np.clip(np.asarray(roll, float), junction_roll(design, y), tip_roll(design, y))
    return np.asarray(y, float) - design.middle, design.pinion_base_radius * on_flank
