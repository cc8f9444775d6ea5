"""A chunk of samples in one warm process: appended as it goes, resumed where it was killed."""

import gc
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from facegear.errors import FacegearError
from facegear.io import journal

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
    """Evaluate samples by number, and keep every finished one at once.

    A killed chunk goes on after its last sample. A sample that raises FacegearError becomes a row with the
    error's text.

    Parameters
    ----------
    evaluate : Evaluate
        Results by column name of one sample, given its number.
    numbers : Sequence[int]
        Numbers of the samples.
    columns : Sequence[str]
        Names of the results.
    partial : str or Path
        Journal of finished samples; its rows count only if they were written under the same identity.
    identity : str
        Hash of everything that decides a result.
    on_progress : Callable[[], None]
        Called after each sample.

    Returns
    -------
    pd.DataFrame
        Columns sample, `columns` and error, rows in the order of the numbers; NaN in `columns` where a sample
        failed.
    """
    stored_records = {record[SAMPLE]: record for record in journal.read(partial, identity)}
    results, errors = np.full((len(numbers), len(columns)), np.nan), []
    with journal.appending(partial, identity) as append:
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
    try:
        values = evaluate(number)
    except FacegearError as error:
        return {SAMPLE: number, "values": None, ERROR: str(error).splitlines()[0]}
    return {SAMPLE: number, "values": [float(values[name]) for name in columns], ERROR: ""}


def identity(*parts: object) -> str:
    """Join values to a text that differs whenever one of them does.

    Parameters
    ----------
    *parts : object
        Plain values.

    Returns
    -------
    str
        The text.
    """
    return json.dumps(parts, sort_keys=True)
