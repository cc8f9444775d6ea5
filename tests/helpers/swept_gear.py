"""A face gear as the shaper leaves it that turns through all angles: no equation of meshing.

The shaper is a rack's envelope (`rolled_rack`) with a cone for its tip and a ball that rounds its edge.
Points stand in the gear's body frame; `side` is the sign of the flank that cuts them.
"""

from collections.abc import Callable
from math import cos, pi, tan

import numpy as np
from rolled_rack import body_turn, outside_flank

from facegear.teeth.tooth_family import ToothFamily, turn_about_axis

WIDEST = 1.5
"""Largest turn (rad) of the shaper that is tried."""


def in_shaper(family: ToothFamily, angle: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return points (n, 3) in the shaper's body (x, a, u) where it has turned by angles (k, n), (k, n, 3)."""
    lift = (family.shaper_teeth - family.pinion_teeth) * family.rack.transverse_module / 2
    axis = np.array([family.offset, 0.0, 0.0]) + lift * family.motion.basis[2]
    placed = turn_about_axis(-angle * family.shaper_teeth / family.gear_teeth, points) - axis
    return body_turn(angle, placed @ family.motion.basis.T)


def tip_radius(family: ToothFamily, y: np.ndarray) -> np.ndarray:
    """Return the radius of the shaper's tip at places y along its axis, m."""
    radius = family.shaper_teeth * family.rack.transverse_module / 2 + family.shaper_addendum
    return radius + family.profile_shift + (y - family.middle) * tan(family.rack.taper_angle)


def outside_tip(family: ToothFamily, body: np.ndarray) -> np.ndarray:
    """Return how far (m) points (..., 3) of the shaper's body stand outside its tip cone."""
    radius = np.hypot(body[..., 0], body[..., 2])
    return (radius - tip_radius(family, body[..., 1])) * cos(family.rack.taper_angle)


def least(function: Callable[[np.ndarray], np.ndarray], count: int) -> np.ndarray:
    """Return the least of a function of the shaper's angle (k, n), by finer and finer steps, (n,)."""
    middle, width = np.zeros(count), WIDEST
    for steps in (300, *12 * [20]):
        angle = middle + width * np.linspace(-1.0, 1.0, steps + 1)[:, None]
        values = function(angle)
        values = np.where(np.isnan(values), np.inf, values)
        middle = angle[np.argmin(values, axis=0), np.arange(count)]
        width *= 4.0 / steps
    return values.min(axis=0)


def above_flank(family: ToothFamily, side: int, points: np.ndarray) -> np.ndarray:
    """Return how deep (m) points (n, 3) stand in the metal that the shaper's flank leaves."""

    def outside(angle: np.ndarray) -> np.ndarray:
        body = in_shaper(family, angle, points)
        distance = outside_flank(family, family.shaper_teeth, side, 0.0, body)
        return np.where(outside_tip(family, body) <= 0.0, distance, np.inf)

    return least(outside, len(points))


def above_sharp_edge(family: ToothFamily, side: int, points: np.ndarray) -> np.ndarray:
    """Return how deep (m) points (n, 3) stand in the metal that a shaper without tip rounding leaves."""

    def outside(angle: np.ndarray) -> np.ndarray:
        body = in_shaper(family, angle, points)
        distance = outside_flank(family, family.shaper_teeth, side, 0.0, body)
        return np.maximum(distance, outside_tip(family, body))

    return least(outside, len(points))


def above_tip(family: ToothFamily, points: np.ndarray) -> np.ndarray:
    """Return how deep (m) points (n, 3) stand in the metal that the shaper's tip cone leaves."""
    return least(lambda angle: outside_tip(family, in_shaper(family, angle, points)), len(points))


def ball_centre(family: ToothFamily, side: int, y: np.ndarray) -> np.ndarray:
    """Return the centres (..., 3) of the tip rounding at places y, in the shaper's body (x, a, u), m."""
    rounding = family.shaper_tip_rounding
    radius = tip_radius(family, y) - rounding / cos(family.rack.taper_angle)
    pitch_radius = family.shaper_teeth * family.rack.transverse_module / 2
    outside = (family.middle - y) * tan(family.rack.helix_angle) / pitch_radius
    inside = outside - side * 2 * pi / family.shaper_teeth
    for _ in range(50):
        angle = (inside + outside) / 2
        body = np.stack([radius * np.sin(angle), y, -radius * np.cos(angle)], axis=-1)
        distance = outside_flank(family, family.shaper_teeth, side, 0.0, body)
        is_inside = distance < -rounding
        inside, outside = np.where(is_inside, angle, inside), np.where(is_inside, outside, angle)
    return body


def above_ball(family: ToothFamily, side: int, points: np.ndarray) -> np.ndarray:
    """Return how deep (m) points (n, 3) stand in the metal that the ball along the shaper's tip leaves."""
    count, reach = len(points), np.hypot(points[:, 0], points[:, 1])
    below = tip_radius(family, reach) - (family.shaper_teeth - family.pinion_teeth) * (
        family.rack.transverse_module / 2
    )
    level = np.sqrt(reach**2 - family.offset**2)
    angle, y = np.zeros(count), (level + below * family.motion.cosine) / family.motion.sine
    widths = np.array([WIDEST, 4 * family.rack.normal_module])
    for many, some in ((600, 60), *22 * [(16, 16)]):
        first = angle + widths[0] * np.linspace(-1.0, 1.0, many + 1)[:, None]
        second = y + widths[1] * np.linspace(-1.0, 1.0, some + 1)[:, None]
        body = in_shaper(family, first, points)
        distance = np.linalg.norm(body[:, None] - ball_centre(family, side, second), axis=-1)
        best = np.argmin(distance.reshape(-1, count), axis=0)
        angle = first[best // (some + 1), np.arange(count)]
        y = second[best % (some + 1), np.arange(count)]
        widths *= 8.0 / np.array([many, some])
    return distance.min(axis=(0, 1)) - family.shaper_tip_rounding
