"""What the samples of a machine with its tolerances say."""

from collections.abc import Sequence

import pandas as pd

from facegear.config.tolerances import Tolerances
from facegear.load_sharing.quantity_names import MISSED, OPEN, REVERSED
from facegear.scenarios.chunks import ERROR
from facegear.scenarios.summary import (
    importance_table,
    index_table,
    percentile_table,
    sampling_table,
    share_table,
)
from facegear.stages.outcome import Outcome

SHARES = {
    OPEN: "some mesh that shares a load opens",
    REVERSED: "some mesh is loaded on the flank that it does not work on",
}


def tolerances(
    samples: Sequence[pd.DataFrame], indices: Sequence[pd.DataFrame], tolerances: Tolerances
) -> Outcome:
    """`samples`, `percentiles`, `shares`, `importance`, `indices`, `sampling` (tables) from both designs.

    `sampling`: what the mesh cycles taken from the hunting cycle miss, in the samples that were computed over
    the whole of it.
    """
    causes = [cause.name for cause in tolerances.causes]
    every = pd.concat(samples, ignore_index=True)
    found = every.drop(columns=list(MISSED.values()), errors="ignore")
    design = pd.concat(indices, ignore_index=True) if indices else every.iloc[:0]
    percentiles = percentile_table(found, causes, tolerances.confidence)
    shares = share_table(every, SHARES, tolerances.confidence)
    top = percentiles[(percentiles["percentile"] == 99.0) & percentiles["quantity"].str.startswith("k_gamma")]
    worst = top.nlargest(1, "value")
    told = ", ".join(f"99 of 100 stay below {row.quantity} = {row.value:.3f}" for row in worst.itertuples())
    sampling = sampling_table(every, MISSED)
    told = "; ".join([told or "no path shares a load", *_missed_in_words(sampling)])
    failed = int((every[ERROR] != "").sum())
    if failed == len(every):
        told = f"the first by: {every[ERROR].iloc[0]}"
    return Outcome(
        {
            "samples": every,
            "percentiles": percentiles,
            "shares": shares,
            "importance": importance_table(found, causes),
            "indices": index_table(design, causes, tolerances.confidence),
            "sampling": sampling,
        },
        f"{len(every)} samples, {failed} failed; {told}",
    )


def _missed_in_words(sampling: pd.DataFrame) -> list[str]:
    parts = [f"{row.quantity} {row.largest_missed:.1e}" for row in sampling.itertuples()]
    most = sampling["samples"].max()
    return [f"the mesh cycles taken miss at most {', '.join(parts)} ({most} samples)"] if parts else []
