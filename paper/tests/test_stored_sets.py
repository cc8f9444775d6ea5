"""A stored set of undisclosed inputs as a config."""

import copy
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from facegear.build.cases import set_key
from facegear.build.load import load_config
from facegear.build.machine import MachineInputs
from facegear.harmonics import Harmonics
from paper.stored.sets import config_changes, set_cases
from paper.stored.waveforms import Waveform

ROOT = Path(__file__).parents[2]
VALUES = load_config(ROOT / "config" / "paper.yaml").model_dump(mode="json")
ROW = pd.read_csv(ROOT / "config" / "identified" / "paper.csv").iloc[0].to_dict()


@pytest.mark.parametrize("waveform", list(Waveform))
@pytest.mark.parametrize(("meaning", "wanted"), [("amplitude", 100e-6), ("range", 50e-6)])
def test_error_in_the_config_of_a_row_has_the_stated_range_for_every_form(waveform, meaning, wanted):
    row = {**ROW, "waveform": str(waveform), "meaning": meaning}
    values = copy.deepcopy(VALUES)
    for key, value in config_changes(row).items():
        set_key(values, key, value)
    machine = MachineInputs.of_config(values, Harmonics(np.zeros(2), np.array([4.1e8, 2e7]))).build()
    assert np.ptp(machine.error(np.linspace(0, 1, 3601))) == pytest.approx(wanted, rel=1e-6)
    assert machine.torques[2] == pytest.approx(row["per_input_n_m"])


def test_a_row_sets_the_two_stiffer_bearings_of_their_study_and_leaves_all_other_points_alone():
    row = ROW | {"mid_bearing_n_per_m": 2e8, "stiff_bearing_n_per_m": 3e9}
    base, points = set_cases(VALUES, row)
    bearings = {
        point: values["transmission"]["pinion"]["bearing_stiffness_n_per_m"]["x"]
        for (study, point), values in points.items()
        if study == "pinion_bearings"
    }
    assert bearings == {"soft": 6.5e7, "mid": 2e8, "stiff": 3e9}
    assert base["mesh_stiffness"]["variation"] == pytest.approx(row["stiffness_variation"])
    others = [key for key in points if key not in (("pinion_bearings", "mid"), ("pinion_bearings", "stiff"))]
    assert all(points[key]["transmission"]["pinion"] == VALUES["transmission"]["pinion"] for key in others)
