"""Local maxima of a curve, as by `scipy.signal.find_peaks`, which takes half a second to import."""

import numpy as np

from facegear.arrays import Array, Integers


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
    """Smallest value before one that is larger than the first."""
    beyond = ~(curve <= curve[0])
    return float(curve[: beyond.argmax() if beyond.any() else curve.size].min())
