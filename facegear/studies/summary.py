"""Chunks of samples that resume where they were killed, and tables of what many samples say."""

import gc
import json
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import scipy.stats

from facegear.errors import FacegearError
from facegear.io import documents
from facegear.studies.statistics import Estimate, fraction_of, percentile, sobol_indices

Evaluate = Callable[[int], Mapping[str, float]]
"""Results by column name of one sample, given its number. Raises FacegearError where it has none."""

SAMPLE, ERROR = "sample", "error"
"""Columns of the sample's number and of the text of its error."""
SAMPLES_PER_COLLECTION = 1000
"""Number of samples after which garbage is collected.

Arrays count for nothing with Python's own collector, which comes late where a few objects hold large ones.
"""


def run_chunk(
    evaluate: Evaluate,
    numbers: Sequence[int],
    columns: Sequence[str],
    partial: str | Path,
    identity: str,
    on_progress: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Evaluate samples by number, and append every finished one to a journal at once.

    Samples that the journal has under this identity are not evaluated again. A sample that raises
    FacegearError becomes a row with the error's text.

    Parameters
    ----------
    evaluate : Evaluate
        Function from a sample's number to its results by column name.
    numbers : Sequence[int]
        Numbers of the samples.
    columns : Sequence[str]
        Names of the results that are kept, in the order of the table's columns.
    partial : str or Path
        Journal of finished samples; its rows count only if they were written under the same identity.
    identity : str
        Text made of everything that decides a result, see `identity`.
    on_progress : Callable[[], None]
        Called after each sample, those from the journal included.

    Returns
    -------
    pd.DataFrame
        Columns sample, `columns` and error, rows in the order of the numbers; NaN in `columns` where a
        sample failed.
    """
    stored_records = {record[SAMPLE]: record for record in documents.read_journal(partial, identity)}
    results, errors = np.full((len(numbers), len(columns)), np.nan), []
    with documents.appending(partial, identity) as append:
        for row, number in enumerate(numbers):
            record = stored_records.pop(number, None)
            if record is None:
                record = _record(evaluate, number, columns)
                append(record)
            if record["values"] is not None:
                results[row] = record["values"]
            errors.append(record[ERROR])
            if (row + 1) % SAMPLES_PER_COLLECTION == 0:
                gc.collect()
            on_progress()
    frame = pd.DataFrame(results, columns=list(columns))
    frame.insert(0, SAMPLE, np.array(numbers, dtype=np.int64))
    frame[ERROR] = errors
    return frame


def _record(evaluate: Evaluate, number: int, columns: Sequence[str]) -> dict[str, Any]:
    """Evaluate one sample and return its journal entry: keys sample (number), values and error.

    Values are in the order of `columns`, and error is empty. For a FacegearError values is None and error
    the first line of its text.
    """
    try:
        values = evaluate(number)
    except FacegearError as error:
        return {SAMPLE: number, "values": None, ERROR: str(error).splitlines()[0]}
    return {SAMPLE: number, "values": [float(values[name]) for name in columns], ERROR: ""}


def identity(*parts: object) -> str:
    """Join values to a text (JSON with sorted keys) that differs whenever one of them does.

    Parameters
    ----------
    *parts : object
        Values that JSON can hold.

    Returns
    -------
    str
        The text, which identifies the journal of a chunk.
    """
    return json.dumps(parts, sort_keys=True)


PERCENTILES, LOW_PERCENTILES = (0.5, 0.95, 0.99), (0.5, 0.05, 0.01)
"""Levels (fractions) of the percentiles of quantities that are better small, and of those that are better
large.
"""
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
"""Columns of `index_table`."""


def quantities_of(samples: pd.DataFrame, causes: Sequence[str]) -> list[str]:
    """Return the columns of a table of samples that hold results: all but sample, the causes and error.

    Parameters
    ----------
    samples : pd.DataFrame
        Table of samples, one a row.
    causes : Sequence[str]
        Names of the causes, which are columns, too.

    Returns
    -------
    list[str]
        Names of the result columns, in their order.
    """
    return [name for name in samples.columns if name not in (SAMPLE, *causes, ERROR)]


def percentile_table(
    samples: pd.DataFrame, causes: Sequence[str], confidence: float, better_large: Collection[str] = ()
) -> pd.DataFrame:
    """Tabulate percentiles of every quantity with their confidence intervals.

    Samples that failed are left out; column `samples` counts the others.

    Parameters
    ----------
    samples : pd.DataFrame
        Table of samples: columns sample, causes, quantities and error.
    causes : Sequence[str]
        Names of the causes.
    confidence : float
        Confidence of the intervals, a fraction.
    better_large : Collection[str]
        Quantities that are better large; their low percentiles are tabulated.

    Returns
    -------
    pd.DataFrame
        Columns quantity, percentile (%), value, low, high (in the quantity's unit) and samples (count):
        one row for each quantity and percentile. NaN in low or high: the sample is too small to bound
        that end.
    """
    rows = []
    for name in quantities_of(samples, causes):
        values = samples[name].to_numpy(float)
        values = values[np.isfinite(values)]
        probabilities = LOW_PERCENTILES if name in better_large else PERCENTILES
        for probability in probabilities if values.size else ():
            estimate = _nan_if_unbounded(percentile(values, probability, confidence))
            rows.append((name, 100.0 * probability, *estimate, values.size))
    table = pd.DataFrame(rows, columns=["quantity", "percentile", "value", "low", "high", "samples"])
    numbers = dict.fromkeys(("percentile", "value", "low", "high"), float)
    return table.astype({"quantity": str, **numbers, "samples": int})  # also where every sample failed


def fraction_table(samples: pd.DataFrame, events: dict[str, str], confidence: float) -> pd.DataFrame:
    """Tabulate the fraction of samples that failed, and in which an event occurs: a column is above zero.

    Parameters
    ----------
    samples : pd.DataFrame
        Table of samples with column error, empty where a sample did not fail.
    events : dict[str, str]
        Name of the event in words, by the column that is above zero where it occurs; absent columns are
        left out.
    confidence : float
        Confidence of the intervals, a fraction.

    Returns
    -------
    pd.DataFrame
        Columns what (the event), fraction, low, high (its interval) and samples: all of them for
        failures, those that did not fail for the events.
    """
    is_failed = samples[ERROR].to_numpy() != ""
    rows = [("cannot be built or computed", is_failed)]
    rows += [
        (label, samples.loc[~is_failed, name].to_numpy(float) > 0.0)
        for name, label in events.items()
        if name in samples
    ]
    fractions = [(label, fraction_of(hits, confidence), hits.size) for label, hits in rows if hits.size]
    return pd.DataFrame(
        [(label, fraction.value, fraction.low, fraction.high, size) for label, fraction, size in fractions],
        columns=["what", "fraction", "low", "high", "samples"],
    )


def sampling_table(samples: pd.DataFrame, deviation_columns: Mapping[str, str]) -> pd.DataFrame:
    """Tabulate the errors by which samples differ from a computation over the whole hunting cycle.

    The error comes from those samples that are also computed over the whole cycle.

    Parameters
    ----------
    samples : pd.DataFrame
        Table of samples with the error columns.
    deviation_columns : Mapping[str, str]
        Column with the error of each quantity, nan in the other samples.

    Returns
    -------
    pd.DataFrame
        Columns quantity, samples (count with an error), median_missed and largest_missed, of the errors'
        sizes in the unit of their columns; no row for a quantity that was not computed twice.
    """
    rows = []
    for name, column in deviation_columns.items():
        sizes = samples[column].dropna().abs() if column in samples else pd.Series(dtype=float)
        if not sizes.empty:
            rows.append((name, len(sizes), sizes.median(), sizes.max()))
    return pd.DataFrame(rows, columns=["quantity", "samples", "median_missed", "largest_missed"])


def importance_table(samples: pd.DataFrame, causes: Sequence[str]) -> pd.DataFrame:
    """Tabulate the rank correlation (Spearman) of every quantity with every cause.

    Parameters
    ----------
    samples : pd.DataFrame
        Table of samples: columns sample, causes, quantities and error; failed ones are left out.
    causes : Sequence[str]
        Names of the causes.

    Returns
    -------
    pd.DataFrame
        Columns quantity, cause and rank_correlation (-1 to 1), a row for each pair; NaN where one of both
        never changes or fewer than three samples have a finite value.
    """
    whole = samples[samples[ERROR] == ""]
    rows = []
    for name in quantities_of(samples, causes):
        values = whole[name].to_numpy(float)
        is_finite = np.isfinite(values)
        for cause in causes:
            cause_values = whole[cause].to_numpy(float)[is_finite]
            changes = is_finite.sum() > 2 and np.ptp(values[is_finite]) > 0.0 and np.ptp(cause_values) > 0.0
            rank = scipy.stats.spearmanr(cause_values, values[is_finite]).statistic if changes else np.nan
            rows.append((name, cause, rank))
    return pd.DataFrame(rows, columns=["quantity", "cause", "rank_correlation"])


def index_table(samples: pd.DataFrame, causes: Sequence[str], confidence: float) -> pd.DataFrame:
    """Tabulate the Sobol indices of every quantity that changes.

    Parameters
    ----------
    samples : pd.DataFrame
        Table of the samples of Saltelli's design, all of them in the order of `sampling.index_samples`.
    causes : Sequence[str]
        Names of the causes.
    confidence : float
        Confidence of the intervals, a fraction.

    Returns
    -------
    pd.DataFrame
        A row for each quantity and cause: first-order and total index, each with low and high end of its
        interval, and numbers of blocks used and failed; columns INDEX_COLUMNS.
    """
    rows = []
    for name in quantities_of(samples, causes) if len(samples) else ():
        values = samples[name].to_numpy(float)
        if not np.isfinite(values).any() or np.nanmax(values) == np.nanmin(values):
            continue
        indices = sobol_indices(values, len(causes), confidence)
        for cause, first, total in zip(causes, indices.first, indices.total, strict=True):
            ends = (first.value, first.low, first.high, total.value, total.low, total.high)
            rows.append((name, cause, *ends, indices.blocks, indices.failed_blocks))
    return pd.DataFrame(rows, columns=list(INDEX_COLUMNS))


def _nan_if_unbounded(estimate: Estimate) -> tuple[float, float, float]:
    """Return value, low and high end of an estimate, with NaN in place of an infinite end."""
    low, high = (end if np.isfinite(end) else np.nan for end in (estimate.low, estimate.high))
    return estimate.value, low, high
