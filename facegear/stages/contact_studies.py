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
    """`table`, a row a case and torque.

    `points`: study, point and label of each case, the machine itself first; of each case the record of stage
    geometry and what stage contact gives.
    """
    cases = StudiedContact.from_columns(points, pair, ltca, by_torque, pressure)
    table = study_table(cases)
    shift = table.loc[table["path_shift_mm"].abs().idxmax()]
    largest = f"{shift['path_shift_mm']:.2f} mm ({shift['label']})"
    return Outcome(
        {"table": table}, f"{count_noun(len(cases) - 1, 'case')}; largest shift of the contact path {largest}"
    )
