"""Flanks, fillets and limits of four public designs have the numbers that were computed outside the package.

The numbers (all digits) were made with closed forms typed in twice, checked by rolled racks, by cutting and
by classical tooth contact analysis; stated errors are 1e-9 mm, 1e-11 rad and 2e-7 mm for fillet radii.
"""

import re

import numpy as np
import pytest
from public_teeth import MM, NAMES, public_design, public_numbers
from references import against, agrees

from facegear.errors import NotConverged
from facegear.teeth.family_limits import family_limits, singular_quadratic, tip_land
from facegear.teeth.generated_fillet import flank_end, gear_fillet
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.helicoid import PinionFlank, pinion_fillet, pinion_land, pinion_start

LENGTH = 1e-12
ANGLE = 1e-11
SIDES = {"drive": 1, "coast": -1}
CASES = pytest.mark.parametrize(("name", "side"), [(name, side) for name in NAMES for side in SIDES])


def polar_angle(point):
    """Return the gear angle (rad) of points (..., 3)."""
    return np.arctan2(point[..., 0], point[..., 1])


@CASES
def test_helicoids_have_the_public_base_cylinders_and_thickness(name, side):
    family, numbers = public_design(name), public_numbers(name)
    pinion = family.pinion_flanks[SIDES[side] < 0]
    assert abs(pinion.pressure_angle - numbers[f"{side} transverse pressure angle rad"]) < ANGLE
    assert abs(pinion.sine - numbers[f"{side} sine of base helix"]) < ANGLE
    assert abs(pinion.base_radius - numbers[f"{side} pinion base radius mm"] * MM) < LENGTH
    assert abs(pinion.half_base_angle - numbers[f"{side} pinion half base angle rad"]) < ANGLE
    assert abs(family.shaper_flanks[SIDES[side] < 0].phase - numbers[f"{side} shaper phase c rad"]) < ANGLE
    assert abs(family.rack.transverse_module - numbers["transverse module mm"] * MM) < LENGTH
    assert abs(family.pinion_pitch_radius - numbers["pinion pitch radius mm"] * MM) < LENGTH


@against(
    "second implementation",
    "public designs of the family",
    capability="geometry",
    module="facegear.teeth.generated_flank",
)
@pytest.mark.parametrize("name", NAMES)
def test_flank_points_and_normals_are_the_public_ones(name):
    family, numbers, compared = public_design(name), public_numbers(name), 0
    for key, value in numbers.items():
        found = re.fullmatch(r"(drive|coast) flank at R ([\d.]+) mm, ([\d.]+) mn below the tip", key)
        if found is None:
            continue
        flank, radius = gear_flank(family, SIDES[found[1]]), float(found[2]) * MM
        height = family.gear_tip.height(radius) - float(found[3]) * family.rack.normal_module
        psi, s = flank.parameters_at(radius, height)
        assert abs(height - value["z_mm"] * MM) < LENGTH
        agrees("contact parameter psi, rad", psi, value["psi_rad"], absolute=ANGLE)
        agrees("generator parameter s, m", s, value["s_mm"] * MM, absolute=LENGTH)
        angle = polar_angle(flank.point(psi, s))
        agrees("gear angle of a flank point, rad", angle, value["gear_angle_rad"], absolute=ANGLE)
        agrees("normal of the flank", flank.normal(psi, s), value["normal"], absolute=ANGLE)
        compared += 1
    assert compared == 5


@pytest.mark.parametrize("radius_mm", [10.0, 100.0, 190.0])
def test_a_place_that_no_flank_has_is_named_by_its_radius(radius_mm):
    """Far inside, an upright normal of endless length was taken for a place of the flank."""
    family = public_design("P1")
    radii = np.array([228.5, radius_mm]) * MM
    heights = np.full(2, family.gear_tip.height(228.5 * MM) - family.rack.normal_module)
    with pytest.raises(NotConverged, match=f"{radius_mm:.3f} mm from the axis"):
        gear_flank(family, 1).parameters_at(radii, heights)


@against(
    "second implementation",
    "public designs of the family",
    capability="geometry",
    module="facegear.teeth.family_limits",
)
@CASES
def test_inner_limits_and_their_reasons_are_the_public_ones(name, side):
    start = family_limits(public_design(name)).starts[SIDES[side] < 0]
    radius, reason = public_numbers(name)[f"{side} inner limit mm"]
    assert start.reason == reason
    agrees("inner limit, m", start.radius, radius * MM, absolute=LENGTH)


@CASES
def test_the_shapers_involute_begins_on_the_tip_where_it_should(name, side):
    start = family_limits(public_design(name)).starts[SIDES[side] < 0]
    expected = public_numbers(name)[f"{side} start of the involute on the tip mm"] * MM
    np.testing.assert_allclose(start.involute, expected, rtol=0, atol=LENGTH)


@pytest.mark.parametrize("name", NAMES)
def test_pointing_and_lands_are_the_public_ones(name):
    family, numbers = public_design(name), public_numbers(name)
    pointing, expected = family_limits(family).pointing, numbers["pointing radius mm"]
    assert pointing == np.inf if isinstance(expected, str) else abs(pointing - expected * MM) < LENGTH
    lands = tip_land(family, np.array([family.inner_radius, family.outer_radius]))
    assert abs(lands[0] - numbers["tip land at inner radius mm"] * MM) < LENGTH
    assert abs(lands[1] - numbers["tip land at outer radius (smallest) mm"] * MM) < LENGTH
    land = pinion_land(family, family.middle + family.width / 2)
    assert abs(land - numbers["pinion tip land at outer end mm"] * MM) < LENGTH


