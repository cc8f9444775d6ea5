"""Separation contours of the flanks: how far pinion flank points stay from the gear all along."""

from dataclasses import dataclass
from math import pi

import numpy as np

from facegear.arrays import Array, Mask
from facegear.geometry import face_gear, pinion
from facegear.geometry.design import PairDesign
from facegear.geometry.pinion_surface import flank_points
from facegear.geometry.placement import conjugate_angle
from facegear.geometry.separation import FLANK, separation


@dataclass(frozen=True)
class EaseOff:
    """On a grid (n_profile, n_width) of pinion flank points, roll (rad) and y (m).

    gap: smallest separation (m) from the gear's flank while the tooth passes through the mesh; facing:
    whether the point meets the gear's flank at all (gap, radius, height are zero where not); radius,
    height: where on the gear (gear radius and z, m).
    """

    roll: Array
    y: Array
    gap: Array
    facing: Mask
    radius: Array
    height: Array


def ease_off(design: PairDesign, transmission_error: float, shape: tuple[int, int] = (25, 25)) -> EaseOff:
    """Compute the ease-off of the drive side.

    The separation is sampled over three pitches and its smallest value taken from the parabola through the
    three samples around it.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    transmission_error : float
        Mean unloaded transmission error, m, see `unloaded`.
    shape : tuple[int, int]
        Number of points along profile and width.

    Returns
    -------
    EaseOff
        Grid of gaps, m.
    """
    gear = design.face_gear
    half = design.pinion.width / 2
    first = max(gear.inner_radius, design.mean_radius - half)
    last = min(gear.outer_radius, design.mean_radius + half)
    rolls = np.linspace(pinion.junction_roll(design), design.pinion_tip_roll, shape[0])
    roll, y = np.meshgrid(rolls, np.linspace(first, last, shape[1]), indexing="ij")
    phi1 = np.linspace(-1.5, 1.5, 61) * 2 * pi / design.pinion.teeth
    phi2 = conjugate_angle(design, phi1) + transmission_error / design.gear_base_radius
    separations = separation(design, flank_points(design, roll, y).flat(), phi1, phi2)
    gap = np.where(separations.part == FLANK, separations.gap, np.inf)
    best = np.clip(np.argmin(gap, axis=0), 1, len(phi1) - 2)
    points = np.arange(gap.shape[1])
    before, middle, after = (gap[best + step, points] for step in (-1, 0, 1))
    is_facing = np.isfinite(before) & np.isfinite(middle) & np.isfinite(after)
    with np.errstate(invalid="ignore", divide="ignore"):
        min_gap = middle - (after - before) ** 2 / (8 * (before - 2 * middle + after))
    hit = face_gear.flank_point(design, separations.u[best, points], separations.v[best, points])
    radius = np.hypot(hit[:, 0], hit[:, 1])

    def facing_values(values: Array) -> Array:
        return np.where(is_facing, values, 0.0).reshape(shape)

    return EaseOff(
        roll=roll,
        y=y,
        gap=facing_values(min_gap),
        facing=is_facing.reshape(shape),
        radius=facing_values(radius),
        height=facing_values(hit[:, 2]),
    )
