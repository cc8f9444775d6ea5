"""Inputs judged from several starts: which of its motions a machine reaches, its inputs do not say."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import scipy.special
from numpy.typing import NDArray

from facegear.paper.identify.claim_judge import ClaimJudge
from facegear.paper.identify.inputs import INPUT_COLUMNS
from facegear.paper.identify.likelihood import Likelihood
from facegear.scenarios.chunks import run_chunk

START, OF_MOTION, LOG_LIKELIHOOD = "start", "log_likelihood_of_motion", "log_likelihood"


def judged_motions(
    judge: ClaimJudge,
    likelihood: Likelihood,
    rows: Sequence[Mapping[str, Any]],
    starts: int,
    partial: str | Path,
    identity: str,
    told: Callable[[], None] = lambda: None,
    first: int = 0,
) -> pd.DataFrame:
    """One row for each motion of the inputs in `rows`: inputs, start, the judge's columns, error, the
    log-likelihoods of the motion and of the inputs.

    A speed sweep begins at rest; what is read from it is the same for all starts of the inputs. `first` is
    the number of the first inputs; `partial` keeps finished motions of the same `identity`.
    """
    found = run_chunk(
        lambda number: judge.found(rows[number // starts - first], start=number % starts),
        range(first * starts, (first + len(rows)) * starts),
        judge.columns,
        partial,
        identity,
        told,
    ).drop(columns="sample")
    for name in set(judge.columns) - set(judge.without_sweep.columns):
        found[name] = np.repeat(found[name].to_numpy()[::starts], starts)
    inputs = pd.DataFrame([row for row in rows for _ in range(starts)], columns=list(INPUT_COLUMNS))
    inputs[START] = np.tile(np.arange(starts), len(rows))
    judged = pd.concat([inputs, found], axis=1)
    of_motions = likelihood(judged)
    of_inputs = np.repeat(over_motions(of_motions.reshape(-1, starts)), starts)
    return judged.assign(**{OF_MOTION: of_motions, LOG_LIKELIHOOD: of_inputs})


def over_motions(likelihoods: NDArray[np.float64]) -> NDArray[np.float64]:
    """Log-likelihood of inputs, shape (inputs,), from those of their motions, shape (inputs, starts).

    The likelihood of the inputs is the mean over starts, since the paper's motion may have been any.
    """
    mean: NDArray[np.float64] = scipy.special.logsumexp(likelihoods, axis=1) - np.log(likelihoods.shape[1])
    return mean


def distinct_inputs(judged: pd.DataFrame) -> pd.DataFrame:
    """The first row of each of the inputs."""
    return judged.drop_duplicates(list(INPUT_COLUMNS))
