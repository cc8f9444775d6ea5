"""Search for the most likely inputs: which patterns of e(t) go on, and the search under one of them."""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import scipy.optimize
from numpy.typing import NDArray

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import COORDINATES, Space
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.motions import LOG_LIKELIHOOD, START, distinct_inputs, judged_motions
from facegear.paper.identify.patterns import READING_PATTERNS
from facegear.paper.identify.random_inputs import Plausible
from facegear.paper.scorecard.base_rates import by_input

REPEAT = "repeat"
WORST = 1e3
"""Minus the log-likelihood of inputs without a result, below that of any others."""


@dataclass(frozen=True)
class Budget:
    """Points of a generation, generations after the first, the seed of their changes, starts of each.

    Then which patterns go on: so many by the mean and by the upper 5 % of the claims that random inputs hold,
    at so many places; and once more those within so many log units of the best.
    """

    population: int
    generations: int
    seed: int
    starts: int
    by_mean: int
    by_upper: int
    places: int
    again_within: float


def start_at(
    place: int,
    repeat: int,
    plausible: Plausible,
    likelihood: Likelihood,
    structures: pd.DataFrame,
    first_round: pd.DataFrame | None,
    budget: Budget,
) -> tuple[str, NDArray[np.float64]]:
    """Pattern that goes on at a place, and points (points, coordinates) from which it is searched.

    No name and no points at a place where none does. A search that is repeated begins at other random points.
    `structures`: random inputs judged under every pattern; `first_round`: evaluations of the first round, for
    the second.
    """
    if first_round is None:
        rates = by_input(structures, likelihood.claims, "pattern")
        patterns = going_on(rates, budget.by_mean, budget.by_upper, budget.places)
        before = []
    else:
        patterns = searched_again(first_round, budget.again_within)
        before = [structures.copy().assign(**{LOG_LIKELIHOOD: likelihood(structures)}), first_round]
    if place >= len(patterns):
        return "", np.empty((0, len(COORDINATES)))
    return patterns[place], first_points(plausible, before, patterns[place], budget.population, repeat)


def going_on(rates: pd.DataFrame, by_mean: int, by_upper: int, places: int) -> list[str]:
    """Patterns to search: the readings of the paper, the best by the mean and the best by the upper 5 %.

    `rates`: a row a pattern, as of `by_input`. Patterns that tie for the last place all go on, as long as
    there are places.
    """
    best = [
        rates.nlargest(count, column, keep="all")["value"]
        for column, count in (("mean", by_mean), ("upper", by_upper))
    ]
    return list(dict.fromkeys([*READING_PATTERNS, *itertools.chain(*best)]))[:places]


def searched_again(found: pd.DataFrame, within: float) -> list[str]:
    """Patterns whose most likely evaluation lies within so many log units of that of all, the best first."""
    best = found.groupby("pattern", sort=False)[LOG_LIKELIHOOD].max()
    return best[best >= best.max() - within].sort_values(ascending=False, kind="stable").index.tolist()


def first_points(
    plausible: Plausible, before: Sequence[pd.DataFrame], pattern: str, count: int, repeat: int
) -> NDArray[np.float64]:
    """Points (count, coordinates) that a search starts from: random ones, others in every repeat, or the most
    likely of the pattern in tables of evaluations before it.
    """
    if not before:
        return np.array([plausible.unit(count * repeat + number) for number in range(count)])
    found = pd.concat(before, ignore_index=True)
    own = distinct_inputs(found[found["pattern"] == pattern])
    best = own.sort_values(LOG_LIKELIHOOD, ascending=False, kind="stable").head(count)
    return np.array([plausible.space.unit(row) for row in best.to_dict("records")])


def search_pattern(
    judge: ClaimJudge,
    likelihood: Likelihood,
    space: Space,
    pattern: str,
    first: NDArray[np.float64],
    budget: Budget,
    repeat: int,
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Differential evolution from the points `first` (points, coordinates); every motion of the inputs that
    it evaluates is a row, and without points there is none.

    Columns as of `judged_motions`, and repeat. `partial` keeps finished motions of the same `identity`: a
    search that was killed goes on where it was, since it asks for the same points again.
    """
    generations: list[pd.DataFrame] = []

    def evaluate(units: NDArray[np.float64]) -> NDArray[np.float64]:
        """Minus the log-likelihood of points (coordinates, points)."""
        done = sum(map(len, generations)) // budget.starts
        rows = [space.row(unit, pattern) for unit in units.T]
        found = judged_motions(judge, likelihood, rows, budget.starts, partial, identity, told, done)
        generations.append(found)
        of_inputs = found.loc[found[START] == 0, LOG_LIKELIHOOD].to_numpy(float)
        return np.minimum(-of_inputs, WORST)

    if not len(first):
        none = judged_motions(judge, likelihood, [], budget.starts, partial, identity)
        return none.assign(**{REPEAT: pd.Series(dtype=int)})
    scipy.optimize.differential_evolution(
        evaluate,
        [(0.0, 1.0)] * len(COORDINATES),
        init=first,
        maxiter=budget.generations,
        mutation=(0.4, 0.9),
        polish=False,
        tol=0.0,
        rng=np.random.default_rng(budget.seed + repeat),
        vectorized=True,
        updating="deferred",
    )
    return pd.concat(generations, ignore_index=True).assign(**{REPEAT: repeat})
