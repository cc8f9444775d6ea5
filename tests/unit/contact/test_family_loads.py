"""Loaded contact of every kind of teeth without finite elements: Hertz, lengths of lines, wrenches, poses."""

from dataclasses import replace
from math import cos, pi, radians, sin

import numpy as np
import pytest
from contact_bodies import STEEL
from family_pairs import public_pair
from lattice_bodies import FLANKS_ALONE, foundation, half_spaces, model_of, patch, whole_flank
from public_teeth import ERRORS, MM, NAMES, public_numbers
from references import against, agrees

from facegear.contact.hertz import contact_modulus
from facegear.contact.lines import contact_gaps, first_roll
from facegear.contact.ltca import check_overlap, even_positions, loaded_contact
from facegear.contact.nodal_loads import contact_wrenches, wrench_table
from facegear.contact.pressure import flank_pressure
from facegear.errors import InvalidInput
from facegear.teeth.bounded_contact import contact_path
from facegear.teeth.design import AssemblyErrors, FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.family_contact import contact_line
from facegear.teeth.limits import common_face
from facegear.teeth.pinion import tip_roll
from facegear.teeth.placement import mirror_design, pinion_angle

MODULUS = contact_modulus((STEEL, STEEL))
SIDES = {"drive": 1, "coast": -1}
FOUNDATION = foundation(1e13)
RACK_TEETH = 2_000_000


def place_of(design, s, line):
    """Return length of roll and y (m) on the pinion and the position (pitches) of the contact at s (m)."""
    flank = design.family.pinion_flanks[0]
    roll, y = float((s + line.pinion_lead) * flank.cosine), float(line.pinion_y(s))
    angle = (roll + flank.lead * (y - design.middle)) / flank.base_radius - line.pinion_slope - flank.phase
    return (roll, y), angle * design.pinion.teeth / (2 * pi) + 0.5


@against(
    "second implementation",
    "public designs of the family",
    capability="contact",
    module="facegear.contact.ltca",
)
@pytest.mark.parametrize("name", NAMES)
def test_light_contact_of_half_spaces_is_hertz_of_the_public_numbers(name):
    """A twenty-fifth of the public torque, whose ellipse one pair of teeth carries within the face."""
    design, share = public_pair(name), 0.04
    line = contact_line(design.family, 1)
    s = contact_path(design.family, line).middle
    long, short, pressure, approach = hertz_of(public_numbers(name))
    long, short, pressure = (value * share ** (1 / 3) for value in (long, short, pressure))
    centre, position = place_of(design, s, line)
    side = patch(design, centre, (short / 5, long / 24), (17, 53), -float(line.curvatures(s)[2]))
    model = model_of(design, side, half_spaces(MODULUS))
    result = loaded_contact(model, [position], [share * 500.0], FLANKS_ALONE)[0]
    agrees("approach, m", result.ste - result.unloaded_error, approach * share ** (2 / 3), relative=3e-3)
    loads = flank_pressure([result], model.flanks, (STEEL, STEEL)).loads[0]
    found = int(np.nanargmax(loads.pressure))
    agrees("pressure, Pa", loads.pressure[found], pressure, relative=5e-3)
    agrees("half-width of the ellipse, m", loads.half_width[found], short, relative=0.012)
    agrees("half-length of the ellipse, m", loads.length.sum() / 2, long, relative=0.03)


def hertz_of(numbers):
    """Return the public half axes (m), pressure (Pa) and approach (m) of the drive flank at 500 N m."""
    name = next(key for key in numbers if key.startswith("drive Hertz"))
    long, short, pressure, approach = numbers[name]
    return long * MM, short * MM, pressure * 1e6, approach * 1e-6


def flank_model(design, shape=(31, 21)):
    """Return the contact of the whole drive flank on a foundation."""
    return model_of(design, whole_flank(design, shape), FOUNDATION)


@against(
    "analytic",
    "axial force of a helicoid",
    capability="contact",
    module="facegear.contact.nodal_loads",
)
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("name", NAMES)
def test_axial_force_per_torque_is_the_helicoid_s_at_every_position_and_pose(name, side):
    design = public_pair(name)
    design = design if side == "drive" else mirror_design(design)
    posed = replace(design, assembly=AssemblyErrors(60e-6, radians(0.02), -40e-6, 150e-6))
    expected = public_numbers(name)[f"{side} force on pinion along its axis, along u N"][0]
    for pair in (design, posed):
        model = flank_model(pair)
        table = wrench_table(
            model.flanks.pinion, loaded_contact(model, even_positions(3), [50.0, 500.0], FLANKS_ALONE)
        )
        for torque, axial in zip(table["torque_n_m"], table["pinion_axial_n"], strict=True):
            agrees(
                "axial force, N",
                axial,
                expected * torque / 500.0,
                relative=1e-9,
                absolute=1e-9 * torque / 0.04,
            )


