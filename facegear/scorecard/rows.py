"""The scorecard: each claim beside our result, with a verdict and its reason."""

from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Any

import pandas as pd

from facegear.errors import FacegearError
from facegear.scorecard.claims import Claim, Claims
from facegear.scorecard.criteria import CRITERIA
from facegear.scorecard.outcome import Outcome, Tables, describe


class Verdict(StrEnum):
    """What a row comes to."""

    REPRODUCED = "reproduced"
    DIFFERS = "differs"
    DEPENDS = "depends on an undisclosed input"


def scorecard(claims: Claims, tables: Tables, others: Mapping[str, Tables]) -> pd.DataFrame:
    """One row a claim, judged with the config's own inputs and with `others`, sets that fit about as well.

    A row that fails with the config's inputs but holds with another set depends on an undisclosed input.
    Raises FacegearError for a criterion that finds no result, and for a row that fails unexplained.
    """
    return pd.DataFrame([_row(claim, tables, others) for claim in claims.claims])


def evaluate(claim: Claim, tables: Tables) -> tuple[Outcome, bool]:
    """The criterion's outcome and whether the claim holds. Raises FacegearError where a result is missing."""
    if claim.criterion not in CRITERIA:
        raise FacegearError(f"scorecard row {claim.id}: unknown criterion {claim.criterion!r}")
    try:
        outcome = CRITERIA[claim.criterion](tables, **claim.args)
    except (KeyError, IndexError, TypeError) as error:
        raise FacegearError(f"scorecard row {claim.id}: no result for it ({error})") from error
    if claim.paper is None or claim.tolerance is None:
        return outcome, bool(outcome.holds)
    slack = 1e-9 * abs(claim.paper)
    holds = outcome.value is not None and abs(outcome.value - claim.paper) <= claim.tolerance + slack
    return outcome, holds


def verdict(holds: bool, others: Sequence[bool], undisclosed: Sequence[str]) -> Verdict:
    """Verdict of a row from what holds with the config's inputs and with each other set that fits."""
    if holds:
        return Verdict.REPRODUCED
    return Verdict.DEPENDS if undisclosed and any(others) else Verdict.DIFFERS


def _row(claim: Claim, tables: Tables, others: Mapping[str, Tables]) -> dict[str, Any]:
    outcome, holds = evaluate(claim, tables)
    spread = [evaluate(claim, other) for other in others.values()] if claim.undisclosed else []
    decided = verdict(holds, [held for _, held in spread], claim.undisclosed)
    if decided is not Verdict.REPRODUCED and not claim.reason:
        raise FacegearError(f"scorecard row {claim.id} is {decided.value} ({outcome.shown}) without a reason")
    values = [found.value for found, _ in spread if found.value is not None]
    numeric = claim.paper is not None and outcome.value is not None
    return {
        "id": claim.id,
        "where": claim.where,
        "claim": claim.claim,
        "criterion": describe(CRITERIA[claim.criterion], claim.args),
        "paper": claim.paper,
        "ours": outcome.value,
        "difference": outcome.value - claim.paper if numeric else None,
        "tolerance": claim.tolerance,
        "unit": claim.unit,
        "shown": outcome.shown,
        "verdict": decided.value,
        "fitted": claim.fitted,
        "sets_low": min(values) if values else None,
        "sets_high": max(values) if values else None,
        "sets_reproducing": f"{sum(held for _, held in spread)} of {len(spread)}" if spread else "",
        "undisclosed": "; ".join(claim.undisclosed),
        "reason": claim.reason if decided is not Verdict.REPRODUCED else "",
    }
