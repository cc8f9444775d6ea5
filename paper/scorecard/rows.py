"""The scorecard: each claim beside our result, with a verdict and its reason."""

from collections.abc import Iterable, Sequence
from enum import StrEnum
from typing import Any

import pandas as pd

from facegear.errors import FacegearError
from paper.scorecard.claims import Claim
from paper.scorecard.criteria import CRITERIA
from paper.scorecard.outcome import ClaimOutcome, Tables, describe

CONFIG_SET = "config"
"""Name of the config's own inputs among the sets."""
RUN_COLUMNS = ("set", "id", "runs", "held", "low", "high")
"""Columns of the table of repeated runs."""
OUTCOME_COLUMNS = ("id", "value", "shown", "holds", "chance", "windows", "spread")
"""Columns of the table of outcomes."""


class Verdict(StrEnum):
    """Verdicts of a row."""

    REPRODUCED = "reproduced"
    INCONCLUSIVE = "undecided"
    DIFFERS = "differs"
    DEPENDS = "depends on an undisclosed input"


def outcome_table(claims: Iterable[Claim], tables: Tables) -> pd.DataFrame:
    """Evaluate the criteria of all claims.

    The chance is the probability with which a number picked at random would hold, where the criterion takes
    the nearest of several. `windows` is the range of a number over single cycles and other starts where its
    ends do not hold alike, and empty otherwise; `spread` is half its width.

    Parameters
    ----------
    claims : Iterable[Claim]
        Claims to evaluate.
    tables : Tables
        Stored results by name.

    Returns
    -------
    DataFrame
        Columns as OUTCOME_COLUMNS.

    Raises
    ------
    FacegearError
        For an unknown criterion or one that finds no result.
    """
    rows = []
    for claim in claims:
        outcome = _evaluate(claim, tables)
        chance = None if claim.tolerance is None else outcome.chance(claim.tolerance)
        columns = (outcome.value, outcome.text, _holds(claim, outcome.value, outcome.holds), chance)
        low, high = outcome.windows or (0.0, 0.0)
        rows.append((claim.id, *columns, _split(claim, outcome), 0.5 * (high - low)))
    return pd.DataFrame(rows, columns=list(OUTCOME_COLUMNS))


def scorecard(
    claims: Iterable[Claim], outcomes: pd.DataFrame, runs: pd.DataFrame, rates: pd.DataFrame
) -> pd.DataFrame:
    """Judge each claim from its outcome with the config's inputs, one row a claim.

    A row is undecided where runs of the config that differ by rounding or start disagree, or its number does
    not hold in all windows of the motion. One that fails with the config's inputs but holds in every run of
    another set depends on an undisclosed input.

    Parameters
    ----------
    claims : Iterable[Claim]
        Claims to judge.
    outcomes : DataFrame
        Outcomes with the config's inputs (OUTCOME_COLUMNS).
    runs : DataFrame
        Results of other runs of the config and of other sets that fit as well (RUN_COLUMNS); may be empty.
    rates : DataFrame
        Results of random inputs (RATE_COLUMNS); may be empty.

    Returns
    -------
    DataFrame
        The scorecard.

    Raises
    ------
    FacegearError
        For a row that differs or depends without a reason.
    """
    indexed = outcomes.set_index("id")
    runs_by_claim = {str(name): rows.set_index("set") for name, rows in runs.groupby("id")}
    shares = rates.set_index("id")
    return pd.DataFrame([_row(claim, indexed, runs_by_claim.get(claim.id), shares) for claim in claims])


def verdict(
    split: bool, holds: bool, set_verdicts: Sequence[bool], undisclosed_inputs: Sequence[str]
) -> Verdict:
    """Return the verdict of a row.

    Parameters
    ----------
    split : bool
        Whether its own runs disagree.
    holds : bool
        Whether the claim holds with the config's inputs.
    set_verdicts : Sequence[bool]
        Whether it holds in every run of each other set.
    undisclosed_inputs : Sequence[str]
        Undisclosed inputs on which the row depends.

    Returns
    -------
    Verdict
        The verdict.
    """
    if split:
        return Verdict.INCONCLUSIVE
    if holds:
        return Verdict.REPRODUCED
    return Verdict.DEPENDS if undisclosed_inputs and any(set_verdicts) else Verdict.DIFFERS


