"""Random plausible inputs judged by number, in chunks that resume where they were killed."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pandas as pd

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import INPUT_COLUMNS
from facegear.paper.scorecard.claims import Claim, read_claims
from facegear.paper.scorecard.criteria import reads_sweep
from facegear.scenarios.chunks import SAMPLE, run_chunk


def dynamic_judge(
    values: Mapping[str, Any],
    ltca: pd.DataFrame,
    claims: str | Path,
    kept: Callable[[Claim], bool] = lambda claim: True,
    settings: Mapping[str, Any] = MappingProxyType({}),
) -> ClaimJudge:
    """Judge of a config by the dynamic claims of a file, or some of them."""
    chosen = [claim for claim in read_claims(claims).claims if claim.dynamic and kept(claim)]
    return ClaimJudge(values, ltca, chosen, settings)


def fitted_at_speed(claim: Claim) -> bool:
    """Whether the fit uses a claim that needs no sweep."""
    return claim.fitted and unswept(claim)


def unswept(claim: Claim) -> bool:
    """Whether a claim needs no speed sweep, which takes ten times as long as all the rest."""
    return not reads_sweep(claim.criterion)


def judged_samples(
    judge: ClaimJudge,
    rows: Sequence[Mapping[str, Any]],
    numbers: Sequence[int],
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """One row a sample: its number, its inputs (`rows`, in the order of the numbers), the judge's columns,
    error.

    `partial` keeps finished samples of the same `identity`. A sample without a result has its error.
    """
    by_number = dict(zip(numbers, rows, strict=True))
    found = run_chunk(
        lambda number: judge.found(by_number[number]), numbers, judge.columns, partial, identity, told
    )
    inputs = pd.DataFrame([*rows], columns=list(INPUT_COLUMNS))
    return pd.concat([found[[SAMPLE]], inputs, found.drop(columns=SAMPLE)], axis=1)
