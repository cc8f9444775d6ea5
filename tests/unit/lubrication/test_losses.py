"""Loss factors in closed form, and the same through the loads and vectors of a spur twin."""

from dataclasses import replace
from math import pi, radians, sqrt

import numpy as np
import pytest
from closed_losses import section_loss_factor, spur_loss_factor
from contact_bodies import STEEL, pair_design
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees
from spur_path import SpurPath, c40

from facegear.contact.hertz import contact_modulus
from facegear.lubrication.loss import OverTorque, loss_factors

TORQUE, WIDTH, SPEED = 215.5, 0.040, 1800 * pi / 30


@against(
    "analytic",
    "Ohlendorf's loss factor of spur gears",
    capability="lubrication machine_loss",
    module="facegear.lubrication.loss",
)
@pytest.mark.parametrize(("approach", "recess"), [(0.8, 0.7), (0.65, 0.9), (0.5, 0.55)])
@pytest.mark.parametrize("ratio", [1.5, 5.0])
def test_spur_twin_has_ohlendorf_s_loss_factor(approach, recess, ratio):
    """Kinks of the load lie between the positions, so that their mean is the integral."""
    base = 0.04 * np.cos(radians(25.0))
    path = SpurPath((base, ratio * base), radians(25.0), approach, recess, 23)
    found = loss_factors(path.hats(200)).mean[0]
    agrees("loss factor", found, spur_loss_factor((23, ratio * 23), recess, approach), relative=1e-6)


@against(
    "third-party program",
    "GEARpie, an open gear code: C40 gears; Ohlendorf",
    capability="lubrication machine_loss",
    module="facegear.lubrication.loss",
)
def test_c40_gears_lose_what_an_open_gear_code_and_ohlendorf_say():
    """GEARpie, REPORT/C40.txt: 827.4 MPa, 122.56 um, 0.1986 (Ohlendorf) and 0.1984 (numeric), 206.31 W."""
    path = c40()
    factor = spur_loss_factor((16, 24), path.recess, path.approach)
    assert factor == pytest.approx(0.1986199318, rel=1e-8)
    agrees("loss factor", loss_factors(path.hats(200_000)).mean[0], factor, relative=2e-5)
    assert 0.05 * factor * TORQUE * SPEED == pytest.approx(403.4049569, rel=1e-8)
    assert pytest.approx(206.33, abs=0.02) == 0.0256018 * 0.1984 * TORQUE * SPEED
    first, second = path.curvature_radii
    radius, load = first * second / (first + second), TORQUE / path.base[0] / WIDTH
    modulus = contact_modulus((STEEL, STEEL))
    assert sqrt(load * modulus / (pi * radius)) == pytest.approx(827.363e6, rel=1e-5)
    assert sqrt(4 * load * radius / (pi * modulus)) == pytest.approx(122.541e-6, rel=1e-5)


def test_plane_of_the_contact_path_of_the_paper_s_pair_has_its_closed_loss_factor():
    assert section_loss_factor(pair_design(), 0.143 * 3.75 / 2) == pytest.approx(0.0906276478, rel=1e-9)


def test_loss_factor_of_a_plane_becomes_a_rack_s_as_the_gear_grows():
    """The gear as a rack: Ohlendorf with an infinite wheel, where sliding along the axis vanishes."""
    small = pair_design()
    large = replace(small, face_gear=replace(small.face_gear, teeth=143000))
    radius = large.gear_pitch_radius
    pitch = 2 * pi * large.pinion_base_radius / 23
    path = large.pinion_base_radius * np.tan(large.pressure_angle)
    recess = (large.pinion_tip_roll * large.pinion_base_radius - path) / pitch
    approach = large.face_gear.addendum / np.sin(large.pressure_angle) / pitch
    expected = spur_loss_factor((23, 23 * 10**9), recess, approach)
    assert section_loss_factor(large, radius) == pytest.approx(expected, rel=1e-6)


@given(st.floats(100.0, 1000.0))
def test_loss_factor_between_the_torques_solved_is_monotone_and_says_where_it_is_known(torque):
    known = OverTorque(np.array([100.0, 300.0, 1000.0]), np.array([0.105, 0.113, 0.124]))
    value = float(known.at(torque))
    assert 0.105 <= value <= 0.124
    assert float(known.at(-torque)) == value
    assert float(known.at(1.01 * torque)) >= value
    assert bool(known.within(torque)) and not bool(known.within(99.0)) and not bool(known.within(1001.0))
    assert float(known.at(20.0)) == pytest.approx(0.105)
