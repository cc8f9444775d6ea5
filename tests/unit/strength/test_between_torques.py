"""Stress and pressure between, below and beyond the torques that were solved."""

from math import sqrt

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from references import against, agrees
from root_stresses import power_law

from facegear.strength.contact_pressure import ContactPressure, contact_pressure
from facegear.strength.root_stress import RootStress, down_the_fillet, largest_tension


@against(
    "analytic",
    "Hertz: pressure of a line load grows with its root",
    capability="rating",
    module="facegear.strength.contact_pressure",
)
@given(factor=st.floats(1.0, 5.0))
def test_beyond_the_torques_solved_pressure_rises_with_the_root_of_the_torque_and_edges_with_it(factor):
    table = pd.DataFrame(
        {
            "torque_n_m": [500.0, 1000.0],
            "pressure_mpa": [np.nan, 1200.0],
            "pressure_error_mpa": [np.nan, 24.0],
            "tip_line_load_n_per_mm": [100.0, 300.0],
            "tip_length_mm": [2.0, 4.0],
            "fillet_share": [0.0, 0.0],
        }
    )
    found = contact_pressure(table)
    agrees(
        "pressure beyond the torques solved, Pa",
        found.at(1000.0 * factor),
        1200e6 * sqrt(factor),
        relative=1e-6,
    )
    assert found.error_at(1000.0 * factor) == pytest.approx(0.02 * found.at(1000.0 * factor))
    assert found.edge_at(1000.0 * factor) == pytest.approx((300e3 * factor, 4e-3))
    assert found.at(500.0) == pytest.approx(1200e6 * 0.5 ** (1 / 3))  # of a point contact: no less than it is


@settings(deadline=None)
@given(torque=st.floats(10.0, 2000.0))
def test_the_largest_tension_between_torques_is_that_of_every_place_of_the_fillet(torque):
    stress = np.random.default_rng(3).normal(size=(3, 4, 2, 5, 3))
    torques, error = np.array([100.0, 400.0, 1000.0]), np.zeros(3)
    full = RootStress(torques, np.arange(4.0), stress, np.arange(3.0), np.ones((2, 5, 3)), error)
    expected = down_the_fillet(full.at_torque(torque)).max()
    assert largest_tension(full)(torque) == pytest.approx(expected, rel=1e-12)


@settings(deadline=None)
@given(torque=st.floats(10.0, 2000.0), seed=st.integers(0, 9))
def test_sections_that_are_left_out_never_have_the_largest_stress(torque, seed):
    draw, torques = np.random.default_rng(seed), np.array([100.0, 400.0, 1000.0])
    sizes = draw.uniform(0.0, 1.0, (1, 40, 2, 1, 3)) ** 3 * torques[:, None, None, None, None]
    stress = sizes * draw.uniform(0.3, 1.0, (3, 40, 2, 5, 3))
    full = RootStress(torques, np.arange(40.0), stress, np.arange(3.0), np.ones((2, 5, 3)), np.zeros(3))
    expected = down_the_fillet(full.at_torque(torque)).max()
    assert largest_tension(full)(torque) == pytest.approx(expected, rel=1e-12)


@given(
    exponent=st.floats(0.5, 1.0),
    solved=st.sampled_from([(1000.0,), (300.0, 1000.0), (200.0, 300.0, 1000.0)]),
    torque=st.floats(20.0, 3000.0),
)
def test_stress_at_no_torque_is_taken_for_less_than_it_is(exponent, solved, torque):
    true = 400e6 * (torque / 500.0) ** exponent
    found = largest_tension(power_law(solved, exponent))(torque)
    assert found >= true * (1 - 1e-9)
    if len(solved) > 1 and torque <= solved[-1]:
        assert found <= true * max(solved[0] / torque, 1.0) ** 0.11 * (1 + 1e-9)


@given(exponent=st.floats(1 / 3, 0.5), torque=st.floats(20.0, 3000.0))
def test_pressure_at_no_torque_is_taken_for_less_than_it_is(exponent, torque):
    torques, none = np.array([300.0, 1000.0]), np.zeros(2)
    for solved in (torques, torques[1:]):
        pressure = 1e9 * (solved / 500.0) ** exponent
        found = ContactPressure(solved, pressure, none[: solved.size], none, none, none).at(torque)
        assert found >= 1e9 * (torque / 500.0) ** exponent * (1 - 1e-9)
