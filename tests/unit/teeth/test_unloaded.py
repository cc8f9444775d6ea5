from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.teeth.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.teeth.flank_shapes import Relief
from facegear.teeth.unloaded_contact import unloaded_contact, unloaded_motion


def test_a_touch_of_edges_where_each_turn_leaves_half_of_the_gap_is_found():
    pinion = PinionGeometry(
        teeth=19, width=3e-3, addendum=3.15e-3, dedendum=3.75e-3, rack_tip_radius=0.0, bore_radius=12.375e-3
    )
    gear = FaceGearGeometry(
        teeth=105, inner_radius=0.138530235488, outer_radius=0.141530235488, addendum=3e-3, rim_thickness=3e-3
    )
    design = PairDesign(3e-3, np.radians(30.0), pinion, gear, Shaper(19, 3.1875e-3, 0.3e-3))
    contact = unloaded_contact(design, np.linspace(-0.5, 0.5, 9) * 2 * np.pi / 19)
    assert np.abs(contact.gap.min(axis=1)).max() < 1e-11


@settings(max_examples=6, deadline=None)
@given(st.floats(0, 40), st.floats(0, 30), st.floats(-100, 100), st.floats(-0.05, 0.05))
def test_the_motion_is_that_of_all_pairs_though_only_those_that_can_touch_are_followed(
    pair, relief, crowning, offset, angle
):
    made = {"tip_relief": Relief(1e-6 * relief, length=2e-3), "offset": 1e-6 * offset}
    flat = pair(shaft_angle_error=np.radians(angle), **made)
    design = replace(flat, pinion=replace(flat.pinion, lead_crowning=Relief(1e-6 * crowning, length=12e-3)))
    phi1 = np.linspace(-0.13, 0.13, 9)
    phi2, error = unloaded_motion(design, phi1)
    contact = unloaded_contact(design, phi1)
    assert error == pytest.approx(contact.transmission_error, abs=2e-12)
    assert phi2 == pytest.approx(contact.phi2, abs=1e-11)
