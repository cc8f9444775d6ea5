"""How likely inputs are, by the claims that the fit uses."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
import scipy.stats
from numpy.typing import NDArray

from facegear.paper.identify.claim_judge import SPREAD, VALUE
from facegear.paper.scorecard.base_rates import sound
from facegear.paper.scorecard.claims import Claim
from facegear.paper.scorecard.criteria import reads_sweep

FREEDOM = 4.0
"""Degrees of freedom of the t distribution of a number about the paper's."""
UNDEFINED = 1.0
"""Distance from the paper's number that stands for one without a value: half the range of the idlers'
coefficient.
"""

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Likelihood:
    """Log-likelihood of inputs over distinct fitted claims.

    `surprise`: minus the logarithm of each claim's base rate, shape (claims,).
    """

    claims: tuple[Claim, ...]
    surprise: Array

    @classmethod
    def of(cls, claims: Sequence[Claim], random: pd.DataFrame) -> "Likelihood":
        """Over the fitted ones of the claims that random inputs were judged by, with their base rates.

        A rate is that of Laplace, (held + 1) / (samples + 2), so that none is zero; samples that were not
        judged by a claim hold NaN.
        """
        kept = tuple(one for one in claims if one.fitted and one.counts and one.id in random.columns)
        held = sound(random)[[claim.id for claim in kept]].to_numpy(float)
        rates = (np.nansum(held, axis=0) + 1.0) / (np.isfinite(held).sum(axis=0) + 2.0)
        return cls(kept, -np.log(rates))

    def __call__(self, found: pd.DataFrame) -> Array:
        """Log-likelihood of each row of judged inputs, shape (rows,); minus infinity without a result.

        A statement that holds counts its surprise. So does the nearest of several speeds, which some speed
        always is. A number counts the logarithm of a t density, its scale the root of the squares of half the
        tolerance and of the spread over windows of the motion, in units of half the tolerance. Claims that
        the rows were not judged by count nothing.
        """
        total = np.zeros(len(found))
        for claim, surprise in zip(self.claims, self.surprise, strict=True):
            if claim.id not in found.columns:
                continue
            if is_number(claim):
                total += _number(claim, found)
            else:
                total += surprise * found[claim.id].fillna(0.0).to_numpy(float)
        failed = found["error"].fillna("").to_numpy(str) != ""
        return np.where(failed, -np.inf, total)

    def most_without(self, found: pd.DataFrame) -> float:
        """The most that claims which the rows were not judged by could still add."""
        absent = [claim.id not in found.columns for claim in self.claims]
        return float(self.surprise[absent].sum())


def is_number(claim: Claim) -> bool:
    """Whether a claim counts as a number: not a statement, and not the nearest of several speeds."""
    return claim.paper is not None and not reads_sweep(claim.criterion)


def _number(claim: Claim, found: pd.DataFrame) -> Array:
    assert claim.paper is not None and claim.tolerance is not None
    unit = 0.5 * claim.tolerance
    off = (found[f"{claim.id} {VALUE}"] - claim.paper).fillna(UNDEFINED).to_numpy(float)
    scale = np.hypot(unit, found[f"{claim.id} {SPREAD}"].fillna(0.0).to_numpy(float))
    density: Array = scipy.stats.t.logpdf(off / scale, FREEDOM) - np.log(scale / unit)
    return density
