"""Mean and largest mesh forces of the cases of studies over numbers."""

from collections.abc import Sequence

import pandas as pd

from facegear.stages.outcome import Outcome
from facegear.ties import first_largest_row


def study_forces(
    points: Sequence[tuple[str, str, str, str, str, float]], tables: Sequence[pd.DataFrame]
) -> Outcome:
    """Collect mean and largest mesh forces of the cases of studies over numbers.

    Parameters
    ----------
    points : Sequence[tuple[str, str, str, str, str, float]]
        Study, point, label of the number, label on the other axis, key and number of every point.
    tables : Sequence[pd.DataFrame]
        `load_sharing/forces.csv` of each point.

    Returns
    -------
    Outcome
        Table `forces`, a row for each point and mesh.
    """
    parts = []
    for point, table in zip(points, tables, strict=True):
        key_columns = dict(zip(("study", "point", "axis", "beside", "key", "number"), point, strict=True))
        parts.append(
            pd.DataFrame({**{name: [value] * len(table) for name, value in key_columns.items()}, **table})
        )
    forces = pd.concat(parts, ignore_index=True)
    worst = first_largest_row(forces, "largest_n")
    at = f"{worst['axis']} = {worst['number']:g}"
    text = f"largest force {worst['largest_n']:.5g} N, on {worst['mesh']} at {at}"
    return Outcome({"forces": forces}, text)
