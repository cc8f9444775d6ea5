"""Results that the repository stores in addition to the config's own run: other sets, repeated runs, random
inputs.
"""

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
    """Read the stored results.

    Parameters
    ----------
    claims : Sequence[Claim]
        All claims.
    case : Mapping[str, Any]
        Full plain values of the config.
    sets : File
        File of the sets that fit.
    runs : File
        File of the repeated runs.
    random : File
        File of the random inputs.

    Returns
    -------
    Evidence
        Results that hold for the config's settings.

    Raises
    ------
    CorruptFile
        If a file cannot be read.
    """
    fitting = pd.read_csv(str(sets)) if sets else pd.DataFrame()
    matching_runs, rates = pd.DataFrame(columns=RUN_COLUMNS), pd.DataFrame(columns=RATE_COLUMNS)
    chance, starts = None, pd.DataFrame(columns=START_COLUMNS)
    if runs:
        set_rows = stored_sets(str(sets)) if sets else {}
        stored_runs = tables.read(str(runs), STORED_COLUMNS[:4])
        matching_runs, starts = runs_of_config(stored_runs, case, set_rows), start_table(stored_runs, claims)
    if random:
        samples = tables.read(str(random))
        judged_claims = [claim for claim in claims if claim.id in samples.columns]
        rates, chance = base_rates(samples, judged_claims), totals(samples, judged_claims)
    return Evidence(fitting, matching_runs, rates, chance, starts)
