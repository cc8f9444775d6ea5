"""The scorecard as an HTML page."""

from pathlib import Path
from typing import Any

import pandas as pd

from facegear.io import pages
from facegear.number_format import format_number
from paper.scorecard.base_rates import Totals
from paper.scorecard.rows import Verdict

TEMPLATE = Path(__file__).with_name("scorecard.html.j2")
DIGITS = 4
"""Number of significant digits on the page."""
ORDER = (Verdict.DIFFERS, Verdict.INCONCLUSIVE, Verdict.DEPENDS, Verdict.REPRODUCED)
"""Verdicts in the order of the page: differences first."""


def counts(frame: pd.DataFrame) -> dict[str, int]:
    """Count the distinct rows about this model by verdict, all verdicts present.

    Parameters
    ----------
    frame : DataFrame
        The scorecard, a row a claim.

    Returns
    -------
    dict[str, int]
        Number of rows by verdict.
    """
    counted_rows = frame[frame["counted"]]
    return {verdict.value: int((counted_rows["verdict"] == verdict.value).sum()) for verdict in Verdict}


def render(
    frame: pd.DataFrame,
    source: str,
    inputs: list[str],
    sets: pd.DataFrame,
    starts: pd.DataFrame,
    chance: Totals | None = None,
) -> str:
    """Render the page.

    Parameters
    ----------
    frame : DataFrame
        The scorecard, a row a claim.
    source : str
        The publication.
    inputs : list[str]
        Lines that name the inputs the paper does not disclose.
    sets : DataFrame
        Sets of inputs that fit.
    starts : DataFrame
        Claims that each set holds from rest and from every start (START_COLUMNS).
    chance : Totals or None
        Claims that random inputs hold, None where there are none.

    Returns
    -------
    str
        The page, HTML.
    """
    held_out = frame[(frame["undisclosed"] != "") & ~frame["fitted"]]
    return pages.render(
        TEMPLATE,
        source=source,
        counts=counts(frame),
        fitted=counts(frame[frame["fitted"]]),
        held_out=counts(held_out),
        left_out=int((~frame["counted"]).sum()),
        chance=None if chance is None else against_chance(frame, chance),
        inputs=inputs,
        groups=groups(frame),
        starts_header=[str(name).replace("_", " ") for name in starts.columns],
        starts_rows=[[_cell(value) for value in row] for row in starts.itertuples(index=False)],
        sets_header=[str(name).replace("_", " ") for name in sets.columns],
        sets_rows=[[_cell(value) for value in row] for row in sets.itertuples(index=False)],
        cell=_cell,
    )


def groups(frame: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the rows by verdict, differences first; rows that do not count are the last group.

    Parameters
    ----------
    frame : DataFrame
        The scorecard, a row a claim.

    Returns
    -------
    list of dict
        Of each group `name` (for styles), `words`, `title`, the number of `rows`, and its `claims`. Every row
        is in one group.
    """
    is_counted = frame["counted"].astype(bool)
    parts = [(str(verdict), frame[is_counted & (frame["verdict"] == verdict.value)]) for verdict in ORDER]
    parts.append(("not counted", frame[~is_counted]))
    return [
        {
            "name": words.split()[0],
            "words": words,
            "title": words.capitalize(),
            "rows": len(part),
            "claims": part.to_dict("records"),
        }
        for words, part in parts
    ]


def against_chance(frame: pd.DataFrame, chance: Totals) -> str:
    """Compare the claims that the config's inputs hold with those of random inputs, in words.

    Parameters
    ----------
    frame : DataFrame
        The scorecard, a row a claim.
    chance : Totals
        Claims that random inputs hold.

    Returns
    -------
    str
        The text.
    """
    dynamic_rows = frame[frame["counted"] & frame["dynamic"]]
    true_claims = int(dynamic_rows["holds"].sum())
    steady = int((dynamic_rows["verdict"] == Verdict.REPRODUCED).sum())
    low, high = chance.spread
    share = chance.share_reaching(true_claims)
    better = "no better than chance" if true_claims <= high else "more than 95 % of random inputs do"
    return (
        f"Of {chance.claims} distinct claims that hang on the dynamics' undisclosed inputs, "
        f"{chance.claims_held.size} random plausible sets of inputs hold {chance.mean:.1f} on average "
        "(the middle "
        f"90 % of them {low:.0f} to {high:.0f}, the best {chance.claims_held.max():.0f}). "
        "The inputs used here hold "
        f"{true_claims}, {steady} of them in every run: {better}; {100 * share:.0f} % of the random sets "
        "hold as many or more."
    )


def _cell(value: object) -> str:
    if value is None or value != value:
        return ""
    return format_number(value, DIGITS) if isinstance(value, float) else str(value)
