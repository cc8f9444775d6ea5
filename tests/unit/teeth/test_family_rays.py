"""Gaps along the pinion's normals for all kinds of teeth, against a shaper that turns through all angles."""

from dataclasses import replace
from functools import cache
from math import cos, pi, sin, tan

import numpy as np
import pytest
from family_pairs import pair_of
from public_teeth import NAMES, public_design
from random_families import SEED, random_family, with_possible_face
from spur_values import shipped_designs
from swept_gear import above_ball, above_flank, above_sharp_edge, above_tip
from unloaded_pairs import MIRROR, contact_angles, pinion_points, unloaded_line

from facegear.errors import GeometryError
from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.closest import PAIRS
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.family_limits import check_family
from facegear.teeth.pinion import junction_roll, tip_roll
from facegear.teeth.placement import mirror_design, pinion_angle, to_left_flank
from facegear.teeth.rays import FILLET, FLANK, ROOT_LAND, TIP_LAND
from facegear.teeth.separation import separation
from facegear.teeth.surfaces import SurfacePoints, flank_points
from facegear.teeth.unloaded_contact import unloaded_motion

RANDOM, GROUP = 20, 5
"""Number of random designs, and how many a test takes."""
CASES = [*NAMES, *range(0, RANDOM, GROUP)]
SIDES = (1, -1)


@cache
def random_designs():
    """Return random designs that can be made and whose flanks touch for more than a pitch."""
    rng, designs = np.random.default_rng(SEED), []
    while len(designs) < RANDOM:
        try:
            family = with_possible_face(random_family(rng))
            check_family(family)
        except GeometryError:
            continue
        pairs = [posed_pair(family, side) for side in SIDES]
        if all(contact_path(pair.family, unloaded_line(pair)).contact_ratio > 1.05 for pair in pairs):
            designs.append(family)
    return designs


def families_of(case):
    """Return the designs of a case: a public one, or a group of random ones."""
    return [public_design(case)] if isinstance(case, str) else random_designs()[case : case + GROUP]


def posed_pair(family, side):
    """Return the pair whose drive flank is a flank of the family, with all four errors of assembly."""
    module = family.rack.normal_module
    errors = AssemblyErrors(0.01 * module, 2e-4, -0.01 * module, 0.03 * module)
    design = replace(pair_of(family), assembly=errors)
    return design if side > 0 else mirror_design(design)


def rays_of(design, rng):
    """Return points and normals of the pinion's flank, continued inwards, and of its tip and root lands."""
    family, helicoid = design.family, design.family.pinion_flanks[0]
    ends = design.middle + design.pinion.width / 2 * np.array([-1.0, 1.0])
    last = np.sqrt(design.pinion_tip_radius**2 - helicoid.base_radius**2)
    flank = pinion_points(design, rng.uniform(0.1, 1.0, 200) * last, rng.uniform(*ends, 200))
    angle = (rng.integers(-2, 3, 100) + rng.uniform(-0.05, 0.05, 100)) * pi / family.pinion_teeth
    radial = np.stack([np.sin(angle), 0.0 * angle, -np.cos(angle)], axis=-1)
    from_axis = (design.pinion_tip_radius - 0.3 * design.module) * radial
    from_axis[:, 1] = rng.uniform(*ends, 100)
    return SurfacePoints(np.concatenate([flank.position, from_axis]), np.concatenate([flank.normal, radial]))


def placements(design):
    """Return pinion angles, gear angles without load, and numbers of three pairs at three positions."""
    line = unloaded_line(design)
    phi1 = np.repeat(np.array([-0.4, 0.1, 0.45]) * 2 * pi / design.pinion.teeth, 3)
    phi2 = line.motion.ratio * (phi1 + line.transmission_error / line.base_pitch)
    return phi1, phi2, np.tile([-1, 0, 1], 3)


