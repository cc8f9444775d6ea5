"""Rules of the family of teeth: mirror, axial screw, virtual work, statics of small models, traps."""

from dataclasses import replace
from math import cos, hypot, pi, sin, tan

import numpy as np
import pytest
from public_teeth import ERRORS, MM, NAMES, public_design
from rolled_rack import body_turn, depth_in_pinion

from facegear.errors import GeometryError
from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.family_contact import contact_line
from facegear.teeth.family_limits import check_family, family_limits, root_land
from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.helicoid import pinion_fillet, shaper_land
from facegear.teeth.tooth_family import turn_about_axis
from facegear.teeth.unloaded_contact import gear_backlash

SIDES = (1, -1)
CASES = pytest.mark.parametrize(("name", "side"), [(name, side) for name in NAMES for side in SIDES])
MIRROR = np.array([-1.0, 1.0, 1.0])
FORCE_STEPS = {"offset": 0, "gear_axial": 1, "shaft_angle_error": 2, "pinion_axial": 3}


def with_error(key, value):
    """Return the public errors of assembly with one more error."""
    return replace(ERRORS, **{key: getattr(ERRORS, key) + value})


@CASES
def test_the_coast_flank_is_the_mirrored_drive_flank_of_the_other_hand(name, side):
    family = public_design(name)
    other = family.mirror_image
    flank, image = gear_flank(family, side), gear_flank(other, -side)
    psi, s = np.linspace(0.3, 0.6, 4)[:, None], np.linspace(0.01, 0.03, 3)
    assert np.abs(flank.point(psi, s) - MIRROR * image.point(psi, s)).max() < 1e-15
    assert np.abs(flank.normal(psi, s) - MIRROR * image.normal(psi, s)).max() < 1e-15
    mean = (family.inner_radius + family.outer_radius) / 2
    fillet, image = gear_fillet(family, side), gear_fillet(other, -side)
    points, expected = (part.point(part.y_at(mean, 0.4), 0.4) for part in (fillet, image))
    assert np.abs(points - MIRROR * expected).max() < 1e-14
    root, image = pinion_fillet(family, side), pinion_fillet(other, -side)
    y = family.middle + MM
    assert np.abs(root.point(1.2, y) - MIRROR * image.point(1.2, y)).max() < 1e-15


