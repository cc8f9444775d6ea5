"""Separation along the pinion's normal, unloaded contact and curvature, against independent forms."""

from dataclasses import replace

import numpy as np
import pytest
from references import against, agrees
from scipy.optimize import root

from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.analysis import path_curvatures, section_contact_ratio
from facegear.teeth.curvature import relative_curvatures
from facegear.teeth.document import ease_off
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.limits import sharpest_fillet_radius
from facegear.teeth.placement import conjugate_angle, mirror_design, to_left_flank
from facegear.teeth.rays import FILLET, FLANK, ROOT_LAND, TIP_LAND
from facegear.teeth.separation import separation
from facegear.teeth.surfaces import SurfacePoints, fillet_points, flank_points
from facegear.teeth.unloaded_contact import unloaded_contact
from facegear.teeth.validate import check


def pitch(design, count):
    return (np.arange(count) / count - 0.5) * 2 * np.pi / design.pinion.teeth


@against(
    "analytic",
    "conjugate flanks: line contact without transmission error",
    capability="geometry",
    module="facegear.teeth.unloaded_contact",
)
def test_equal_tooth_numbers_touch_in_a_line_without_transmission_error(pair):
    design = pair(23)
    contact = unloaded_contact(design, pitch(design, 24))
    agrees("transmission error, rad", contact.transmission_error, 0.0, absolute=1e-12)
    ys = np.linspace(0.2505, 0.2745, 9)
    touching = [
        np.min(separation(design, flank_points(design, np.linspace(0.2, 0.66, 4001), y), 0.0, 0.0).gap)
        for y in ys
    ]
    agrees("gap along the contact line, m", touching, 0.0, absolute=1e-10)


@against(
    "analytic",
    "localised contact lies at the pitch radius",
    capability="geometry",
    module="facegear.teeth.unloaded_contact",
)
@pytest.mark.parametrize("teeth", [24, 25, 26])
def test_localised_contact_path_lies_at_the_pitch_radius(pair, teeth):
    design = pair(teeth)
    contact = unloaded_contact(design, pitch(design, 16))
    roll, y = contact.path
    agrees("transmission error, rad", contact.transmission_error, 0.0, absolute=1e-12)
    position = flank_points(design, roll, y).position
    gear = [
        to_left_flank(design, f1, f2, j).points(p[None])[0]
        for p, f1, f2, j in zip(position, contact.phi1, contact.phi2, contact.tooth, strict=True)
    ]
    radius = np.hypot(*np.array(gear)[:, :2].T)
    # y is the axial coordinate; the radius differs by the sideways part of the point only
    agrees(
        "place of the path along the pinion's axis, m",
        y,
        design.gear_pitch_radius,
        relative=1e-7,
        absolute=1e-5,
    )
    agrees("radius of the path, m", radius, design.gear_pitch_radius, absolute=2e-4)


@against(
    "analytic",
    "separation of the generating planes in closed form",
    capability="geometry",
    module="facegear.teeth.separation",
)
@pytest.mark.parametrize("teeth", [24, 26])
def test_separation_of_the_generating_planes_has_the_closed_form(pair, teeth):
    """Tangent planes of slope a_x stand (r_ps - r_p1)(sin a + cos a (a_x - a) - sin a_x) apart.

    Gear flank point on the instantaneous line of generation, pinion flank point with the same normal.
    """
    design = pair(teeth)
    ratio, space = design.shaper_ratio, design.shaper_half_space_angle
    a = design.pressure_angle
    for gear_radius in np.linspace(0.251, 0.275, 10):
        slope = np.arccos(design.gear_base_radius / gear_radius)
        turn = 0.013
        phi_s = ratio**-1 * turn
        roll = slope - phi_s - space
        gear = face_gear.flank_point(design, roll, slope) * [-1, 1, 1]
        pinion_roll = design.pinion_half_base_angle + slope
        phi1 = -turn * 143 / 23
        # left flank of the gear at -turn: mirror image of the right flank at +turn
        c, s = np.cos(-turn), np.sin(-turn)
        gear = np.array([c * gear[0] + s * gear[1], c * gear[1] - s * gear[0], gear[2]])
        normal = np.array([np.cos(slope), 0.0, -np.sin(slope)])
        angle = phi1 - np.pi / 23
        pinion_roll += angle
        point = flank_points(design, pinion_roll, gear_radius).position
        c, s = np.cos(angle), np.sin(angle)
        point = np.array([c * point[0] - s * point[2], point[1], s * point[0] + c * point[2]])
        lift = design.shaper_lift
        expected = -lift * (np.sin(slope) - np.sin(a) - np.cos(a) * (slope - a))
        agrees("separation, m", (gear - point) @ normal, expected, absolute=1e-12)


