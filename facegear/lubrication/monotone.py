"""Monotone cubic interpolation of many small tables at once, each at a point of its own."""

import numpy as np

from facegear.arrays import Array


def monotone_at(nodes: Array, values: Array, at: Array) -> Array:
    """Interpolate tables, each at a point of its own (Fritsch and Butland 1984), as SciPy's
    PchipInterpolator.

    SciPy's set-up for every call takes longer than all else that a sample of tolerances needs for its
    friction.

    Parameters
    ----------
    nodes : (t,) array
        Rising nodes, t > 1, any unit.
    values : (..., n, t) array
        Tables over the nodes, any unit.
    at : (n,) array
        Point of each table within the nodes, in the unit of the nodes.

    Returns
    -------
    (..., n) array
        Values in the unit of the tables.
    """
    steps = np.diff(nodes)
    rises = np.diff(values) / steps
    slopes = _slopes(steps, rises)
    left = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, steps.size - 1)
    columns = np.arange(at.size)
    step, part = steps[left], (at - nodes[left]) / steps[left]
    first, last = (values[..., columns, left + offset] for offset in (0, 1))
    left_slope, right_slope = (step * slopes[..., columns, left + offset] for offset in (0, 1))
    back = 1.0 - part
    start = back**2 * ((1.0 + 2.0 * part) * first + part * left_slope)
    return start + part**2 * ((3.0 - 2.0 * part) * last - back * right_slope)


def _slopes(steps: Array, rises: Array) -> Array:
    """Return the slopes (..., t) of the monotone interpolant at its nodes."""
    slopes = np.zeros((*rises.shape[:-1], steps.size + 1))
    if steps.size == 1:
        slopes[...] = rises
        return slopes
    before, after = rises[..., :-1], rises[..., 1:]
    weights = 2 * steps[1:] + steps[:-1], steps[1:] + 2 * steps[:-1]
    same_sign = before * after > 0.0
    safe = np.where(same_sign, before, 1.0), np.where(same_sign, after, 1.0)
    means = (weights[0] + weights[1]) / (weights[0] / safe[0] + weights[1] / safe[1])
    slopes[..., 1:-1] = np.where(same_sign, means, 0.0)
    slopes[..., 0] = _end(steps[0], steps[1], rises[..., 0], rises[..., 1])
    slopes[..., -1] = _end(steps[-1], steps[-2], rises[..., -1], rises[..., -2])
    return slopes


def _end(step: float, beside: float, rise: Array, rise_beside: Array) -> Array:
    """Slope at an end: of three points, within what keeps the curve monotone there."""
    slope = ((2 * step + beside) * rise - step * rise_beside) / (step + beside)
    overshoots = (np.sign(rise) != np.sign(rise_beside)) & (np.abs(slope) > 3 * np.abs(rise))
    return np.where(np.sign(slope) != np.sign(rise), 0.0, np.where(overshoots, 3 * rise, slope))