def _evaluate(claim: Claim, tables: Tables) -> ClaimOutcome:
    if claim.criterion not in CRITERIA:
        raise FacegearError(f"scorecard row {claim.id}: unknown criterion {claim.criterion!r}")
    try:
        return CRITERIA[claim.criterion](tables, **claim.args)
    except (KeyError, IndexError, TypeError) as error:
        raise FacegearError(f"scorecard row {claim.id}: no result for it ({error})") from error


def _holds(claim: Claim, value: float | None, statement_holds: bool | None) -> bool:
    if claim.paper is None or claim.tolerance is None:
        return bool(statement_holds)
    slack = 1e-9 * abs(claim.paper)
    return value is not None and abs(value - claim.paper) <= claim.tolerance + slack


def _split(claim: Claim, outcome: ClaimOutcome) -> str:
    """Return the range over the windows where a part of it, but not all, is within the tolerance."""
    if outcome.windows is None or claim.paper is None or claim.tolerance is None:
        return ""
    low, high = outcome.windows
    lower, upper = claim.paper - claim.tolerance, claim.paper + claim.tolerance
    meets, inside = low <= upper and high >= lower, lower <= low and high <= upper
    return f"{low:.4g} to {high:.4g}" if meets and not inside else ""


def _row(
    claim: Claim, outcomes: pd.DataFrame, claim_runs: pd.DataFrame | None, rates: pd.DataFrame
) -> dict[str, Any]:
    run = outcomes.loc[claim.id]
    sets = (
        pd.DataFrame(columns=RUN_COLUMNS)
        if claim_runs is None
        else claim_runs.drop(index=CONFIG_SET, errors="ignore")
    )
    again = None if claim_runs is None or CONFIG_SET not in claim_runs.index else claim_runs.loc[CONFIG_SET]
    set_verdicts = [bool(entry.held == entry.runs) for entry in sets.itertuples()]
    note = _disagreement(bool(run["holds"]), str(run["windows"]), again)
    row_verdict = verdict(note != "", bool(run["holds"]), set_verdicts, claim.undisclosed_inputs)
    reason = note if note else "" if row_verdict is Verdict.REPRODUCED else claim.reason
    if row_verdict is not Verdict.REPRODUCED and not reason:
        raise FacegearError(
            f"scorecard row {claim.id} ({run['shown']}): {row_verdict.value}, without a reason"
        )
    value = float(run["value"]) if pd.notna(run["value"]) else None
    rate = rates.loc[claim.id] if claim.id in rates.index else None
    return {
        "id": claim.id,
        "where": claim.location,
        "claim": claim.claim,
        "criterion": describe(CRITERIA[claim.criterion], claim.args),
        "paper": claim.paper,
        "ours": value,
        "difference": value - claim.paper if value is not None and claim.paper is not None else None,
        "tolerance": claim.tolerance,
        "unit": claim.unit,
        "shown": run["shown"],
        "chance": float(run["chance"]) if pd.notna(run["chance"]) else None,
        "random_share": None if rate is None else float(rate["share"]),
        "random_low": None if rate is None else float(rate["low"]),
        "random_high": None if rate is None else float(rate["high"]),
        "verdict": row_verdict.value,
        "holds": bool(run["holds"]),
        "runs_holding": "" if again is None else f"{int(again['held'])} of {int(again['runs'])}",
        "fitted": claim.is_fitted,
        "counted": claim.counts,
        "dynamic": claim.dynamic,
        "sets_low": float(sets["low"].min()) if sets["low"].notna().any() else None,
        "sets_high": float(sets["high"].max()) if sets["high"].notna().any() else None,
        "sets_reproducing": f"{sum(set_verdicts)} of {len(set_verdicts)}" if set_verdicts else "",
        "undisclosed": "; ".join(claim.undisclosed_inputs),
        "reason": reason,
    }


def _disagreement(holds: bool, windows: str, again: "pd.Series | None") -> str:
    """Return why a row is undecided; empty where it is not."""
    if windows:
        return f"Single cycles of the motion, or other starts, give {windows}: only a part of it agrees."
    if again is None or int(again["held"]) == holds * int(again["runs"]):
        return ""
    return (
        f"Holds {'' if holds else 'not '}here, and in {int(again['held'])} of {int(again['runs'])} runs that "
        "differ by 1e-12 in the inputs and in their start: the motion, or which one is reached, hangs on it."
    )
