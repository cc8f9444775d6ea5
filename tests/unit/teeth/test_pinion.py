"""The pinion's section: involute and trochoid meet smoothly, and both are what the rack leaves."""

from dataclasses import replace

import numpy as np
import pytest
from references import against, agrees

from facegear.teeth import pinion
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.helicoid import pinion_fillet
from facegear.teeth.surfaces import fillet_points


@pytest.mark.parametrize(("shift", "thinning"), [(0.0, 0.0), (0.3, 0.0), (-0.1, 1e-4)])
def test_involute_and_trochoid_share_point_and_normal(pair, shift, thinning):
    design = pair(shift=shift, thinning=thinning)
    y = design.middle
    roll, gamma = pinion.junction_roll(design, y), design.pressure_angle
    np.testing.assert_allclose(
        pinion.involute_point(design, roll, y), pinion.trochoid_point(design, gamma, y), atol=1e-15
    )
    np.testing.assert_allclose(
        pinion.involute_normal(design, roll, y), pinion.trochoid_normal(design, gamma, y), atol=1e-14
    )


def test_normals_are_orthogonal_to_the_section(pair):
    design = pair(rack_tip_radius=0.25)
    step = 1e-6
    for point, normal, at in (
        (pinion.involute_point, pinion.involute_normal, np.linspace(0.25, 0.7, 11)),
        (pinion.trochoid_point, pinion.trochoid_normal, np.linspace(0.45, 1.55, 11)),
    ):
        after = pinion.cartesian(*point(design, at + step, 0.0), 0.0)
        tangent = after - pinion.cartesian(*point(design, at - step, 0.0), 0.0)
        tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
        normals = normal(design, at, 0.0)
        assert np.max(np.abs(np.einsum("ij,ij->i", tangent, normals))) < 1e-8
        np.testing.assert_allclose(np.linalg.norm(normals, axis=-1), 1, atol=1e-14)


def test_trochoid_ends_on_the_root_circle_where_the_root_land_begins(pair):
    design = pair()
    radius, angle = pinion.trochoid_point(design, np.pi / 2, design.middle)
    assert radius == pytest.approx(design.pinion_root_radius, abs=1e-16)
    assert np.pi / 23 - angle == pytest.approx(pinion.root_half_angle(design), abs=1e-15)
    np.testing.assert_allclose(
        pinion.trochoid_normal(design, np.pi / 2, 0.26), [np.sin(angle), 0.0, -np.cos(angle)], atol=1e-15
    )


@against(
    "analytic",
    "thickness of a shifted and thinned involute tooth on its pitch circle",
    capability="geometry",
    module="facegear.teeth.pinion",
)
def test_thickness_on_the_pitch_circle(pair):
    design = pair(shift=0.2, thinning=1e-4)
    _, angle = pinion.involute_point(design, np.tan(design.pressure_angle), design.middle)
    expected = np.pi * design.module / 2 + 2 * 0.2 * design.module * np.tan(design.pressure_angle)
    expected -= 1e-4 / np.cos(design.pressure_angle)
    agrees(
        "tooth thickness of the pinion, m", 2 * angle * design.pinion_pitch_radius, expected, absolute=1e-15
    )


def test_rack_tip_circle_never_cuts_into_the_trochoid(pair):
    """Envelope property: over the rolling motion the tip circle touches each fillet point from outside."""
    design = pair(rack_tip_radius=0.25)
    root = pinion_fillet(design.family, 1)
    lateral, depth = root.lateral, root.depth
    radius, angle = pinion.trochoid_point(design, np.linspace(design.pressure_angle, np.pi / 2, 41), 0.0)
    from_space = np.pi / 23 - angle
    shifts = np.linspace(-6e-3, 12e-3, 4001)[:, None]
    turned = from_space + shifts / design.pinion_pitch_radius
    x, y = radius * np.sin(turned), design.pinion_pitch_radius - radius * np.cos(turned)
    clearance = np.hypot(x - lateral - shifts, y - depth) - design.pinion.rack_tip_radius
    closest = clearance.min(axis=0)
    assert np.all(closest > -1e-12)
    assert np.all(closest < 1e-8)


def test_root_relief_keeps_its_amount_into_the_fillet(pair):
    design = pair()
    relieved = replace(design, pinion=replace(design.pinion, root_relief=Relief(12e-6, 0.0, 1e-3)))
    start = pinion.junction_roll(design, design.middle)
    roll = start + np.array(
        [-0.05, 0.0, 0.5e-3 / design.pinion_base_radius, 2e-3 / design.pinion_base_radius]
    )
    np.testing.assert_allclose(
        pinion.removed_depth(relieved, roll, 0.262), [12e-6, 12e-6, 6e-6, 0.0], atol=1e-15
    )
    offset = fillet_points(design, 1.0, 0.262).position - fillet_points(relieved, 1.0, 0.262).position
    assert np.linalg.norm(offset) == pytest.approx(12e-6, rel=1e-9)
