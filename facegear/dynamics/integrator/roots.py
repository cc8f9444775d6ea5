"""First zero of a polynomial in an interval, certain to be found or excluded.

Bernstein coefficients bound the polynomial, and the interval is halved until they have one change of sign or
none (Lane and Riesenfeld 1981).
"""

from functools import cache

import numpy as np

from facegear.arrays import Array
from facegear.dynamics.integrator.kernel import inlined, kernel

MAX_DEPTH = 48
BESIDE = 1e-12
"""Part of an interval beside its end in which a zero may be that of the next one."""
CLOSE = 1e-10
"""Newton's last step, over the interval: the error after it is of the order of its square."""


@cache
def bernstein_matrix(degree: int) -> Array:
    """Conversion from power to Bernstein coefficients on [0, 1], shape (degree + 1, degree + 1), lower
    triangular.

    b_i = sum_k C(i, k) / C(degree, k) a_k.
    """
    matrix = np.zeros((degree + 1, degree + 1))
    for i in range(degree + 1):
        ratio = 1.0
        for k in range(i + 1):
            matrix[i, k] = ratio
            ratio *= (i - k) / (degree - k) if k < degree else 0.0
    return matrix


@kernel
def first_root(coefficients: Array, degree: int, conversion: Array, work: Array) -> float:
    """Smallest t in (0, 1] where sum_n c_n t^n changes sign, or 2.0 if there is none.

    `coefficients` may be longer than degree + 1; conversion is bernstein_matrix(degree); work (MAX_DEPTH + 2,
    degree + 1). Zeros of even order that do not change the sign are passed over.
    """
    rest = 0.0
    for k in range(1, degree + 1):
        rest += abs(coefficients[k])
    if abs(coefficients[0]) > rest:
        return 2.0
    for i in range(degree + 1):
        total = 0.0
        for k in range(i + 1):
            total += conversion[i, k] * coefficients[k]
        work[0, i] = total
    depth = 0
    left, width = 0.0, 1.0
    before = 0.0  # a value of the sign that the interval before ends with
    while True:
        changes = 0
        last = before
        for i in range(degree + 1):
            value = work[depth, i]
            if value != 0.0:
                if last != 0.0 and (last > 0.0) != (value > 0.0):
                    changes += 1
                last = value
        if changes == 1:
            if work[depth, 0] != 0.0 and (work[depth, 0] > 0.0) == (last > 0.0):
                return left  # to rounding: the two intervals give their common end different signs
            return refine_root(coefficients, degree, left, left + width, work[depth, 0], last)
        if changes > 1 and depth < MAX_DEPTH:
            _halve(work, depth, degree)
            depth += 1
            width *= 0.5
            continue
        # Nothing in this interval: go on with the next one to the right.
        before = last
        left += width
        if depth == 0:
            return 2.0
        depth, width = _next(left, width, depth)
        if depth < 0:
            return 2.0
        _restart(coefficients, degree, conversion, left, width, work, depth)


@inlined
def _next(left: float, width: float, depth: int) -> tuple[int, float]:
    """Depth and width of the largest dyadic interval that starts at `left` within [0, 1]; -1 at the end."""
    if left >= 1.0:
        return -1, 0.0
    while depth > 1 and (left / (2.0 * width)) % 1.0 == 0.0:
        width *= 2.0
        depth -= 1
    return depth, width


@inlined
def _halve(work: Array, depth: int, degree: int) -> None:
    """Bernstein coefficients of the left half, from row `depth` into row `depth + 1` (de Casteljau)."""
    for i in range(degree + 1):
        work[depth + 1, i] = work[depth, i]
    for level in range(1, degree + 1):
        for i in range(degree, level - 1, -1):
            work[depth + 1, i] = 0.5 * (work[depth + 1, i] + work[depth + 1, i - 1])


@inlined
def _restart(
    coefficients: Array, degree: int, conversion: Array, left: float, width: float, work: Array, depth: int
) -> None:
    """Bernstein coefficients on [left, left + width] afresh, by Taylor shift and scaling, into row
    `depth`.
    """
    shifted = work[MAX_DEPTH + 1]
    for k in range(degree + 1):
        shifted[k] = coefficients[k]
    for start in range(degree):
        for k in range(degree - 1, start - 1, -1):
            shifted[k] += left * shifted[k + 1]
    scale = 1.0
    for k in range(degree + 1):
        shifted[k] *= scale
        scale *= width
    for i in range(degree + 1):
        total = 0.0
        for k in range(i + 1):
            total += conversion[i, k] * shifted[k]
        work[depth, i] = total


@inlined
def root_after(coefficients: Array, degree: int, root: float, conversion: Array, work: Array) -> float:
    """The next zero after a spurious one at the start: it is divided out of `coefficients` first."""
    carry = coefficients[degree]
    for i in range(degree - 1, -1, -1):
        value = coefficients[i]
        coefficients[i] = carry
        carry = value + root * carry
    coefficients[degree] = 0.0
    return first_root(coefficients, degree, conversion, work)


@kernel
def refine_root(
    coefficients: Array, degree: int, low: float, high: float, at_low: float, at_high: float
) -> float:
    """The one zero between low and high: Newton's method kept inside a shrinking bracket."""
    if at_high == 0.0:
        return high
    rising = at_high > at_low
    t = low + (high - low) * at_low / (at_low - at_high)
    if high - t <= BESIDE * (high - low):
        t = 0.5 * (low + high)  # another zero may lie at the end, to rounding
    for _ in range(100):
        value = coefficients[degree]
        slope = 0.0
        for k in range(degree - 1, -1, -1):
            slope = slope * t + value
            value = value * t + coefficients[k]
        if value == 0.0:
            return t
        if (value > 0.0) == rising:
            high = t
        else:
            low = t
        step = t - value / slope if slope != 0.0 else low - 1.0
        inside = low < step < high
        if inside and abs(step - t) <= CLOSE:
            return step
        if not inside:
            step = 0.5 * (low + high)
            if high - low <= 4e-16:
                return step
        t = step
    return t
