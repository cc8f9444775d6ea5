"""The pinion's section: involute, tip chamfer, the root trochoid cut by a rack with a rounded tip, reliefs.

Everything is for the right flank of tooth 0 in the pinion body frame (see `design`): polar angle a from the
tooth's centre line, so x = r sin a, z = -r cos a. The left flank is the mirror image a -> -a.
Involute and trochoid are sections of the right flank and root of the family, see `helicoid`.
"""

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.teeth.design import PairDesign
from facegear.teeth.flank_shapes import linear, parabola
from facegear.teeth.helicoid import PinionFlank, pinion_fillet, pinion_start
from facegear.teeth.modifications import deviation


def involute_point(design: PairDesign, roll: ArrayLike) -> tuple[Array, Array]:
    """Compute points of the right flank's involute in polar coordinates of the section.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Roll angle, rad.

    Returns
    -------
    tuple of (...) arrays
        Radius, m, and polar angle, rad.
    """
    return _polar(
        _flank(design).point(design.pinion_base_radius * np.asarray(roll, float), design.mean_radius)
    )


def involute_normal(design: PairDesign, roll: ArrayLike) -> tuple[Array, Array]:
    """Compute unit normals of the right flank's involute, out of the tooth.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    roll : (...) array_like
        Roll angle, rad.

    Returns
    -------
    tuple of (...) arrays
        Components x and z, dimensionless.
    """
    length = design.pinion_base_radius * np.asarray(roll, float)
    normal = _flank(design).normal(length, design.mean_radius)
    return normal[..., 0], normal[..., 2]


def junction_roll(design: PairDesign) -> float:
    """Compute the roll angle where involute and trochoid meet.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        rad; negative when the rack undercuts the pinion.
    """
    return float(pinion_start(design.family, 1, design.mean_radius)) / design.pinion_base_radius


def trochoid_point(design: PairDesign, gamma: ArrayLike) -> tuple[Array, Array]:
    """Compute points of the root trochoid of the right side in polar coordinates of the section.

    gamma runs from the pressure angle (the junction with the involute) to pi/2 (the root circle).

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gamma : (...) array_like
        Slope of the normal to the rack's pitch line, rad.

    Returns
    -------
    tuple of (...) arrays
        Radius, m, and polar angle, rad.
    """
    return _polar(pinion_fillet(design.family, 1).point(gamma, design.mean_radius))


def trochoid_normal(design: PairDesign, gamma: ArrayLike) -> tuple[Array, Array]:
    """Compute unit normals of the root trochoid of the right side, out of the material.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    gamma : (...) array_like
        Slope of the normal to the rack's pitch line, rad.

    Returns
    -------
    tuple of (...) arrays
        Components x and z, dimensionless.
    """
    normal = pinion_fillet(design.family, 1).normal(gamma, design.mean_radius)
    return normal[..., 0], normal[..., 2]


def _flank(design: PairDesign) -> PinionFlank:
    """Return the pinion's right (drive) flank as a surface of `helicoid`."""
    return PinionFlank(design.family.pinion_flanks[0])


def _polar(points: Array) -> tuple[Array, Array]:
    """Return radius (m) and polar angle (rad) from the tooth's centre line of body-frame points (..., 3)."""
    return np.hypot(points[..., 0], points[..., 2]), np.arctan2(points[..., 0], -points[..., 2])


def tip_half_angle(design: PairDesign) -> float:
    """Compute half the angle of the tip land about the axis, chamfer taken off.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        rad; negative for a pointed tooth.
    """
    _, angle = involute_point(design, design.pinion_tip_roll)
    return float(angle) - design.pinion.tip_chamfer / design.pinion_tip_radius


def root_half_angle(design: PairDesign) -> float:
    """Compute half the angle of the root land about the axis.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Returns
    -------
    float
        rad; negative when the rack's tip circles overlap.
    """
    return pinion_fillet(design.family, 1).lateral / design.pinion_pitch_radius


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
    reliefs = (part.tip_relief, linear), (part.root_relief, linear), (part.lead_crowning, parabola)
    roll, y = np.asarray(roll, float), np.asarray(y, float)
    depth = np.zeros(np.broadcast_shapes(roll.shape, y.shape))
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
        Length of roll below the tip, length of roll above the root's junction, and distance from the
        middle of the face, m.
    """
    base = design.pinion_base_radius
    return (
        base * (design.pinion_tip_roll - roll),
        base * (roll - junction_roll(design)),
        abs(y - design.mean_radius),
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
        Distance along the face from its middle, and length of roll within the involute's ends, m.
    """
    on_flank = np.clip(np.asarray(roll, float), junction_roll(design), design.pinion_tip_roll)
    return np.asarray(y, float) - design.mean_radius, design.pinion_base_radius * on_flank
