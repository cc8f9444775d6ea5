"""Functions of a pair describe every kind of teeth: closed forms, public numbers, mirror rule, feet and gaps.

The closed forms of `tooth_family` and its neighbours are confirmed elsewhere; functions of `PairDesign` are
held to them here on both flanks, the coast side by `placement.mirror_teeth` and a mirror.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
from family_pairs import public_pair, random_pairs
from public_teeth import CROWNING_UM, ERRORS, MM, NAMES, crowning, public_numbers
from scipy.optimize import minimize_scalar

from facegear.teeth import face_gear, face_gear_fillet, pinion
from facegear.teeth.analysis import REGULAR_CONTACTS
from facegear.teeth.bounded_contact import modified_contact
from facegear.teeth.clearance import smallest_gaps
from facegear.teeth.conjugate import exact_contact
from facegear.teeth.curvature import relative_curvatures
from facegear.teeth.design import AssemblyErrors
from facegear.teeth.family_contact import contact_line
from facegear.teeth.flank_shapes import DeviationGrid, Flanks
from facegear.teeth.generated_fillet import gear_fillet
from facegear.teeth.generated_flank import gear_flank
from facegear.teeth.helicoid import PinionFlank, pinion_fillet
from facegear.teeth.opposite import fillet_curve, tip_edge_feet
from facegear.teeth.placement import conjugate_angle, mirror_teeth, pair_at, to_pinion_section
from facegear.teeth.surfaces import fillet_points, flank_face, flank_points, nominal_points
from facegear.teeth.unloaded_contact import normal_backlash, unloaded_motion

MIRROR = np.array([-1.0, 1.0, 1.0])
RANDOM = 12
CASES = [*NAMES, *range(RANDOM)]
LENGTH, ANGLE = 1e-12, 1e-11


@pytest.fixture(scope="module")
def pairs():
    """Public designs by name and random ones by number."""
    return {name: public_pair(name) for name in NAMES} | dict(enumerate(random_pairs(RANDOM)))


def sides_of(design):
    """Yield the sign of each flank, the pair whose functions describe it, and the mirror to the frame."""
    yield 1, design, np.ones(3)
    yield -1, mirror_teeth(design), MIRROR


@pytest.mark.parametrize("case", CASES)
def test_pinion_flanks_and_roots_are_the_familys(pairs, case):
    design = pairs[case]
    family, y = design.family, design.middle + np.array([-0.5, 0.1, 0.5]) * design.pinion.width
    for sign, pair, mirror in sides_of(design):
        helicoid = family.pinion_flanks[sign < 0]
        low, high = pinion.roll_ends(pair, y)
        roll = low + np.linspace(0.0, 1.0, 4)[:, None] * (high - low)
        found, flank = flank_points(pair, roll, y), PinionFlank(helicoid)
        length = helicoid.base_radius * roll
        assert np.abs(mirror * found.position - flank.point(length, y)).max() < LENGTH
        assert np.abs(mirror * found.normal - flank.normal(length, y)).max() < LENGTH
        assert found.lever_arm == pytest.approx(pair.normal_arm, rel=1e-12)
        tips = np.hypot(found.position[-1, :, 0], found.position[-1, :, 2])
        assert tips == pytest.approx(pinion.tip_radius(design, y), abs=LENGTH)
        gamma = np.linspace(helicoid.pressure_angle, np.pi / 2, 4)[:, None]
        found, root = fillet_points(pair, gamma, y), pinion_fillet(family, sign)
        assert np.abs(mirror * found.position - root.point(gamma, y)).max() < LENGTH
        assert np.abs(mirror * found.normal - root.normal(gamma, y)).max() < LENGTH
        bottom = np.hypot(found.position[-1, :, 0], found.position[-1, :, 2])
        assert bottom == pytest.approx(pinion.root_radius(design, y), abs=LENGTH)
        starts = pinion.involute_point(pair, low, y), pinion.trochoid_point(pair, helicoid.pressure_angle, y)
        assert np.abs(starts[0][0] - starts[1][0]).max() < 2e-6 * abs(design.taper_angle) + LENGTH


@pytest.mark.parametrize("case", CASES)
def test_root_lands_of_the_pinion_meet_in_the_middle_of_the_space(pairs, case):
    design = pairs[case]
    y = design.middle + np.array([-0.5, 0.0, 0.5]) * design.pinion.width
    right, left = pinion.root_angle(design, y), pinion.root_angle(mirror_teeth(design), y)
    assert right + left == pytest.approx(2 * np.pi / design.pinion.teeth, abs=1e-14)


@pytest.mark.parametrize("case", CASES)
def test_gear_flanks_and_fillets_are_the_familys(pairs, case):
    design = pairs[case]
    gear, family = design.face_gear, design.family
    radius = np.linspace(gear.inner_radius, gear.outer_radius, 5)
    for sign, pair, mirror in sides_of(design):
        # functions show the gear's left flank in a mirror, and in the mirror's mirror its right one
        flank, fillet = gear_flank(family, sign), gear_fillet(family, sign)
        back = np.array([-mirror[0], 1.0, 1.0])
        top, end = face_gear.tip_parameters(pair, radius)[0], face_gear.end_parameters(pair, radius)[0]
        roll = top + np.linspace(0.0, 1.0, 4)[:, None] * (end - top)
        psi = face_gear.psi_at(pair, radius, roll)
        s = pair.shaper_base_radius * roll
        points = back * face_gear.flank_point(pair, roll, psi)
        assert np.abs(points - flank.point(psi, s)).max() < LENGTH
        assert np.abs(back * face_gear.flank_normal(pair, roll, psi) - flank.normal(psi, s)).max() < LENGTH
        assert np.abs(np.hypot(points[..., 0], points[..., 1]) - radius).max() < LENGTH
        assert np.abs(points[0, :, 2] - face_gear.tip_height(design, radius)).max() < LENGTH
        for fraction in (0.0, 1.0):
            slope = face_gear_fillet.fillet_slopes(pair, radius, fraction)
            angle, height = face_gear_fillet.fillet_section(pair, radius, slope)
            expected = fillet.point(fillet.y_at(radius, fraction), fraction)
            assert np.abs(back * face_gear.cylindrical(radius, angle, height) - expected).max() < LENGTH
        assert np.abs(points[-1] - fillet.point(fillet.y_at(radius, 0.0), 0.0)).max() < LENGTH
        assert np.abs(height - face_gear_fillet.root_height(design, radius)).max() < LENGTH
        half = face_gear_fillet.root_half_angle(pair, radius)
        assert np.abs(angle + half - face_gear_fillet.root_land_middle(pair, radius)).max() < ANGLE


@pytest.mark.parametrize("name", NAMES)
def test_nominal_points_of_both_gear_flanks_are_the_public_ones(pairs, name):
    design, compared = pairs[name], 0
    face = flank_face(design, "face_gear")
    for key, value in public_numbers(name).items():
        found = re.fullmatch(r"(drive|coast) flank at R ([\d.]+) mm, ([\d.]+) mn below the tip", key)
        if found is None:
            continue
        side = "left" if found[1] == "drive" else "right"
        place = np.array([float(found[2]) * MM]), np.array([float(found[3]) * design.module])
        points, normals = (part[0, 0] for part in nominal_points(face, side, *place))
        assert abs(points[2] - value["z_mm"] * MM) < LENGTH
        assert abs(np.arctan2(points[0], points[1]) - value["gear_angle_rad"]) < ANGLE
        assert np.abs(normals - value["normal"]).max() < ANGLE
        compared += 1
    assert compared == 5


@pytest.mark.parametrize("name", NAMES)
def test_nominal_points_of_the_left_pinion_flank_are_no_reflection(pairs, name):
    design = pairs[name]
    along, across = np.array([-0.4, 0.3]) * design.pinion.width, np.array([0.014, 0.02])
    face = flank_face(design, "pinion")
    points, normals = nominal_points(face, "left", along, across)
    flank, y = PinionFlank(design.family.pinion_flanks[1]), design.middle + along[:, None]
    assert np.abs(points - flank.point(across, y)).max() < LENGTH
    assert np.abs(normals - flank.normal(across, y)).max() < LENGTH
    reflected = nominal_points(face, "right", along, across)[0] * MIRROR
    assert bool(np.abs(points - reflected).max() < 1e-9) is design.is_symmetric


@pytest.mark.parametrize("name", NAMES)
def test_fillets_roots_and_lands_of_a_pair_are_the_public_ones(pairs, name):
    design, numbers = pairs[name], public_numbers(name)
    mean = design.mean_radius
    assert abs(face_gear.tip_height(design, mean) - numbers["tip height z at mean radius mm"] * MM) < LENGTH
    root = face_gear_fillet.root_height(design, mean)
    assert abs(root - numbers["root height z at mean radius mm"] * MM) < LENGTH
    end = design.middle + design.pinion.width / 2
    land = pinion.tip_half_angle(design, end) + pinion.tip_half_angle(mirror_teeth(design), end)
    land *= pinion.tip_radius(design, end)
    assert abs(land - numbers["pinion tip land at outer end mm"] * MM) < LENGTH
    for side, (_, pair, mirror) in zip(("drive", "coast"), sides_of(design), strict=True):
        start = face_gear_fillet.fillet_start(pair, mean)
        angle, height = face_gear_fillet.fillet_section(pair, mean, start)
        expected = next(
            value
            for key, value in numbers.items()
            if key.startswith(f"{side} fillet at R") and abs(float(key.split()[4]) * MM - mean) < 1e-9
        )
        assert abs(height - expected["start_z_mm"] * MM) < LENGTH
        assert abs(-mirror[0] * angle - expected["start_gear_angle_rad"]) < ANGLE
        expected = numbers[f"{side} pinion form radius at ym mm"]
        junction = pinion.junction_roll(pair, design.middle)
        form, _ = pinion.involute_point(pair, junction, design.middle)
        assert abs(form - expected * MM) < LENGTH


@pytest.mark.parametrize("case", CASES)
def test_the_back_pair_is_the_coast_side_and_the_lower_pair_the_other_gear(pairs, case):
    """Traps 1 and 2: the mirror rule, and two different gears beside one pinion."""
    design = replace(pairs[case], assembly=ERRORS)
    for gear, family in (("upper", design.family), ("lower", design.family.below)):
        drive, back = pair_at(design, gear, "drive"), pair_at(design, gear, "back")
        assert drive.family.offset == family.offset
        assert drive.family.shaft_angle == pytest.approx(family.shaft_angle, abs=1e-15)
        assert back.family.rack == family.mirror_image.rack
        signs = {"upper": 1.0, "lower": -1.0}[gear]
        assert drive.assembly == replace(
            ERRORS, offset=signs * ERRORS.offset, shaft_angle_error=signs * ERRORS.shaft_angle_error
        )
        lines = contact_line(drive.family, -1, drive.assembly), contact_line(back.family, 1, back.assembly)
        if lines[0] is None:
            assert lines[1] is None
            continue
        assert abs(lines[0].transmission_error + lines[1].transmission_error) < 1e-15
        assert np.abs(lines[0].foot - MIRROR * lines[1].foot).max() < LENGTH
    is_one_gear = design.offset == 0.0 and design.shaft_angle == np.pi / 2
    assert (pair_at(design, "lower", "drive").family == design.family) is is_one_gear


@pytest.mark.parametrize("case", CASES)
def test_relative_curvatures_on_the_path_are_those_of_the_contact_line(pairs, case):
    design = pairs[case]
    line = contact_line(design.family, 1)
    s = np.linspace(0.3, 0.6, 3) * line.gear.pitch_distance + 0.5 * line.gear.pitch_distance
    large, small, angle = relative_curvatures(design, s / design.shaper_base_radius, line.psi)
    expected = line.curvatures(s)
    assert large == pytest.approx(expected[0], rel=1e-9)
    assert small == pytest.approx(expected[1], rel=1e-7, abs=1e-9)
    assert angle == pytest.approx(expected[2], abs=1e-8)


def nearest_point(surface, point, starts):
    """Return the smallest distance (m) of a point from a surface of two parameters, from many starts."""
    best = np.inf
    for start in starts:
        place = np.array(start)
        for _ in range(40):
            away = point - surface.point(*place)
            tangents = np.stack(surface.tangents(*place), axis=-1)
            step = np.linalg.lstsq(tangents, away, rcond=None)[0]
            place = place + np.clip(step, [-0.1, -1e-3], [0.1, 1e-3]) * 0.9
        best = min(best, float(np.linalg.norm(point - surface.point(*place))))
    return best


@pytest.mark.parametrize("name", NAMES)
def test_feet_of_the_gears_tip_edge_are_those_of_brute_force(pairs, name):
    design = public_pair(name)
    for pair in (design, mirror_teeth(design)):
        gear, family = pair.face_gear, pair.family
        radius = np.linspace(gear.inner_radius, gear.outer_radius, 4)
        edge = face_gear.tip_edge(pair, radius) * MIRROR
        phi1 = np.linspace(-0.25, 0.15, 5)
        placement = phi1, conjugate_angle(pair, phi1), np.zeros(5)
        curve = fillet_curve(pair, family.pinion_flanks[0].pressure_angle, np.pi / 2)
        feet = tip_edge_feet(pair, edge, placement, curve, 0.3 * pair.module)
        section = to_pinion_section(pair, *placement[:2], np.zeros((5, 1))).points(edge)[:, 0]
        points = section[..., [0, 2, 1]] * [1.0, 1.0, -1.0]
        compared = {"flank": 0, "fillet": 0}
        for row, column in zip(*np.nonzero(np.abs(feet.gap) < 0.2 * pair.module), strict=True):
            kind = "flank" if np.isfinite(feet.flank[row, column]) else "fillet"
            surface = PinionFlank(family.pinion_flanks[0]) if kind == "flank" else pinion_fillet(family, 1)
            y = feet.y[row, column]
            firsts = np.linspace(0.3, 0.8, 3) * family.pinion_flanks[0].base_radius
            if kind == "fillet":
                firsts = np.linspace(0.5, 1.5, 3)
            distance = nearest_point(surface, points[row, column], [(first, y) for first in firsts])
            assert abs(abs(feet.gap[row, column]) - distance) < 1e-9
            compared[kind] += 1
        assert compared["flank"] > 0


ROOTS = {
    # the gear's addendum mm, whether the coast flank drives, inner gear radius mm, depth um in the root
    "P2": (3.75, False, 252.0, 51.0),
    "P3": (3.0, True, 159.0, 28.0),
    "P4": (4.0, False, 229.0, 24.0),
}


def gaps_at_contact(design, positions):
    """Return the smallest gaps of a pair where its drive flanks touch, without errors."""
    phi1 = np.linspace(-0.5, 0.5, positions) * 2 * np.pi / design.pinion.teeth
    return smallest_gaps(design, phi1, unloaded_motion(design, phi1)[0])


@pytest.mark.parametrize("name", ROOTS)
def test_clearance_shows_how_deep_a_high_gear_tip_cuts_into_a_rounded_root(name):
    """Trap 10, with its numbers, each flank where it drives."""
    addendum, is_coast, radius, depth = ROOTS[name]
    design = public_pair(name)
    gear = replace(design.face_gear, addendum=addendum * MM, inner_radius=radius * MM)
    design = replace(
        design, face_gear=gear, pinion=replace(design.pinion, rack_tip_radius=0.2 * design.module)
    )
    gap = gaps_at_contact(mirror_teeth(design) if is_coast else design, 81)["fillet", "tip edge"]
    assert gap.side == "drive"
    assert abs(-gap.gap * 1e6 - depth) < 0.5
    assert gap.radius == pytest.approx(radius * MM, abs=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_the_public_pairs_clear_each_others_roots(pairs, name):
    for pair in (pairs[name], mirror_teeth(pairs[name])):
        gaps = gaps_at_contact(pair, 33)
        assert ("fillet", "tip edge") in gaps
        assert all(gap.gap > -2e-8 for parts, gap in gaps.items() if parts not in REGULAR_CONTACTS)
        assert abs(gaps["flank", "flank"].gap) < 2e-7


def crowned(design, amounts_um):
    """Return a pair whose pinion's deviations take the public crowning off its right flank."""
    removal, base = crowning(design.family, amounts_um), design.pinion_base_radius
    y = np.linspace(-0.5, 0.5, 6) * design.pinion.width
    length = np.linspace(0.5 * base * pinion.junction_roll(design, design.middle), 1.2 * base * 0.8, 7)
    depth = removal(length, design.middle + y[:, None])
    grid = DeviationGrid(tuple(y), tuple(length), tuple(map(tuple, -depth)))
    return replace(design, pinion=replace(design.pinion, flanks=Flanks(right=grid)))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("errors", [AssemblyErrors(), ERRORS])
