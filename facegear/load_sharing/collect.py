"""The results of all cases of the studies in one place."""

from collections.abc import Mapping

import pandas as pd

NOMINAL = "nominal"


def collected(
    frames: Mapping[tuple[str, str], pd.DataFrame], labels: Mapping[tuple[str, str], str] | None = None
) -> pd.DataFrame:
    """Tables of several cases under each other, with the columns study, point and label in front.

    `point` is the case's folder, `label` what the config calls it; without `labels` they are the same.
    """
    parts = []
    for (study, point), frame in frames.items():
        labelled = frame.copy()
        labelled.insert(0, "study", study)
        labelled.insert(1, "point", point)
        labelled.insert(2, "label", (labels or {}).get((study, point), point))
        parts.append(labelled)
    return pd.concat(parts, ignore_index=True)
