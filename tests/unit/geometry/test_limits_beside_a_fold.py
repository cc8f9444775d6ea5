"""Limits of the radii beside a fold of the flank, and rotations."""

from math import radians

import numpy as np
from scipy.spatial.transform import Rotation

from facegear.geometry.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.geometry.limits import face_range, radius_limits
from facegear.geometry.placement import rotation


def test_rotations_are_scipys():
    angles = np.linspace(-7.0, 7.0, 12).reshape(3, 4)
    for axis in (np.array([1.0, 0.0, 0.0]), np.array([0.0, -1.0, 0.0]), np.array([0.6, 0.0, 0.8])):
        theirs = Rotation.from_rotvec(angles.reshape(-1, 1) * axis).as_matrix().reshape(3, 4, 3, 3)
        np.testing.assert_allclose(rotation(axis, angles), theirs, atol=1e-15)


def test_limits_are_found_where_the_flank_turns_back_at_the_tip_plane():
    """Of 400 random designs these four ended in `flank at a height: 60 Newton steps`, before any work."""
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
