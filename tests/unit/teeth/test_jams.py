"""Bodies whose fillets and tips leave no room for the teeth of the other gear."""

from dataclasses import replace

import numpy as np
import pytest
from family_pairs import public_pair

from facegear.errors import FacegearError
from facegear.pipeline.stages.teeth import geometry
from facegear.teeth.analysis import analyse, jam

DEEP = {"shaper_teeth": 24, "rack_tip_radius": 0.25}
"""The gear's tip edge stands 51 um deep in the pinion's fillet on either side (numerics.md)."""


def test_tips_in_fillets_on_both_sides_jam_by_twice_their_depth_less_the_backlash(pair):
    design = pair(**DEEP, thinning=60e-6)
    assert jam(design, analyse(design)).depth == pytest.approx(2 * 51e-6 - 60e-6, abs=2e-6)


def test_with_backlash_to_clear_them_tips_in_fillets_do_not_jam(pair):
    design = pair(**DEEP, thinning=110e-6)
    found = analyse(design, 8)
    assert found.interference is not None
    assert jam(design, found) is None


def test_a_tip_in_the_root_land_jams_at_every_turn(pair):
    usual = pair(thinning=1e-3, gear_axial=-1e-4)
    tall = replace(usual, face_gear=replace(usual.face_gear, addendum=1.24 * usual.module))
    found = analyse(tall, 8)
    assert found.interference is not None
    assert jam(tall, found).depth == np.inf


def test_a_jam_is_refused_with_its_amount(pair, monkeypatch):
    """It was a remark in the report, and contact left it out."""
    design = pair(**DEEP)
    monkeypatch.setattr("facegear.pipeline.stages.teeth.pair", lambda _: type("Pair", (), {"design": design}))
    with pytest.raises(FacegearError) as caught:
        geometry(None)
    assert str(caught.value).startswith("tooth_pair: the bodies jam by 101.2 um along the line of action: ")
    assert "the gear's tip edge stands 47.5 um deep in the pinion's fillet" in str(caught.value)


@pytest.mark.parametrize("name", ["P1", "P2"])
def test_a_jam_of_other_teeth_is_found_without_a_number_that_is_not_one(name):
    """Points beyond the reach of the search stand at an infinite distance before and after the turn."""
    usual = public_pair(name, thinning=0.0)
    tall = replace(usual, face_gear=replace(usual.face_gear, addendum=1.2 * usual.module))
    with np.errstate(invalid="raise"):
        assert 1e-4 < jam(tall, analyse(tall, 4)).depth < 1e-3
