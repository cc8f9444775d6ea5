"""Extremes between even samples, local maxima of curves, and the order of Floquet multipliers."""

import numpy as np
import scipy

from facegear.arrays import Array, ComplexArray, Integers, Mask


def local_maxima(curve: Array) -> tuple[Integers, Array]:
    """Find the maxima of a curve, without its ends, and their prominences.

    Of equal neighbours the middle counts. A prominence is the height above the larger of the two smallest
    values that lie on either side before a larger value than the maximum comes.

    Parameters
    ----------
    curve : (n,) array
        Values, any unit.

    Returns
    -------
    (m,) array
        Positions, as indices.
    (m,) array
        Prominences, in the unit of the values.
    """
    changes = np.flatnonzero(np.diff(curve))
    first, last = np.append(0, changes + 1), np.append(changes, curve.size - 1)
    level = curve[first]
    tops = np.flatnonzero((level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])) + 1
    positions = (first[tops] + last[tops]) // 2
    valleys = [max(_valley(curve[i::-1]), _valley(curve[i:])) for i in positions]
    return positions, curve[positions] - np.array(valleys, dtype=float)


def _valley(curve: Array) -> float:
    """Return the smallest value of a curve (n,) before its first value that is larger than curve[0], else
    of all.
    """
    beyond = ~(curve <= curve[0])
    return float(curve[: beyond.argmax() if beyond.any() else curve.size].min())


RELATIVE_TOLERANCE = 1e-9
"""Moduli and real parts nearer than this, relative to the largest modulus, are equal."""


def by_modulus(multipliers: ComplexArray) -> Integers:
    """Order multipliers by falling modulus; those of equal modulus by falling real, then falling imaginary
    part.

    Parameters
    ----------
    multipliers : (n,) array
        Floquet multipliers, dimensionless.

    Returns
    -------
    (n,) array
        Indices.

    Examples
    --------
    >>> by_modulus(np.array([0.5 - 0.5j, 0.5 + 0.5j, -0.9]))
    array([2, 1, 0])
    """
    modulus = np.abs(multipliers)
    near = RELATIVE_TOLERANCE * float(modulus.max(initial=0.0))
    return np.lexsort((-multipliers.imag, _rank(-multipliers.real, near), _rank(-modulus, near)))


def _rank(values: Array, near: float) -> Integers:
    """Return the rank (n,) of each value, from 0 for the smallest; values within `near` of the next
    smaller share its rank.
    """
    ascending = np.argsort(values)
    rank = np.zeros(len(values), dtype=int)
    rank[ascending[1:]] = np.cumsum(np.diff(values[ascending]) > near)
    return rank


REACH = 3
"""Number of samples on each side of the largest one through which a polynomial is laid."""
NUM_COMPARED = 64
"""Number of samples of each column, those with the largest values, among which peaks are sought."""
CANDIDATES = 2
"""Number of samples of each column that are examined: those with the largest parabolas."""
LOOKS = 16
"""Number of parts of the time between two samples at whose ends the polynomial is evaluated."""
FINE_STEPS = np.linspace(-1.0, 1.0, 2 * LOOKS + 1)
"""Positions at which values_around() is evaluated, in samples from that of the row."""


def located_extremes(values: Array, wraps: bool) -> tuple[Array, Array]:
    """Locate the smallest and the largest value of each column of even samples.

    A polynomial of sixth degree goes through a sample and three neighbours on each side. The parabola through
    the largest three of its points gives the extreme. No extreme is less far out than the samples.

    Parameters
    ----------
    values : (K, columns)
        Samples at even distances in time, any unit.
    wraps
        Whether the first sample follows the last, as those of whole periods of a periodic motion do.

    Returns
    -------
    minimum, maximum : (columns,)
        Smallest and largest values, in the unit of the values.
    """
    return -_located_maxima(-values, wraps), _located_maxima(values, wraps)


def max_peaks(values: Array, wraps: bool) -> tuple[Integers, Mask]:
    """Find the samples of each column at which the parabola through a sample and its neighbours rises
    highest.

    Parameters
    ----------
    values : (K, columns)
        Samples at even distances in time, at least 2 REACH + 1.
    wraps
        As in located_extremes().

    Returns
    -------
    rows : (CANDIDATES, columns)
        Numbers of samples.
    is_peak : (CANDIDATES, columns)
        Whether that sample is a peak: a column may have fewer.
    """
    count = len(values)
    num_compared = min(NUM_COMPARED, count)
    at = np.argpartition(values, count - num_compared, axis=0)[-num_compared:]
    heights, peak = _parabolas(values, at, wraps)
    best = np.argsort(np.where(peak, heights, -np.inf), axis=0)[-CANDIDATES:]
    return np.take_along_axis(at, best, axis=0), np.take_along_axis(peak, best, axis=0)


def values_around(values: Array, rows: Integers) -> Array:
    """Evaluate polynomials through 2 REACH + 1 samples from one sample before each row to one after it.

    The samples are taken as periodic: after the last comes the first.

    Parameters
    ----------
    values : (K, columns) array
        Samples at even distances in time, any unit.
    rows : (R,) array
        Numbers of samples.

    Returns
    -------
    (2 LOOKS + 1, R, columns) array
        Values at FINE_STEPS, in the unit of the samples.
    """
    steps = np.arange(-REACH, REACH + 1)
    return np.asarray(np.tensordot(_POLYNOMIAL, values[(rows + steps[:, None]) % len(values)], 1))


