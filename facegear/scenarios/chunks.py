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
COLLECTED = 1000
"""Samples after which garbage is collected: arrays count for nothing with Python's own collector, which comes
late where a few objects hold large ones."""


def run_chunk(
    evaluate: Evaluate,
    numbers: Sequence[int],
    columns: Sequence[str],
    partial: str | Path,
    identity: str,
    on_progress: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Evaluate samples by number; rows in the order of the numbers.

    `partial` keeps every finished sample at once, so that a killed chunk goes on after its last one; its rows
    count only if they were written under the same `identity` (a hash of everything that decides a result).
    `on_progress` is called after each sample. A sample that raises FacegearError becomes a row with the
    error's text and NaN in `columns`. Columns: sample, `columns`, error.
    """
    known = {record[SAMPLE]: record for record in journal.read(partial, identity)}
    results, errors = np.full((len(numbers), len(columns)), np.nan), []
    with journal.appending(partial, identity) as append:
        for row, number in enumerate(numbers):
            record = known.pop(number, None)
            if record is None:
                record = _record(evaluate, number, columns)
                append(record)
            if record["values"] is not None:
                results[row] = record["values"]
            errors.append(record[ERROR])
            if (row + 1) % COLLECTED == 0:
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
    """Text that differs whenever one of the parts, plain values, does."""
    return json.dumps(parts, sort_keys=True)