@pytest.mark.parametrize("name", NAMES)
def test_force_of_a_light_contact_is_along_the_public_normal_and_turns_both_gears(name):
    design = public_pair(name)
    line = contact_line(design.family, 1)
    _, position = place_of(design, contact_path(design.family, line).middle, line)
    model = flank_model(design, (61, 21))
    results = loaded_contact(model, [position], [5.0], FLANKS_ALONE)
    wrench = contact_wrenches(model.flanks.pinion, results)[0]
    force = np.array(public_numbers(name)["drive force on gear at 500 N m, x y z N"]) / 100.0
    assert wrench[:3] == pytest.approx(force, abs=5e-3 * np.linalg.norm(force))
    # moments about z: the gear's torque; about the pinion's axis: minus the torque that drives it
    ratio = design.face_gear.teeth / design.pinion.teeth
    assert wrench[5] == pytest.approx(-5.0 * ratio, rel=2e-3)


@against(
    "analytic",
    "virtual work",
    capability="contact",
    module="facegear.contact.nodal_loads",
)
@pytest.mark.parametrize("errors", [AssemblyErrors(), ERRORS], ids=["as designed", "displaced"])
@pytest.mark.parametrize("name", NAMES)
def test_wrench_is_the_derivative_of_the_transmission_error_by_the_pose(name, errors):
    """dTE/d(pose) of the loaded solution against its own wrench, with a rigid gear on a foundation."""
    design, torque, step = replace(public_pair(name), assembly=errors), 5.0, 0.2e-6
    line = contact_line(design.family, 1, errors)
    centre, position = place_of(design, contact_path(design.family, line).middle, line)
    axis = line.posed_frame[0].basis[1]
    model = model_of(design, patch(design, centre, (0.06 * MM, 1.2 * MM), (41, 25)), FOUNDATION)
    middle, force = np.array([design.offset, 0.0, 0.0]), torque / design.normal_arm
    # the error of the shaft angle tilts about the place that offset and shift of the gear put the middle to
    middle += design.middle * design.family.motion.basis[1] + [errors.offset, 0.0, errors.gear_axial]

    def error(**pose):
        moved = {way: getattr(errors, way) + size for way, size in pose.items()}
        posed = model.with_assembly(replace(errors, **moved))
        return loaded_contact(posed, [position], [torque], FLANKS_ALONE)[0].ste

    found = loaded_contact(model, [position], [torque], FLANKS_ALONE)[0]
    wrench = contact_wrenches(model.flanks.pinion, [found])[0]
    moment = wrench[3] - np.cross(middle, wrench[:3])[0]
    ways = {"offset": np.eye(3)[0], "gear_axial": np.eye(3)[2], "pinion_axial": axis}
    works = {name: wrench[:3] @ way for name, way in ways.items()}
    lengths = dict.fromkeys(ways, 1.0) | {"shaft_angle_error": design.middle}
    for name, work in (works | {"shaft_angle_error": moment}).items():
        small = step / lengths[name]
        slope = (error(**{name: small}) - error(**{name: -small})) / (2 * small)
        agrees(f"slope by {name}", slope, -work / force, absolute=2e-3 * lengths[name])


def rack_pair(overlap):
    """Return P1's pinion with a shaper of as many teeth on a gear so large that it is a helical rack."""
    module, helix = 3.5 * MM, radians(15)
    width = overlap * pi * module / sin(helix)
    middle = RACK_TEETH * module / cos(helix) / 2
    pinion = PinionGeometry(25, width, module, 1.25 * module, 0.1 * module, 0.02, middle=middle)
    gear = FaceGearGeometry(RACK_TEETH, middle - 0.6 * width, middle + 0.6 * width, module, 0.01)
    return PairDesign(module, radians(25), pinion, gear, Shaper(25, 1.25 * module), helix_angle=helix)