def top_of(fine: Array) -> Array:
    """Return the largest value of fine even samples along the first axis, by the parabola through the
    largest three.

    Parameters
    ----------
    fine : (n, ...) array
        Samples at even distances, any unit.

    Returns
    -------
    (...) array
        Largest values, in the unit of the samples.
    """
    best = np.clip(fine.argmax(axis=0), 1, len(fine) - 2)
    low, middle, high = (np.take_along_axis(fine, (best + step)[None], axis=0)[0] for step in (-1, 0, 1))
    bend, slope = 2.0 * middle - low - high, 0.5 * (high - low)
    inside = (bend > 0.0) & (np.abs(slope) <= bend)
    rise = np.where(inside, 0.5 * slope**2 / np.where(inside, bend, 1.0), 0.0)
    return np.asarray(np.maximum(middle + rise, fine.max(axis=0)))


def located_by_cycle(values: Array, wraps: bool) -> Array:
    """Locate the largest value of each column in each of several cycles.

    Parameters
    ----------
    values : (cycles, positions, columns)
        Samples at even distances in time, `positions` in each cycle, any unit.
    wraps
        As in located_extremes().

    Returns
    -------
    (cycles, columns)
        In the unit of the values; no less than the largest sample of the cycle.
    """
    cycles, positions, columns = values.shape
    flat, largest = values.reshape(-1, columns), values.max(axis=1)
    if len(flat) <= 2 * REACH:
        return np.asarray(largest)
    rows = values.argmax(axis=1) + positions * np.arange(cycles)[:, None]
    _, peak = _parabolas(flat, rows, wraps)
    return np.where(peak, np.maximum(largest, _tops(flat, rows)), largest)


def finer(values: Array, factor: int, wraps: bool) -> Array:
    """Interpolate even samples by a cubic spline at `factor` times as many instants.

    Where two neighbouring samples do not differ in sign, the values between have no other sign: a contact
    that is open at both is open between them. Without wrapping the last value is repeated after the last
    sample.

    Parameters
    ----------
    values : (K,) array
        Samples at even distances in time, any unit.
    factor : int
        Number of instants for each sample.
    wraps : bool
        Whether the first sample follows the last, as those of whole periods of a periodic motion do.

    Returns
    -------
    (factor K,) array
        Values, in the unit of the samples.
    """
    count = len(values)
    after = np.append(values[1:], values[0] if wraps else values[-1])
    through = np.append(values, after[-1])
    spline = scipy.interpolate.CubicSpline(
        np.arange(count + 1.0), through, bc_type="periodic" if wraps else "not-a-knot"
    )
    between = spline(np.arange(count)[:, None] + np.arange(factor) / factor)
    low, high = np.minimum(values, after)[:, None], np.maximum(values, after)[:, None]
    between = np.where(low >= 0.0, np.maximum(between, 0.0), between)
    between = np.where(high <= 0.0, np.minimum(between, 0.0), between)
    return np.asarray(between.ravel())


def _located_maxima(values: Array, wraps: bool) -> Array:
    """Return the largest value (columns,) of each column of samples (K, columns), located between them by
    polynomials.
    """
    largest = np.asarray(values.max(axis=0))
    if len(values) <= 2 * REACH:
        return largest
    rows, is_peak = max_peaks(values, wraps)
    return np.where(is_peak, np.maximum(largest, _tops(values, rows)), largest).max(axis=0)


def _parabolas(values: Array, rows: Integers, wraps: bool) -> tuple[Array, Mask]:
    """Return the height of the parabola through each sample of `rows` (R, columns) and its neighbours,
    and whether it is a peak.

    Both are (R, columns). The curve must bend down at the sample and at its higher neighbour, between
    which the peak lies. It does not where a contact opens and its force stays zero. Without `wraps`
    samples near the ends are no peaks.
    """
    count = len(values)

    def beside(step: int | Integers) -> Array:
        return np.take_along_axis(values, (rows + step) % count, axis=0)

    before, middle, after = beside(-1), beside(0), beside(1)
    higher = np.where(after >= before, 1, -1)
    bend = 2.0 * middle - before - after
    bends_on = 2.0 * beside(higher) - middle - beside(2 * higher) > 0.0
    peak = (middle >= before) & (middle >= after) & (bend > 0.0) & bends_on
    if not wraps:
        peak &= (rows >= REACH) & (rows < count - REACH)
    return middle + (after - before) ** 2 / np.where(peak, 8.0 * bend, 1.0), peak


def _tops(values: Array, rows: Integers) -> Array:
    """Return the largest value (R, columns) of the polynomial through samples (K, columns) around each of
    `rows` (R, columns).
    """
    steps = np.arange(-REACH, REACH + 1)
    near = np.stack([np.take_along_axis(values, (rows + step) % len(values), axis=0) for step in steps])
    return top_of(np.tensordot(_POLYNOMIAL, near, 1))


def _values_between() -> Array:
    """Return the matrix (2 LOOKS + 1, 2 REACH + 1) from samples to values of their polynomial at points
    between them.
    """
    samples = np.arange(-REACH, REACH + 1.0)
    return np.asarray(np.vander(FINE_STEPS, samples.size) @ np.linalg.inv(np.vander(samples)))


_POLYNOMIAL = _values_between()
"""Matrix from values at neighbouring samples to values of their polynomial between them."""
