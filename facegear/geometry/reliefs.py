"""How much a modification takes off by the distance from where it is measured."""

import numpy as np

from facegear.arrays import Array
from facegear.geometry.design import Relief


def linear(relief: Relief, from_end: Array) -> Array:
    """Of a tip, root or end relief: removed (m) at distances from the end (m)."""
    if relief.amount == 0:
        return 0.0 * from_end
    part = (relief.start + relief.length - from_end) / relief.length
    return relief.amount * np.minimum(np.maximum(part, 0.0), 1.0)


def parabola(relief: Relief, from_middle: Array) -> Array:
    """Of a crowning: removed (m) at distances from the middle (m)."""
    if relief.amount == 0:
        return 0.0 * from_middle
    return relief.amount * np.maximum((from_middle - relief.start) / relief.length, 0.0) ** 2


def parabola_curvature(relief: Relief, from_middle: Array) -> Array:
    """Second derivative (1/m) of `parabola`."""
    if relief.amount == 0:
        return np.zeros_like(from_middle)
    return np.where(from_middle > relief.start, 2.0 * relief.amount / relief.length**2, 0.0)