@pytest.mark.parametrize("name", NAMES)
def test_tip_and_root_heights_are_the_public_ones(name):
    family, numbers = public_design(name), public_numbers(name)
    mean, fillet = (family.inner_radius + family.outer_radius) / 2, gear_fillet(family, 1)
    lowest = fillet.point(fillet.y_at(mean, 1.0), 1.0)
    assert abs(family.gear_tip.height(mean) - numbers["tip height z at mean radius mm"] * MM) < LENGTH
    assert abs(lowest[2] - numbers["root height z at mean radius mm"] * MM) < LENGTH


@against(
    "second implementation",
    "public designs of the family",
    capability="geometry",
    module="facegear.teeth.generated_fillet",
)
@CASES
def test_fillets_begin_and_bend_as_the_public_ones(name, side):
    family, compared = public_design(name), 0
    fillet = gear_fillet(family, SIDES[side])
    for key, value in public_numbers(name).items():
        found = re.fullmatch(rf"{side} fillet at R ([\d.]+) mm", key)
        if found is None:
            continue
        radius = float(found[1]) * MM
        start = fillet.point(fillet.y_at(radius, 0.0), 0.0)
        agrees("height where the fillet begins, m", start[2], value["start_z_mm"] * MM, absolute=LENGTH)
        angle = polar_angle(start)
        agrees("gear angle of its beginning, rad", angle, value["start_gear_angle_rad"], absolute=ANGLE)
        smallest = fillet.smallest_radius(radius)
        agrees("smallest radius of the fillet, m", smallest, value["smallest_radius_mm"] * MM, absolute=2e-10)
        compared += 1
    assert compared == 3


@CASES
def test_the_fillet_joins_the_flanks_end_with_its_normal(name, side):
    family = public_design(name)
    fillet, flank = gear_fillet(family, SIDES[side]), gear_flank(family, SIDES[side])
    y = fillet.y_at(np.linspace(family.inner_radius, family.outer_radius, 7), 0.0)
    start = fillet.point(y, 0.0)
    psi, s = flank.parameters_at(np.hypot(start[:, 0], start[:, 1]), start[:, 2])
    assert np.abs(s - flank_end(family, SIDES[side], psi)).max() < LENGTH
    assert np.abs(flank.point(psi, s) - start).max() < LENGTH
    assert np.abs(flank.normal(psi, s) - fillet.normal(y, 0.0)).max() < 1e-10


@CASES
def test_the_pinions_root_is_the_public_one(name, side):
    family, numbers = public_design(name), public_numbers(name)
    pinion = family.pinion_flanks[SIDES[side] < 0]
    flank, root = PinionFlank(pinion), pinion_fillet(family, SIDES[side])
    start = pinion_start(family, SIDES[side], family.middle)
    form = np.hypot(pinion.base_radius, start)
    assert abs(form - numbers[f"{side} pinion form radius at ym mm"] * MM) < LENGTH
    key = f"{side} pinion fillet at ym: radius mm, angle from the middle of the space rad"
    radius, angle = numbers[key]
    gamma = np.linspace(pinion.pressure_angle, np.pi / 2, 20001)
    points = root.point(gamma, family.middle)
    radii = np.hypot(points[:, 0], points[:, 2])
    near = np.interp(-radius * MM, -radii, gamma)
    for _ in range(4):
        point, by_gamma = root.point(near, family.middle), root.tangents(near, family.middle)[0]
        distance = np.hypot(point[0], point[2])
        near -= (distance - radius * MM) * distance / (point[0] * by_gamma[0] + point[2] * by_gamma[2])
    point = root.point(near, family.middle)
    from_space = np.arctan2(point[0], -point[2]) - SIDES[side] * np.pi / family.pinion_teeth
    assert abs(from_space - angle) < ANGLE
    joint = root.point(pinion.pressure_angle, family.middle)
    assert np.abs(joint - flank.point(start, family.middle)).max() < LENGTH


@CASES
@pytest.mark.parametrize("part", ["flank", "fillet", "pinion flank", "pinion root"])
def test_tangents_are_derivatives_and_square_to_normals(name, side, part):
    family, sign = public_design(name), SIDES[side]
    middle, module = family.middle, family.rack.normal_module
    pinion = family.pinion_flanks[sign < 0]
    surface, (u, v) = {
        "flank": (gear_flank(family, sign), (pinion.pressure_angle + 0.05, 6 * module)),
        "fillet": (gear_fillet(family, sign), (middle + module, 0.4)),
        "pinion flank": (PinionFlank(pinion), (5 * module, middle - module)),
        "pinion root": (pinion_fillet(family, sign), (1.1, middle + module)),
    }[part]
    step, (by_u, by_v) = 1e-6, surface.tangents(u, v)
    along_u = (surface.point(u + step, v) - surface.point(u - step, v)) / (2 * step)
    along_v = (surface.point(u, v + step) - surface.point(u, v - step)) / (2 * step)
    assert np.abs(by_u - along_u).max() < 1e-9
    assert np.abs(by_v - along_v).max() < 1e-9
    normal = surface.normal(u, v)
    assert abs(normal @ normal - 1.0) < 1e-14
    assert max(abs(normal @ by_u), abs(normal @ by_v)) < 1e-14


@CASES
def test_both_tangents_are_parallel_where_the_singular_quadratic_vanishes(name, side):
    flank = gear_flank(public_design(name), SIDES[side])
    for psi in (0.1, 0.3, 0.5):
        roots = np.roots([float(part) for part in singular_quadratic(flank, psi)])
        for s in roots[np.abs(roots.imag) == 0.0].real:
            by_psi, by_s = flank.tangents(psi, s)
            assert np.linalg.norm(np.cross(by_psi, by_s)) < 1e-12 * np.linalg.norm(by_psi)
