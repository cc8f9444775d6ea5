"""A rated flank is judged by the contacts that it has in its machine."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from facegear.geometry.flank_errors import FLANKS, GEARS
from facegear.strength.duty import FlankDuty
from facegear.strength.met_flanks import met_by, worst_pressure, worst_root
from facegear.strength.root_stress import RootStress
from facegear.strength.root_tables import root_arrays

ONE = np.ones(1)
DUTY = FlankDuty("pinion", "pinion", "drive", np.zeros(1, int), 500.0 * ONE, 1e6 * ONE, 0 * ONE)
NUMBERS = np.array([[0, 1], [2, 3]])
PRESSURES = {("upper", "drive"): 900.0, ("upper", "back"): 950.0, ("lower", "drive"): 930.0}


def root(size):
    grid = (2, 4, 3)
    stress = np.zeros((2, 4, *grid))
    stress[:, 1, 0] = size * np.array([300.0, 1000.0])[:, None, None]
    return RootStress(
        np.array([300.0, 1000.0]), np.arange(4) / 2, stress, np.zeros(3), np.zeros(grid), np.zeros(3)
    )


@pytest.mark.parametrize(
    ("duty", "gears", "met"),
    [
        ({}, GEARS, [("upper", "drive"), ("lower", "drive")]),
        ({}, ("upper",), [("upper", "drive")]),
        ({"flank": "back"}, ("upper",), [("upper", "back")]),
        ({"flank": "each"}, ("upper",), [("upper", "drive"), ("upper", "back")]),
        ({"body": "lower face gear", "gear": "face_gear"}, GEARS, [("lower", "drive")]),
        ({"body": "lower face gear", "gear": "face_gear"}, ("upper",), [("upper", "drive")]),
        ({"body": "face_gear", "gear": "face_gear"}, GEARS, [("upper", "drive"), ("lower", "drive")]),
    ],
)
def test_a_gear_s_flank_meets_its_pinions_and_a_pinion_s_flank_both_gears(duty, gears, met):
    assert met_by(replace(DUTY, **duty), gears) == met


def test_the_worst_of_all_contacts_of_a_flank_is_rated():
    sizes = (1.0, 1.2, 1.1, 1.05)
    variants = [{body: root(size) for body in ("pinion", "face_gear")} for size in sizes]
    place = np.zeros((2, 4, 3, 3))
    stress = root_arrays(variants, NUMBERS, {"pinion": place, "face_gear": place})
    for (row, column), number in np.ndenumerate(NUMBERS):
        alone = worst_root(stress, DUTY, [(GEARS[row], FLANKS[column])])
        assert alone.stress.max() == pytest.approx(1000.0 * sizes[number])
    found = worst_root(stress, DUTY, met_by(DUTY, GEARS))
    assert found.stress.max() == pytest.approx(1100.0)
    rows = [
        (gear, flank, torque, size * torque, 10.0, 50.0 * size, 1.0)
        for (gear, flank), size in PRESSURES.items()
        for torque in (300.0, 1000.0)
    ]
    names = ("pressure_mpa", "pressure_error_mpa", "tip_line_load_n_per_mm", "tip_length_mm")
    table = pd.DataFrame(rows, columns=["gear", "flank", "torque_n_m", *names])
    pressure = worst_pressure(table, met_by(DUTY, GEARS))
    np.testing.assert_allclose(pressure.pressure, 1e6 * 930.0 * np.array([300.0, 1000.0]))
    np.testing.assert_allclose(pressure.edge_load, 1e3 * 50.0 * 930.0)
