"""The scorecard as an HTML page."""

from pathlib import Path

import pandas as pd

from facegear.io import pages
from facegear.paper.scorecard.rows import Verdict

TEMPLATE = Path(__file__).with_name("scorecard.html.j2")
DIGITS = 5


def counts(frame: pd.DataFrame) -> dict[str, int]:
    """Distinct rows about this model by verdict, all verdicts present."""
    kept = frame[frame["counted"]]
    return {one.value: int((kept["verdict"] == one.value).sum()) for one in Verdict}


def render(frame: pd.DataFrame, source: str, inputs: list[str], sets: pd.DataFrame) -> str:
    """The page; `inputs` are lines naming the inputs the paper does not disclose, `sets` those that fit."""
    held_out = frame[(frame["undisclosed"] != "") & ~frame["fitted"]]
    return pages.render(
        TEMPLATE,
        source=source,
        counts=counts(frame),
        fitted=counts(frame[frame["fitted"]]),
        held_out=counts(held_out),
        left_out=int((~frame["counted"]).sum()),
        inputs=inputs,
        parts=[(where, rows.to_dict("records")) for where, rows in frame.groupby("where", sort=False)],
        sets_header=[str(name).replace("_", " ") for name in sets.columns],
        sets_rows=[[_cell(value) for value in row] for row in sets.itertuples(index=False)],
        cell=_cell,
    )


def _cell(value: object) -> str:
    if value is None or value != value:
        return ""
    return f"{value:.{DIGITS}g}" if isinstance(value, float) else str(value)
