"""Mean and largest mesh forces of the cases of studies over numbers."""

from collections.abc import Sequence

import pandas as pd

from facegear.config.lumped_model import ToothNumbers, layout
from facegear.config.transmission import Transmission
from facegear.load_sharing.study_forces import force_rows
from facegear.stages.outcome import Outcome


def study_forces(
    points: Sequence[tuple[str, str, str, str, str, float]],
    transmission: Transmission,
    teeth: ToothNumbers,
    summaries: Sequence[pd.DataFrame],
) -> Outcome:
    """`forces` (table): one row a point and mesh.

    `points`: study, point, label of the number, label on the other axis, key and number of every point;
    `summaries`: `dynamics/summary.csv` of each.
    """
    machine = layout(transmission, teeth)
    parts = []
    for point, summary in zip(points, summaries, strict=True):
        rows = force_rows(machine, summary)
        for name, value in zip(("study", "point", "axis", "beside", "key", "number"), point, strict=True):
            rows.insert(rows.columns.get_loc("mesh"), name, value)
        parts.append(rows)
    forces = pd.concat(parts, ignore_index=True)
    worst = forces.loc[forces["largest_n"].idxmax()]
    at = f"{worst['axis']} = {worst['number']:g}"
    text = f"largest force {worst['largest_n']:.5g} N, on {worst['mesh']} at {at}"
    return Outcome({"forces": forces}, text)
