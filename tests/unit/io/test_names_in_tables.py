"""A user's names survive a table, whatever they look like to a reader of numbers."""

import numpy as np
import pandas as pd
from hypothesis import given
from hypothesis import strategies as st

from facegear.io import tables

NAMES = st.one_of(
    st.sampled_from(["NA", "None", "nan", "null", "True", "12", "1e5", "N/A", "-", "inf", "007"]),
    st.text(st.characters(codec="utf-8", exclude_categories=("C", "Z")), min_size=1, max_size=8),
)


@given(st.lists(NAMES, min_size=1, max_size=5))
def test_names_come_back_as_they_were_written(tmp_path_factory, names):
    """Pinions called NA, None or nan ended the figures in a KeyError, as did 12."""
    path = tmp_path_factory.mktemp("names") / "a.csv"
    columns = ("body", "mesh", "body_or_mesh", "study", "point", "label", "group")
    tables.write(path, pd.DataFrame({**dict.fromkeys(columns, names), "value": np.arange(len(names)) + 0.5}))
    found = tables.read(path, ["value"])
    assert all(found[column].to_list() == names for column in columns)


def test_a_number_that_is_missing_is_still_missing(tmp_path):
    frame = pd.DataFrame({"body": ["a", "b"], "value": [1.5, np.nan], "motion": ["", "chaotic"]})
    tables.write(tmp_path / "a.csv", frame)
    found = tables.read(tmp_path / "a.csv")
    assert np.isnan(found["value"][1]) and found["value"].dtype == float
    assert found["motion"].isna().to_list() == [True, False]
