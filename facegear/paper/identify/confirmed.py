"""The most likely inputs at full accuracy, in runs that differ by rounding, and which of them are kept."""

import string
from collections.abc import Callable
from pathlib import Path

import pandas as pd

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import INPUT_COLUMNS
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.search import LOG_LIKELIHOOD
from facegear.scenarios.chunks import run_chunk

QUICK_LIKELIHOOD = "quick_log_likelihood"


def confirmed_inputs(
    judge: ClaimJudge,
    likelihood: Likelihood,
    region: pd.DataFrame,
    runs: int,
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Rows of a region with the least log-likelihood of `runs` runs of the judge, the most likely first.

    Quick runs may reach another motion than accurate ones, so that the order changes; of equals the one with
    the smaller share at the tail comes first. The region's own log-likelihood is kept as that of quick runs.
    """
    rows = region[list(INPUT_COLUMNS)].to_dict("records")
    found = run_chunk(
        lambda number: judge.found(rows[number // runs], number % runs),
        range(len(rows) * runs),
        judge.columns,
        partial,
        identity,
        told,
    )
    least = likelihood(found).reshape(len(rows), runs).min(axis=1)
    kept = region.rename(columns={LOG_LIKELIHOOD: QUICK_LIKELIHOOD}).assign(**{LOG_LIKELIHOOD: least})
    order = [LOG_LIKELIHOOD, "tail_share"]
    return kept.sort_values(order, ascending=[False, True], kind="stable").reset_index(drop=True)


def kept_sets(confirmed: pd.DataFrame, most: int) -> pd.DataFrame:
    """The best inputs of each pattern, at most so many, named a, b, c ...; the first is `recommended`."""
    best = confirmed.drop_duplicates("pattern").head(most).reset_index(drop=True)
    names = list(string.ascii_lowercase[: len(best)])
    columns = [*INPUT_COLUMNS, LOG_LIKELIHOOD, QUICK_LIKELIHOOD]
    return best[columns].assign(set=names, recommended=best.index == 0)[["set", "recommended", *columns]]
