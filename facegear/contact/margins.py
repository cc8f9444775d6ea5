"""Distances of the contact pattern of a pair from every edge of its flanks."""

from dataclasses import dataclass

import numpy as np

from facegear.arrays import Arrays
from facegear.contact.columns import EDGES
from facegear.geometry.design import PairDesign
from facegear.geometry.limits import radius_limits
from facegear.geometry.placement import pinion_angle, to_left_flank


@dataclass(frozen=True)
class PatternMargins:
    """Distances (m) from a contact pattern to the edges of the flanks, 0 where it reaches one.

    Attributes
    ----------
    inner_end, outer_end
        Along the gear's radius, to the ends of the common face.
    pinion_tip
        Along the pinion's radius, to its tip.
    gear_tip
        Along the gear's axis, to its tip plane.
    undercut, pointing
        Along the gear's radius, to where the gear's flank ends in undercut, and where its tips are pointed.
    """

    inner_end: float
    outer_end: float
    pinion_tip: float
    gear_tip: float
    undercut: float
    pointing: float


def pattern_margins(arrays: Arrays, design: PairDesign, torque: float) -> PatternMargins | None:
    """Compute the distances of the contact pattern from the edges of the flanks.

    Loaded planes across the pinion's axis count half way to their neighbours. Across the profile the
    pattern is that of the positions solved; a strip that reaches over a tip edge has no distance to it.

    Parameters
    ----------
    arrays : Arrays
        Arrays as PRESSURE_ARRAYS of the pair.
    design : PairDesign
        Pair of gears.
    torque : float
        On the pinion, N m.

    Returns
    -------
    PatternMargins, optional
        Distances, m; None without load at this torque.
    """
    on = arrays["line_torque_n_m"] == torque
    if not on.any():
        return None
    line_keys = list(zip(arrays["contact_position"].tolist(), arrays["contact_tooth"].tolist(), strict=True))
    row = {key: number for number, key in enumerate(line_keys)}
    keys = zip(arrays["line_position"][on].tolist(), arrays["line_tooth"][on].tolist(), strict=True)
    lines = np.array([row[key] for key in keys])
    points = arrays["contact_point_m"][lines, arrays["line_plane"][on]]
    touches_edge = {
        name: bool((arrays["line_where"][on] == number).any()) for number, name in enumerate(EDGES)
    }
    half = 0.5 * float(np.diff(arrays["contact_point_m"][0, :, 1]).mean())
    phi1 = pinion_angle(design, arrays["line_position"][on])
    motion = to_left_flank(design, phi1, np.zeros_like(phi1), arrays["line_tooth"][on])
    x, y, z = motion.points(points[:, None, :])[:, 0].T
    radius = np.hypot(x, y)
    gear, width, limits = design.face_gear, design.pinion.width, radius_limits(design)
    first = max(gear.inner_radius, design.mean_radius - width / 2)
    last = min(gear.outer_radius, design.mean_radius + width / 2)
    inner, outer = max(radius.min() - half, first), min(radius.max() + half, last)
    to_tip = design.pinion_tip_radius - np.hypot(points[:, 0], points[:, 2]).max()
    below = design.gear_tip_plane - z.max()
    return PatternMargins(
        inner_end=inner - first,
        outer_end=last - outer,
        pinion_tip=0.0 if touches_edge["pinion tip"] else max(float(to_tip), 0.0),
        gear_tip=0.0 if touches_edge["gear tip"] else max(float(below), 0.0),
        undercut=inner - limits.inner,
        pointing=limits.outer - outer,
    )
