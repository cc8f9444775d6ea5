"""Number of claims that sets of inputs hold by their motion from rest, and from every start."""

from collections.abc import Sequence

import pandas as pd

from paper.scorecard.claims import Claim

START_COLUMNS = ("set", "claims", "from_rest", "from_every_start", "from_some_start", "without_number")
"""Columns of `start_table`."""


def start_table(runs: pd.DataFrame, claims: Sequence[Claim]) -> pd.DataFrame:
    """Count the distinct claims on the dynamics that each set holds, one row a set.

    `without_number` counts those on a number that no run gives, of every set by the same rule: a mean
    coefficient is none where no mesh of its group carries load for half the cycle or more.

    Parameters
    ----------
    runs : DataFrame
        Columns set, id, runs, held, low, high, at_rest: how many runs from all starts judged a claim, how
        many hold it, the range of its number, and whether the one from rest, with the inputs as given, holds
        it.
    claims : Sequence[Claim]
        All claims.

    Returns
    -------
    DataFrame
        Columns as START_COLUMNS.
    """
    counted_ids = {claim.id for claim in claims if claim.counts and claim.dynamic}
    numbers = {claim.id for claim in claims if claim.paper is not None}
    rows = []
    for name, of_set in runs[runs["id"].isin(counted_ids)].groupby("set", sort=False):
        runs_held, run_count = of_set["held"], of_set["runs"]
        rest = int(of_set["at_rest"].astype(bool).sum())
        without_number = int((of_set["id"].isin(numbers) & of_set["low"].isna()).sum())
        every_start, some_start = int((runs_held == run_count).sum()), int((runs_held > 0).sum())
        rows.append((str(name), len(of_set), rest, every_start, some_start, without_number))
    return pd.DataFrame(rows, columns=list(START_COLUMNS))
