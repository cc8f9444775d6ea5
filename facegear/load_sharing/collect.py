"""Collect the results of all cases of the studies in one table."""

from collections.abc import Mapping

import pandas as pd

NOMINAL = "nominal"
"""Name of the study without changes."""


def collect_tables(
    frames: Mapping[tuple[str, str], pd.DataFrame], labels: Mapping[tuple[str, str], str] | None = None
) -> pd.DataFrame:
    """Put tables of several cases under each other, with the columns study, point and label in front.

    Parameters
    ----------
    frames : mapping of (study, point) to DataFrame
        Tables; point is the case's folder.
    labels : mapping of (study, point) to str, or None
        Name of each case in the config; the folder if None.

    Returns
    -------
    pd.DataFrame
        All rows.
    """
    parts = []
    for (study, point), frame in frames.items():
        table = frame.copy()
        table.insert(0, "study", study)
        table.insert(1, "point", point)
        table.insert(2, "label", (labels or {}).get((study, point), point))
        parts.append(table)
    return pd.concat(parts, ignore_index=True)
