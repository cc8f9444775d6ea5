"""Flanks as measured: grids enter the gap as the displaced flank does, and on either gear alike."""

from dataclasses import replace

import numpy as np
import pytest
from measured_flanks import MM, UM, constant, place_on_pinion, sampled, seen_from, with_grid
from references import against, agrees

from facegear.teeth import face_gear, modifications
from facegear.teeth.analysis import path_curvatures
from facegear.teeth.curvature import opposite_curvatures
from facegear.teeth.flank_shapes import GearModifications, Relief
from facegear.teeth.modifications import derivative, deviation
from facegear.teeth.placement import conjugate_angle, mirror_design, to_left_flank
from facegear.teeth.rays import FLANK
from facegear.teeth.separation import separation
from facegear.teeth.surfaces import flank_face, flank_points
from facegear.teeth.unloaded_contact import unloaded_contact

MIDDLE = 262.5 * MM


def crowning(face, profile):
    return -20 * UM * ((face - MIDDLE) / (12.5 * MM)) ** 2 + 0.0 * profile


def wave(face, profile):
    return 5 * UM * np.sin(2 * np.pi * face / (9 * MM)) * np.cos(2 * np.pi * profile / (6 * MM))


def turns(design, count=4):
    return (np.arange(count) / count - 0.4) * 2 * np.pi / design.pinion.teeth


def gaps(design, phi1=0.01, phi2=0.0016):
    points = flank_points(design, np.linspace(0.25, 0.6, 7)[:, None], np.linspace(0.252, 0.272, 5)).flat()
    return separation(design, points, phi1, phi2).gap


@pytest.mark.parametrize("body", ["pinion", "face_gear"])
def test_a_grid_of_zeros_changes_no_bit(pair, body):
    design = pair()
    flat = with_grid(design, body, sampled(design, body, constant(0.0)))
    np.testing.assert_array_equal(gaps(flat), gaps(design))
    first, second = (unloaded_contact(one, [0.03]) for one in (flat, design))
    assert first.transmission_error == second.transmission_error


@against(
    "analytic",
    "crowning as a modification",
    capability="geometry",
    module="facegear.teeth.modifications",
)
@pytest.mark.parametrize("places", [(4, 4), (13, 9), (3, 2)])
def test_a_parabola_given_as_a_grid_is_the_modification_itself(pair, places):
    design = pair()
    made = GearModifications(lead_crowning=Relief(20 * UM, 0.0, 12.5 * MM))
    modified = replace(design, face_gear=replace(design.face_gear, modifications=made))
    given = with_grid(design, "face_gear", sampled(design, "face_gear", crowning, places))
    agrees("gap, m", gaps(given), gaps(modified), absolute=1e-15)
    radius = np.linspace(0.250, 0.275, 6)
    edges = [modifications.tip_edge_as_made(one, radius) for one in (given, modified)]
    agrees("tip edge, m", edges[0], edges[1], absolute=1e-15)


def test_between_its_places_a_grid_is_of_fourth_order(pair):
    design = pair()
    face, profile = np.linspace(255, 270, 41)[:, None] * MM, np.linspace(1.5, 6.5, 37) * MM
    errors = []
    for count in (17, 33, 65):
        found = deviation(sampled(design, "face_gear", wave, (count, count)), face, profile)
        errors.append(np.abs(found - wave(face, profile)).max())
    assert np.log2(errors[0] / errors[1]) > 3.5 and 3.7 < np.log2(errors[1] / errors[2]) < 4.6


def test_beyond_a_grid_its_edge_stands_and_is_flat(pair):
    grid = sampled(pair(), "face_gear", wave)
    inside, beyond = deviation(grid, 0.275, [0.0, 4 * MM]), deviation(grid, 0.280, [-1 * MM, 4 * MM])
    np.testing.assert_array_equal(inside, beyond)
    assert (derivative(grid, 0.280, [1 * MM, 4 * MM], (2, 0)) == 0.0).all()
    assert abs(derivative(grid, 0.280, [1 * MM, 4 * MM], (0, 2))).min() > 0.1


@against(
    "analytic",
    "points of the flank displaced along its normal",
    capability="geometry",
    module="facegear.teeth.modifications",
)
@pytest.mark.parametrize("field", [lambda r, d: 10 * wave(r, d), constant(-50 * UM)])
def test_rays_end_at_the_measured_flank_to_a_tenth_of_a_micrometre_at_50(pair, field):
    design = pair()
    grid = sampled(design, "face_gear", field, (33, 33))
    measured = with_grid(design, "face_gear", grid)
    radius, depth = (
        part.ravel() for part in np.meshgrid(np.linspace(252, 273, 9) * MM, np.linspace(1, 5, 7) * MM)
    )
    places = face_gear.roll_and_psi_at_height(design, radius, face_gear.tip_height(design, radius) - depth)
    displaced = modifications.flank_as_made(measured, *places)
    found = seen_from(measured, displaced, face_gear.flank_normal(design, *places), 10 * UM)
    assert (found.part == FLANK).all()
    agrees("gap at 50 um, m", found.gap[0], 10 * UM, absolute=0.1 * UM)


@against(
    "second implementation",
    "the same deviations on the other gear, by conjugate action",
    capability="geometry",
    module="facegear.teeth.modifications",
)
@pytest.mark.parametrize(("amount", "stated"), [(20 * UM, 5e-10), (50 * UM, 3e-9)])
def test_the_same_deviations_on_either_gear_move_it_alike(pair, amount, stated):
    errors = on_either(pair(), lambda along, across: -amount * (along**2 + 0.0 * across))
    agrees("transmission error, m", errors[0], errors[1], absolute=stated)
    assert errors[0].min() < -1 * UM


