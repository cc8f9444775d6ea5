"""The rack as planes and a rounded edge, rolled by matrices: an independent view of what it cuts.

Nothing here uses the closed forms of `facegear.teeth`: only the parameters of the family's rack are shared.
"""

from math import cos, pi, sin

import numpy as np

from facegear.teeth.tooth_family import ToothFamily


def rack_normal(family: ToothFamily, side: int) -> np.ndarray:
    """Return the normal (3,) of a flank of the rack in (x, a, u), out of the pinion's metal."""
    rack = family.rack
    alpha, beta, delta = rack.pressure_angle(side), rack.helix_angle, rack.taper_angle
    flat = np.array([side * cos(alpha), 0.0, -sin(alpha)])
    about_u = np.array([[cos(beta), -sin(beta), 0.0], [sin(beta), cos(beta), 0.0], [0.0, 0.0, 1.0]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cos(delta), sin(delta)], [0.0, -sin(delta), cos(delta)]])
    return about_x @ about_u @ flat


def rack_point(family: ToothFamily, side: int, radius: float, thinning: float) -> np.ndarray:
    """Return a point (3,) of a flank of the rack on its datum line in the section y = middle."""
    half = pi * family.rack.transverse_module / 4 + thinning / 2 / abs(rack_normal(family, side)[0])
    return np.array([-side * half, family.middle, -(radius + family.profile_shift)])


def body_turn(angle: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return points (..., 3) in (x, a, u) of a body that has turned by `angle` (...), at angle 0."""
    c, s = np.cos(angle), np.sin(angle)
    x, a, u = points[..., 0], points[..., 1], points[..., 2]
    # a positive turn moves the lower side towards +x
    return np.stack([x * c + u * s, a + 0.0 * c, u * c - x * s], axis=-1)


def depth_in_pinion(family: ToothFamily, points: np.ndarray, rolls: np.ndarray) -> np.ndarray:
    """Return how deep (m) points (n, 3) of the pinion's body at angle 0 stand in the metal the rack left.

    It is the smallest signed distance from the rack's tooth at its places `rolls` (rad); negative outside.
    """
    rack, radius = family.rack, family.pinion_pitch_radius
    beta, delta = rack.helix_angle, rack.taper_angle
    along = np.array([-sin(beta), cos(beta) * cos(delta), -cos(beta) * sin(delta)])
    tip = np.array([0.0, sin(delta), cos(delta)])
    top = family.pinion_dedendum * cos(delta) - family.rack_tip_radius
    placed = body_turn(-rolls, points[:, None, :])
    placed[..., 0] -= radius * rolls
    datum = np.array([0.0, family.middle, -(radius + family.profile_shift)])
    corners, outs, slides = [], [], []
    for side in (1, -1):
        normal = rack_normal(family, side)
        start = rack_point(family, side, radius, family.thinning)
        system = np.array([normal, tip, along])
        levels = [normal @ start + family.rack_tip_radius, tip @ datum + top, along @ datum]
        corners.append(np.linalg.solve(system, levels))
        slide = np.cross(along, normal)
        outs.append(-normal)
        slides.append(slide if slide @ tip > 0 else -slide)
    beyond = [np.einsum("...i,i->...", placed - corner, tip) for corner in corners]
    distance = beyond[0]
    for corner, out, slide in zip(corners, outs, slides, strict=True):
        from_corner = placed - corner
        from_corner = from_corner - np.einsum("...i,i->...", from_corner, along)[..., None] * along
        flank = np.einsum("...i,i->...", from_corner, out)
        past_flank = np.einsum("...i,i->...", from_corner, slide) > 0.0
        edge = np.cross(along, tip)
        edge = edge if edge @ out > 0 else -edge
        past_tip = np.einsum("...i,i->...", from_corner, edge) > 0.0
        at_corner = np.linalg.norm(from_corner, axis=-1)
        distance = np.where(past_flank & past_tip, at_corner, np.maximum(distance, flank))
    return (distance - family.rack_tip_radius).min(axis=-1)


def outside_flank(
    family: ToothFamily, teeth: int, side: int, thinning: float, points: np.ndarray
) -> np.ndarray:
    """Return how far (...) points (..., 3) of a body at angle 0 stand outside a flank that the rack cuts, m.

    The flank is the envelope of the rack's plane, so that the distance is that of the plane at the roll
    where it is stationary and largest; nan where there is no such roll.
    """
    radius = teeth * family.rack.transverse_module / 2
    normal, start = rack_normal(family, side), rack_point(family, side, radius, thinning)
    x, u = points[..., 0], points[..., 2]
    cosine, sine = normal[2] * x - normal[0] * u, -(normal[0] * x + normal[2] * u)
    with np.errstate(invalid="ignore"):
        apart = np.arccos(normal[0] * radius / np.hypot(cosine, sine))
    rolls = [np.arctan2(sine, cosine) + sign * apart for sign in (1.0, -1.0)]
    roll = np.where(sine * np.cos(rolls[0]) - cosine * np.sin(rolls[0]) < 0.0, rolls[0], rolls[1])
    roll = (roll + pi) % (2 * pi) - pi
    placed = body_turn(-roll, points)
    placed[..., 0] -= radius * roll
    return (placed - start) @ normal