def closed_form(design, y):
    a, slope = design.pressure_angle, np.arccos(design.gear_base_radius / np.asarray(y))
    return -design.shaper_lift * (np.sin(slope) - np.sin(a) - np.cos(a) * (slope - a))


@against(
    "analytic",
    "separation of the generating planes in closed form",
    capability="geometry contact",
    module="facegear.teeth.separation",
)
@pytest.mark.parametrize("teeth", [24, 26])
@pytest.mark.parametrize("position", [0.0, 0.1, 0.2])
def test_smallest_separation_in_a_section_follows_the_closed_form(pair, teeth, position):
    """Along the pinion's own normal the field differs from the planes' distance in second order only."""
    design = pair(teeth)
    phi1 = position * 2 * np.pi / 23
    phi2 = conjugate_angle(design, phi1)
    for y in np.linspace(0.251, 0.2745, 10):
        low, high = float(pinion.junction_roll(design, design.middle)), design.pinion_tip_roll
        for _ in range(8):
            roll = np.linspace(low, high, 41)
            gap = separation(design, flank_points(design, roll, y), phi1, phi2).gap[0]
            best, step = np.argmin(gap), roll[1] - roll[0]
            low, high = max(low, roll[best] - 2 * step), min(high, roll[best] + 2 * step)
        agrees("smallest separation in a section, m", gap.min(), closed_form(design, y), relative=1e-3)


@against(
    "analytic",
    "separation of the generating planes in closed form",
    capability="geometry",
    module="facegear.teeth.separation",
)
def test_contours_are_the_closed_form_within_a_fifth_of_a_micrometre(pair):
    """The contours' own error: the parabola over the sampled mesh positions."""
    design = pair(26)
    contours = ease_off(design, 0.0, (9, 10))
    facing = contours.is_facing[4]
    assert facing.sum() >= 8
    expected = closed_form(design, contours.y[4][facing])
    agrees("separation, m", contours.gap[4][facing], expected, relative=1e-7, absolute=2e-7)


@against(
    "second implementation",
    "nearest point of a dense cloud of the gear",
    capability="geometry contact",
    module="facegear.teeth.separation",
)
def test_separation_agrees_with_a_dense_cloud_of_the_gear(pair):
    """Brute force: distance along the ray to the nearest of half a million gear points."""
    design = pair(26, offset=1e-4, shaft_angle_error=1e-3, gear_axial=5e-5, thinning=1e-4)
    points = flank_points(design, [0.35, 0.4, 0.5], [0.256, 0.262, 0.27])
    phi1 = np.array([0.02])
    found = separation(design, points, phi1, conjugate_angle(design, phi1), 0)
    motion = to_left_flank(design, phi1, conjugate_angle(design, phi1), 0)
    position, normal = motion.points(points.position)[0], motion.directions(points.normal)[0]
    radius = np.linspace(0.25, 0.275, 700)[None, :]
    roll = np.linspace(0.35, 0.66, 700)[:, None]
    cloud = face_gear.flank_point(design, roll, face_gear.psi_at(design, radius, roll)).reshape(-1, 3)
    for number in range(3):
        offset = cloud - position[number]
        along = offset @ normal[number]
        aside = np.linalg.norm(offset - along[:, None] * normal[number], axis=1)
        nearest = np.argmin(aside)
        assert found.part[0, number] == FLANK
        agrees("separation, m", found.gap[0, number], along[nearest], absolute=0.05 * aside[nearest] + 1e-7)


def test_relief_opens_the_gap_by_its_amount(pair):
    design = pair(26)
    relieved = pair(26, tip_relief=Relief(amount=20e-6, start=0.2e-3, length=2e-3))
    roll = design.pinion_tip_roll - np.array([0.0, 0.1e-3, 1.2e-3, 3e-3]) / design.pinion_base_radius
    phi1 = np.array([0.14])
    plain, cut = (
        separation(d, flank_points(d, roll, 0.266), phi1, conjugate_angle(d, phi1)).gap
        for d in (design, relieved)
    )
    np.testing.assert_allclose((cut - plain)[0], [20e-6, 20e-6, 10e-6, 0.0], atol=1e-9)


def test_lead_crowning_is_a_parabola_in_the_face(pair):
    design = pair(23)
    crowned = replace(design, pinion=replace(design.pinion, lead_crowning=Relief(10e-6, 0.0, 0.0125)))
    y = design.mean_radius + np.array([-0.0125, -0.00625, 0.0, 0.00625, 0.0125])
    offset = flank_points(design, 0.4, y).position - flank_points(crowned, 0.4, y).position
    np.testing.assert_allclose(np.linalg.norm(offset, axis=1), [10e-6, 2.5e-6, 0, 2.5e-6, 10e-6], atol=1e-12)


