"""Advice of the load-sharing map is what changed configs with drawn errors do."""

import numpy as np
import pandas as pd
import pytest
from idler_machines import make_idlers
from references import against, agrees

from validation.sharing_advice import (
    MACHINES,
    POSITIONS,
    TABLE,
    advice_table,
    conditioned_parts,
    repeat_advice,
)

CLOSE = 2e-6
"""Difference of gains that counts as none: the stored table has seven digits."""


@against(
    "second implementation",
    "a hundred changed configs, each put at rest",
    capability="sharing_map",
    module="facegear.sharing.sharing_advice",
)
@pytest.mark.parametrize(
    "words",
    ["halve the radial stiffness of the bearings of the idlers", "let the upper face gear float", POSITIONS],
)
def test_gain_of_idlers_is_that_of_changed_configs_with_drawn_errors(words):
    machine = make_idlers(4, 3e8, backlash_um=2000.0).with_values({"sharing_map": {"samples": 100}})
    repeated = repeat_advice(machine, [words])
    assert set(repeated["change"]) == {words} and set(repeated["kind"]) == {"idlers"}
    agrees("gain in P95 of K_gamma", repeated["found_gain"], repeated["gain"], absolute=1e-8)


def test_drawn_parts_have_their_deviations_and_the_given_sum():
    deviations = np.array([5.0, 5.0, 9.0])
    total = np.random.default_rng(0).standard_normal((20000, 2)) * np.linalg.norm(deviations)
    parts = conditioned_parts(total, deviations)
    np.testing.assert_allclose(parts.sum(axis=1), total, atol=1e-12)
    np.testing.assert_allclose(parts.std(axis=(0, 2)), deviations, rtol=0.02)
    assert abs(np.corrcoef(parts[:, 0, 0], parts[:, 2, 0])[0, 1]) < 0.02


def test_stored_advice_is_repeated_by_configs_of_three_machines():
    rows = pd.read_csv(TABLE)
    assert list(rows["machine"].unique()) == list(MACHINES)
    assert rows.groupby("machine")["change"].nunique().min() >= 8
    np.testing.assert_allclose(rows["found_gain"], rows["gain"], atol=CLOSE)


def test_the_page_shows_idlers_and_one_input_of_each_machine():
    page = advice_table(pd.read_csv(TABLE))
    for name in MACHINES:
        assert f"| {name} | idlers |" in page
    assert "left input" not in page and "+0.00000" not in page
