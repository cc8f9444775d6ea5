"""The results of all cases of the studies in one place."""

from collections.abc import Mapping

import pandas as pd

NOMINAL = "nominal"


def collected(frames: Mapping[tuple[str, str], pd.DataFrame]) -> pd.DataFrame:
    """Tables of several cases under each other, with the columns study and point in front."""
    parts = []
    for (study, point), frame in frames.items():
        labelled = frame.copy()
        labelled.insert(0, "study", study)
        labelled.insert(1, "point", point)
        parts.append(labelled)
    return pd.concat(parts, ignore_index=True)
