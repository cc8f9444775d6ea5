"""Runs of a set of inputs that differ by rounding and start: how many of them hold each claim."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import pandas as pd

from facegear.paper.identify.cases import settings_key
from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.sets import set_cases
from facegear.paper.scorecard.rows import OWN, RUN_COLUMNS

HOLDS, VALUE = "holds", "value"
STORED_COLUMNS = (*RUN_COLUMNS, "at_rest", "settings")


def run_columns(ids: Sequence[str]) -> list[str]:
    """Columns of one run: whether each claim holds, and its number."""
    return [f"{name} {what}" for name in ids for what in (HOLDS, VALUE)]


def one_run(
    judge: ClaimJudge, row: Mapping[str, Any] | None, swept: int, starts: int
) -> Callable[[int], dict[str, float]]:
    """Function of the number of a run giving its columns; runs from number `swept` on make no sweep, and have
    NaN for the claims that need one. Runs differ by rounding, and take the `starts` in turn.
    """

    def evaluate(run: int) -> dict[str, float]:
        asked = judge if run < swept else judge.without_sweep
        found = asked.outcomes(row, run, run % starts).set_index("id")
        told = {HOLDS: found["holds"].astype(float), VALUE: found["value"].astype(float)}
        return {
            f"{name} {what}": values.get(name, float("nan"))
            for name in judge.names
            for what, values in told.items()
        }

    return evaluate


def run_table(name: str, runs: pd.DataFrame, ids: Sequence[str], settings: str) -> pd.DataFrame:
    """One row a claim of a set: runs that judged it, those that hold it, range of its number, and whether the
    first run holds it, which begins at rest with the inputs as given; `settings` is their key.
    """
    rows = []
    for claim in ids:
        values = runs[f"{claim} {VALUE}"]
        holds = runs[f"{claim} {HOLDS}"].dropna()
        found = (len(holds), int(holds.sum()), values.min(), values.max(), bool(holds.iloc[0]))
        rows.append((name, claim, *found, settings))
    return pd.DataFrame(rows, columns=list(STORED_COLUMNS))


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
