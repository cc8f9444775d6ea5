"""The pinion's section: involute, tip chamfer, the root trochoid cut by a rack with a rounded tip, reliefs.

Everything is for the right flank of tooth 0 in the pinion body frame (see `design`): polar angle a from the
tooth's centre line, so x = r sin a, z = -r cos a. The left flank is the mirror image a -> -a.
Sources: involute geometry (Litvin and Fuentes 2004, chapter 10); the trochoid is the
envelope of the rack's tip circle, whose normals pass through the pitch point.
"""

from math import cos, pi, sin, tan

import numpy as np
from numpy.typing import ArrayLike

from facegear.arrays import Array
from facegear.geometry.design import PairDesign
from facegear.geometry.deviations import deviation
from facegear.geometry.reliefs import linear, parabola


def involute_point(design: PairDesign, roll: ArrayLike) -> tuple[Array, Array]:
    """Radius (m) and angle (rad) at roll angle `roll` (rad, any shape)."""
    roll = np.asarray(roll, dtype=float)
    radius = design.pinion_base_radius * np.sqrt(1 + roll**2)
    return radius, design.pinion_half_base_angle - roll + np.arctan(roll)


def involute_normal(design: PairDesign, roll: ArrayLike) -> tuple[Array, Array]:
    """x and z components of the outward unit normal."""
    tangent_point = design.pinion_half_base_angle - np.asarray(roll, dtype=float)
    return np.cos(tangent_point), np.sin(tangent_point)


def rack_tip_centre(design: PairDesign) -> tuple[float, float]:
    """Centre of the rack's tip circle (m): distance from the rack tooth's middle, depth."""
    pinion, angle = design.pinion, design.pressure_angle
    depth = pinion.dedendum - pinion.rack_tip_radius
    half_thickness = pi * design.module / 4 + pinion.thinning / (2 * cos(angle))
    lateral = half_thickness - depth * tan(angle) - pinion.rack_tip_radius / cos(angle)
    return lateral, depth - pinion.profile_shift


def junction_roll(design: PairDesign) -> float:
    """Roll angle (rad) where involute and trochoid meet; negative when the rack undercuts the pinion."""
    _, depth = rack_tip_centre(design)
    angle = design.pressure_angle
    return tan(angle) - (depth / sin(angle) + design.pinion.rack_tip_radius) / design.pinion_base_radius


def trochoid_point(design: PairDesign, gamma: ArrayLike) -> tuple[Array, Array]:
    """Radius (m) and angle (rad); gamma (rad) is the normal's slope to the rack's pitch line.

    gamma runs from the pressure angle (the junction with the involute) to pi/2 (the root circle).
    """
    gamma = np.asarray(gamma, dtype=float)
    lateral, depth = rack_tip_centre(design)
    centre = depth / np.tan(gamma)
    x = centre + design.pinion.rack_tip_radius * np.cos(gamma)
    height = design.pinion_pitch_radius - depth - design.pinion.rack_tip_radius * np.sin(gamma)
    turned = (centre - lateral) / design.pinion_pitch_radius
    return np.hypot(x, height), pi / design.pinion.teeth - np.arctan2(x, height) + turned


def trochoid_normal(design: PairDesign, gamma: ArrayLike) -> tuple[Array, Array]:
    """x and z components of the outward unit normal."""
    gamma = np.asarray(gamma, dtype=float)
    lateral, depth = rack_tip_centre(design)
    turned = (depth / np.tan(gamma) - lateral) / design.pinion_pitch_radius
    slope = gamma - turned - pi / design.pinion.teeth
    return np.cos(slope), -np.sin(slope)


def tip_half_angle(design: PairDesign) -> float:
    """Half the angle of the tip land (rad), chamfer taken off; negative for a pointed tooth."""
    _, angle = involute_point(design, design.pinion_tip_roll)
    return float(angle) - design.pinion.tip_chamfer / design.pinion_tip_radius


def root_half_angle(design: PairDesign) -> float:
    """Half the angle of the root land (rad); negative when the rack's tip circles overlap."""
    return rack_tip_centre(design)[0] / design.pinion_pitch_radius


def cartesian(radius: ArrayLike, angle: ArrayLike, y: ArrayLike) -> Array:
    """Points (..., 3) of the pinion body frame."""
    radius = np.asarray(radius)
    points = np.broadcast_arrays(radius * np.sin(angle), y, -radius * np.cos(angle))
    return np.stack(points, axis=-1)


def removed(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> Array:
    """Material (m) taken off along the normal at roll angle `roll` (rad) and axial position `y` (m).

    Beyond the ends of the involute (in the fillet) the root relief keeps its full amount, and the deviation
    at the end stands. Negative where the right flank deviates towards more material.
    """
    part = design.pinion
    reliefs = (part.tip_relief, linear), (part.root_relief, linear), (part.lead_crowning, parabola)
    roll, y = np.asarray(roll, float), np.asarray(y, float)
    taken = np.zeros(np.broadcast_shapes(roll.shape, y.shape))
    for (relief, shape), distance in zip(reliefs, distances(design, roll, y), strict=True):
        if relief.amount != 0.0:
            taken += shape(relief, distance)
    if part.flanks.right is None:
        return taken
    return taken - deviation(part.flanks.right, *deviation_place(design, roll, y))


def distances(design: PairDesign, roll: Array, y: Array) -> tuple[Array, Array, Array]:
    """Distances (m) of roll angles (rad) and axial positions y (m) from where tip relief, root relief and
    lead crowning are measured.
    """
    base = design.pinion_base_radius
    return (
        base * (design.pinion_tip_roll - roll),
        base * (roll - junction_roll(design)),
        abs(y - design.mean_radius),
    )


def deviation_place(design: PairDesign, roll: ArrayLike, y: ArrayLike) -> tuple[Array, Array]:
    """Face and profile (m) of `DeviationGrid` at roll angle (rad) and axial position y (m)."""
    on_flank = np.clip(np.asarray(roll, float), junction_roll(design), design.pinion_tip_roll)
    return np.asarray(y, float) - design.mean_radius, design.pinion_base_radius * on_flank
