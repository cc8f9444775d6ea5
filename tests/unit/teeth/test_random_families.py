"""Random designs of every kind of teeth: solved or refused, conjugate in any pose, true to a rolled rack."""

import numpy as np
import pytest
from random_families import SEED, random_errors, random_family, with_possible_face
from rolled_rack import body_turn, outside_flank

from facegear.errors import GeometryError
from facegear.teeth.bounded_contact import contact_path, modified_contact
from facegear.teeth.family_contact import contact_line
from facegear.teeth.family_limits import check_family
from facegear.teeth.generated_fillet import flank_end
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.tooth_family import turn_about_axis

DESIGNS, CHECKED = 300, 20
SIDES = (1, -1)


def solve(family, pose):
    """Return paths of both flanks of a design in a pose, None where a flank touches nowhere."""
    family = with_possible_face(family)
    check_family(family)
    lines = [contact_line(family, side, pose) for side in SIDES]
    return family, [None if line is None else contact_path(family, line) for line in lines]


@pytest.fixture(scope="module")
def designs():
    """Solved designs with their poses and paths, and messages of the others."""
    rng = np.random.default_rng(SEED)
    solved, refused = [], []
    for _ in range(DESIGNS):
        family = random_family(rng)
        pose = random_errors(rng, family.rack.normal_module)
        try:
            solved.append((*solve(family, pose), pose))
        except GeometryError as error:
            refused.append(str(error))
    return solved, refused


def test_each_of_300_random_designs_is_solved_or_refused_with_a_reason(designs):
    solved, refused = designs
    assert len(solved) + len(refused) == DESIGNS
    assert len(solved) > 150
    assert all(" = " in message and "must be" in message and "nan" not in message for message in refused)
    for _, paths, _ in solved:
        assert all(path is not None for path in paths)
        assert all(np.isfinite([path.first, path.last]).all() or path.contact_ratio < 0 for path in paths)


def touching(designs):
    """Return designs whose paths are longer than a pitch, with their poses and paths."""
    return [case for case in designs[0] if min(path.contact_ratio for path in case[1]) > 1.05][:CHECKED]


def test_unmodified_flanks_run_conjugate_in_random_poses(designs):
    cases = touching(designs)
    assert len(cases) == CHECKED
    for family, paths, pose in cases:
        angle = np.linspace(0.05, 0.95, 3) * 2 * np.pi / family.pinion_teeth
        for side, path in zip(SIDES, paths, strict=True):
            contact = modified_contact(family, side, angle, lambda roll, y: 0.0 * roll * y, pose)
            assert np.abs(contact.transmission_error - path.line.transmission_error).max() < 1e-12


@pytest.mark.parametrize("side", SIDES)
def test_gear_flanks_are_what_a_shaper_of_a_rolled_rack_leaves(designs, side):
    for family, *_ in touching(designs):
        flank = gear_flank(family, side)
        radius = np.linspace(family.inner_radius, family.outer_radius, 5)[1:-1]
        height = family.gear_tip.height(radius) - 0.5 * family.rack.normal_module
        psi, s = flank.parameters_at(radius, height)
        assert np.all(s < flank_end(family, side, psi))
        points = flank.point(psi, s)
        shaft = np.array([family.offset, 0.0, 0.0]) + family.lift * family.motion.basis[2]
        generated = flank.turn(psi, s, flank.lines(psi).y) / family.cutting_motion.ratio
        middle, width = generated, 0.1
        for _ in range(8):
            angle = middle + width * np.linspace(-1.0, 1.0, 41)[:, None]
            placed = turn_about_axis(-angle * family.cutting_motion.ratio, points) - shaft
            body = body_turn(angle, placed @ family.motion.basis.T)
            distance = outside_flank(family, family.shaper_teeth, side, 0.0, body)
            distance = np.where(np.isnan(distance), np.inf, distance)
            middle = angle[np.argmin(distance, axis=0), np.arange(radius.size)]
            width /= 10.0
        assert np.abs(distance.min(axis=0)).max() < 1e-12


@pytest.mark.parametrize("side", SIDES)
def test_whole_flanks_touch_where_the_contact_line_says(designs, side):
    for family, paths, _ in touching(designs):
        path = paths[side < 0]
        line, angle = path.line, 0.3 * np.pi / family.pinion_teeth
        motion, middle = line.posed_frame
        turn = (angle + line.transmission_error / line.base_pitch) * family.motion.ratio
        center, half = np.array([line.psi, path.middle]), np.array([0.2, 3 * family.rack.normal_module])
        for _ in range(14):
            psi = center[0] + half[0] * np.linspace(-1.0, 1.0, 21)[:, None]
            s = center[1] + half[1] * np.linspace(-1.0, 1.0, 21)
            placed = turn_about_axis(-turn, line.gear.point(psi, s)) - np.array(middle)
            local = placed @ motion.basis.T + np.array([0.0, family.middle, 0.0])
            body = body_turn(np.array(angle), local)
            distance = outside_flank(family, family.pinion_teeth, side, family.thinning, body)
            first, second = np.unravel_index(np.nanargmin(distance), distance.shape)
            center, half = np.array([psi[first, 0], s[second]]), half / 2.5
        assert abs(np.nanmin(distance)) < 1e-12
