"""The most likely inputs at full accuracy, in runs that differ by rounding, and which of them are kept."""

import string
from collections.abc import Callable
from pathlib import Path

import pandas as pd

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import BEARINGS, INPUT_COLUMNS, NUMBERS
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.region import judged_again, with_claims
from facegear.paper.identify.search import LOG_LIKELIHOOD
from facegear.scenarios.chunks import run_chunk

QUICK_LIKELIHOOD = "quick_log_likelihood"
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
    """Rows of a region with the least log-likelihood of `runs` runs of the judge, the most likely first.

    Their numbers are rounded before. Quick runs may reach another motion than accurate ones, so that the
    order changes; of equals the one with the smaller share at the tail comes first. The region's own
    log-likelihood is kept as that of quick runs.
    """
    tidy = region.assign(**{name: region[name].map(rounded) for name in ROUNDED})
    rows = tidy[list(INPUT_COLUMNS)].to_dict("records")
    found = run_chunk(
        lambda number: judge.found(rows[number // runs], number % runs),
        range(len(rows) * runs),
        judge.columns,
        partial,
        identity,
        told,
    )
    least = likelihood(found).reshape(len(rows), runs).min(axis=1)
    kept = tidy.rename(columns={LOG_LIKELIHOOD: QUICK_LIKELIHOOD}).assign(**{LOG_LIKELIHOOD: least})
    order = [LOG_LIKELIHOOD, "tail_share"]
    return kept.sort_values(order, ascending=[False, True], kind="stable").reset_index(drop=True)


def accurate_region(
    judge: ClaimJudge,
    likelihood: Likelihood,
    region: pd.DataFrame,
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Every row of a region in one run of the judge: inputs, whether each claim holds, how many fitted and
    held-out ones do, the log-likelihood and that which the region has by quick runs.
    """
    found = judged_again(judge, likelihood, region, partial, identity, told)
    quick = region[LOG_LIKELIHOOD].to_numpy(float)
    return with_claims(found, judge.claims).assign(**{QUICK_LIKELIHOOD: quick})


def rounded(value: float) -> float:
    """The number to DIGITS digits."""
    return float(f"{value:.{DIGITS}g}")


def kept_sets(confirmed: pd.DataFrame, most: int) -> pd.DataFrame:
    """The best inputs of each pattern, at most so many, named a, b, c ...; the first is `recommended`."""
    best = confirmed.drop_duplicates("pattern").head(most).reset_index(drop=True)
    names = list(string.ascii_lowercase[: len(best)])
    columns = [*INPUT_COLUMNS, LOG_LIKELIHOOD, QUICK_LIKELIHOOD]
    return best[columns].assign(set=names, recommended=best.index == 0)[["set", "recommended", *columns]]