@CASES
def test_contact_in_a_pose_is_the_mirrored_contact_of_the_other_hand(name, side):
    family = public_design(name)
    line = contact_line(family, side, ERRORS)
    errors = replace(ERRORS, offset=-ERRORS.offset)
    image = contact_line(family.mirror_image, -side, errors)
    assert abs(line.transmission_error + image.transmission_error) < 1e-16
    assert abs(line.psi - image.psi) < 1e-12
    assert np.abs(line.foot - MIRROR * image.foot).max() < 1e-12
    s = contact_path(family, line).middle
    assert line.curvatures(s)[:2] == pytest.approx(image.curvatures(s)[:2], rel=1e-11)
    assert line.curvatures(s)[2] == pytest.approx(-image.curvatures(s)[2], rel=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_the_lower_gear_is_the_upper_one_only_at_right_angles_without_offset(name):
    family = public_design(name)
    below = family.below
    assert (below == family) is (name in ("P1", "P2"))
    assert below.below == replace(family, shaft_angle=below.below.shaft_angle)
    assert below.rack == family.rack
    inner = family_limits(family).starts[0].radius, family_limits(below).starts[0].radius
    assert (abs(inner[0] - inner[1]) < 1e-15) is (name in ("P1", "P2"))


@pytest.mark.parametrize("name", ["P1", "P4"])
def test_an_axial_pitch_outwards_is_a_turn_by_one_tooth(name):
    family = public_design(name)
    for side in SIDES:
        helicoid = family.pinion_flanks[side < 0]
        pitch = 2 * pi * helicoid.base_radius * helicoid.cosine / family.pinion_teeth
        still = contact_line(family, side, replace(ERRORS, pinion_axial=0.0))
        moved = contact_line(family, side, replace(ERRORS, pinion_axial=pitch / helicoid.sine))
        assert abs(moved.transmission_error - still.transmission_error - side * pitch) < 1e-15
        assert np.abs(moved.foot - still.foot).max() < 1e-14
        assert (moved.psi, moved.turn) == pytest.approx((still.psi, still.turn), abs=1e-13)


@CASES
@pytest.mark.parametrize("outwards", [1e-5, 3e-3])
def test_any_place_outwards_changes_the_error_by_the_base_helix(name, side, outwards):
    family = public_design(name)
    eta = family.pinion_flanks[side < 0].sine
    still = contact_line(family, side, replace(ERRORS, pinion_axial=0.0))
    moved = contact_line(family, side, replace(ERRORS, pinion_axial=outwards))
    change = moved.transmission_error - still.transmission_error
    assert abs(change - side * eta * outwards) < 1e-15
    assert abs(moved.pinion_place + outwards - still.pinion_place) < 1e-12


@CASES
def test_virtual_work_of_the_wrench_is_the_slope_of_the_error(name, side):
    family = public_design(name)
    line, step = contact_line(family, side, ERRORS), 1e-6
    pivot = np.array(line.posed_frame[1]) - ERRORS.pinion_axial * line.posed_frame[0].basis[1]
    wrench = line.frame(0.02).wrench(pivot)
    axis = line.posed_frame[0].basis[1]
    work = side * np.array([wrench[0], wrench[2], wrench[3], wrench[:3] @ axis])
    for key, row in FORCE_STEPS.items():
        at = [
            contact_line(family, side, with_error(key, part * step)).transmission_error
            for part in (-2, -1, 1, 2)
        ]
        slope = (8 * (at[2] - at[1]) - (at[3] - at[0])) / (12 * step)
        assert abs(slope - work[row]) < 3e-9
    assert np.abs(line.error_slopes()[0] - work).max() < 1e-14


@CASES
def test_slopes_of_the_contacts_place_are_its_differences(name, side):
    family = public_design(name)
    slopes, step = contact_line(family, side, ERRORS).error_slopes()[1], 1e-6
    for key, row in FORCE_STEPS.items():
        at = [
            contact_line(family, side, with_error(key, part * step)).pinion_place for part in (-2, -1, 1, 2)
        ]
        difference = (8 * (at[2] - at[1]) - (at[3] - at[0])) / (12 * step)
        assert abs(difference - slopes[row]) < 1e-8 * max(1.0, abs(slopes[row]))


@CASES
def test_a_shaper_touches_its_own_gear_along_lines_without_error(name, side):
    family = public_design(name)
    family = replace(family, shaper_teeth=family.pinion_teeth, thinning=0.0)
    line = contact_line(family, side)
    assert abs(line.transmission_error) < 1e-16
    large, small, _ = line.curvatures(np.array([0.012, 0.018, 0.025]))
    assert np.abs(small / large).max() < 1e-13
    assert contact_line(family, side, ERRORS) is None


def axial_forces(family, torque):
    """Return axial forces (N) of a pinion that drives the upper and the lower gear, and of an idler."""
    forces = []
    for gear, side in ((family, 1), (family.below, 1), (family.below, -1)):
        line = contact_line(gear, side)
        forces.append(-torque / line.base_pitch * float(line.normal @ gear.motion.basis[1]))
    return forces[0] + forces[1], forces[0] + forces[2]


@pytest.mark.parametrize(
    ("name", "driving", "idling"),
    [("P1", -5915.863888, 0.0), ("P2", 754.271952, 754.271952), ("P4", 3215.706994, 0.0)],
)
def test_axial_forces_add_for_inputs_and_the_helix_cancels_for_idlers(name, driving, idling):
    family, torque = public_design(name), 500.0
    rack = family.rack
    drives, idles = axial_forces(family, torque)
    assert drives == pytest.approx(driving, rel=1e-9)
    assert idles == pytest.approx(idling, rel=1e-9, abs=1e-9)
    slopes = tan(rack.pressure_angle(1)) + tan(rack.pressure_angle(-1))
    taper = torque * sin(rack.taper_angle) * slopes / (family.pinion_pitch_radius * cos(rack.helix_angle))
    assert idles == pytest.approx(taper, rel=1e-12, abs=1e-9)


@CASES
def test_the_axial_force_is_the_same_in_every_pose(name, side):
    family = public_design(name)
    rack = family.rack
    for errors in (AssemblyErrors(), ERRORS):
        line = contact_line(family, side, errors)
        force = -float(line.normal @ line.posed_frame[0].basis[1]) / line.base_pitch
        helix = side * tan(rack.helix_angle) * cos(rack.taper_angle)
        taper = tan(rack.pressure_angle(side)) * sin(rack.taper_angle) / cos(rack.helix_angle)
        assert force == pytest.approx(-(helix - taper) / family.pinion_pitch_radius, rel=1e-11, abs=1e-13)


SPRUNG = {"P1": 8.18004e7, "P4": 8.08322e7, "spur": 8.0e7}
FREQUENCIES = {"P1": (1948.9005, 2975.3889), "P4": (2028.8879, 3596.0913)}


@pytest.mark.parametrize("name", SPRUNG)
def test_a_pinion_on_springs_is_as_stiff_as_its_mesh_normal_says(name):
    family = public_design("P1" if name == "spur" else name)
    if name == "spur":
        family = replace(family, rack=replace(family.rack, helix_angle=0.0))
    line = contact_line(family, 1)
    radial, axial = 1e8, 2e8
    local = family.motion.basis @ line.normal
    given = local[1] ** 2 / axial + (local[0] ** 2 + local[2] ** 2) / radial
    assert 1 / (1 / 4e8 + given) == pytest.approx(SPRUNG[name], rel=2e-6)


@pytest.mark.parametrize("name", FREQUENCIES)
def test_torsion_and_axial_motion_of_a_pinion_are_coupled_by_the_helix(name):
    line = contact_line(public_design(name), 1)
    eta = line.helicoid.sine
    stiffness = 4e8 * np.array([[1.0, eta], [eta, eta**2]]) + np.diag([0.0, 2e8])
    mass = np.diag([0.002 / line.base_pitch**2, 1.2])
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
    assert np.sqrt(squares) / (2 * pi) == pytest.approx(FREQUENCIES[name], rel=1e-7)


@pytest.mark.parametrize("name", NAMES)
def test_backlash_has_its_closed_form(name):
    family = public_design(name)
    rack, w = family.rack, 2 * MM
    angles = [rack.pressure_angle(side) for side in SIDES]
    thinning = family.thinning / 2 * sum(1 / cos(angle) for angle in angles) / cos(rack.helix_angle)
    taper = sin(rack.taper_angle) * sum(tan(angle) for angle in angles) / cos(rack.helix_angle)
    assert gear_backlash(family) == pytest.approx(thinning, rel=1e-11)
    outwards = gear_backlash(family, AssemblyErrors(pinion_axial=w)) - gear_backlash(family)
    assert outwards == pytest.approx(w * taper, rel=1e-10, abs=1e-15)
    apart = 1e-8
    normals = [contact_line(family, side).normal for side in SIDES]
    first = -apart * sum(normal[2] / abs(normal[0]) for normal in normals)
    change = gear_backlash(family, AssemblyErrors(gear_axial=apart)) - gear_backlash(family)
    assert change == pytest.approx(first, rel=1e-3)


def rack_lines(family, width, teeth):
    """Return lengths of contact (m) at even positions of a helical pinion on a rack, here a gear of many
    teeth.
    """
    flank, y_m = gear_flank(family, 1), family.middle
    y = y_m + width * ((np.arange(3000) + 0.5) / 3000 - 0.5)
    psi = np.full(y.size, family.pinion_flanks[0].pressure_angle)
    for _ in range(30):
        lines = flank.lines(psi)
        psi = psi - (lines.y - y) / lines.y_slope
    lengths = []
    helicoid, tip = family.pinion_flanks[0], family.pinion_tip_radius
    for position in (np.arange(40) + 0.5) / 40:
        total = 0.0
        for pair in range(-4, 5):
            turn = (position + pair) * 2 * pi / family.pinion_teeth
            # s from the pinion's roll, at the foot's y; its point is at y + eta s, the same line shifted
            s = helicoid.base_radius * helicoid.cosine * (psi + turn + helicoid.phase)
            s = s - helicoid.sine * (y - y_m)
            for _ in range(3):
                foot = y - helicoid.sine * s
                s = helicoid.base_radius * helicoid.cosine * (psi + turn + helicoid.phase)
                s = s - helicoid.sine * (foot - y_m)
            radius = np.hypot(helicoid.base_radius, helicoid.cosine * s)
            foot_height = -helicoid.base_radius * np.cos(psi)
            height = foot_height - helicoid.cosine * np.sin(psi) * s
            inside = (radius <= tip) & (height <= family.gear_tip.height(y))
            total += inside.sum() * width / y.size / helicoid.cosine
        lengths.append(total)
    return np.array(lengths)


def test_contact_lines_of_a_helical_pinion_on_a_rack_have_the_known_lengths():
    family = public_design("P1")
    teeth = 2_000_000
    family = replace(
        family,
        gear_teeth=teeth,
        shaper_teeth=family.pinion_teeth,
        thinning=0.0,
        middle=teeth * family.rack.transverse_module / 2,
    )
    axial_pitch = pi * family.rack.normal_module / sin(family.rack.helix_angle)
    whole = rack_lines(family, axial_pitch, teeth)
    assert np.abs(whole - 64.531650 * MM).max() < 0.02 * MM
    part = rack_lines(family, 0.6 * axial_pitch, teeth)
    assert part.mean() == pytest.approx(38.718990 * MM, rel=1e-3)
    assert part.min() == pytest.approx(29.569266 * MM, rel=3e-3)


def test_thinning_moves_the_helicoid_by_its_normal_share():
    family = public_design("P1")
    thick = replace(family, thinning=0.0).pinion_flanks[0]
    thin = family.pinion_flanks[0]
    moved = thick.base_radius * (thick.half_base_angle - thin.half_base_angle)
    assert moved == pytest.approx(family.thinning / (2 * thin.cosine), rel=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_the_error_is_a_curved_function_of_the_gear_axial(name):
    family, step = public_design(name), 5e-6
    at = [
        contact_line(family, 1, AssemblyErrors(gear_axial=k * step)).transmission_error
        for k in (-2, -1, 1, 2)
    ]
    third = (at[3] - 2 * at[2] + 2 * at[1] - at[0]) / (2 * step**3)
    assert 1e5 < abs(third) < 1e7


def test_the_place_along_the_pinion_is_not_the_gear_radius():
    family = public_design("P3")
    path = contact_path(family, contact_line(family, 1))
    point = path.line.point(path.middle)
    assert path.line.pinion_y(path.middle) == pytest.approx(159.87516730 * MM, abs=1e-11)
    assert np.hypot(point[0], point[1]) == pytest.approx(165 * MM, abs=0.1 * MM)


def test_the_shapers_involute_can_begin_outside_undercut():
    family = replace(public_design("P2"), gear_addendum=3.75 * MM)
    radius, reason, _ = family_limits(family).inner
    assert reason == "start of the involute"
    assert radius == pytest.approx(245.958 * MM, abs=1e-6)
    assert family_limits(family).starts[0].radius == pytest.approx(244.411 * MM, abs=1e-6)


def test_tapered_teeth_need_not_be_pointed_but_lose_their_root_outside():
    family = public_design("P2")
    assert family_limits(family).pointing == np.inf
    lands = shaper_land(family, family.middle + np.array([-0.5, 0.5]) * family.width)
    assert lands[1] < 0.1 * lands[0]
    roots = root_land(family, np.array([family.inner_radius, family.outer_radius]))
    assert roots[1] < 0.3 * roots[0]
    wide = replace(family, width=36 * MM)
    with pytest.raises(GeometryError, match="tip land of the shaper"):
        check_family(wide)


def test_the_sign_of_the_offset_against_the_hand_decides_which_flank_suffers():
    helical = public_design("P4")
    other = replace(helical, offset=-helical.offset)
    without = replace(helical, offset=0.0)
    coast = [family_limits(family).starts[1].radius for family in (helical, without, other)]
    assert coast[0] + 6 * MM < coast[1] < coast[2] - 8 * MM
    drive = [family_limits(family).starts[0].radius for family in (helical, without, other)]
    assert max(drive) - min(drive) < 2 * MM


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("name", ["P1", "P4"])
def test_a_sharp_edge_leaves_a_corner_where_it_moves_along_itself(name, side):
    """The closed form of the corner's radius is that of a cylindrical shaper at a right angle."""
    family = replace(public_design(name), shaper_tip_rounding=0.0)
    # at the lowest place the shaper's edge and the gear move against each other along the edge's direction
    tip, ratio = family.shaper_tip_radius, family.cutting_motion.ratio
    edge = tip / family.shaper_pitch_radius * tan(family.rack.helix_angle)
    corner = hypot(family.offset, tip / ratio + family.offset * edge)
    fillet = gear_fillet(family, side)
    assert fillet.smallest_radius(corner) < 1e-10
    assert fillet.smallest_radius(corner + 2 * MM) > 1e-6
    assert fillet.smallest_radius(corner - 2 * MM) > 1e-6


ROOTS = {
    # the gear's addendum mm, the flank that drives, gear radius mm, depth um of its tip edge in the root
    "P2": (3.75, 1, 252.0, 51.0),
    "P3": (3.0, -1, 159.0, 28.0),
    "P4": (4.0, 1, 229.0, 24.0),
}


def deepest_tip_edge(family, side, radius):
    """Return how deep (m) the gear's tip edge at a radius gets into a pinion that drives with this flank."""
    flank, line = gear_flank(family, side), contact_line(family, side)
    point = flank.point(*flank.parameters_at(radius, family.gear_tip.height(radius)))
    behind = line.transmission_error * family.motion.ratio / line.base_pitch
    angle, rolls = np.linspace(-0.45, 0.45, 91), np.linspace(-0.9, 0.9, 601)
    for _ in range(3):
        turned = turn_about_axis(-(angle * family.motion.ratio + behind), point)
        local = (turned - np.array([family.offset, 0.0, 0.0])) @ family.motion.basis.T
        depth = depth_in_pinion(family, body_turn(angle, local), rolls)
        best, step = angle[np.argmax(depth)], angle[1] - angle[0]
        angle = np.linspace(best - 2 * step, best + 2 * step, 21)
    return depth.max()


@pytest.mark.parametrize("name", ROOTS)
def test_a_high_gear_tip_cuts_into_a_rounded_pinion_root(name):
    addendum, side, radius, depth = ROOTS[name]
    module = public_design(name).rack.normal_module
    family = replace(public_design(name), gear_addendum=addendum * MM, rack_tip_radius=0.2 * module)
    found = deepest_tip_edge(family, side, radius * MM)
    assert abs(found * 1e6 - depth) < 0.5


@CASES
def test_the_public_designs_clear_each_others_roots(name, side):
    family = public_design(name)
    for radius in np.linspace(family.inner_radius, family.outer_radius, 5):
        assert deepest_tip_edge(family, side, radius) < 2e-8


REFUSED = {
    "P1": ({"inner_radius": 210 * MM}, "at least 214.598 mm .undercut of the drive flank."),
    "P3": ({"inner_radius": 156 * MM}, "at least 157.862 mm .undercut of the coast flank."),
    "P4": ({"outer_radius": 275 * MM}, "less than 271.479 mm, where the teeth are pointed"),
    "P2": ({"pinion_addendum": 9 * MM}, "tip land of the pinion"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_face_beyond_its_limits_is_refused_with_flank_and_reason(name):
    change, message = REFUSED[name]
    family = public_design(name)
    check_family(family)
    with pytest.raises(GeometryError, match=message):
        check_family(replace(family, **change))
