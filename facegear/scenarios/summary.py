"""Tables of what many samples say of each quantity."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np
import pandas as pd
import scipy.stats

from facegear.scenarios.chunks import ERROR, SAMPLE
from facegear.scenarios.statistics import Estimate, fraction_of, percentile, sobol_indices

PERCENTILES, LOW_PERCENTILES = (0.5, 0.95, 0.99), (0.5, 0.05, 0.01)
INDEX_COLUMNS = (
    "quantity",
    "cause",
    "first",
    "first_low",
    "first_high",
    "total",
    "total_low",
    "total_high",
    "blocks",
    "blocks_failed",
)


def quantities_of(samples: pd.DataFrame, causes: Sequence[str]) -> list[str]:
    """Columns of a table of samples that hold what was found."""
    return [name for name in samples.columns if name not in (SAMPLE, *causes, ERROR)]


def percentile_table(
    samples: pd.DataFrame, causes: Sequence[str], confidence: float, better_large: Collection[str] = ()
) -> pd.DataFrame:
    """One row a quantity and percentile: value, and the interval that holds it; empty ends are unbounded.

    Of quantities that are `better_large` the small percentiles. Samples that failed are left out; `samples`
    counts the others.
    """
    rows = []
    for name in quantities_of(samples, causes):
        values = samples[name].to_numpy(float)
        values = values[np.isfinite(values)]
        asked = LOW_PERCENTILES if name in better_large else PERCENTILES
        for probability in asked if values.size else ():
            estimate = _bounded(percentile(values, probability, confidence))
            rows.append((name, 100.0 * probability, *estimate, values.size))
    table = pd.DataFrame(rows, columns=["quantity", "percentile", "value", "low", "high", "samples"])
    numbers = dict.fromkeys(("percentile", "value", "low", "high"), float)
    return table.astype({"quantity": str, **numbers, "samples": int})  # also where every sample failed


def fraction_table(samples: pd.DataFrame, events: dict[str, str], confidence: float) -> pd.DataFrame:
    """Fraction of the samples that failed, and of those in which a fraction of time or loss is above zero.

    `events`: column -> what it means in words. Columns: what, fraction, low, high, samples.
    """
    failed = samples[ERROR].to_numpy() != ""
    rows = [("cannot be built or computed", failed)]
    rows += [
        (label, samples.loc[~failed, name].to_numpy(float) > 0.0)
        for name, label in events.items()
        if name in samples
    ]
    fractions = [(label, fraction_of(hits, confidence), hits.size) for label, hits in rows if hits.size]
    return pd.DataFrame(
        [(label, fraction.value, fraction.low, fraction.high, size) for label, fraction, size in fractions],
        columns=["what", "fraction", "low", "high", "samples"],
    )


def sampling_table(samples: pd.DataFrame, missed: Mapping[str, str]) -> pd.DataFrame:
    """What samples miss that take a part of the hunting cycle, from those computed over the whole of it too.

    `missed`: quantity -> column that holds it, nan in the other samples. Columns: quantity, samples,
    median_missed, largest_missed (sizes); no row for a quantity that was not computed twice.
    """
    rows = []
    for name, column in missed.items():
        sizes = samples[column].dropna().abs() if column in samples else pd.Series(dtype=float)
        if not sizes.empty:
            rows.append((name, len(sizes), sizes.median(), sizes.max()))
    return pd.DataFrame(rows, columns=["quantity", "samples", "median_missed", "largest_missed"])


def importance_table(samples: pd.DataFrame, causes: Sequence[str]) -> pd.DataFrame:
    """Rank correlation (Spearman) of every quantity with every cause; empty where one never changes."""
    whole = samples[samples[ERROR] == ""]
    rows = []
    for name in quantities_of(samples, causes):
        values = whole[name].to_numpy(float)
        known = np.isfinite(values)
        for cause in causes:
            given = whole[cause].to_numpy(float)[known]
            changes = known.sum() > 2 and np.ptp(values[known]) > 0.0 and np.ptp(given) > 0.0
            rank = scipy.stats.spearmanr(given, values[known]).statistic if changes else np.nan
            rows.append((name, cause, rank))
    return pd.DataFrame(rows, columns=["quantity", "cause", "rank_correlation"])


def index_table(samples: pd.DataFrame, causes: Sequence[str], confidence: float) -> pd.DataFrame:
    """Sobol indices of every quantity that changes, from the results of Saltelli's design."""
    rows = []
    for name in quantities_of(samples, causes) if len(samples) else ():
        values = samples[name].to_numpy(float)
        if not np.isfinite(values).any() or np.nanmax(values) == np.nanmin(values):
            continue
        indices = sobol_indices(values, len(causes), confidence)
        for cause, first, total in zip(causes, indices.first, indices.total, strict=True):
            ends = (first.value, first.low, first.high, total.value, total.low, total.high)
            rows.append((name, cause, *ends, indices.blocks, indices.failed))
    return pd.DataFrame(rows, columns=list(INDEX_COLUMNS))


def _bounded(estimate: Estimate) -> tuple[float, float, float]:
    low, high = (end if np.isfinite(end) else np.nan for end in (estimate.low, estimate.high))
    return estimate.value, low, high
