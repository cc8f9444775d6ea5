"""How often random plausible inputs hold each claim: the level that a verdict has to be seen against."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.scenarios.statistics import fraction_of
from paper.scorecard.claims import Claim

CONFIDENCE = 0.95
TAILS = (0.05, 0.95)
RATE_COLUMNS = ("id", "samples", "held", "share", "low", "high")


@dataclass(frozen=True, eq=False)
class Totals:
    """Of `claims` distinct claims, how many each random set of inputs holds, shape (samples,)."""

    claims: int
    held: Array

    @property
    def mean(self) -> float:
        """Claims held on average."""
        return float(self.held.mean())

    @property
    def spread(self) -> tuple[float, float]:
        """The 5th and the 95th percentile of the number of claims held."""
        low, high = np.quantile(self.held, TAILS)
        return float(low), float(high)

    def share_reaching(self, count: int) -> float:
        """Share of the samples that hold at least as many claims."""
        return float((self.held >= count).mean())


def base_rates(samples: pd.DataFrame, claims: Iterable[Claim]) -> pd.DataFrame:
    """Samples judged, samples that hold the claim, their share and its Wilson interval; one row a claim.

    `samples` has a column a claim, 1 where it holds; samples that have no result are left out.
    """
    rows, judged = [], sound(samples)
    for claim in claims:
        held = judged[claim.id].to_numpy(bool)
        fraction = fraction_of(held, CONFIDENCE)
        rows.append((claim.id, held.size, int(held.sum()), fraction.value, fraction.low, fraction.high))
    return pd.DataFrame(rows, columns=list(RATE_COLUMNS))


def totals(samples: pd.DataFrame, claims: Sequence[Claim]) -> Totals:
    """Claims held by each sample; repeated numbers count once, and only claims that were judged count."""
    ids = [claim.id for claim in claims if claim.counts and claim.id in samples.columns]
    return Totals(len(ids), sound(samples)[ids].sum(axis=1).to_numpy(float))


def sound(samples: pd.DataFrame) -> pd.DataFrame:
    """The samples that have a result."""
    return samples[samples["error"].isna() | (samples["error"] == "")]
