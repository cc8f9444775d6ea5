"""Search for the most likely inputs under one pattern of e(t)."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import scipy.optimize
from numpy.typing import NDArray

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import COORDINATES
from facegear.paper.identify.likelihood import Likelihood
from facegear.paper.identify.random_inputs import Plausible
from facegear.paper.identify.random_verdicts import judged_samples

LOG_LIKELIHOOD = "log_likelihood"
WORST = 1e3
"""Minus the log-likelihood of inputs without a result, below that of any others."""


@dataclass(frozen=True)
class Budget:
    """Points of a generation, generations after the first, and the seed of their changes."""

    population: int
    generations: int
    seed: int


def search_pattern(
    judge: ClaimJudge,
    likelihood: Likelihood,
    plausible: Plausible,
    pattern: str,
    budget: Budget,
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Differential evolution from the first random points of the space; every evaluation is a row.

    Columns as of `judged_samples`, and log_likelihood. `partial` keeps finished evaluations of the same
    `identity`: a search that was killed goes on where it was, since the same seed asks for the same points.
    """
    generations: list[pd.DataFrame] = []

    def evaluate(units: NDArray[np.float64]) -> NDArray[np.float64]:
        """Minus the log-likelihood of points (coordinates, points)."""
        first = sum(map(len, generations))
        rows = [plausible.space.row(unit, pattern) for unit in units.T]
        numbers = range(first, first + len(rows))
        found = judged_samples(judge, rows, numbers, partial, identity, told)
        found[LOG_LIKELIHOOD] = likelihood(found)
        generations.append(found)
        return np.minimum(-found[LOG_LIKELIHOOD].to_numpy(float), WORST)

    scipy.optimize.differential_evolution(
        evaluate,
        [(0.0, 1.0)] * len(COORDINATES),
        init=np.array([plausible.unit(number) for number in range(budget.population)]),
        maxiter=budget.generations,
        mutation=(0.4, 0.9),
        polish=False,
        tol=0.0,
        rng=np.random.default_rng(budget.seed),
        vectorized=True,
        updating="deferred",
    )
    return pd.concat(generations, ignore_index=True)
