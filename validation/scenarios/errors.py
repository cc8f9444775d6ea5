"""Error of percentiles and Sobol indices against the closed form of a linear machine with normal causes."""

from collections.abc import Sequence
from statistics import NormalDist

import numpy as np
import pandas as pd

from facegear.studies.sampling import Cause, Distribution, Population, Shape, index_samples, samples
from facegear.studies.statistics import percentile, sobol_indices

WEIGHTS = np.array([4.0, 3.0, 2.0, 1.0, 0.5, 0.25])
"""Weights of the causes in the linear machine."""
SEEDS = range(6)
"""Seeds of the samples."""


def statistics_errors(sizes: Sequence[int]) -> pd.DataFrame:
    """Compute the RMS over seeds of errors: percentiles (share of the spread above the mean), total indices.

    Errors of total indices are relative to the largest one.

    Parameters
    ----------
    sizes : Sequence[int]
        Numbers of samples, and of blocks of the design for indices, powers of two.

    Returns
    -------
    DataFrame
        One row for each size.
    """
    spread = float(np.linalg.norm(WEIGHTS))
    exact = WEIGHTS**2 / spread**2
    rows = []
    for size in sizes:
        estimates: dict[str, list[float]] = {"p95": [], "p99": [], "total_index": []}
        for seed in SEEDS:
            population = _population(seed)
            values = samples(population, 0, size) @ WEIGHTS
            for level in (95, 99):
                exact_value = spread * NormalDist().inv_cdf(level / 100.0)
                estimates[f"p{level}"].append(percentile(values, level / 100.0).value / exact_value - 1.0)
            design = index_samples(population, 0, size * (WEIGHTS.size + 2)) @ WEIGHTS
            indices = sobol_indices(design, WEIGHTS.size, resamples=1)
            estimates["total_index"].append(indices.total[0].value / exact[0] - 1.0)
        rows.append((size, *(float(np.sqrt(np.mean(np.square(errors)))) for errors in estimates.values())))
    return pd.DataFrame(rows, columns=["samples", *(f"{name}_error" for name in estimates)])


def _population(seed: int) -> Population:
    normal = Distribution(Shape.NORMAL, spread=1.0)
    causes = tuple(Cause(f"x{i}", normal, ((f"x{i}", 1.0),), "standard normal") for i in range(WEIGHTS.size))
    return Population(causes, seed)
