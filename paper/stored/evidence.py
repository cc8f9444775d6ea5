"""What the repository stores beside the config's own run: other sets, repeated runs, random inputs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from facegear.io import tables
from paper.scorecard.base_rates import RATE_COLUMNS, Totals, base_rates, totals
from paper.scorecard.claims import Claim
from paper.scorecard.rows import RUN_COLUMNS
from paper.scorecard.starts import START_COLUMNS, start_table
from paper.stored.runs import STORED_COLUMNS, runs_of_config
from paper.stored.sets import stored_sets

File = str | Path | Sequence[str]
"""A file, or nothing where there is none."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Sets that fit, runs made with the config's settings, rates of claims and totals of random inputs.

    `starts`: how many claims each set holds from rest and from every start.
    """

    sets: pd.DataFrame
    runs: pd.DataFrame
    rates: pd.DataFrame
    chance: Totals | None
    starts: pd.DataFrame


def stored_evidence(
    claims: Sequence[Claim], case: Mapping[str, Any], sets: File, runs: File, random: File
) -> Evidence:
    """Read what is stored; `case` holds the full plain values of the config. Raises CorruptFile."""
    fitting = pd.read_csv(str(sets)) if sets else pd.DataFrame()
    same, rates = pd.DataFrame(columns=RUN_COLUMNS), pd.DataFrame(columns=RATE_COLUMNS)
    chance, starts = None, pd.DataFrame(columns=START_COLUMNS)
    if runs:
        others = stored_sets(str(sets)) if sets else {}
        stored = tables.read(str(runs), STORED_COLUMNS[:4])
        same, starts = runs_of_config(stored, case, others), start_table(stored, claims)
    if random:
        samples = tables.read(str(random))
        judged = [claim for claim in claims if claim.id in samples.columns]
        rates, chance = base_rates(samples, judged), totals(samples, judged)
    return Evidence(fitting, same, rates, chance, starts)
