"""The summary of the contact table against transmission errors and patterns whose answer is known."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees

from facegear.contact.pattern import LTCA_COLUMNS
from facegear.contact.summary import contact_summary, path_radii


def table(positions, size_um, phase=0.0, torque=300.0):
    at = np.arange(positions) / positions
    frame = pd.DataFrame(1.0, index=at, columns=list(LTCA_COLUMNS))
    wave = np.cos(2 * np.pi * (at + phase))
    frame = frame.assign(torque_n_m=torque, position=at, pairs_in_contact=2)
    return frame.assign(ste_um=60.0 + 0.5 * size_um * wave, unloaded_ste_um=50.0 + 0.1 * wave)


@against(
    "manufactured",
    "a wave of known size",
    capability="contact",
    module="facegear.contact.summary",
)
def test_peak_to_peak_of_a_wave_sampled_at_its_extremes_is_its_size():
    rows = pd.concat([table(8, 3.0), table(8, 5.0, torque=900.0)]).sample(frac=1.0, random_state=1)
    found = contact_summary(rows)
    assert found["torque_n_m"].to_list() == [300.0, 900.0]
    agrees(
        "peak to peak of the loaded error, um",
        found["ste_peak_to_peak_um"].to_list(),
        [3.0, 5.0],
        relative=1e-6,
    )
    agrees(
        "peak to peak of the unloaded error, um",
        found["unloaded_peak_to_peak_um"].to_list(),
        [0.2, 0.2],
        relative=1e-6,
    )


@given(st.integers(4, 40), st.floats(0.0, 1.0))
def test_peak_to_peak_never_exceeds_the_true_value_and_reaches_it_with_the_square_of_the_step(half, phase):
    found = contact_summary(table(2 * half, 1.0, phase)).iloc[0]
    missing = 1.0 - found["ste_peak_to_peak_um"]
    assert -1e-12 < missing < 0.5 * (np.pi / (2 * half)) ** 2
    assert found["ste_peak_to_peak_half_um"] <= found["ste_peak_to_peak_um"] + 1e-12


def test_the_path_lies_at_the_centroid_of_the_forces():
    pressure = {
        "torque_n_m": np.array([100.0, 100.0, 200.0]),
        "node": np.array([0, 1, 1]),
        "force_n": np.array([3.0, 1.0, 5.0]),
        "point_m": np.array([[0.0, 0.260, 0.04], [0.0, 0.268, 0.04]]),
    }
    assert path_radii(pressure)["path_radius_mm"].to_list() == pytest.approx([262.0, 268.0])
