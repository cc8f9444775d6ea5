"""Contact of the studies' cases side by side."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from facegear.arrays import Arrays
from facegear.contact.studies import StudiedContact, study_table
from facegear.number_format import count_noun
from facegear.stages.outcome import Outcome


def contact_studies(
    points: Sequence[Sequence[str]],
    pair: Sequence[Mapping[str, Any]],
    ltca: Sequence[pd.DataFrame],
    by_torque: Sequence[pd.DataFrame],
    pressure: Sequence[Arrays],
) -> Outcome:
    """Collect the contact of the studies' cases side by side.

    Parameters
    ----------
    points : Sequence[Sequence[str]]
        Study, point and label of each case, the machine itself first.
    pair : Sequence[Mapping[str, Any]]
        Record `pair` of stage geometry of each case.
    ltca : Sequence[pd.DataFrame]
        Table of stage contact of each case.
    by_torque : Sequence[pd.DataFrame]
        Table of stage contact of each case.
    pressure : Sequence[Arrays]
        Arrays of stage contact of each case.

    Returns
    -------
    Outcome
        `table`, a row for each case and torque.
    """
    cases = StudiedContact.from_columns(points, pair, ltca, by_torque, pressure)
    table = study_table(cases)
    shift = table.loc[table["path_shift_mm"].abs().idxmax()]
    largest = f"{shift['path_shift_mm']:.2f} mm ({shift['label']})"
    return Outcome(
        {"table": table}, f"{count_noun(len(cases) - 1, 'case')}; largest shift of the contact path {largest}"
    )
