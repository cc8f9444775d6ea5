"""The space of undisclosed inputs, a row of it as a config, and the first estimate of the load."""

import copy
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.config.cases import set_key
from facegear.config.load import load_config
from facegear.config.machines import case_machine
from facegear.harmonics.series import Harmonics
from facegear.paper.identify.inputs import (
    BEARINGS,
    CHOICES,
    COORDINATES,
    INPUT_COLUMNS,
    NUMBERS,
    Space,
    Waveform,
)
from facegear.paper.identify.load_estimates import estimate_table, load_for_mean
from facegear.paper.identify.sets import config_changes, set_cases
from facegear.stiffness.curve import LoadTable

VALUES = load_config(Path(__file__).parents[4] / "config" / "paper.yaml").model_dump(mode="json")
SPACE = Space((100.0, 1000.0), (0.0, 0.4), (0.5, 2.5), (1e8, 1e10), (120.0, 450.0), gears=2)
TORQUES = np.array([50.0, 200.0, 800.0])
POSITIONS = np.arange(16) / 16
CURVES = np.array([2e8, 4e8, 6e8])[:, None] * (1 + 0.1 * np.sin(2 * np.pi * POSITIONS))
TABLE = LoadTable(TORQUES, POSITIONS, CURVES, CURVES)
MIDDLE = [0.5] * len(COORDINATES)


@given(st.lists(st.floats(0.0, 1.0), min_size=len(COORDINATES), max_size=len(COORDINATES)))
def test_every_point_of_the_unit_cube_is_a_row_of_inputs_within_their_ranges(unit):
    row = SPACE.row(unit, "none")
    assert set(row) == set(INPUT_COLUMNS)
    assert 99.999 <= row["per_input_n_m"] <= 1000.001 and 0.0 <= row["tail_share"] <= 0.4
    assert 0.0 <= row["error_phase_deg"] < 360.0 and 0.5 <= row["stiffness_variation"] <= 2.5
    assert 0.999e8 <= row[BEARINGS[0]] <= row[BEARINGS[1]] <= 1.001e10
    assert all(row[name] in list(kind) for name, kind in CHOICES.items())
    assert 120.0 <= row["stiffness_torque_n_m"] <= 450.0
    again = SPACE.row(SPACE.unit(row), "none")
    assert {key: again[key] for key in CHOICES} == {key: row[key] for key in CHOICES}
    assert all(again[key] == pytest.approx(row[key]) for key in (*NUMBERS, *BEARINGS))


@pytest.mark.parametrize("waveform", list(Waveform))
@pytest.mark.parametrize(("meaning", "wanted"), [("amplitude", 100e-6), ("range", 50e-6)])
def test_error_in_the_config_of_a_row_has_the_stated_range_for_every_form(waveform, meaning, wanted):
    row = {**SPACE.row(MIDDLE, "none"), "waveform": str(waveform), "meaning": meaning}
    values = copy.deepcopy(VALUES)
    for key, value in config_changes(row).items():
        set_key(values, key, value)
    machine = case_machine(values, Harmonics(np.zeros(2), np.array([4.1e8, 2e7])))
    assert np.ptp(machine.error(np.linspace(0, 1, 3601))) == pytest.approx(wanted, rel=1e-6)
    assert machine.torques[2] == pytest.approx(row["per_input_n_m"])


def test_a_row_sets_the_two_stiffer_bearings_of_their_study_and_leaves_all_other_points_alone():
    row = SPACE.row(MIDDLE, "none") | {"mid_bearing_n_per_m": 2e8, "stiff_bearing_n_per_m": 3e9}
    base, points = set_cases(VALUES, row)
    bearings = {
        point: values["transmission"]["pinion"]["bearing_stiffness_n_per_m"]["x"]
        for (study, point), values in points.items()
        if study == "pinion_bearings"
    }
    assert bearings == {"soft": 6.5e7, "mid": 2e8, "stiff": 3e9}
    assert base["mesh_stiffness"]["variation"] == pytest.approx(1.5)
    others = [key for key in points if key not in (("pinion_bearings", "mid"), ("pinion_bearings", "stiff"))]
    assert all(points[key]["transmission"]["pinion"] == VALUES["transmission"]["pinion"] for key in others)


def test_first_estimate_finds_the_load_that_gives_the_mean():
    load = load_for_mean(TABLE, 5e8, "average")
    assert 200.0 < load < 800.0
    assert TABLE.at(load, "average").mean() == pytest.approx(5e8)
    assert load_for_mean(TABLE, 9e8, "average") is None


def test_estimate_table_says_where_a_design_reaches_the_mean_and_what_it_has_at_the_configs_load():
    softer = LoadTable(TORQUES, POSITIONS, 0.8 * CURVES, 0.8 * CURVES)
    table = estimate_table({"config": TABLE, "thin rim": softer}, 4e8, "average", 800.0).set_index("design")
    assert table.loc["config", "load_from_mean_stiffness_n_m"] == pytest.approx(200.0, rel=1e-9)
    assert table.loc["config", "ratio_to_paper"] == pytest.approx(1.5, rel=1e-12)
    assert table.loc["thin rim", "load_from_mean_stiffness_n_m"] > 200.0
    assert table.loc["thin rim", "ratio_to_paper"] == pytest.approx(1.2, rel=1e-12)


def test_a_load_beyond_those_solved_is_left_empty():
    table = estimate_table({"config": TABLE}, 4e8, "average", 900.0)
    assert table["mean_at_config_load_n_per_m"].isna().all()
