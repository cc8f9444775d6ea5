"""A rated flank is judged by the contacts that it has in its machine."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from facegear.strength.flank_contacts import (
    contacts_of,
    flank_contacts,
    met_by,
    worst_contact,
    worst_pressure,
)
from facegear.strength.materials import FlankDuty
from facegear.strength.root_stress import RootStress
from facegear.strength.root_tables import root_arrays
from facegear.teeth.placement import GEARS

ONE = np.ones(1)
DUTY = FlankDuty("pinion", "pinion", "drive", np.zeros(1, int), 500.0 * ONE, 1e6 * ONE, 0 * ONE)
NUMBERS = np.array([[0, 1], [2, 3]])
PRESSURES = {
    ("upper", "drive"): 900.0,
    ("upper", "back"): 950.0,
    ("lower", "drive"): 930.0,
    ("lower", "back"): 910.0,
}
SIZES = (1.0, 1.2, 1.1, 1.05)


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


def contacts(numbers):
    variants = [{body: root(size) for body in ("pinion", "face_gear")} for size in SIZES]
    place = np.zeros((2, 4, 3, 3))
    stress = root_arrays(variants, numbers, len(variants) * [{"pinion": place, "face_gear": place}])
    rows = [
        (gear, flank, torque, size * torque, 10.0, 50.0 * size, 1.0, 1e-4 * size)
        for (gear, flank), size in PRESSURES.items()
        for torque in (300.0, 1000.0)
    ]
    values = ("pressure_mpa", "pressure_error_mpa", "tip_line_load_n_per_mm", "tip_length_mm", "fillet_share")
    return flank_contacts(stress, pd.DataFrame(rows, columns=["gear", "flank", "torque_n_m", *values]))


def test_the_worst_of_all_contacts_of_a_flank_is_rated():
    found = contacts(NUMBERS)
    for number, contact in enumerate(found.values()):
        assert contact.roots["pinion"].stress.max() == pytest.approx(1000.0 * SIZES[number])
    met = {at: found[at] for at in met_by(DUTY, GEARS)}
    assert worst_contact(DUTY, met) == ("lower", "drive")
    assert worst_contact(DUTY, found) == ("upper", "back")
    pressure = worst_pressure(list(met.values()))
    np.testing.assert_allclose(pressure.pressure, 1e6 * 930.0 * np.array([300.0, 1000.0]))
    np.testing.assert_allclose(pressure.edge_load, 1e3 * 50.0 * 930.0)
    np.testing.assert_allclose(pressure.fillet_share, 0.093)


def test_a_mesh_has_the_contacts_of_its_own_gear_and_a_gear_alone_those_of_the_upper():
    found = contacts(NUMBERS)
    assert contacts_of("a/lower", found, GEARS)["back"] is found["lower", "back"]
    assert contacts_of("a/wheel", found, ("upper",))["drive"] is found["upper", "drive"]
    alike = contacts(np.zeros((2, 2), int))
    assert len(set(alike.values())) == 1  # flanks with the same errors share one contact
