"""The loosest tolerances that keep a percentile below a limit."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from facegear.arrays import Array
from facegear.errors import FacegearError
from facegear.scenarios.statistics import Estimate, percentile

HALVINGS = 10
"""Halvings of the range of scales: its width falls to a thousandth."""


@dataclass(frozen=True, eq=False)
class Loosest:
    """`scale` that all deviations may be multiplied by, what the percentile is there, and all that was tried.

    `interval`: the scales at which the upper and the lower end of the percentile's interval meet the limit,
    interpolated between the trials; infinite where no trial bounds it. `trials`: scale, value, low, high (the
    interval of the percentile), failed (samples without result).
    """

    scale: float
    interval: tuple[float, float]
    percentile: Estimate
    trials: pd.DataFrame


def loosest(
    sample_results: Callable[[float], Array], at_most: float, level: float, max_factor: float
) -> Loosest:
    """Find the largest scale of all deviations at which a percentile does not exceed a limit, by bisection.

    The percentile is taken to rise with the scale.

    Parameters
    ----------
    sample_results : callable
        Function from a scale to the results (samples,) of the same samples, nan where one has none, which
        counts as above every limit; scale dimensionless.
    at_most : float
        Limit, in the unit of the results.
    level : float
        Level of the percentile, a fraction from 0 to 1.
    max_factor : float
        Largest scale to try, dimensionless factor.

    Returns
    -------
    Loosest
        The scale, its interval, the percentile there, and all trials.

    Raises
    ------
    FacegearError
        If the limit is exceeded by the machine without any deviation.
    """
    results_by_scale: dict[float, tuple[Estimate, int]] = {}

    def holds(scale: float) -> bool:
        values = sample_results(scale)
        is_failed = np.isnan(values)
        results_by_scale[scale] = percentile(np.where(is_failed, np.inf, values), level), int(is_failed.sum())
        return bool(results_by_scale[scale][0].value <= at_most)  # inf and nan do not hold

    if not holds(0.0):
        requirement = f"already {results_by_scale[0.0][0].value:.6g} without any deviation"
        raise FacegearError(f"at_most = {at_most:g}: {requirement}")
    low, high = 0.0, max_factor
    if holds(max_factor):
        low = max_factor
    for _ in range(HALVINGS if low < max_factor else 0):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    rows = [
        (scale, answer.value, answer.low, answer.high, failures)
        for scale, (answer, failures) in sorted(results_by_scale.items())
    ]
    trials = pd.DataFrame(rows, columns=["scale", "value", "low", "high", "failed"])
    return Loosest(low, _interval(trials, at_most), results_by_scale[low][0], trials)


def _interval(trials: pd.DataFrame, at_most: float) -> tuple[float, float]:
    """Scales at which the ends of the percentile's interval, made to rise, pass the limit."""
    scale = trials["scale"].to_numpy(float)
    bounds = []
    for end in ("high", "low"):
        values = np.maximum.accumulate(trials[end].to_numpy(float))
        above = np.flatnonzero(values > at_most)
        first = int(above[0]) if above.size else len(scale)
        if first in (0, len(scale)):
            bounds.append(0.0 if first == 0 else np.inf)
        elif not np.isfinite(values[[first - 1, first]]).all():
            bounds.append(float(scale[first - 1]))
        else:
            bounds.append(
                float(np.interp(at_most, values[first - 1 : first + 1], scale[first - 1 : first + 1]))
            )
    return bounds[0], bounds[1]