def test_profile_deviations_on_either_gear_differ_to_second_order_alone(pair):
    """Flanks slide, so that the same deviation is another slope on either: slope squared over curvature."""
    design = pair()
    off = []
    for amount in (5 * UM, 10 * UM):
        errors = on_either(design, lambda along, across, a=amount: -a * across**2 + 0.0 * along)
        off.append(np.abs(errors[0] - errors[1]).max())
    assert off[1] < 0.1 * UM
    assert 3.0 < off[1] / off[0] < 5.0


def on_either(design, field):
    """Transmission errors (m) of a field of the places on the pinion, -1..1 along and across its flank, as
    deviations of the pinion and of the gear.
    """

    def on_pinion(face, profile):
        return field(face / (12.5 * MM), (profile - 18 * MM) / (9 * MM))

    def on_gear(radius, depth):
        return on_pinion(*place_on_pinion(design, *np.broadcast_arrays(radius, depth)))

    first = with_grid(design, "pinion", sampled(design, "pinion", on_pinion, (17, 17)))
    second = with_grid(design, "face_gear", sampled(design, "face_gear", on_gear, (33, 33), deepest=0.85))
    return [unloaded_contact(one, turns(design, 2)).transmission_error for one in (first, second)]


def test_material_on_a_flank_sets_its_own_side_ahead_and_leaves_the_other(pair):
    design = pair(thinning=100 * UM)
    thick = with_grid(design, "pinion", sampled(design, "pinion", constant(7 * UM)))
    thick = with_grid(thick, "face_gear", sampled(design, "face_gear", constant(3 * UM), (9, 9)), "left")
    plain = unloaded_contact(design, [0.03]).transmission_error
    drive, back = (unloaded_contact(one, [0.03]).transmission_error for one in (thick, mirror_design(thick)))
    assert drive - plain == pytest.approx(10 * UM, abs=1e-9)
    assert back == pytest.approx(plain, abs=1e-12)


@against(
    "second implementation",
    "second differences of the gap",
    capability="geometry contact",
    module="facegear.teeth.curvature",
)
@pytest.mark.parametrize("body", ["pinion", "face_gear"])
def test_deviations_bend_the_gap_as_their_curvatures_say(pair, body):
    plain = pair(26)
    face = flank_face(plain, body)

    def field(along, across):
        along, across = along - np.mean(face.face), across - np.mean(face.profile)
        return 1.0 * along**2 - 1.5 * across**2 + 0.8 * along * across + 1e-3 * across

    design = with_grid(plain, body, sampled(plain, body, field))
    roll, *_ = (part[16] for part in path_curvatures(plain))
    base = plain.pinion_base_radius
    phi1 = np.array([roll - plain.pinion_half_base_angle - plain.pressure_angle + np.pi / 23])
    step = 2e-4
    across, along = np.meshgrid([-step, 0, step], [-step, 0, step], indexing="ij")
    points = flank_points(design, np.sqrt(2 * (across + roll**2 * base / 2) / base), 0.268125 + along)
    seen = separation(design, points.flat(), phi1, conjugate_angle(plain, phi1))
    gap = seen.gap.reshape(3, 3)
    second = np.diff(gap, 2, axis=0)[0, 1], np.diff(gap, 2, axis=1)[1, 0]
    cross = (gap[2, 2] - gap[0, 2] - gap[2, 0] + gap[0, 0]) / 4
    bent = np.linalg.eigvalsh(np.array([[second[0], cross], [cross, second[1]]]) / step**2)
    to_gear = to_left_flank(plain, phi1, conjugate_angle(plain, phi1), 0).matrix
    place = np.array([roll]), 0.268125
    large, small, _ = opposite_curvatures(design, place, seen.u[0, 4:5], seen.v[0, 4:5], to_gear)
    agrees("relative curvature, 1/m", bent, np.sort([small[0], large[0]]), relative=5e-3)
    nominal = opposite_curvatures(plain, place, seen.u[0, 4:5], seen.v[0, 4:5], to_gear)
    assert abs(nominal[0][0] - large[0]) > 1.0


def test_a_wave_of_1_um_and_3_mm_has_the_curvature_of_its_second_derivative(pair):
    """4.4 1/m, 8 % of the flank's own 55."""
    design = pair()
    grid = sampled(design, "face_gear", lambda r, d: UM * np.cos(2 * np.pi * d / (3 * MM)) + 0.0 * r, (5, 65))
    assert -derivative(grid, 0.2625, 3 * MM, (0, 2)) == pytest.approx(4.386, rel=3e-3)


@pytest.mark.parametrize("places", [(2, 2), (2, 5), (3, 3), (3, 6)])
def test_few_places_have_the_derivatives_of_their_polynomial(pair, places):
    grid = sampled(pair(), "face_gear", lambda r, d: (1.0 + r) * (1.0 + d) * 1e-3, places)
    found = [derivative(grid, 0.26, 0.004, orders) for orders in ((1, 0), (0, 1), (1, 1), (2, 0), (0, 2))]
    np.testing.assert_allclose(found, [1.004e-3, 1.26e-3, 1e-3, 0.0, 0.0], atol=1e-9)
