"""Unloaded contact in closed form: against published numbers, against search, and beyond the face."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from references import against, agrees

from facegear.teeth.conjugate import conjugate_contact, exact_contact
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.placement import mirror_design
from facegear.teeth.unloaded_contact import normal_backlash, searched_contact, unloaded_contact

POSES = {
    (120, 0, 0.03): ((58.763527287, 264.388284, 23.213899), (159.915598075, 269.136890, 25.468187)),
    (-170, 0, 0): ((-202.938890664, 272.215998, 26.787096), (-105.111990312, 264.630971, 23.324938)),
    (200, 92, 0): ((98.248447048, 260.101140, 20.890039), (270.142134608, 268.191282, 25.030350)),
    (0, 0, -0.05): ((-47.301252948, 271.306433, 26.387864), (47.301252948, 271.306433, 26.387864)),
}
"""Offset and axial shift (um), error of the shaft angle (deg): transmission error (um), path (mm) and slope
of the normal (deg) of the drive and the back flank, computed once by displacing bodies in another program."""


@pytest.fixture(scope="module")
def posed(pair):
    def build(offset_um=0.0, shift_um=0.0, angle_deg=0.0, **design):
        errors = {"offset": 1e-6 * offset_um, "gear_axial": 1e-6 * shift_um}
        return pair(thinning=1e-4, shaft_angle_error=np.radians(angle_deg), **errors, **design)

    return build


@against(
    "second implementation",
    "a pair displaced rigidly and searched at 1e-13 m",
    capability="geometry",
    module="facegear.teeth.conjugate",
)
@pytest.mark.parametrize("pose", POSES)
def test_a_displaced_pair_touches_where_the_published_numbers_have_it(posed, pose):
    design = posed(*pose)
    flanks = [exact_contact(design), exact_contact(mirror_design(design))]
    errors = [1e6 * flank.transmission_error for flank in flanks]
    expected = np.array(POSES[pose])
    agrees("transmission error, um", [errors[0], -errors[1]], expected[:, 0], absolute=1e-9)
    agrees("path, mm", [1e3 * flank.y for flank in flanks], expected[:, 1], absolute=6e-7)
    agrees("slope, deg", [np.degrees(flank.psi) for flank in flanks], expected[:, 2], absolute=6e-7)
    agrees("backlash, um", 1e6 * normal_backlash(design), expected[1, 0] - expected[0, 0], absolute=2e-9)


@settings(max_examples=8, deadline=None)
@given(st.floats(-120, 120), st.floats(-60, 60), st.floats(-0.03, 0.03), st.floats(-0.13, 0.13))
def test_the_closed_form_is_that_of_a_search_over_the_flanks(posed, offset, shift, angle, phi1):
    design = posed(offset, shift, angle)
    exact, search = exact_contact(design), searched_contact(design, [phi1])
    assert exact.transmission_error == pytest.approx(search.transmission_error[0], abs=1e-14)
    roll, y = search.path
    contact = unloaded_contact(design, [phi1])
    assert np.abs(contact.gap.min()) < 1e-11
    assert exact.y == pytest.approx(y[0], abs=2e-6)
    tooth = int(search.tooth[0])
    assert exact.normal_roll + phi1 + tooth * 2 * np.pi / 23 == pytest.approx(roll[0], abs=2e-5)


@settings(max_examples=12, deadline=None)
@given(st.floats(-300, 300), st.floats(-150, 150), st.floats(-0.08, 0.08))
@example(0.0, 0.0, 0.0)
def test_the_transmission_error_changes_with_a_shift_by_the_common_normal(posed, offset, shift, angle):
    """Its slope by the slope of the normal vanishes, so that the force acts along the exact normal."""
    design, step = posed(offset, shift, angle), 1e-7
    contact = conjugate_contact(design)

    def error(**moved):
        errors = replace(
            design.assembly, **{key: getattr(design.assembly, key) + by for key, by in moved.items()}
        )
        return conjugate_contact(replace(design, assembly=errors)).transmission_error

    by_offset = (error(offset=step) - error(offset=-step)) / (2 * step)
    by_shift = (error(gear_axial=step) - error(gear_axial=-step)) / (2 * step)
    assert by_offset == pytest.approx(np.cos(contact.psi) * np.cos(contact.turn), abs=1e-7)
    assert by_shift == pytest.approx(-np.sin(contact.psi), abs=1e-7)


def test_along_the_line_of_action_the_contact_does_not_move(posed):
    moved = 2e-4
    angle = np.radians(25.0)
    design = posed(1e6 * moved * np.cos(angle), -1e6 * moved * np.sin(angle))
    contact = exact_contact(design)
    assert contact.y == pytest.approx(268.125e-3, abs=1e-12)
    assert contact.transmission_error == pytest.approx(moved - 0.5e-4, abs=1e-15)


def test_beyond_the_face_the_edge_touches_and_the_closed_form_is_not_used(posed):
    design = posed(-340.0)
    assert conjugate_contact(design).y > design.face_gear.outer_radius
    assert exact_contact(design) is None
    contact = unloaded_contact(design, [0.02])
    assert contact.path[1][0] == pytest.approx(design.face_gear.outer_radius, abs=1e-4)
    assert contact.transmission_error[0] < conjugate_contact(design).transmission_error


def test_modified_flanks_and_lines_of_contact_are_left_to_the_search(posed):
    design = posed(50.0)
    relieved = replace(design, pinion=replace(design.pinion, tip_relief=Relief(1e-5, 0.0, 1e-3)))
    assert exact_contact(design) is not None
    assert exact_contact(relieved) is None
    assert exact_contact(posed(shaper_teeth=23)) is None
