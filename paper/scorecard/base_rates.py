"""Shares of random plausible inputs that hold each claim: the level to compare a verdict with."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.studies.statistics import fraction_of
from paper.scorecard.claims import Claim

CONFIDENCE = 0.95
"""Level of the Wilson interval of a share, dimensionless."""
TAILS = (0.05, 0.95)
"""Quantiles of the number of claims held that are quoted as its spread, dimensionless."""
RATE_COLUMNS = ("id", "samples", "held", "share", "low", "high")
"""Columns of `base_rates`."""


@dataclass(frozen=True, eq=False)
class Totals:
    """Number of claims that each random set of inputs holds, (samples,), out of `claims` distinct ones."""

    claims: int
    claims_held: Array

    @property
    def mean(self) -> float:
        """Claims held on average."""
        return float(self.claims_held.mean())

    @property
    def spread(self) -> tuple[float, float]:
        """The 5th and the 95th percentile of the number of claims held."""
        low, high = np.quantile(self.claims_held, TAILS)
        return float(low), float(high)

    def share_reaching(self, count: int) -> float:
        """Return the share of the samples that hold at least as many claims.

        Parameters
        ----------
        count : int
            Number of claims.

        Returns
        -------
        float
            Share, 0 to 1.
        """
        return float((self.claims_held >= count).mean())


def base_rates(samples: pd.DataFrame, claims: Iterable[Claim]) -> pd.DataFrame:
    """Count the samples that hold each claim, one row a claim.

    Rows hold the samples judged, samples that hold the claim, their share and its Wilson interval.

    Parameters
    ----------
    samples : DataFrame
        A column a claim, 1 where it holds; samples that have no result are left out.
    claims : Iterable[Claim]
        Claims to count.

    Returns
    -------
    DataFrame
        Columns as RATE_COLUMNS.
    """
    rows, valid_samples = [], sound(samples)
    for claim in claims:
        is_true = valid_samples[claim.id].to_numpy(bool)
        fraction = fraction_of(is_true, CONFIDENCE)
        rows.append((claim.id, is_true.size, int(is_true.sum()), fraction.value, fraction.low, fraction.high))
    return pd.DataFrame(rows, columns=list(RATE_COLUMNS))


def totals(samples: pd.DataFrame, claims: Sequence[Claim]) -> Totals:
    """Count the claims held by each sample; repeated numbers count once, and only claims that were judged
    count.

    Parameters
    ----------
    samples : DataFrame
        A column a claim, 1 where it holds.
    claims : Sequence[Claim]
        All claims.

    Returns
    -------
    Totals
        Number of claims held by each sample.
    """
    ids = [claim.id for claim in claims if claim.counts and claim.id in samples.columns]
    return Totals(len(ids), sound(samples)[ids].sum(axis=1).to_numpy(float))


def sound(samples: pd.DataFrame) -> pd.DataFrame:
    """Select the samples that have a result.

    Parameters
    ----------
    samples : DataFrame
        Samples with a column `error`.

    Returns
    -------
    DataFrame
        Rows without an error.
    """
    return samples[samples["error"].isna() | (samples["error"] == "")]
