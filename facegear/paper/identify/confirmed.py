"""The most likely inputs at full accuracy, from several starts, and which of them are kept."""

import string
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import BEARINGS, INPUT_COLUMNS, NUMBERS
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import LOG_LIKELIHOOD, distinct_inputs, judged_motions, over_motions
from facegear.paper.identify.region import with_claims
from facegear.scenarios.chunks import run_chunk

QUICK_LIKELIHOOD, LEAST = "quick_log_likelihood", "least_log_likelihood"
DIGITS = 4
"""Digits of the numbers of a set: more than the region knows."""
ROUNDED = (*NUMBERS, *BEARINGS, "stiffness_torque_n_m")


def confirmed_inputs(
    judge: ClaimJudge,
    likelihood: Likelihood,
    region: pd.DataFrame,
    runs: int,
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Rows of a region with their log-likelihood over `runs` runs of the judge and the least of one of them,
    the most likely first.

    Each run has another start, and all but the first are moved by rounding. Numbers of the rows are rounded
    before. Quick runs may reach other motions than accurate ones, so that the order changes; of equals the
    one with the smaller share at the tail comes first. The region's own log-likelihood is kept as that of
    quick runs.
    """
    tidy = region.assign(**{name: region[name].map(rounded) for name in ROUNDED})
    rows = tidy[list(INPUT_COLUMNS)].to_dict("records")
    found = run_chunk(
        lambda number: judge.found(rows[number // runs], run=number % runs, start=number % runs),
        range(len(rows) * runs),
        judge.columns,
        partial,
        identity,
        told,
    )
    of_runs = likelihood(found).reshape(len(rows), runs)
    kept = tidy.rename(columns={LOG_LIKELIHOOD: QUICK_LIKELIHOOD}).assign(
        **{LOG_LIKELIHOOD: over_motions(of_runs), LEAST: of_runs.min(axis=1)}
    )
    order = [LOG_LIKELIHOOD, "tail_share"]
    return kept.sort_values(order, ascending=[False, True], kind="stable").reset_index(drop=True)


def accurate_region(
    judge: ClaimJudge,
    likelihood: Likelihood,
    region: pd.DataFrame,
    starts: int,
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """The inputs of a region from each of the starts: columns of `with_claims`, and the log-likelihood which
    the region has by quick runs.
    """
    inputs = distinct_inputs(region)
    rows = inputs[list(INPUT_COLUMNS)].to_dict("records")
    found = judged_motions(judge, likelihood, rows, starts, partial, identity, told)
    quick = np.repeat(inputs[LOG_LIKELIHOOD].to_numpy(float), starts)
    return with_claims(found, judge.claims).assign(**{QUICK_LIKELIHOOD: quick})


def rounded(value: float) -> float:
    """The number to DIGITS digits."""
    return float(f"{value:.{DIGITS}g}")


def kept_sets(confirmed: pd.DataFrame, most: int) -> pd.DataFrame:
    """The best inputs of each pattern, at most so many, named a, b, c ...; the first is `recommended`."""
    best = confirmed.drop_duplicates("pattern").head(most).reset_index(drop=True)
    names = list(string.ascii_lowercase[: len(best)])
    columns = [*INPUT_COLUMNS, LOG_LIKELIHOOD, LEAST, QUICK_LIKELIHOOD]
    return best[columns].assign(set=names, recommended=best.index == 0)[["set", "recommended", *columns]]
