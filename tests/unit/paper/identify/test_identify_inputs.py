import copy
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from facegear.config.cases import set_key
from facegear.config.load import load_config
from facegear.config.machines import case_machine
from facegear.errors import ConfigError
from facegear.harmonics.series import Harmonics
from facegear.paper.identify.inputs import (
    Branch,
    Inputs,
    Meaning,
    Space,
    StiffnessLoad,
    Waveform,
    error_series,
    machine_with,
)
from facegear.paper.identify.load_estimates import estimate_table
from facegear.paper.identify.optima import separate_optima
from facegear.paper.identify.search import inputs_of, inputs_row
from facegear.paper.identify.sets import config_changes
from facegear.paper.identify.stiffness import load_for_mean, scaled_stiffness
from facegear.stiffness.curve import LoadTable
from facegear.transmission.phases import PhaseConvention

VALUES = load_config(Path(__file__).parents[4] / "config" / "paper.yaml").model_dump(mode="json")
SPACE = Space((100.0, 1000.0), (0.0, 0.4))
TORQUES = np.array([50.0, 200.0, 800.0])
POSITIONS = np.arange(16) / 16
CURVES = np.array([2e8, 4e8, 6e8])[:, None] * (1 + 0.1 * np.sin(2 * np.pi * POSITIONS))
TABLE = LoadTable(TORQUES, POSITIONS, CURVES, CURVES)


def branch(waveform=Waveform.SINE, meaning=Meaning.AMPLITUDE, load=StiffnessLoad.OPERATING):
    return Branch(meaning, True, PhaseConvention.PRINTED, waveform, load)


@pytest.mark.parametrize("waveform", list(Waveform))
@pytest.mark.parametrize("meaning", list(Meaning))
def test_error_has_the_stated_range_for_every_form(waveform, meaning):
    series = error_series(50e-6, branch(waveform, meaning), 0.3)
    found = np.ptp(series(np.linspace(0, 1, 3601)))
    wanted = 100e-6 if meaning is Meaning.AMPLITUDE else 50e-6
    assert found == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("waveform", list(Waveform))
@pytest.mark.parametrize("meaning", list(Meaning))
def test_a_set_put_into_the_config_gives_the_machine_that_was_searched(waveform, meaning):
    stiffness = Harmonics(np.zeros(2), np.array([4.1e8, 2e7]))
    inputs = Inputs(branch(waveform, meaning), 432.1, 0.123, 0.37)
    searched = machine_with(case_machine(VALUES, stiffness), inputs, 50e-6, lambda _: stiffness, 175.0)
    values = copy.deepcopy(VALUES)
    row = {**inputs_row(inputs), "stiffness_torque_n_m": 216.0}
    for key, value in config_changes(row, 50.0).items():
        set_key(values, key, value)
    configured = case_machine(values, stiffness)
    cycles = np.linspace(0, 1, 33)
    np.testing.assert_allclose(configured.error(cycles), searched.error(cycles), atol=1e-15)
    np.testing.assert_allclose(configured.torques, searched.torques, rtol=1e-12)
    np.testing.assert_array_equal(configured.phases, searched.phases)
    np.testing.assert_array_equal(configured.error_phases, searched.error_phases)


def test_inputs_survive_their_table_row():
    inputs = Inputs(branch(Waveform.ARCS, Meaning.RANGE, StiffnessLoad.MEAN), 700.0, 0.2, 0.9)
    again = inputs_of(inputs_row(inputs))
    assert again.branch == inputs.branch
    assert (again.torque, again.tail_share, again.error_phase) == pytest.approx((700.0, 0.2, 0.9))


def test_first_road_finds_the_load_that_gives_the_mean():
    load = load_for_mean(TABLE, 5e8, "average")
    assert 200.0 < load < 800.0
    assert TABLE.at(load, "average").mean() == pytest.approx(5e8)
    assert load_for_mean(TABLE, 9e8, "average") is None


def test_stiffness_keeps_the_wanted_mean_and_the_shape_of_the_load():
    series = scaled_stiffness(TABLE, 4.1e8, 4, "average")(300.0)
    assert series.mean == pytest.approx(4.1e8)
    assert series.amplitudes[1] / series.mean == pytest.approx(0.1)


def test_stiffness_is_never_extrapolated():
    with pytest.raises(ConfigError):
        scaled_stiffness(TABLE, 4.1e8, 4, "average")(900.0)


def test_neighbours_count_as_one_optimum_and_phase_is_cyclic():
    rows = pd.DataFrame(
        {
            "branch": ["x", "x", "x", "y"],
            "per_input_n_m": [300.0, 300.0, 900.0, 300.0],
            "tail_share": [0.1, 0.1, 0.1, 0.1],
            "error_phase_deg": [1.0, 359.0, 1.0, 1.0],
            "misfit": [1.0, 1.1, 1.2, 1.3],
        }
    )
    kept = separate_optima(rows, SPACE, most=5)
    assert kept["misfit"].tolist() == [1.0, 1.2, 1.3]
    assert len(separate_optima(rows, SPACE, most=1)) == 1


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
