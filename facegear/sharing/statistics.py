"""Averages of a coefficient over many mesh cycles, and the samples that they need."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from facegear.arrays import Array, Integers, Mask
from facegear.motion.plan import Motion
from facegear.motion.steady_state.averages import BATCHES, mean_interval
from facegear.motion.steady_state.response import SteadyState
from facegear.motion.track import DenseMotion, track

DENSE, MAX_SAMPLES_OF_RUN = 2048, 16_384
"""Samples of a mesh cycle, and of a period of many cycles."""
ORBIT_TOLERANCE = 1e-5
"""Distance over the length scale, in mesh deflections, within which two positions count as one."""


def densely_sampled(response: SteadyState) -> DenseMotion:
    """Return a periodic motion at many instants, others at their samples.

    Coefficients jump where a path takes up or loses load, so their means err by the time between two samples:
    by 6e-3 with 256 a cycle. The motion has no jumps, and its Fourier series gives the instants between.

    Parameters
    ----------
    response : SteadyState
        The motion at its own samples.

    Returns
    -------
    DenseMotion
        At most DENSE samples in a mesh cycle, or MAX_SAMPLES_OF_RUN in a period of many cycles.
    """
    factor = 1
    if response.motion is Motion.PERIODIC:
        longest = MAX_SAMPLES_OF_RUN // len(response.coordinates)
        factor = max(min(DENSE // response.per_period, longest), 1)
    return DenseMotion(response, factor * response.per_period, track(response, factor))


def same_orbit(first: SteadyState, second: SteadyState) -> bool:
    """Tell whether two periodic motions are the same orbit, perhaps begun at another mesh cycle of it.

    Their periods must be equal, and some mesh cycle's first position of `first` must be within
    ORBIT_TOLERANCE times the length scale of the start of `second`, in all mesh deflections.

    Parameters
    ----------
    first : SteadyState
        A motion.
    second : SteadyState
        Another motion of the same machine.

    Returns
    -------
    bool
        False where one is not periodic.
    """
    if not first.period or first.period != second.period:
        return False
    distances = first.coordinates[:: first.per_period] - second.coordinates[0]
    far = np.abs(distances @ first.system.mesh_jacobian.T).max(axis=1)
    return bool(far.min() <= ORBIT_TOLERANCE * first.system.scale)


SIGNIFICANCE = 0.05
"""Chance at which means from several starts are wrongly taken to differ by more than batches say."""


@dataclass(frozen=True)
class Average:
    """Mean over all defined instants, its confidence half-width, extremes, and statistics of single cycles.

    `cycle_low` and `cycle_high` bound the means of single cycles at the confidence level; `cycle_minimum` is
    the median of their minima. `lost_fraction` and `undefined_fraction` are shares of time with a path
    without load and with no load at all; undefined instants are left out of everything else. All are NaN
    where nothing is ever loaded.
    """

    mean: float
    half_width: float
    minimum: float
    maximum: float
    cycle_low: float
    cycle_high: float
    cycle_minimum: float
    lost_fraction: float
    undefined_fraction: float
    cycles: int


def average(
    coefficients: Array,
    lost_mask: Mask,
    confidence: float = 0.95,
    periodic: bool = False,
) -> Average:
    """Average a load-sharing coefficient over many mesh cycles, with a confidence interval from batch
    means.

    A periodic motion given over its whole period has an exact mean: its half-width is zero.

    Parameters
    ----------
    coefficients : (cycles, samples) array
        Dimensionless; NaN where undefined, as no mesh is loaded.
    lost_mask : (cycles, samples) array of bool
        Whether a path is without load.
    confidence : float
        Confidence level from 0 to 1, dimensionless, of the mean and of the range of single cycles' means.
    periodic : bool
        Whether the samples are of a whole period.

    Returns
    -------
    Average
        Dimensionless; all instants weigh the same.
    """
    is_undefined = np.isnan(coefficients)
    counts = (~is_undefined).sum(axis=-1)
    has_load = counts > 0
    count = len(coefficients)
    if not has_load.any():
        nan = float("nan")
        return Average(
            mean=nan,
            half_width=nan,
            minimum=nan,
            maximum=nan,
            cycle_low=nan,
            cycle_high=nan,
            cycle_minimum=nan,
            lost_fraction=float(lost_mask.mean()),
            undefined_fraction=1.0,
            cycles=count,
        )
    sums = np.where(is_undefined, 0.0, coefficients).sum(axis=-1)
    means = sums[has_load] / counts[has_load]
    lows = np.where(is_undefined, np.inf, coefficients).min(axis=-1)[has_load]
    tail = 0.5 * (1.0 - confidence)
    return Average(
        mean=float(sums.sum() / counts.sum()),
        half_width=0.0 if periodic else _half_width(sums, counts, confidence),
        minimum=float(np.nanmin(coefficients)),
        maximum=float(np.nanmax(coefficients)),
        cycle_low=float(np.quantile(means, tail)),
        cycle_high=float(np.quantile(means, 1.0 - tail)),
        cycle_minimum=float(np.median(lows)),
        lost_fraction=float(lost_mask.mean()),
        undefined_fraction=float(is_undefined.mean()),
        cycles=count,
    )


def held_over_starts(first_average: Average, again: Sequence[float], confidence: float) -> Average:
    """Widen the half-width of an irregular motion's average where runs from other starts differ by more.

    Batches of one run show nothing of what changes more slowly than the run lasts, other runs do. Where the
    variance of the n + 1 means significantly exceeds the variance of a mean that the batches imply (F test at
    SIGNIFICANCE), the half-width is Student's of a single one of n + 1 runs: t times the standard deviation.

    Parameters
    ----------
    first_average : Average
        Average of one run.
    again : sequence of n floats
        Means of the same motion from other starts, dimensionless; NaN ones do not count.
    confidence : float
        Confidence level from 0 to 1, dimensionless.

    Returns
    -------
    Average
        The first average, dimensionless, with its mean and everything else but the half-width unchanged; all
        unchanged where the means do not differ significantly, n is 0 or the half-width is not above 0.
    """
    means = [first_average.mean, *(mean for mean in again if not np.isnan(mean))]
    freedom = len(means) - 1
    if freedom < 1 or not first_average.half_width > 0.0:
        return first_average
    batches = min(BATCHES, first_average.cycles) - 1
    error = first_average.half_width / scipy.special.stdtrit(batches, 0.5 + 0.5 * confidence)
    spread = float(np.std(means, ddof=1))
    if (spread / error) ** 2 <= scipy.special.fdtri(freedom, batches, 1.0 - SIGNIFICANCE):
        return first_average
    return replace(
        first_average, half_width=float(scipy.special.stdtrit(freedom, 0.5 + 0.5 * confidence)) * spread
    )


def defined_mean(coefficients: Array) -> float:
    """Return the mean over all instants at which a coefficient is defined, equal to `average(...).mean`.

    Parameters
    ----------
    coefficients : array of any shape (...)
        Dimensionless; NaN where undefined.

    Returns
    -------
    float
        Dimensionless; NaN where no instant is defined.
    """
    is_undefined = np.isnan(coefficients)
    if not is_undefined.any():
        return float(coefficients.mean())
    return float("nan") if is_undefined.all() else float(coefficients[~is_undefined].mean())


def _half_width(sums: Array, counts: Integers, confidence: float) -> float:
    """Compute the half-width of the mean's confidence interval from the means of at most BATCHES batches
    of cycles.

    `sums` and `counts` (cycles,) are the sum of the coefficient and the number of defined instants in
    each cycle. Successive cycles are not independent, batches of many cycles nearly are. NaN from fewer
    than two batches.
    """
    batches = min(BATCHES, sums.size)
    means = [
        batch_sums.sum() / batch_counts.sum()
        for batch_sums, batch_counts in zip(
            np.array_split(sums, batches), np.array_split(counts, batches), strict=True
        )
        if batch_counts.sum() > 0
    ]
    if len(means) < 2:
        return float("nan")
    return float(mean_interval(np.array(means), confidence))
