"""Exponents of growth are those of power laws, and every curve says what bends it."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from validation.growth.curves import CURVES
from validation.growth.machines import decaying_harmonics, shipped_machine
from validation.growth.measure import exponents, measure_point


@given(st.floats(-1.0, 3.0), st.floats(1e-6, 1e3), st.floats(-0.5, 2.0))
def test_exponents_of_power_laws_are_found_in_time_and_in_memory(power, factor, of_memory):
    size = np.array([1.0, 2.0, 5.0, 17.0])
    table = pd.DataFrame(
        {
            "curve": "law",
            "size": size,
            "seconds": factor * size**power,
            "peak_mb": 300.0 + 100.0 * size**of_memory,
            "own_mb": 100.0 * size**of_memory,
        }
    )
    fitted = exponents(table).iloc[0]
    assert fitted["exponent"] == pytest.approx(power, abs=1e-9)
    assert fitted["exponent_at_the_end"] == pytest.approx(power, abs=1e-9)
    assert fitted["memory_exponent"] == pytest.approx(of_memory, abs=1e-9)


def test_memory_that_the_process_itself_takes_has_no_exponent():
    table = pd.DataFrame(
        {"curve": "flat", "size": [1.0, 2.0], "seconds": [1.0, 2.0], "peak_mb": 300.0, "own_mb": [0.5, 3.0]}
    )
    assert np.isnan(exponents(table).iloc[0]["memory_exponent"])


def test_curves_go_over_several_sizes_and_say_what_bends_them():
    for curve in CURVES.values():
        assert len(curve.values) >= 4 and curve.times >= 1
        assert curve.bent_by.endswith(".")


def test_a_point_is_measured_with_its_size_time_and_memory():
    point = measure_point("harmonics", 1)
    assert point["size"] == CURVES["harmonics"].values[1]
    assert point["seconds"] > 0.0 and point["peak_mb"] > point["own_mb"] >= 0.0


def test_harmonics_that_are_added_leave_mean_and_first_amplitude_of_the_stiffness():
    given_series = shipped_machine("config/paper.yaml").stiffness
    more = decaying_harmonics(given_series, 40)
    assert more.order == 40 and more.mean == given_series.mean
    assert more.amplitudes[1] == pytest.approx(given_series.amplitudes[1])
