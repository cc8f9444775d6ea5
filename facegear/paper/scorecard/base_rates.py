"""How often random plausible inputs hold each claim: the level that a verdict has to be seen against."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from facegear.paper.scorecard.claims import Claim
from facegear.scenarios.statistics import share

CONFIDENCE = 0.95
TAILS = (0.05, 0.95)
RESAMPLES = 499
INPUT_RATE_COLUMNS = (
    *("input", "value", "samples"),
    *("claims", "mean", "mean_error", "upper", "upper_error", "most"),
    *("all_claims", "all_mean", "all_most"),
)
RATE_COLUMNS = ("id", "samples", "held", "share", "low", "high")


@dataclass(frozen=True, eq=False)
class Totals:
    """Of `claims` distinct claims, how many each random set of inputs holds, shape (samples,)."""

    claims: int
    held: NDArray[np.float64]

    @property
    def mean(self) -> float:
        """Claims held on average."""
        return float(self.held.mean())

    @property
    def spread(self) -> tuple[float, float]:
        """Claims held by the lowest and the highest 5 % of the samples, at most and at least."""
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
        found = share(held, CONFIDENCE)
        rows.append((claim.id, held.size, int(held.sum()), found.value, found.low, found.high))
    return pd.DataFrame(rows, columns=list(RATE_COLUMNS))


def totals(samples: pd.DataFrame, claims: Sequence[Claim]) -> Totals:
    """Claims held by each sample; repeated numbers count once, and only claims that were judged count."""
    ids = [claim.id for claim in claims if claim.counts and claim.id in samples.columns]
    return Totals(len(ids), sound(samples)[ids].sum(axis=1).to_numpy(float))


def by_input(samples: pd.DataFrame, claims: Sequence[Claim], name: str) -> pd.DataFrame:
    """Distinct claims held under each value of an input, fitted ones and all; the best value first.

    Columns input, value, samples; of the fitted claims their number, and mean, upper 5 % and most of those
    held, mean and upper with their standard errors; of all claims their number, mean and most.
    """
    rows = []
    for value, group in samples.groupby(name, sort=False):
        fitted, every = totals(group, [claim for claim in claims if claim.fitted]), totals(group, claims)
        upper, held = fitted.spread[1], fitted.held
        errors = held.std(ddof=1) / np.sqrt(held.size), upper_error(held)
        told = (fitted.claims, fitted.mean, errors[0], upper, errors[1], int(held.max()))
        rows.append((name, value, held.size, *told, every.claims, every.mean, int(every.held.max())))
    frame = pd.DataFrame(rows, columns=list(INPUT_RATE_COLUMNS))
    return frame.sort_values(["mean", "upper"], ascending=False, kind="stable").reset_index(drop=True)


def upper_error(held: NDArray[np.float64]) -> float:
    """Standard error of the upper 5 %, by resampling."""
    drawn = np.random.default_rng(0).choice(held, (RESAMPLES, held.size))
    return float(np.quantile(drawn, TAILS[1], axis=1).std(ddof=1))


def shares_of(designs: Mapping[str, pd.DataFrame], claims: Iterable[Claim]) -> pd.DataFrame:
    """Share of the samples of each design that hold each distinct claim, with its interval; and the claim's
    id and whether the fit uses it.
    """
    judged = [claim for claim in claims if claim.counts and all(claim.id in one for one in designs.values())]
    told = pd.DataFrame([(claim.id, claim.fitted) for claim in judged], columns=["id", "fitted"])
    for name, samples in designs.items():
        rates = base_rates(samples, judged)
        told = told.assign(**{f"{name}_{what}": rates[what] for what in ("share", "low", "high")})
    return told


def sound(samples: pd.DataFrame) -> pd.DataFrame:
    """The samples that have a result."""
    return samples[samples["error"].isna() | (samples["error"] == "")]
