"""Gaps against the same closed forms in long double: their error is that of the coordinates alone.

Forces of single basis functions move by up to 1e9 N/m with a gap, so that the last place of a coordinate
(1.4e-17 m at 0.1 m) is seen in their tenth digit. A gap can be no better than the points it lies between.
"""

import numpy as np
import pytest

from facegear.teeth.placement import AXIS, conjugate_angle, pinion_to_gear
from facegear.teeth.rays import FLANK
from facegear.teeth.separation import separation
from facegear.teeth.surfaces import flank_points

LONG = np.longdouble
PI = 2 * np.arcsin(LONG(1))
LAST_PLACE = np.spacing(0.275)
"""Distance (m) of neighbouring doubles at the gear's outer radius, 5.6e-17."""
pytestmark = pytest.mark.skipif(
    np.finfo(LONG).eps > 1e-18, reason="long double has no more digits than double here"
)


def turn(body, angle):
    """Matrices of a turn about a body's axis by Rodrigues' formula."""
    axis = AXIS[body].astype(LONG)
    across = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]], LONG)
    along = np.outer(axis, axis)
    return np.cos(angle) * (np.eye(3, dtype=LONG) - along) + np.sin(angle) * across + along


def make_motion(design, phi1, phi2, tooth):
    """`to_left_flank` without assembly errors."""
    pinion = turn("pinion", LONG(phi1) + (tooth - LONG(0.5)) * 2 * PI / design.pinion.teeth)
    gear = turn("face_gear", -(LONG(phi2) + tooth * 2 * PI / design.face_gear.teeth))
    return np.diag([LONG(-1), LONG(1), LONG(1)]) @ gear @ pinion


def flank_frame(design, roll, psi):
    """Points of the gear's flank and their derivatives by roll and psi."""
    base, lift = LONG(design.shaper_base_radius), LONG(design.shaper_lift)
    ratio, space = LONG(design.shaper_ratio), LONG(design.shaper_half_space_angle)
    angle = ratio * (psi - roll - space)
    c, s, cosine, sine = np.cos(angle), np.sin(angle), np.cos(psi), np.sin(psi)
    p, q = base * (sine - roll * cosine), base / ratio / cosine
    p_psi, q_psi = base * (cosine + roll * sine), base / ratio / cosine * sine / cosine
    x, y = p * c - q * s, p * s + q * c
    by_roll = ratio * y - base * c * cosine, -ratio * x - base * s * cosine, -base * sine
    by_psi = p_psi * c - q_psi * s - ratio * y, p_psi * s + q_psi * c + ratio * x, p
    return (np.stack(part, axis=-1) for part in ((x, y, lift - p_psi), by_roll, by_psi))


def exact_gaps(design, starts, ways, roll, psi):
    """Lengths of rays up to the flank by Newton's method for roll, psi and length."""
    roll, psi, length = roll.astype(LONG), psi.astype(LONG), np.zeros(len(roll), LONG)
    for _ in range(6):
        point, by_roll, by_psi = flank_frame(design, roll, psi)
        apart = starts + length[:, None] * ways - point
        normal = np.cross(by_roll, by_psi)
        off = -(apart * normal).sum(axis=1) / (ways * normal).sum(axis=1)
        apart, length = apart + off[:, None] * ways, length + off
        aa, bb, ab = ((u * v).sum(axis=1) for u, v in ((by_roll,) * 2, (by_psi,) * 2, (by_roll, by_psi)))
        ra, rb, area = (apart * by_roll).sum(axis=1), (apart * by_psi).sum(axis=1), aa * bb - ab**2
        roll, psi = roll + (ra * bb - rb * ab) / area, psi + (rb * aa - ra * ab) / area
    return length


def test_gaps_differ_from_long_double_by_rounding_of_coordinates(pair):
    design, random = pair(26), np.random.default_rng(7)
    roll, y = random.uniform(0.05, design.pinion_tip_roll, 4000), random.uniform(0.251, 0.274, 4000)
    points, phi1, tooth = flank_points(design, roll, y), 0.07, 1
    phi2 = float(conjugate_angle(design, phi1))
    found = separation(design, points, phi1, phi2, tooth)
    hit = found.part[0] == FLANK
    assert hit.sum() > 1000
    matrix = make_motion(design, phi1, phi2, tooth)
    placed = np.diag([-1.0, 1.0, 1.0]) @ pinion_to_gear(design, phi1, phi2, tooth).matrix
    assert np.abs(matrix - placed).max() < 1e-15
    normal = points.normal[hit].astype(LONG)
    normal = normal / np.sqrt((normal**2).sum(axis=1))[:, None]
    starts, ways = points.position[hit].astype(LONG) @ matrix.T, normal @ matrix.T
    error = np.abs(found.gap[0, hit] - exact_gaps(design, starts, ways, found.u[0, hit], found.v[0, hit]))
    assert error.max() < 0.5 * LAST_PLACE
    assert np.sqrt((error**2).mean()) < 0.1 * LAST_PLACE
