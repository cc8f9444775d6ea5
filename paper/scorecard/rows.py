"""The scorecard: each claim beside our result, with a verdict and its reason."""

from collections.abc import Iterable, Sequence
from enum import StrEnum
from typing import Any

import pandas as pd

from facegear.errors import FacegearError
from paper.scorecard.claims import Claim
from paper.scorecard.criteria import CRITERIA
from paper.scorecard.outcome import ClaimOutcome, Tables, describe

OWN = "config"
"""Name of the config's own inputs among the sets."""
RUN_COLUMNS = ("set", "id", "runs", "held", "low", "high")
OUTCOME_COLUMNS = ("id", "value", "shown", "holds", "chance", "windows", "spread")


class Verdict(StrEnum):
    """What a row comes to."""

    REPRODUCED = "reproduced"
    UNDECIDED = "undecided"
    DIFFERS = "differs"
    DEPENDS = "depends on an undisclosed input"


def outcome_table(claims: Iterable[Claim], tables: Tables) -> pd.DataFrame:
    """What the criteria find, columns OUTCOME_COLUMNS.

    The chance is the probability with which a number picked at random would hold, where the criterion takes
    the nearest of several. `windows` is the range of a number over single cycles and other starts where its
    ends do not hold alike, and empty otherwise; `spread` is half its width.

    Raises FacegearError for an unknown criterion or one that finds no result.
    """
    rows = []
    for claim in claims:
        outcome = _evaluate(claim, tables)
        chance = None if claim.tolerance is None else outcome.chance(claim.tolerance)
        judged = (outcome.value, outcome.shown, _holds(claim, outcome.value, outcome.holds), chance)
        low, high = outcome.windows or (0.0, 0.0)
        rows.append((claim.id, *judged, _split(claim, outcome), 0.5 * (high - low)))
    return pd.DataFrame(rows, columns=list(OUTCOME_COLUMNS))


def scorecard(
    claims: Iterable[Claim], own: pd.DataFrame, runs: pd.DataFrame, rates: pd.DataFrame
) -> pd.DataFrame:
    """One row a claim, from its outcome with the config's inputs.

    `runs` (columns RUN_COLUMNS) says how other runs of the config and of other sets that fit as well came
    out, `rates` (RATE_COLUMNS) how random inputs do; both may be empty. A row is undecided where runs of the
    config that differ by rounding or start disagree, or its number does not hold in all windows of the
    motion. One that fails with the config's inputs but holds in every run of another set depends on an
    undisclosed input.

    Raises FacegearError for a row that differs or depends without a reason.
    """
    indexed = own.set_index("id")
    judged = {str(name): rows.set_index("set") for name, rows in runs.groupby("id")}
    shares = rates.set_index("id")
    return pd.DataFrame([_row(claim, indexed, judged.get(claim.id), shares) for claim in claims])


def verdict(split: bool, holds: bool, others: Sequence[bool], undisclosed: Sequence[str]) -> Verdict:
    """Verdict of a row from whether its own runs disagree, what they say, and whether other sets hold."""
    if split:
        return Verdict.UNDECIDED
    if holds:
        return Verdict.REPRODUCED
    return Verdict.DEPENDS if undisclosed and any(others) else Verdict.DIFFERS


def _evaluate(claim: Claim, tables: Tables) -> ClaimOutcome:
    if claim.criterion not in CRITERIA:
        raise FacegearError(f"scorecard row {claim.id}: unknown criterion {claim.criterion!r}")
    try:
        return CRITERIA[claim.criterion](tables, **claim.args)
    except (KeyError, IndexError, TypeError) as error:
        raise FacegearError(f"scorecard row {claim.id}: no result for it ({error})") from error


def _holds(claim: Claim, value: float | None, stated: bool | None) -> bool:
    if claim.paper is None or claim.tolerance is None:
        return bool(stated)
    slack = 1e-9 * abs(claim.paper)
    return value is not None and abs(value - claim.paper) <= claim.tolerance + slack


def _split(claim: Claim, outcome: ClaimOutcome) -> str:
    """Range over the windows where a part of it, but not all, is within the tolerance."""
    if outcome.windows is None or claim.paper is None or claim.tolerance is None:
        return ""
    low, high = outcome.windows
    lower, upper = claim.paper - claim.tolerance, claim.paper + claim.tolerance
    meets, inside = low <= upper and high >= lower, lower <= low and high <= upper
    return f"{low:.4g} to {high:.4g}" if meets and not inside else ""


def _row(claim: Claim, own: pd.DataFrame, judged: pd.DataFrame | None, rates: pd.DataFrame) -> dict[str, Any]:
    run = own.loc[claim.id]
    sets = pd.DataFrame(columns=RUN_COLUMNS) if judged is None else judged.drop(index=OWN, errors="ignore")
    again = None if judged is None or OWN not in judged.index else judged.loc[OWN]
    others = [bool(entry.held == entry.runs) for entry in sets.itertuples()]
    note = _disagreement(bool(run["holds"]), str(run["windows"]), again)
    decided = verdict(note != "", bool(run["holds"]), others, claim.undisclosed)
    reason = note if note else "" if decided is Verdict.REPRODUCED else claim.reason
    if decided is not Verdict.REPRODUCED and not reason:
        raise FacegearError(f"scorecard row {claim.id} ({run['shown']}): {decided.value}, without a reason")
    ours = float(run["value"]) if pd.notna(run["value"]) else None
    rate = rates.loc[claim.id] if claim.id in rates.index else None
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
        "shown": run["shown"],
        "chance": float(run["chance"]) if pd.notna(run["chance"]) else None,
        "random_share": None if rate is None else float(rate["share"]),
        "random_low": None if rate is None else float(rate["low"]),
        "random_high": None if rate is None else float(rate["high"]),
        "verdict": decided.value,
        "holds": bool(run["holds"]),
        "runs_holding": "" if again is None else f"{int(again['held'])} of {int(again['runs'])}",
        "fitted": claim.fitted,
        "counted": claim.counts,
        "dynamic": claim.dynamic,
        "sets_low": float(sets["low"].min()) if sets["low"].notna().any() else None,
        "sets_high": float(sets["high"].max()) if sets["high"].notna().any() else None,
        "sets_reproducing": f"{sum(others)} of {len(others)}" if others else "",
        "undisclosed": "; ".join(claim.undisclosed),
        "reason": reason,
    }


def _disagreement(holds: bool, windows: str, again: "pd.Series | None") -> str:
    """Why a row is undecided; empty where it is not."""
    if windows:
        return f"Single cycles of the motion, or other starts, give {windows}: only a part of it agrees."
    if again is None or int(again["held"]) == holds * int(again["runs"]):
        return ""
    return (
        f"Holds {'' if holds else 'not '}here, and in {int(again['held'])} of {int(again['runs'])} runs that "
        "differ by 1e-12 in the inputs and in their start: the motion, or which one is reached, hangs on it."
    )