def test_crowning_of_a_pair_gives_the_motion_of_the_same_removal(pairs, name, errors):
    design = crowned(pairs[name], CROWNING_UM[name])
    base, family = design.pinion_base_radius, design.family
    angle = np.linspace(0.0, 2 * np.pi / family.pinion_teeth, 9)

    def removal(roll, y):
        return pinion.removed_depth(design, roll / base, y)

    found = modified_contact(family, 1, angle, removal, errors)
    expected = modified_contact(family, 1, angle, crowning(family, CROWNING_UM[name]), errors)
    assert np.abs(found.transmission_error - expected.transmission_error).max() < 2e-14


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("errors", "words"), [(AssemblyErrors(), "nominal"), (ERRORS, "with errors")])
def test_the_crowned_pairs_unloaded_motion_has_the_public_extremes(pairs, name, errors, words):
    """The closed forms say at which angles; the search of the pair, which knows all edges, says how far."""
    design = replace(crowned(pairs[name], CROWNING_UM[name]), assembly=errors)
    family, removal = design.family, crowning(design.family, CROWNING_UM[name])
    pitch = 2 * np.pi / family.pinion_teeth

    def contact(angle):
        return modified_contact(family, 1, angle, removal, errors)

    angle = np.linspace(0.0, pitch, 25)
    error, step = contact(angle).transmission_error, pitch / 24
    highest = minimize_scalar(
        lambda at: -contact(at).transmission_error[0],
        bounds=(angle[np.argmax(error)] - step, angle[np.argmax(error)] + step),
        method="bounded",
        options={"xatol": 1e-6},
    ).x
    low, high = angle[np.argmin(error)] + np.array([-step, step])
    before = contact(low).pair[0]
    for _ in range(36):
        middle = (low + high) / 2
        low, high = (middle, high) if contact(middle).pair[0] == before else (low, middle)
    largest, smallest = unloaded_motion(design, [highest, low])[1] * 1e6
    expected = public_numbers(name)[f"crowned pinion, drive, {words}: te largest, peak to peak um"]
    assert abs(largest - expected[0]) < 2e-8
    assert abs(largest - smallest - expected[1]) < 2e-8


