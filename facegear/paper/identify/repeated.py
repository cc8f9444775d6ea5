"""Runs of a set of inputs that differ by rounding: how many of them hold each claim."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import pandas as pd

from facegear.paper.identify.cases import settings_key
from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.sets import set_cases
from facegear.paper.scorecard.rows import OWN, RUN_COLUMNS

HOLDS, VALUE = "holds", "value"
STORED_COLUMNS = (*RUN_COLUMNS, "settings")


def run_columns(ids: Sequence[str]) -> list[str]:
    """Columns of one run: whether each claim holds, and its number."""
    return [f"{name} {what}" for name in ids for what in (HOLDS, VALUE)]


def one_run(judge: ClaimJudge, row: Mapping[str, Any] | None) -> Callable[[int], dict[str, float]]:
    """Function of the number of a run giving its columns."""

    def evaluate(run: int) -> dict[str, float]:
        found = judge.outcomes(row, run).set_index("id")
        values = found["value"].astype(float)
        return {
            **{f"{name} {HOLDS}": float(holds) for name, holds in found["holds"].items()},
            **{f"{name} {VALUE}": float(value) for name, value in values.items()},
        }

    return evaluate


def run_table(name: str, runs: pd.DataFrame, ids: Sequence[str], settings: str) -> pd.DataFrame:
    """One row a claim of a set: runs, runs that hold it, range of its number; `settings` is their key."""
    rows = []
    for claim in ids:
        values = runs[f"{claim} {VALUE}"]
        held = int(runs[f"{claim} {HOLDS}"].sum())
        rows.append((name, claim, len(runs), held, values.min(), values.max(), settings))
    return pd.DataFrame(rows, columns=list(STORED_COLUMNS))


def runs_of_config(
    stored: pd.DataFrame, values: Mapping[str, Any], sets: Mapping[str, Mapping[str, Any]]
) -> pd.DataFrame:
    """Those of the stored runs that were made with this config's settings, RUN_COLUMNS.

    `values` are the config's plain values, `sets` the rows of the other sets by name.
    """
    rows = {OWN: None, **sets}
    keys = {name: settings_key(*set_cases(values, row)) for name, row in rows.items()}
    same = stored["settings"] == stored["set"].map(keys)
    return stored.loc[same, list(RUN_COLUMNS)]