def line_lengths(design, positions, approach, shape):
    """Return the lengths (m) of all contact lines from the forces of a foundation at one approach (m).

    A foundation carries 4 sqrt(2 R)/3 k approach^1.5 per length; the factor is taken from the middle station
    of the longest line, which no edge cuts.
    """
    model, flank = flank_model(design, shape), design.family.pinion_flanks[0]
    pinion, lengths = model.flanks.pinion, []
    for position in positions:
        torque = 50.0
        for _ in range(8):
            result = loaded_contact(model, [position], [torque], FLANKS_ALONE)[0]
            factor = approach / (result.ste - result.unloaded_error)
            if abs(factor - 1.0) < 1e-5:
                break
            torque *= factor**1.5
        scaled = []
        for spot in result.spots:
            row, column = np.divmod(spot.hats, pinion.shape[1])
            s = pinion.side.u[row, column] * flank.base_radius / flank.cosine
            force, moment = np.zeros((2, pinion.shape[1]))
            np.add.at(force, column, spot.force)
            np.add.at(moment, column, spot.force * s)
            on = force > 0
            scaled.append(force[on] / np.sqrt(moment[on] / force[on]))
        step = design.pinion.width / (shape[1] - 1) / flank.cosine
        whole = max(np.median(values) for values in scaled if values.size > shape[1] // 2)
        lengths.append(step * sum(values.sum() for values in scaled) / whole)
    return np.array(lengths)


@against(
    "analytic",
    "lengths of contact of helical gears",
    capability="contact",
    module="facegear.contact.ltca",
)
@pytest.mark.parametrize(
    ("overlap", "mean", "smallest"), [(1.0, 64.531650, 64.531650), (0.6, 38.718990, 29.569266)]
)
def test_lines_of_a_helical_pinion_on_a_rack_have_the_lengths_of_helical_gears(overlap, mean, smallest):
    """Whole overlap: constant; else with the mean of it and the minimum of the standards."""
    positions = even_positions(12)
    lengths = line_lengths(rack_pair(overlap), positions, 3e-6, (81, 25)) / MM
    agrees("mean length, mm", lengths.mean(), mean, relative=5e-3)
    if overlap == 1.0:  # the same at every position
        agrees("shortest of all positions, mm", lengths.min(), mean, relative=7e-3)
        agrees("longest of all positions, mm", lengths.max(), mean, relative=7e-3)
    lowest = positions[int(np.argmin(lengths))]
    near = line_lengths(rack_pair(overlap), [lowest - 0.03, lowest + 0.03], 3e-6, (81, 25)) / MM
    # strips of 0.3 mm smooth the corner in which one line ends while another begins
    agrees("smallest length, mm", min(lengths.min(), near.min()), smallest, relative=1.5e-2)


def test_an_axial_pitch_outwards_turns_a_wide_helical_pinion_by_one_tooth():
    """All contact comes back with the next pair of teeth, at another place of the pinion's face."""
    narrow = public_pair("P1")
    design = replace(narrow, pinion=replace(narrow.pinion, width=0.12))
    flank = design.family.pinion_flanks[0]
    pitch = 2 * pi * design.normal_arm / (design.pinion.teeth * flank.sine)
    line = contact_line(design.family, 1)
    (roll, y), position = place_of(design, contact_path(narrow.family, line).middle, line)
    found = []
    for outwards in (0.0, pitch):
        side = patch(design, (roll, y - outwards), (0.15 * MM, 1.0 * MM), (41, 21))
        model = model_of(design, side, FOUNDATION).with_assembly(AssemblyErrors(pinion_axial=outwards))
        found.append(loaded_contact(model, [position], [100.0], FLANKS_ALONE)[0])
    assert found[1].ste - found[1].unloaded_error == pytest.approx(
        found[0].ste - found[0].unloaded_error, rel=1e-9
    )
    np.testing.assert_allclose(found[1].load_share[:-1], found[0].load_share[1:], atol=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_a_pinion_like_the_shaper_touches_along_whole_lines(name):
    design = public_pair(name)
    teeth = design.shaper.teeth
    pinion = replace(design.pinion, teeth=teeth, thinning=0.0)
    design = replace(design, pinion=pinion)
    y = np.linspace(*common_face(design), 15)
    phi1 = pinion_angle(design, np.array([0.2, 0.7]))
    phi2 = phi1 * teeth / design.face_gear.teeth
    placement = np.repeat(phi1, 3), np.repeat(phi2, 3), np.tile([-1.0, 0.0, 1.0], 2)
    roll, gap, _ = contact_gaps(design, placement, y)
    inside = (roll > 1.001 * first_roll(design, y)) & (roll < 0.999 * tip_roll(design, y)) & np.isfinite(gap)
    assert np.count_nonzero(inside) > 15
    assert np.abs(gap[inside]).max() < 2e-9


def test_teeth_that_overlap_too_far_are_refused_in_one_line():
    narrow = public_pair("P1")
    check_overlap(narrow)
    wide = replace(narrow, helix_angle=radians(35), pinion=replace(narrow.pinion, width=0.12))
    with pytest.raises(
        InvalidInput, match=r"overlap of the teeth .* must be at most 2\.5: a smaller helix angle"
    ):
        check_overlap(wide)
