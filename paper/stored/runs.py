"""Stored runs of the config and of sets of inputs, which differ by rounding and start."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from paper.scorecard.rows import CONFIG_SET, RUN_COLUMNS
from paper.stored.cases import settings_key
from paper.stored.sets import set_cases

STORED_COLUMNS = (*RUN_COLUMNS, "at_rest", "settings")
"""Columns of the file of stored runs."""


def runs_of_config(
    stored_runs: pd.DataFrame, values: Mapping[str, Any], sets: Mapping[str, Mapping[str, Any]]
) -> pd.DataFrame:
    """Select the stored runs that were made with this config's settings.

    Runs of a set that is the config's own are the config's.

    Parameters
    ----------
    stored_runs : DataFrame
        Columns as STORED_COLUMNS.
    values : Mapping[str, Any]
        Plain values of the config.
    sets : Mapping[str, Mapping[str, Any]]
        Rows of the sets by name.

    Returns
    -------
    DataFrame
        Columns as RUN_COLUMNS.
    """
    config_key = settings_key(*set_cases(values, None))
    keys = {
        CONFIG_SET: config_key,
        **{name: settings_key(*set_cases(values, row)) for name, row in sets.items()},
    }
    matching_runs = stored_runs[stored_runs["settings"] == stored_runs["set"].map(keys)]
    renamed_runs = matching_runs.assign(
        set=matching_runs["set"].where(matching_runs["settings"] != config_key, CONFIG_SET)
    )
    return renamed_runs.drop_duplicates(["set", "id"])[list(RUN_COLUMNS)]
