"""The scorecard: each claim beside our result, with a verdict and its reason."""

from collections.abc import Iterable, Sequence
from enum import StrEnum
from typing import Any

import pandas as pd

from facegear.errors import FacegearError
from facegear.paper.scorecard.claims import Claim
from facegear.paper.scorecard.criteria import CRITERIA
from facegear.paper.scorecard.outcome import Outcome, Tables, describe

OUTCOME_COLUMNS = ("id", "value", "shown", "holds", "chance")


class Verdict(StrEnum):
    """What a row comes to."""

    REPRODUCED = "reproduced"
    DIFFERS = "differs"
    DEPENDS = "depends on an undisclosed input"


def outcome_table(claims: Iterable[Claim], tables: Tables) -> pd.DataFrame:
    """What the criteria find: columns id, value, shown, holds and chance.

    The chance is the probability with which a number picked at random would hold, where the criterion takes
    the nearest of several.

    Raises FacegearError for an unknown criterion or one that finds no result.
    """
    rows = []
    for claim in claims:
        outcome = _evaluate(claim, tables)
        chance = None if claim.tolerance is None else outcome.chance(claim.tolerance)
        rows.append((claim.id, outcome.value, outcome.shown, _holds(claim, outcome), chance))
    return pd.DataFrame(rows, columns=list(OUTCOME_COLUMNS))


def scorecard(claims: Iterable[Claim], own: pd.DataFrame, others: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """One row a claim, judged by the outcomes with the config's inputs and with other sets that fit as well.

    A row that fails with the config's inputs but holds with another set depends on an undisclosed input.
    Raises FacegearError for a row that fails without a reason.
    """
    indexed = own.set_index("id")
    spreads = [other.set_index("id") for other in others]
    return pd.DataFrame([_row(claim, indexed, spreads) for claim in claims])


def verdict(holds: bool, others: Sequence[bool], undisclosed: Sequence[str]) -> Verdict:
    """Verdict of a row from what holds with the config's inputs and with each other set that fits."""
    if holds:
        return Verdict.REPRODUCED
    return Verdict.DEPENDS if undisclosed and any(others) else Verdict.DIFFERS


def _evaluate(claim: Claim, tables: Tables) -> Outcome:
    if claim.criterion not in CRITERIA:
        raise FacegearError(f"scorecard row {claim.id}: unknown criterion {claim.criterion!r}")
    try:
        return CRITERIA[claim.criterion](tables, **claim.args)
    except (KeyError, IndexError, TypeError) as error:
        raise FacegearError(f"scorecard row {claim.id}: no result for it ({error})") from error


def _holds(claim: Claim, outcome: Outcome) -> bool:
    if claim.paper is None or claim.tolerance is None:
        return bool(outcome.holds)
    slack = 1e-9 * abs(claim.paper)
    return outcome.value is not None and abs(outcome.value - claim.paper) <= claim.tolerance + slack


def _row(claim: Claim, own: pd.DataFrame, others: Sequence[pd.DataFrame]) -> dict[str, Any]:
    found = own.loc[claim.id]
    spread = [other.loc[claim.id] for other in others if claim.id in other.index]
    decided = verdict(bool(found["holds"]), [bool(one["holds"]) for one in spread], claim.undisclosed)
    if decided is not Verdict.REPRODUCED and not claim.reason:
        raise FacegearError(f"scorecard row {claim.id} ({found['shown']}): {decided.value}, without a reason")
    values = [float(one["value"]) for one in spread if pd.notna(one["value"])]
    ours = float(found["value"]) if pd.notna(found["value"]) else None
    return {
        "id": claim.id,
        "where": claim.where,
        "claim": claim.claim,
        "criterion": describe(CRITERIA[claim.criterion], claim.args),
        "paper": claim.paper,
        "ours": ours,
        "difference": ours - claim.paper if ours is not None and claim.paper is not None else None,
        "tolerance": claim.tolerance,
        "unit": claim.unit,
        "shown": found["shown"],
        "chance": float(found["chance"]) if pd.notna(found["chance"]) else None,
        "verdict": decided.value,
        "fitted": claim.fitted,
        "counted": claim.counts,
        "sets_low": min(values) if values else None,
        "sets_high": max(values) if values else None,
        "sets_reproducing": f"{sum(bool(one['holds']) for one in spread)} of {len(spread)}" if spread else "",
        "undisclosed": "; ".join(claim.undisclosed),
        "reason": claim.reason if decided is not Verdict.REPRODUCED else "",
    }
