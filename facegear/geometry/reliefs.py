"""How much a modification takes off by the distance from where it is measured."""

import numpy as np

from facegear.arrays import Array
from facegear.geometry.design import Relief


def linear(relief: Relief, from_end: Array) -> Array:
    """Compute the removed depth of a tip, root or end relief.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_end : (...) array
        Distance from the end, m.

    Returns
    -------
    (...) array
        m.
    """
    if relief.amount == 0:
        return 0.0 * from_end
    part = (relief.start + relief.length - from_end) / relief.length
    return relief.amount * np.minimum(np.maximum(part, 0.0), 1.0)


def parabola(relief: Relief, from_middle: Array) -> Array:
    """Compute the removed depth of a crowning.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_middle : (...) array
        Distance from the middle, m.

    Returns
    -------
    (...) array
        m.
    """
    if relief.amount == 0:
        return 0.0 * from_middle
    return relief.amount * np.maximum((from_middle - relief.start) / relief.length, 0.0) ** 2


def parabola_curvature(relief: Relief, from_middle: Array) -> Array:
    """Compute the second derivative of `parabola`.

    Parameters
    ----------
    relief : Relief
        Amount, start and length.
    from_middle : (...) array
        Distance from the middle, m.

    Returns
    -------
    (...) array
        1/m.
    """
    if relief.amount == 0:
        return np.zeros_like(from_middle)
    return np.where(from_middle > relief.start, 2.0 * relief.amount / relief.length**2, 0.0)