def rays_that_hit(family, side, part):
    """Return starts, directions and gaps of rays that meet a part, in the gear's body frame."""
    design, rng = posed_pair(family, side), np.random.default_rng(7)
    points, placement = rays_of(design, rng), placements(design)
    found, motion = separation(design, points, *placement), to_left_flank(design, *placement)
    hit = np.argwhere(found.part == part)
    hit = hit[rng.permutation(len(hit))[:25]]
    at = hit[:, 0], hit[:, 1]
    factors = MIRROR if side > 0 else 1.0
    starts, ways = motion.points(points.position)[at], motion.directions(points.normal)[at]
    return starts * factors, ways * factors, found.gap[at]


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("case", CASES)
def test_rays_end_where_a_shaper_turned_through_all_angles_leaves_metal(case, side):
    in_fillets = 0
    for family in families_of(case):
        is_sharp = family.shaper_tip_rounding == 0.0
        fillet = above_sharp_edge if is_sharp else above_ball
        for part, above in ((FLANK, above_flank), (FILLET, fillet), (ROOT_LAND, None)):
            starts, ways, gap = rays_that_hit(family, side, part)
            assert len(gap) > 3 or part == FILLET
            in_fillets += len(gap) if part == FILLET else 0
            if not len(gap):
                continue

            def depth(length, starts=starts, ways=ways, above=above, family=family):
                """Return how deep (m) in the metal rays end that are so long."""
                ends = starts + length[:, None] * ways
                return above_tip(family, ends) if above is None else above(family, side, ends)

            growth = (depth(gap + 1e-6) - depth(gap - 1e-6)) / 2e-6
            assert np.all(growth > 0.05)
            assert np.abs(depth(gap) / growth).max() < 1e-9
    assert in_fillets > 3


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("case", CASES)
def test_rays_end_on_the_tip_cone_between_both_flanks(case, side):
    for family in families_of(case):
        starts, ways, gap = rays_that_hit(family, side, TIP_LAND)
        assert len(gap) > 3
        ends = starts + gap[:, None] * ways
        radius, gamma = np.hypot(ends[:, 0], ends[:, 1]), family.shaft_angle
        taper = tan(family.rack.taper_angle)
        depth = family.pinion_pitch_radius + family.profile_shift - family.gear_addendum
        y = (radius + (depth - family.middle * taper) * cos(gamma)) / (sin(gamma) - taper * cos(gamma))
        height = -y * cos(gamma) - (depth + (y - family.middle) * taper) * sin(gamma)
        assert np.abs(ends[:, 2] - height).max() < 1e-14
        for flank in SIDES:
            assert above_flank(family, flank, ends).min() > -1e-12


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("case", CASES)
def test_flanks_touch_along_the_contact_line_and_nowhere_deeper(case, side):
    for family in families_of(case):
        design = posed_pair(family, side)
        line = unloaded_line(design)
        path = contact_path(design.family, line)
        s = path.first + np.array([0.05, 0.3, 0.5, 0.8, 0.95]) * (path.last - path.first)
        length, y, phi1, phi2 = contact_angles(line, s)
        points = pinion_points(design, length, y)
        alone = SurfacePoints(points.position[:, None], points.normal[:, None])
        touching = separation(design, alone, phi1, phi2)
        assert np.all(touching.part == FLANK)
        assert np.abs(touching.gap).max() < 1e-12
        turned = to_left_flank(design, phi1, phi2, np.zeros(s.size)).points(alone.position)[:, 0] * MIRROR
        c, sine = np.cos(phi2), np.sin(phi2)
        x, y_mesh = turned[:, 0] * c + turned[:, 1] * sine, turned[:, 1] * c - turned[:, 0] * sine
        placed = np.stack([x, y_mesh, turned[:, 2]], axis=-1)
        assert np.abs(placed - line.point(s)).max() < 1e-12
        grid = np.meshgrid(
            np.linspace(length.min(), length.max(), 41),
            design.middle + design.pinion.width * np.linspace(-0.5, 0.5, 41),
        )
        around = separation(design, pinion_points(design, *grid).flat(), phi1, phi2)
        assert np.min(around.gap[around.part == FLANK]) > -1e-12


def changed(family, key, step):
    """Return a family with a small helix, taper, offset (5 mm at 1 rad), shaft angle or asymmetry."""
    rack, angles = family.rack, family.rack.pressure_angles
    unlike = replace(rack, pressure_angles=(angles[0] + step, angles[1]))
    return {
        "helix": lambda: replace(family, rack=replace(rack, helix_angle=step)),
        "taper": lambda: replace(family, rack=replace(rack, taper_angle=step)),
        "offset": lambda: replace(family, offset=0.005 * step),
        "shaft angle": lambda: replace(family, shaft_angle=pi / 2 + step),
        "asymmetry": lambda: replace(family, rack=unlike),
    }[key]()


@pytest.mark.parametrize("key", ["helix", "taper", "offset", "shaft angle", "asymmetry"])
def test_gaps_move_in_proportion_to_a_small_departure_from_spur(key):
    spur = shipped_designs()["strength_only"].family
    points = rays_of(pair_of(spur), np.random.default_rng(2)).only(slice(200))
    angles = np.repeat(np.linspace(-0.1, 0.1, 3), 3)
    placement = angles, angles * spur.motion.ratio, np.tile([-1, 0, 1], 3)

    def gaps(family):
        found = separation(pair_of(family), points, *placement)
        return np.where(found.part > 0, found.gap, np.nan), found.part

    nominal, parts = gaps(spur)
    steps = (1e-8, 1e-6, 1e-4)
    results = [gaps(changed(spur, key, step)) for step in steps]
    same = np.all([part == parts for _, part in results], axis=0) & (parts > 0)
    slopes = np.array([(gap - nominal)[same] / step for (gap, _), step in zip(results, steps, strict=True)])
    size = np.abs(slopes[1]).max()
    assert size > 1e-5
    assert np.abs(slopes[0] - slopes[1]).max() < 3e-5 * size + 1e-8
    assert np.abs(slopes[2] - slopes[1]).max() < 1e-2 * size
    assert same.sum() > 0.995 * np.sum(parts > 0)
    assert {FLANK, FILLET, TIP_LAND} <= set(parts[same])


def test_rays_of_a_pinion_that_stands_inwards_past_undercut_miss_the_gear_or_meet_it():
    """Newton's method found no foot of rays that leave the flank over its lower edge, near undercut."""
    public, inner = pair_of(public_design("P1")), 215e-3
    design = replace(
        public,
        face_gear=replace(public.face_gear, inner_radius=inner),
        pinion=replace(public.pinion, middle=public.middle - 6e-3),
    )
    ends = design.middle + np.array([-0.5, 0.5]) * design.pinion.width
    y, share = (part.ravel() for part in np.meshgrid(np.linspace(*ends, 57), np.linspace(0.0, 1.0, 41)))
    roll = junction_roll(design, y) + share * (tip_roll(design, y) - junction_roll(design, y))
    phi1 = pinion_angle(design, np.linspace(0.0, 1.0, 5))
    phi2, _ = unloaded_motion(design, phi1)
    placements = (np.repeat(angles, PAIRS.size) for angles in (phi1, phi2))
    points = flank_points(design, roll, y)
    found = separation(design, points, *placements, np.tile(PAIRS, phi1.size), 1e-3)
    on_flank = found.part == FLANK
    assert on_flank.any()
    assert found.radius[on_flank].min() >= inner
