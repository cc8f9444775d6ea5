"""Stored runs of the config and of sets of inputs, which differ by rounding and start."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from paper.scorecard.rows import OWN, RUN_COLUMNS
from paper.stored.cases import settings_key
from paper.stored.sets import set_cases

STORED_COLUMNS = (*RUN_COLUMNS, "at_rest", "settings")


def runs_of_config(
    stored: pd.DataFrame, values: Mapping[str, Any], sets: Mapping[str, Mapping[str, Any]]
) -> pd.DataFrame:
    """Those of the stored runs that were made with this config's settings, RUN_COLUMNS.

    `values` are the config's plain values, `sets` the rows of the sets by name. Runs of a set that is the
    config's own are the config's.
    """
    own = settings_key(*set_cases(values, None))
    keys = {OWN: own, **{name: settings_key(*set_cases(values, row)) for name, row in sets.items()}}
    same = stored[stored["settings"] == stored["set"].map(keys)]
    named = same.assign(set=same["set"].where(same["settings"] != own, OWN))
    return named.drop_duplicates(["set", "id"])[list(RUN_COLUMNS)]
