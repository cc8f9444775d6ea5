"""What a fit by the same rule reaches where the paper is another run of the model, or invented."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from facegear.paper.identify.claim_judge import VALUE
from facegear.paper.identify.likelihood import Likelihood, is_number
from facegear.paper.identify.random_inputs import PATTERN
from facegear.paper.scorecard.base_rates import sound
from facegear.paper.scorecard.claims import Claim
from facegear.scenarios.chunks import SAMPLE

THIS, ANOTHER, INVENTED = "the paper", "another run", "invented"
NULL_COLUMNS = ("paper", "fitted", "held_out")
TAILS = (0.05, 0.95)


def null_counts(samples: pd.DataFrame, claims: Sequence[Claim], papers: int, seed: int) -> pd.DataFrame:
    """Fitted and held-out claims met by the most likely of the samples, one row a paper, NULL_COLUMNS.

    The first paper is the one whose claims they are. Then random samples play the paper, each at most once:
    their numbers and what holds for them are the claims. Then invented papers, for which each group of claims
    (`where`) comes from another random sample, so that every single figure is possible and no machine has all
    of them. The samples that played, and those that share their other inputs, may not answer; so there must
    be more distinct inputs than groups.
    """
    kept = sound(samples).reset_index(drop=True)
    judged = [claim for claim in claims if claim.counts and claim.id in kept.columns]
    inputs = kept[SAMPLE] // kept[PATTERN].nunique()
    random = np.random.default_rng(seed)
    rows: list[tuple[str, int, int]] = [(THIS, *best_counts(kept, judged))]
    for number in random.choice(len(kept), min(papers, len(kept)), replace=False):
        others = kept[inputs != inputs[number]]
        rows.append((ANOTHER, *best_counts(*played(others, judged, kept.loc[number]))))
    places = list(dict.fromkeys(claim.where for claim in judged))
    for _ in range(papers):
        source = dict(zip(places, random.integers(len(kept), size=len(places)), strict=True))
        row = {
            column: kept.at[source[claim.where], column]
            for claim in judged
            for column in (claim.id, f"{claim.id} {VALUE}")
            if column in kept.columns
        }
        others = kept[~inputs.isin(inputs[list(source.values())])]
        rows.append((INVENTED, *best_counts(*played(others, judged, row))))
    return pd.DataFrame(rows, columns=list(NULL_COLUMNS))


def null_summary(counts: pd.DataFrame) -> pd.DataFrame:
    """Papers of each kind, and mean and middle 90 % of the claims that the most likely sample meets."""
    rows = []
    for kind, group in counts.groupby("paper", sort=False):
        told = [
            value
            for column in NULL_COLUMNS[1:]
            for value in (group[column].mean(), *group[column].quantile(list(TAILS)))
        ]
        rows.append((kind, len(group), *told))
    names = [f"{column}_{what}" for column in NULL_COLUMNS[1:] for what in ("mean", "low", "high")]
    return pd.DataFrame(rows, columns=["paper", "papers", *names])


def best_counts(samples: pd.DataFrame, claims: Sequence[Claim]) -> tuple[int, int]:
    """Fitted and held-out claims that hold for the most likely sample."""
    best = samples.iloc[int(Likelihood.of(claims, samples)(samples).argmax())]
    fitted, held_out = ([claim.id for claim in claims if claim.fitted is is_fit] for is_fit in (True, False))
    return int(best[fitted].sum()), int(best[held_out].sum())


def played(
    samples: pd.DataFrame, claims: Sequence[Claim], row: Mapping[str, Any] | pd.Series
) -> tuple[pd.DataFrame, list[Claim]]:
    """Samples judged anew and the claims, with what a row of judged inputs says as the paper's claims."""
    told, columns = [], {}
    for claim in claims:
        if not is_number(claim):
            told.append(claim)
            columns[claim.id] = (samples[claim.id] == row[claim.id]).astype(float)
            continue
        number = float(row[f"{claim.id} {VALUE}"])
        if np.isnan(number):  # a coefficient that is undefined for half the cycle: no claim is made of it
            continue
        told.append(claim.model_copy(update={"paper": number}))
        off = (samples[f"{claim.id} {VALUE}"] - number).abs()
        columns[claim.id] = (off <= claim.tolerance).astype(float)
    return samples.assign(**columns), told
