"""Statistics of the samples of a machine with its tolerances."""

from collections.abc import Sequence

import pandas as pd

from facegear.config.tolerances import Tolerances
from facegear.load_sharing.quantity_names import (
    BETTER_LARGE,
    CONTACT_TEMPERATURE,
    CYCLE_SELECTION_ERRORS,
    LOSS,
    OPEN_FRACTION,
    PAST_LAW,
    REVERSED_FRACTION,
    SIMPLIFICATION_ERRORS,
    UNSOLVED,
)
from facegear.number_format import count_noun
from facegear.scenarios.chunks import ERROR
from facegear.scenarios.summary import (
    fraction_table,
    importance_table,
    index_table,
    percentile_table,
    sampling_table,
)
from facegear.stages.outcome import Outcome

EVENTS = {
    OPEN_FRACTION: "some mesh that shares a load opens",
    REVERSED_FRACTION: "some mesh is loaded on the flank that it does not work on",
    PAST_LAW: "some mesh is past the last level of its load-dependent law",
    UNSOLVED: "some mesh loses under a torque outside those of the contact analysis",
}
CHECKS = {
    **CYCLE_SELECTION_ERRORS,
    **{f"{name}, of few places of the contact": column for name, column in SIMPLIFICATION_ERRORS.items()},
}
"""Quantity -> column that holds, for some samples, what their value misses."""


def tolerances(
    samples: Sequence[pd.DataFrame], indices: Sequence[pd.DataFrame], tolerances: Tolerances
) -> Outcome:
    """Compute percentiles, fractions and importance from both designs of samples.

    `sampling` tells what the mesh cycles taken from the hunting cycle miss, in the samples that were computed
    over the whole of it, and what friction misses that is taken at few places of the contact.

    Parameters
    ----------
    samples : Sequence[pd.DataFrame]
        Chunks of random samples.
    indices : Sequence[pd.DataFrame]
        Chunks of samples for sensitivity indices, empty if there are none.
    tolerances : Tolerances
        Section `tolerances` of the config.

    Returns
    -------
    Outcome
        Tables `samples`, `percentiles`, `fractions`, `importance`, `indices` and `sampling`.
    """
    causes = [cause.name for cause in tolerances.causes]
    every = pd.concat(samples, ignore_index=True)
    values = every.drop(columns=list(CHECKS.values()), errors="ignore")
    index_samples = pd.concat(indices, ignore_index=True) if indices else every.iloc[:0]
    design = index_samples.drop(columns=list(CHECKS.values()), errors="ignore")
    percentiles = percentile_table(values, causes, tolerances.confidence, BETTER_LARGE)
    fractions = fraction_table(every, EVENTS, tolerances.confidence)
    top = percentiles[(percentiles["percentile"] == 99.0) & percentiles["quantity"].str.startswith("k_gamma")]
    worst = top.nlargest(1, "value")
    summary = ", ".join(
        f"99 of 100 stay below {row.quantity} = {row.value:.3f}" for row in worst.itertuples()
    )
    sampling = sampling_table(every, CHECKS)
    summary = "; ".join(
        [summary or "no path shares a load", *_hot_in_words(percentiles), *_missed_in_words(sampling)]
    )
    failure_count = int((every[ERROR] != "").sum())
    if failure_count == len(every):
        summary = f"the first by: {every[ERROR].iloc[0]}"
    return Outcome(
        {
            "samples": every,
            "percentiles": percentiles,
            "fractions": fractions,
            "importance": importance_table(values, causes),
            "indices": index_table(design, causes, tolerances.confidence),
            "sampling": sampling,
        },
        f"{count_noun(len(every), 'sample')}, {failure_count} failed; {summary}",
    )


def _hot_in_words(percentiles: pd.DataFrame) -> list[str]:
    rows = percentiles[percentiles["percentile"] == 99.0].set_index("quantity")["value"]
    if CONTACT_TEMPERATURE not in rows:
        return []
    return [f"{rows[LOSS]:.0f} W of friction and a contact temperature of {rows[CONTACT_TEMPERATURE]:.0f} C"]


def _missed_in_words(sampling: pd.DataFrame) -> list[str]:
    parts = [f"{row.quantity} {row.largest_missed:.1e}" for row in sampling.itertuples()]
    max_samples = sampling["samples"].max()
    cycles = [part for part in parts if part.partition(" ")[0] in CYCLE_SELECTION_ERRORS]
    misses_by_place = sampling.loc[~sampling["quantity"].isin(list(CYCLE_SELECTION_ERRORS)), "largest_missed"]
    cycle_texts = (
        [f"the mesh cycles taken miss at most {', '.join(cycles)} ({count_noun(max_samples, 'sample')})"]
        if cycles
        else []
    )
    return cycle_texts + (
        [f"the places that friction is taken at miss at most {misses_by_place.max():.1e}"]
        if len(misses_by_place)
        else []
    )