def test_assembly_errors_shift_the_path_but_leave_the_motion_conjugate(pair):
    """A spur pinion with a face gear is insensitive to alignment: the path moves, the ratio stays exact."""
    nominal = pair(26).gear_pitch_radius
    for errors in ({"offset": 1e-4}, {"gear_axial": 1e-4}, {"shaft_angle_error": 2e-3}):
        design = pair(26, **errors)
        contact = unloaded_contact(design, pitch(design, 8))
        assert np.ptp(contact.transmission_error) < 1e-11
        assert np.ptp(contact.path[1]) < 1e-4
        assert abs(contact.path[1].mean() - nominal) > 1e-3


@against(
    "analytic",
    "normal part of a displacement",
    capability="geometry",
    module="facegear.teeth.unloaded_contact",
)
def test_gear_axial_opens_each_flank_by_its_normal_part(pair):
    shift = 1e-7
    contact = unloaded_contact(pair(26, gear_axial=shift), [0.0])
    agrees(
        "transmission error, m", contact.transmission_error[0], -shift * np.sin(np.radians(25)), relative=2e-3
    )


@against(
    "analytic",
    "thinning of a flank",
    capability="geometry",
    module="facegear.teeth.unloaded_contact",
)
def test_thinning_turns_the_gear_back_by_half_of_it(pair):
    contact = unloaded_contact(pair(26, thinning=8e-5), pitch(pair(), 4))
    agrees("transmission error, m", contact.transmission_error, -4e-5, relative=1e-7, absolute=1e-12)


@against(
    "analytic",
    "mirror symmetry",
    capability="geometry",
    module="facegear.teeth.unloaded_contact",
)
def test_mirrored_pair_has_the_mirrored_contact(pair):
    design = pair(26, offset=8e-5)
    one = unloaded_contact(design, [0.03]).transmission_error
    other = unloaded_contact(mirror_design(design), [0.03]).transmission_error
    assert abs(one - other)[0] > 1e-5
    twice = unloaded_contact(mirror_design(mirror_design(design)), [0.03]).transmission_error
    agrees("gap of the mirrored pair, m", twice, one, absolute=1e-13)


def test_second_relative_curvature_vanishes_in_line_contact(pair):
    design = pair(23)
    roll = np.linspace(0.2, 0.68, 9)[:, None]
    psi = face_gear.psi_at(design, np.linspace(0.25, 0.275, 7)[None, :], roll)
    large, small, _ = relative_curvatures(design, roll, psi)
    assert np.max(np.abs(small / large)) < 1e-6
    assert np.all(large > 0)


@against(
    "second implementation",
    "second differences of the gap",
    capability="geometry contact",
    module="facegear.teeth.curvature",
)
def test_relative_curvatures_are_the_second_derivatives_of_the_gap(pair):
    design = pair(26)
    roll, large, small, slope = (part[16] for part in path_curvatures(design))
    base = design.pinion_base_radius
    phi1 = roll - design.pinion_half_base_angle - design.pressure_angle + np.pi / 23
    step = 2e-4
    across, along = np.meshgrid([-step, 0, step], [-step, 0, step], indexing="ij")
    length = across + roll**2 * base / 2
    points = flank_points(design, np.sqrt(2 * length / base), design.gear_pitch_radius + along)
    gap = separation(design, points.flat(), phi1, conjugate_angle(design, phi1)).gap.reshape(3, 3)
    assert gap[1, 1] == pytest.approx(0, abs=1e-13)
    second = np.diff(gap, 2, axis=0)[0, 1], np.diff(gap, 2, axis=1)[1, 0]
    cross = gap[2, 2] - gap[0, 2] - gap[2, 0] + gap[0, 0]
    hessian = np.array([[second[0], cross / 4], [cross / 4, second[1]]]) / step**2
    values, vectors = np.linalg.eigh(hessian)
    agrees("relative curvature, 1/m", values, [small, large], relative=5e-3)
    line = vectors[:, 0]
    agrees("angle of the contact line, rad", np.arctan(line[0] / line[1]), slope, absolute=2e-3)


def test_contact_ratio_counts_the_pairs_that_touch(pair):
    design = pair(26)
    contact = unloaded_contact(design, pitch(design, 96))
    touching = np.count_nonzero(contact.gap < 1e-10) / 96
    assert touching == pytest.approx(section_contact_ratio(design), abs=2 / 96)
    assert section_contact_ratio(design) == pytest.approx(1.55, abs=0.01)


def test_rays_of_the_fillet_meet_the_tip_land(pair):
    design = pair(26)
    points = fillet_points(design, np.linspace(0.9, 1.5, 5), 0.262)
    found = separation(design, points, 0.0, 0.0)
    assert set(found.part[0]) <= {0, 1, 3}
    down = SurfacePoints(np.array([[0.0, 0.262, -0.0385]]), np.array([[0.0, 0.0, -1.0]]))
    gap = separation(design, down, np.pi / 23, 0.0).gap
    assert gap[0, 0] == pytest.approx(-0.0385 - face_gear.tip_height(design, 0.26), abs=1e-15)


