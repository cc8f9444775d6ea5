import numpy as np

from facegear.geometry.design import FaceGearGeometry, PairDesign, PinionGeometry, Shaper
from facegear.geometry.unloaded import unloaded_contact


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
