"""Random plausible inputs judged by number, in chunks that resume where they were killed."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.scenarios.chunks import SAMPLE, run_chunk

INPUT_COLUMNS = (
    *("pattern", "meaning", "phase_convention", "waveform"),
    *("per_input_n_m", "tail_share", "error_phase_deg"),
)


def judged_samples(
    judge: ClaimJudge,
    rows: Sequence[Mapping[str, Any]],
    numbers: Sequence[int],
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """One row a sample: its number, its inputs (`rows`, in the order of the numbers), 1 or 0 a claim, error.

    `partial` keeps finished samples of the same `identity`. A sample without a result has its error.
    """
    by_number = dict(zip(numbers, rows, strict=True))
    found = run_chunk(
        lambda number: judge.held(by_number[number]), numbers, judge.names, partial, identity, told
    )
    inputs = pd.DataFrame([{name: row[name] for name in INPUT_COLUMNS} for row in rows])
    return pd.concat([found[[SAMPLE]], inputs, found.drop(columns=SAMPLE)], axis=1)
