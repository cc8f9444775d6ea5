"""The page of the paper's figures: each beside its claims and their verdicts."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.io import pages
from facegear.number_format import count_noun, format_number
from paper.figures.claims_of import NUMBERS, claims_of
from paper.reproduction import InputSet
from paper.scorecard.claims import Claims
from paper.scorecard.page import DIGITS, ORDER, counts

TEMPLATE = Path(__file__).with_name("page.html.j2")
MOST_OPEN = 12
"""Claims of a figure up to which they are shown without a click."""
TITLES = {
    6: "Vibration modes of the system",
    7: "Time-varying mesh stiffness",
    8: "Harmonic components of the mesh stiffness variation",
    9: "Displacements along the line of action of the ten meshes at 7500 rpm, and their spectra",
    10: "RMS of the pinions' translational displacements",
    11: "RMS of the face gears' translational displacements",
    12: "RMS of the displacements along the line of action, speed rising and falling",
    13: "Effect of backlash: upper and lower face gear",
    14: "Effect of backlash: idler pinions and tail rotor idler",
    15: "Effect of pinion supporting stiffness: upper and lower face gear",
    16: "Effect of pinion supporting stiffness: idler pinions and tail rotor idler",
    17: "Effect of face gear supporting stiffness: upper and lower face gear",
    18: "Effect of face gear supporting stiffness: idler pinions and tail rotor idler",
    19: "Effect of distribution angle: upper and lower face gear",
    20: "Effect of distribution angle: idler pinions and tail rotor idler",
}


def file_name(number: int, ending: str) -> str:
    """Return the name of a file of a figure.

    Parameters
    ----------
    number : int
        Number of the figure.
    ending : str
        Ending of the name, without the dot.

    Returns
    -------
    str
        Name of the file.
    """
    return f"fig{number:02d}.{ending}"


def render(
    case: str, words: Sequence[str], claims: Claims, scorecard: pd.DataFrame, inputs: Sequence[InputSet]
) -> str:
    """Render the page of a case.

    Parameters
    ----------
    case : str
        Name of the case.
    words : Sequence[str]
        Undisclosed inputs of the case, in words.
    claims : Claims
        Claims of the publication.
    scorecard : DataFrame
        The scorecard, a row a claim.
    inputs : Sequence[InputSet]
        Cases that the reader may switch between.

    Returns
    -------
    str
        The page, HTML.
    """
    rows = {str(row["id"]): row for row in scorecard.to_dict("records")}
    figures = [
        {
            "number": number,
            "title": TITLES[number],
            "files": {ending: file_name(number, ending) for ending in ("svg", "png", "csv")},
            "rows": [_cells(rows[claim.id]) for claim in claims_of(number, claims.claims)],
            "said": _counts_in_words([rows[claim.id] for claim in claims_of(number, claims.claims)]),
        }
        for number in NUMBERS
    ]
    return pages.render(
        TEMPLATE,
        case=case,
        source=claims.source,
        words=words,
        counts=counts(scorecard),
        left_out=int((~scorecard["counted"]).sum()),
        inputs=inputs,
        figures=figures,
        most_open=MOST_OPEN,
    )


def _counts_in_words(rows: Sequence[Mapping[Any, Any]]) -> str:
    """Return how many claims a figure has, and how many of each verdict, differences first."""
    verdicts = Counter(str(row["verdict"]) for row in rows)
    counts_text = [
        f"{verdicts[verdict.value]} {verdict.value}" for verdict in ORDER if verdicts[verdict.value]
    ]
    return f"{count_noun(len(rows), 'claim')}: {', '.join(counts_text)}"


def _cells(row: Mapping[Any, Any]) -> dict[str, str]:
    """Cells of a claim as text; nothing where there is none."""
    paper, fraction = row["paper"], row["random_share"]
    has_number = paper is not None and paper == paper
    return {
        "claim": str(row["claim"]),
        "fitted": "fitted" if row["fitted"] else "",
        "paper": f"{format_number(paper, DIGITS)} {row['unit'] if row['unit'] == row['unit'] else ''}".strip()
        if has_number
        else "",
        "ours": str(row["shown"]),
        "verdict": str(row["verdict"]),
        "random": f"{100 * fraction:.0f} %" if fraction is not None and fraction == fraction else "",
    }