@pytest.mark.parametrize("name", NAMES)
def test_backlash_along_the_normal_is_the_public_one(pairs, name):
    design, numbers = pairs[name], public_numbers(name)
    scale = design.gear_normal_arm / design.family.gear_pitch_radius
    nominal = normal_backlash(design) / scale
    assert abs(nominal * 1e6 - numbers["backlash at gear pitch circle um"]) < 1e-9
    outwards = normal_backlash(replace(design, assembly=AssemblyErrors(pinion_axial=1 * MM))) / scale
    assert abs((outwards - nominal) * 1e6 - numbers["its change by 1 mm outwards um"]) < 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_contact_as_assembled_is_the_public_one(pairs, name):
    for side, pair in zip(("drive", "coast"), (pairs[name], mirror_teeth(pairs[name])), strict=True):
        sign = 1.0 if side == "drive" else -1.0
        design = replace(pair, assembly=replace(ERRORS, offset=sign * ERRORS.offset))
        contact, numbers = exact_contact(design), public_numbers(name)
        expected = numbers[f"{side} with errors: te along the normal um"] * 1e-6
        assert abs(sign * contact.transmission_error - expected) < 1e-15
        phi1 = np.linspace(-0.1, 0.1, 3)
        phi2, error = unloaded_motion(design, phi1)
        assert np.abs(error - sign * expected).max() < 1e-15
        turn = (phi2 - conjugate_angle(design, phi1)) * design.gear_normal_arm
        assert np.abs(turn - sign * expected).max() < 1e-14
        line = contact_line(design.family, 1, design.assembly)
        roll, y = contact.pinion_place(design.family.pinion_flanks[0], 0.05)
        on_pinion = flank_points(design, roll, y)
        placed = line.helicoid.cosine * (roll * design.pinion_base_radius)
        assert placed > 0.0
        assert abs(on_pinion.normal[1] - line.helicoid.sine) < 1e-15
