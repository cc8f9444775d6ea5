"""Material taken off the face gear's flanks opens gaps like a displaced flank, and like the pinion's."""

from dataclasses import replace

import numpy as np
import pytest
from measured_flanks import MM, UM, seen_from
from references import against, agrees

from facegear.teeth import face_gear, modifications
from facegear.teeth.curvature import opposite_curvatures
from facegear.teeth.flank_shapes import GearModifications, Relief
from facegear.teeth.placement import mirror_design, to_left_flank
from facegear.teeth.rays import FLANK
from facegear.teeth.separation import separation
from facegear.teeth.surfaces import flank_points
from facegear.teeth.unloaded_contact import unloaded_contact

KINDS = {
    "tip relief": GearModifications(tip_relief=Relief(50 * UM, 0.5 * MM, 1.5 * MM)),
    "root relief": GearModifications(root_relief=Relief(50 * UM, 0.3 * MM, 1.2 * MM)),
    "end relief": GearModifications(end_relief=Relief(50 * UM, 1.0 * MM, 3.0 * MM)),
    "profile crowning": GearModifications(profile_crowning=Relief(50 * UM, 0.0, 3.0 * MM)),
    "lead crowning": GearModifications(lead_crowning=Relief(50 * UM, 0.0, 12.5 * MM)),
    "lead slope": GearModifications(lead_slope=50 * UM),
    "profile slope": GearModifications(profile_slope=50 * UM),
    "bias": GearModifications(bias=50 * UM),
}


def modified(design, made):
    return replace(design, face_gear=replace(design.face_gear, modifications=made))


def flank_grid(design, inset=0.1):
    """Roll and psi (rad) of places all over the gear's flank, away from its edges."""
    gear = design.face_gear
    part = np.linspace(inset, 1 - inset, 9)
    radius = gear.inner_radius + part * (gear.outer_radius - gear.inner_radius)
    depth = part[:, None] * modifications.flank_depth(design)(radius)
    return face_gear.roll_and_psi_at_height(
        design, radius[None, :], face_gear.tip_height(design, 0.26) - depth
    )


@against(
    "analytic",
    "points of the flank displaced along its normal",
    capability="geometry",
    module="facegear.teeth.modifications",
)
@pytest.mark.parametrize("kind", KINDS)
def test_rays_end_at_the_flank_that_is_displaced_along_its_normal(pair, kind):
    design = modified(pair(25), KINDS[kind])
    roll, psi = (angle.ravel() for angle in flank_grid(design))
    nominal, normal = face_gear.flank_point(design, roll, psi), face_gear.flank_normal(design, roll, psi)
    radius = np.hypot(nominal[:, 0], nominal[:, 1])
    taken = modifications.removed_depth(design, radius, modifications.depth_below_tip(design, nominal))
    found = seen_from(design, nominal - taken[:, None] * normal, normal, 10 * UM)
    assert (found.part == FLANK).all()
    agrees("gap at 50 um, m", found.gap[0], 10 * UM, absolute=0.1 * UM)


@against(
    "second implementation",
    "the same lead crowning on the pinion",
    capability="geometry",
    module="facegear.teeth.modifications",
)
def test_a_lead_crowning_does_the_same_on_either_gear_where_flanks_touch_in_lines(pair):
    """But for the gear radius, which is not quite the place along the pinion's axis."""
    plain = pair(23)
    turns = (np.arange(8) / 8 - 0.5) * 2 * np.pi / plain.pinion.teeth
    half = 0.5 * (plain.face_gear.outer_radius - plain.face_gear.inner_radius)
    on_gear = modified(plain, GearModifications(lead_crowning=Relief(20 * UM, 0.0, half)))
    crowned = replace(plain.pinion, lead_crowning=Relief(20 * UM, 0.0, half))
    first, second = (unloaded_contact(one, turns) for one in (on_gear, replace(plain, pinion=crowned)))
    agrees("transmission error, m", first.transmission_error, second.transmission_error, absolute=0.05 * UM)
    np.testing.assert_allclose(first.path[1], second.path[1], atol=0.3 * MM)


def test_a_gear_that_nothing_is_taken_off_is_the_gear_itself_to_the_bit(pair):
    design = pair(25)
    nothing = GearModifications(tip_relief=Relief(0.0, 1 * MM, 1 * MM), lead_slope=0.0, bias=-0.0)
    points = flank_points(design, np.linspace(0.25, 0.6, 7)[:, None], np.linspace(0.252, 0.272, 5)).flat()
    first, second = (separation(one, points, 0.01, 0.0016) for one in (design, modified(design, nothing)))
    np.testing.assert_array_equal(first.gap, second.gap)


def test_both_flanks_are_modified_alike(pair):
    design = modified(pair(25), KINDS["bias"])
    assert mirror_design(design).face_gear == design.face_gear


def test_crowned_flanks_are_curved_more_by_the_second_derivative_of_what_is_taken_off(pair):
    plain = pair(25)
    design = modified(plain, GearModifications(profile_crowning=Relief(20 * UM, 0.0, 3.0 * MM)))
    roll, psi = np.array([0.4]), np.array([0.4363])
    to_gear = to_left_flank(plain, 0.0, 0.0, 0).matrix.reshape(3, 3)[None]
    place = roll, 0.2625
    before, after = (opposite_curvatures(one, place, roll, psi, to_gear)[0] for one in (plain, design))
    added = 2 * 20 * UM / (3.0 * MM) ** 2
    assert 0.7 * added < after[0] - before[0] < added


def test_the_tip_edge_stands_back_from_the_pinion_by_what_is_taken_off_there(pair):
    design = modified(pair(25), KINDS["tip relief"])
    radius = np.linspace(0.251, 0.274, 7)
    moved = face_gear.tip_edge(design, radius) - modifications.tip_edge_as_made(design, radius)
    np.testing.assert_allclose(np.linalg.norm(moved, axis=1), 50 * UM, rtol=1e-9)
    assert (moved[:, 0] > 0).all()
