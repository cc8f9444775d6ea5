"""What the samples of a machine with its tolerances say."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from facegear.config.base import parse
from facegear.config.tolerances import Tolerances
from facegear.load_sharing.quantity_names import OPEN, REVERSED
from facegear.scenarios.summary import (
    importance_table,
    index_table,
    percentile_table,
    share_table,
)
from facegear.stages.outcome import Outcome

SHARES = {
    OPEN: "some mesh that shares a load opens",
    REVERSED: "some mesh is loaded on the flank that it does not work on",
}


def tolerances(
    samples: Sequence[pd.DataFrame], indices: Sequence[pd.DataFrame], tolerances: Mapping[str, Any]
) -> Outcome:
    """`samples`, `percentiles`, `shares`, `importance`, `indices` (tables) from both designs."""
    section = parse(Tolerances, tolerances)
    causes = [cause.name for cause in section.causes]
    every = pd.concat(samples, ignore_index=True)
    design = pd.concat(indices, ignore_index=True) if indices else every.iloc[:0]
    percentiles = percentile_table(every, causes, section.confidence)
    shares = share_table(every, SHARES, section.confidence)
    top = percentiles[(percentiles["percentile"] == 99.0) & percentiles["quantity"].str.startswith("k_gamma")]
    worst = top.nlargest(1, "value")
    told = ", ".join(f"99 of 100 stay below {row.quantity} = {row.value:.3f}" for row in worst.itertuples())
    failed = int((every["error"] != "").sum())
    return Outcome(
        {
            "samples": every,
            "percentiles": percentiles,
            "shares": shares,
            "importance": importance_table(every, causes),
            "indices": index_table(design, causes, section.confidence),
        },
        f"{len(every)} samples, {failed} failed; {told or 'no path shares a load'}",
    )
