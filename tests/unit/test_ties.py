"""Names of what is largest do not hang on rounding."""

import numpy as np
import pandas as pd
import pytest

from facegear.ties import first_largest, first_largest_row, first_largest_rows, size_ranks

ROUNDING = (1e-12, -1e-12, 0.0)


@pytest.mark.parametrize("rounding", ROUNDING)
def test_of_twins_that_differ_by_rounding_the_first_is_the_largest(rounding):
    values = np.array([1.0, np.nan, 5.0, 5.0 * (1.0 + rounding), 4.9])
    assert first_largest(values) == 2
    assert first_largest(-values) == 0


def test_what_is_larger_by_more_than_rounding_is_the_largest():
    assert first_largest(np.array([5.0, 5.01])) == 1


@pytest.mark.parametrize("rounding", ROUNDING)
def test_rows_of_groups_keep_the_order_and_name_the_first_twin(rounding):
    table = pd.DataFrame(
        {
            "speed": [9.0, 9.0, 9.0, 3.0, 3.0, 3.0],
            "mesh": ["left", "right", "tail", "left", "right", "tail"],
            "force": [2.0, 2.0 * (1.0 + rounding), 1.0, 1.0, 1.0 + rounding, 7.0],
        }
    )
    assert first_largest_rows(table, "force", ["speed"])["mesh"].to_list() == ["left", "tail"]
    assert first_largest_rows(table, "force", ["speed"], sort=True)["mesh"].to_list() == ["tail", "left"]
    assert first_largest_row(table, "force")["mesh"] == "tail"


@pytest.mark.parametrize("rounding", ROUNDING)
def test_twins_share_a_rank_of_size_whatever_their_signs(rounding):
    values = np.array([1.0, -5.0, 0.0, 5.0 * (1.0 + rounding), 2.0, -1.0 - rounding])
    assert size_ranks(values).tolist() == [2, 0, 3, 0, 1, 2]
    assert size_ranks(np.array([])).tolist() == []
