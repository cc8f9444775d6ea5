"""The pitch line of the pinion, and where paths of contact meet it."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from public_teeth import NAMES, public_design

from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.family_contact import contact_line
from facegear.teeth.family_limits import family_limits
from facegear.teeth.pitch_line import path_middles, pitch_line_radius, pitch_line_y
from facegear.teeth.tooth_family import SIDES


@pytest.mark.parametrize("name", NAMES)
def test_place_and_radius_on_the_pitch_line_are_inverse(name):
    family = public_design(name)
    radius = np.linspace(family.inner_radius, family.outer_radius, 5)
    assert pitch_line_radius(family, pitch_line_y(family, radius)) == pytest.approx(radius, rel=1e-14)


@pytest.mark.parametrize("name", NAMES)
def test_the_path_meets_the_pitch_line_at_its_place(name):
    """The contact line of either flank passes the height of the pitch line there."""
    family = public_design(name)
    up = family.motion.basis[2]
    for side, place in zip(SIDES, path_middles(family), strict=True):
        line = contact_line(family, side)
        s = (-family.pinion_pitch_radius - line.foot @ up) / (line.normal @ up)
        assert line.point(s) @ family.motion.basis[1] == pytest.approx(place, abs=1e-15)
        assert contact_path(family, line).contact_ratio > 1.0


def test_where_the_involute_ends_far_out_is_no_inner_limit():
    """Feet of steep normals fall below the tip again at 891 mm: taken for the start of the involute."""
    taper, shaft = radians(-3.0), radians(80.0)
    family = replace(public_design("P2"), shaft_angle=shaft)
    family = replace(family, rack=replace(family.rack, taper_angle=taper), middle=path_middles(family)[0])
    limits = family_limits(family)
    assert all(np.isnan(start.involute) for start in limits.starts)
    assert limits.inner[0] < float(pitch_line_radius(family, family.middle)) < limits.pointing
