"""Limits of the radii beside a fold of the flank, and rotations."""

from math import radians

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from facegear.teeth import face_gear
from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.limits import THINNEST_LAND, face_range, radius_limits
from facegear.teeth.placement import rotation


def test_rotations_are_scipys():
    angles = np.linspace(-7.0, 7.0, 12).reshape(3, 4)
    for axis in (np.array([1.0, 0.0, 0.0]), np.array([0.0, -1.0, 0.0]), np.array([0.6, 0.0, 0.8])):
        theirs = Rotation.from_rotvec(angles.reshape(-1, 1) * axis).as_matrix().reshape(3, 4, 3, 3)
        np.testing.assert_allclose(rotation(axis, angles), theirs, atol=1e-15)


def test_limits_are_found_where_the_flank_turns_back_at_the_tip_plane():
    """Four of 400 random designs ended in `flank at a height: 60 Newton steps`, before any work."""
    chance = np.random.default_rng(0)
    for number in range(362):
        pinion_teeth, gear_teeth = int(chance.integers(15, 40)), int(chance.integers(80, 250))
        m = chance.uniform(1, 8) * 1e-3
        shaper, radius = pinion_teeth + int(chance.integers(0, 6)), m * gear_teeth / 2
        angle, addendum = radians(chance.uniform(18, 28)), m * chance.uniform(0.8, 1.1)
        shift, gear_addendum = chance.uniform(-0.1, 0.3) * m, m * chance.uniform(0.7, 1)
        if number in (4, 68, 288, 361):
            pinion = PinionGeometry(pinion_teeth, 0.03, addendum, 1.25 * m, 0.1 * m, 0.01, shift)
            gear = FaceGearGeometry(gear_teeth, radius, 1.05 * radius, gear_addendum, 0.01)
            design = PairDesign(m, angle, pinion, gear, Shaper(shaper, 1.25 * m))
            limits = radius_limits(design)
            assert face_range(design, limits).inner >= limits.inner


@pytest.mark.parametrize(("teeth", "angle_deg"), [(60, 30.0), (120, 25.0), (200, 25.0), (400, 20.0)])
def test_many_teeth_have_a_face_although_their_tips_are_pointed_at_tip_undercut(teeth, angle_deg):
    m = 1e-3
    pinion = PinionGeometry(teeth, 8 * m, m, 1.25 * m, 0.1 * m, 0.01)
    gear = FaceGearGeometry(4 * teeth, m, m, m, 3 * m)
    shaper = Shaper(teeth + 3, 1.15 * m, 0.1 * m)
    design = PairDesign(m, radians(angle_deg), pinion, gear, shaper)
    allowed = face_range(design, radius_limits(design))
    assert allowed.inner < m * 2 * teeth < allowed.outer, "the pitch radius has a tooth"

    radius = np.linspace(allowed.inner, allowed.outer, 50)
    roll, psi = face_gear.tip_parameters(design, radius)
    land = 2 * face_gear.flank_point(design, roll, psi)[..., 0]
    assert land.min() >= THINNEST_LAND * m * (1 - 1e-6)
    if allowed.inner_reason == "tips pointed further in":
        assert land[0] == pytest.approx(THINNEST_LAND * m, rel=1e-6)
