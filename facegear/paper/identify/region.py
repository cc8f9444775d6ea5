"""The region of likely inputs: what holds in it, how well each input is known, what never holds together."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from facegear.paper.identify.inputs import BEARINGS, INPUT_COLUMNS, NUMBERS
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import LOG_LIKELIHOOD, OF_MOTION, START, distinct_inputs
from facegear.paper.identify.search import REPEAT
from facegear.paper.scorecard.base_rates import by_input, shares_of, sound
from facegear.paper.scorecard.claims import Claim

LOG_UNITS = 3.0
"""Inputs within this log-likelihood of the best belong to the region."""
EXPECTED = 5.0
"""Pairs of claims are looked at that so many inputs would hold together if they were independent."""
WEIGHT = "weight"
DIGITS = 6


def candidates(searched: pd.DataFrame, likelihood: Likelihood, most: int) -> pd.DataFrame:
    """Of inputs judged without a sweep those that may belong to the region: within LOG_UNITS and what claims
    on sweeps could still add of the best; the most likely, and each input once.
    """
    distinct = distinct_inputs(searched)
    return most_likely(distinct, LOG_UNITS + likelihood.most_without(distinct)).head(most)


def most_likely(found: pd.DataFrame, within: float) -> pd.DataFrame:
    """Rows whose log-likelihood is at most `within` below the largest, the most likely first."""
    kept = found[found[LOG_LIKELIHOOD] >= found[LOG_LIKELIHOOD].max() - within]
    return kept.sort_values(LOG_LIKELIHOOD, ascending=False, kind="stable").reset_index(drop=True)


def region_tables(
    random: pd.DataFrame,
    structures: pd.DataFrame,
    searched: pd.DataFrame,
    judged: pd.DataFrame,
    claims: Sequence[Claim],
) -> dict[str, pd.DataFrame]:
    """Tables by name from all that was looked at: `likely`, the motions `judged` with the claims that they
    hold, and `region`, those of inputs that belong to it; `searches`, `shares` of claims, `counts` of claims
    held, `never_together` and `correlations`.
    """
    region = most_likely(judged, LOG_UNITS)
    looked_at = {"random": random, "patterns": structures, "searched": searched, "likely": judged}
    kinds = [one.copy().assign(**{"kind": name, WEIGHT: _weight(one)}) for name, one in looked_at.items()]
    return {
        "likely": with_claims(most_likely(judged, np.inf), claims),
        "region": with_claims(region, claims),
        "searches": searches(searched, claims),
        "shares": shares_of({"region": region, "random": random}, claims),
        "counts": pd.concat([by_input(one, claims, "kind") for one in kinds], ignore_index=True),
        "never_together": never_together(pd.concat(kinds, ignore_index=True), claims),
        "correlations": correlations(distinct_inputs(region)).reset_index(names="input"),
    }


def _weight(found: pd.DataFrame) -> float:
    """What a motion counts, so that inputs count once however many starts they were judged from."""
    return 1.0 / found[START].nunique() if START in found and len(found) else 1.0


def held_counts(found: pd.DataFrame, claims: Sequence[Claim]) -> pd.DataFrame:
    """Distinct claims that each row holds: columns fitted and held_out, those it was judged by."""
    columns = {
        name: found[[one.id for one in claims if one.counts and one.fitted is is_fit and one.id in found]]
        for name, is_fit in (("fitted", True), ("held_out", False))
    }
    return pd.DataFrame({name: held.sum(axis=1).astype(int) for name, held in columns.items()})


def searches(searched: pd.DataFrame, claims: Sequence[Claim]) -> pd.DataFrame:
    """One row a pattern, the most likely first: inputs evaluated, fitted claims that its search judged, those
    that the most likely motion of the most likely inputs holds and that any motion holds, the largest
    log-likelihood, and that of each repeat.
    """
    rows, repeats = [], sorted(searched[REPEAT].unique())
    held = held_counts(searched, claims)["fitted"]
    judged = sum(claim.counts and claim.fitted and claim.id in searched for claim in claims)
    for pattern, group in searched.groupby("pattern", sort=False):
        best = group.sort_values([LOG_LIKELIHOOD, OF_MOTION], ascending=False, kind="stable").index[0]
        told = (judged, int(held[best]), int(held[group.index].max()), float(group[LOG_LIKELIHOOD][best]))
        repeated = [group.loc[group[REPEAT] == repeat, LOG_LIKELIHOOD].max() for repeat in repeats]
        rows.append((pattern, int((group[START] == 0).sum()), *told, *repeated))
    columns = ["pattern", "evaluations", "claims", "held", "most", LOG_LIKELIHOOD]
    columns += [f"{LOG_LIKELIHOOD}_{repeat}" for repeat in repeats]
    frame = pd.DataFrame(rows, columns=columns)
    return frame.sort_values(LOG_LIKELIHOOD, ascending=False, kind="stable").reset_index(drop=True)


def never_together(found: pd.DataFrame, claims: Sequence[Claim]) -> pd.DataFrame:
    """Pairs of claims that no motion holds together, though EXPECTED inputs would if they were independent.

    Rows that were not judged by a claim hold NaN; a pair is seen in the rows judged by both. A row counts its
    WEIGHT of its inputs. Columns first, second, inputs judged, inputs that hold each, and those expected to
    hold both; the most expected first.
    """
    kept = sound(found)
    ids = [claim.id for claim in claims if claim.counts and claim.id in kept.columns]
    values = kept[ids].to_numpy(float)
    judged, held = np.isfinite(values).astype(float), np.nan_to_num(values)
    weighted = judged * kept[WEIGHT].to_numpy(float)[:, None]
    both, count, together = judged.T @ weighted, held.T @ weighted, held.T @ held
    expected = count * count.T / np.maximum(both, 1.0)
    pairs = np.argwhere(np.triu((together == 0.0) & (expected >= EXPECTED), k=1))
    rows = [(ids[i], ids[j], both[i, j], count[i, j], count[j, i], expected[i, j]) for i, j in pairs]
    names = ["first", "second", "judged", "first_held", "second_held", "expected"]
    frame = pd.DataFrame(rows, columns=names).round(DIGITS)
    return frame.sort_values("expected", ascending=False, kind="stable").reset_index(drop=True)


def correlations(region: pd.DataFrame) -> pd.DataFrame:
    """Spearman's correlation of the numbers over the region, (numbers, numbers)."""
    return region[[*NUMBERS, *BEARINGS]].corr(method="spearman")


def with_claims(found: pd.DataFrame, claims: Sequence[Claim]) -> pd.DataFrame:
    """Inputs, start, log-likelihoods, whether each claim holds, how many fitted and held-out ones do."""
    kept = found[[*INPUT_COLUMNS, START, OF_MOTION, LOG_LIKELIHOOD, *[claim.id for claim in claims]]]
    return kept.assign(**held_counts(found, claims))
