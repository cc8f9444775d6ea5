"""Radii between which the face of any kind may lie: causes, and keys that move a limit away."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest
from public_teeth import NAMES, public_design, public_numbers

from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.face_bounds import REMEDIES, face_bounds, path_middles, pitch_line_radius, pitch_line_y
from facegear.teeth.family_contact import contact_line
from facegear.teeth.family_limits import root_land
from facegear.teeth.helicoid import shaper_land
from facegear.teeth.tooth_family import SIDES, ToothFamily

LANDS = 0.05
"""Thinnest land in modules, as a config asks for."""


def with_angles(family: ToothFamily, step: float) -> ToothFamily:
    """Return the pair with both pressure angles changed by a step, deg."""
    angles = tuple(angle + radians(step) for angle in family.rack.pressure_angles)
    return replace(family, rack=replace(family.rack, pressure_angles=angles))


def with_modules(family: ToothFamily, name: str, step: float) -> ToothFamily:
    """Return the pair with a length changed by a step in modules."""
    return replace(family, **{name: getattr(family, name) + step * family.rack.normal_module})


@pytest.mark.parametrize("name", NAMES)
def test_the_inner_limit_is_the_public_one_with_its_cause(name):
    numbers, bounds = public_numbers(name), face_bounds(public_design(name), 0.0)
    for flank, start in zip(("drive", "coast"), bounds.starts, strict=True):
        radius, cause = numbers[f"{flank} inner limit mm"]
        assert 1e3 * start.radius == pytest.approx(radius, abs=1e-8) and start.reason == cause
    assert bounds.inner == max(start.limit[0] for start in bounds.starts)


def test_tapered_teeth_end_where_their_root_land_vanishes():
    family = public_design("P2")
    bounds = face_bounds(family, 0.0)
    assert bounds.outer_cause == "no root land"
    lands = root_land(family, bounds.outer), shaper_land(family, pitch_line_y(family, bounds.outer))
    assert min(abs(land) for land in lands) < 1e-11


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


@pytest.mark.parametrize(
    ("name", "side", "changed", "cause"),
    [
        ("P1", 0, lambda family: with_angles(family, 0.5), "undercut"),
        ("P1", 0, lambda family: with_modules(family, "shaper_addendum", -0.05), "undercut"),
        ("P1", 1, lambda family: with_angles(family, 0.5), "no height"),
        ("P1", 1, lambda family: with_modules(family, "gear_addendum", 0.05), "no height"),
        ("P3", 1, lambda family: with_angles(family, 0.5), "undercut"),
        ("P4", 1, lambda family: with_modules(family, "shaper_addendum", -0.05), "undercut"),
    ],
)
def test_a_key_that_helps_moves_the_inner_limit_inwards(name, side, changed, cause):
    family = public_design(name)
    before, after = (face_bounds(one, 0.0).starts[side] for one in (family, changed(family)))
    assert before.reason == cause and cause in REMEDIES
    assert after.limit[0] < before.limit[0] - 1e-6


@pytest.mark.parametrize(
    ("name", "changed", "cause"),
    [
        ("P1", lambda family: with_modules(family, "gear_addendum", -0.05), "pointed tips"),
        ("P1", lambda family: with_angles(family, -0.5), "pointed tips"),
        ("P2", lambda family: with_modules(family, "shaper_addendum", -0.05), "no root land"),
        ("P2", lambda family: with_modules(family, "shaper_tip_rounding", -0.02), "no root land"),
    ],
)
def test_a_key_that_helps_moves_the_outer_limit_outwards(name, changed, cause):
    family = public_design(name)
    thinnest = LANDS * family.rack.normal_module
    before, after = (face_bounds(one, thinnest) for one in (family, changed(family)))
    assert before.outer_cause == cause
    assert after.outer > before.outer + 1e-6


def test_where_the_involute_ends_far_out_is_no_inner_limit():
    """Feet of steep normals fall below the tip again at 891 mm: taken for the start of the involute."""
    taper, shaft = radians(-3.0), radians(80.0)
    family = replace(public_design("P2"), shaft_angle=shaft)
    family = replace(family, rack=replace(family.rack, taper_angle=taper), middle=path_middles(family)[0])
    bounds = face_bounds(family, 0.0)
    assert all(np.isnan(start.involute) for start in bounds.starts)
    assert bounds.inner < float(pitch_line_radius(family, family.middle)) < bounds.outer