def test_no_gear_beyond_its_ends(pair):
    design = pair(26)
    points = flank_points(design, 0.4, [0.2485, 0.2765])
    assert np.all(np.isinf(separation(design, points, 0.0, 0.0).gap))
    assert pinion.junction_roll(design, design.middle) < 0.4


def test_a_ray_meets_the_gear_alike_alone_and_beside_others(pair):
    """Rays are cut side by side, each from where another one has met the flank."""
    design = pair(26, offset=1e-4, shaft_angle_error=2e-3)
    rng = np.random.default_rng(5)
    roll, y = rng.uniform(-0.05, 0.75, 300), rng.uniform(0.248, 0.277, 300)
    points = flank_points(design, np.r_[roll, np.sort(roll)], np.r_[y, y])
    together = separation(design, points, 0.1, 0.02, 1)
    assert set(together.part[0]) >= {0, FLANK, FILLET}
    for row in range(0, 600, 7):
        alone = separation(design, points.only(np.array([row])), 0.1, 0.02, 1)
        assert alone.part[0, 0] == together.part[0, row]
        for name in ("gap", "u", "v", "continued"):
            one, among = getattr(alone, name)[0, 0], getattr(together, name)[0, row]
            assert among == pytest.approx(one, rel=1e-11, abs=1e-15, nan_ok=True)


@pytest.mark.parametrize(
    ("rounding", "inner", "outer"), [(0.0, 0.250, 0.275), (0.14, 0.250, 0.275), (0.14, 0.275, 0.297)]
)
def test_every_ray_ends_on_the_part_it_names(pair, rounding, inner, outer):
    """The compiled rays against the closed forms of `face_gear`, the gap against another root find.

    The last face reaches beyond the radius at which the centre of the shaper's tip rolls without sliding.
    """
    design = pair(26, tip_rounding=rounding, offset=1e-4, shaft_angle_error=2e-3, thinning=1e-4)
    face = replace(design.face_gear, inner_radius=inner, outer_radius=outer)
    design = replace(design, face_gear=face)
    assert inner < sharpest_fillet_radius(design) and check(design)
    assert (sharpest_fillet_radius(design) < outer) == (outer > 0.28)
    rng = np.random.default_rng(3)
    y = rng.uniform(inner - 1e-3, outer + 1e-3, 200)
    flank = flank_points(
        design,
        rng.uniform(float(pinion.junction_roll(design, design.middle)), design.pinion_tip_roll, 200),
        y,
    )
    fillet = fillet_points(design, rng.uniform(design.pressure_angle, 1.5, 200), y)
    x = np.linspace(-2e-3, 2e-3, 41)
    tip = np.stack([x, np.full(41, inner + 0.01), np.full(41, -design.pinion_tip_radius)], axis=1)
    points = joined(flank, fillet, SurfacePoints(tip, np.tile([0.0, 0.0, -1.0], (41, 1))))
    phi1 = np.repeat([-0.1, 0.02, 0.12], 3)
    placement = phi1, conjugate_angle(design, phi1), np.tile([-1, 0, 1], 3)
    found = separation(design, points, *placement)
    motion = to_left_flank(design, *placement)
    start, along = motion.points(points.position), motion.directions(points.normal)
    end = start + found.gap[..., None] * along
    surfaces = {
        FLANK: lambda u, v: face_gear.flank_point(design, u, v),
        FILLET: lambda u, v: face_gear.cylindrical(v, *face_gear_fillet.fillet_section(design, v, u)),
        TIP_LAND: lambda u, v: face_gear.cylindrical(v, u, face_gear.tip_height(design, v)),
        ROOT_LAND: lambda u, v: face_gear.cylindrical(v, u, face_gear_fillet.root_height(design, v)),
    }
    for part, surface in surfaces.items():
        hit = found.part == part
        assert hit.sum() > 3
        assert np.abs(surface(found.u[hit], found.v[hit]) - end[hit]).max() < 1e-14
        assert np.abs(np.hypot(*end[hit, :2].T) - found.radius[hit]).max() < 1e-14
    for row, column in np.argwhere(found.part == FLANK)[::25]:
        p, n = start[row, column], along[row, column]
        solved = root(
            lambda x, p=p, n=n: (face_gear.flank_point(design, x[0], x[1]) - p - x[2] * n) * 1e3,
            [found.u[row, column] + 0.03, found.v[row, column] - 0.02, 0.0],
            tol=1e-14,
        )
        assert solved.x[2] == pytest.approx(found.gap[row, column], abs=1e-13)


def joined(*parts):
    return SurfacePoints(
        np.concatenate([part.position for part in parts]), np.concatenate([part.normal for part in parts])
    )
