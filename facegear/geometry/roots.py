"""The root of a function of one number in a bracket.

SciPy's `optimize` takes longer to import (0.45 s of CPU time) than a start of the workflow may take for all
else, and limits of a design are looked at by every start; so they use this instead.
"""

import sys
from collections.abc import Callable

STEPS = 200
ROUNDING = 4 * sys.float_info.epsilon


def root(function: Callable[[float], float], low: float, high: float, tolerance: float = 0.0) -> float:
    """Where `function` changes its sign between `low` and `high`, to `tolerance` or the rounding of the ends.

    False position by the Illinois rule (Dowell and Jarratt 1971), a bisection wherever two steps
    have not halved the bracket. Raises ValueError if the signs at both ends are the same.
    """
    at_low, at_high = function(low), function(high)
    if at_low == 0.0 or at_high == 0.0:
        return low if at_low == 0.0 else high
    if (at_low > 0) == (at_high > 0):
        raise ValueError(f"no change of sign between {low} and {high}")
    positive = at_high > 0  # kept, since a value halved again and again may come to zero
    tolerance = max(tolerance, ROUNDING * max(abs(low), abs(high)))
    kept, widths = 0, [abs(high - low)] * 2
    for _ in range(STEPS):
        middle = low - at_low * (high - low) / (at_high - at_low)
        if abs(high - low) > 0.5 * widths[0] or not min(low, high) < middle < max(low, high):
            middle = low + 0.5 * (high - low)
        widths = [widths[1], abs(high - low)]
        value = function(middle)
        if value == 0.0 or abs(high - low) <= tolerance:
            return middle
        if (value > 0) == positive:
            high, at_high = middle, value
            at_low *= 0.5 if kept == 1 else 1.0
            kept = 1
        else:
            low, at_low = middle, value
            at_high *= 0.5 if kept == -1 else 1.0
            kept = -1
    return middle
