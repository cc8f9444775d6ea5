"""Bearings with radial play: a body's x and y inside a ring, exact in two dimensions.

    F = k (1 - c / r) (x, y) beyond the play c, none inside, and the bearing's damping beta dF/dt.

Each ring has three rows among the meshes, none with a force of its own: x, y, and (r^2 - c^2) / (2 c), near
the rim the way beyond it, whose zeros are the switches. Powers of series follow from the recurrence of
f g' = p f' g for g = f^p.
"""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.work import Work

Array = NDArray[np.float64]
ROWS = 3


@inlined
def ring_row(packed: Packed, work: Work, i: int) -> None:
    """Coefficient i of every ring's third row, and of its force where that is pressed."""
    for r in range(packed.ring_stiffness.size):
        x = packed.m - ROWS * (packed.ring_stiffness.size - r)
        play = packed.ring_play[r]
        square = 0.0
        for j in range(i + 1):
            square += work.deflection[j, x] * work.deflection[i - j, x]
            square += work.deflection[j, x + 1] * work.deflection[i - j, x + 1]
        work.ring_square[i, r] = square
        work.deflection[i, x + 2] = 0.5 * square / play - (0.5 * play if i == 0 else 0.0)
        if work.active[x + 2] > 0.0:
            _power(work.ring_square, r, i, -0.5, work.ring_inverse)
            for k in range(2):
                total = work.deflection[i, x + k]
                for j in range(i + 1):
                    total -= play * work.deflection[i - j, x + k] * work.ring_inverse[j, r]
                work.ring_force[i, 2 * r + k] = packed.ring_stiffness[r] * total


@inlined
def ring_push(packed: Packed, work: Work, i: int, force: Array, factor: float) -> None:
    """Put coefficient i of the rings' forces, spring and damping, times the factor into the meshes' `force`.

    Needs coefficients up to i + 1 of `work.ring_force`.
    """
    for r in range(packed.ring_stiffness.size):
        x = packed.m - ROWS * (packed.ring_stiffness.size - r)
        for k in range(2):
            at = 2 * r + k
            total = work.ring_force[i, at] + packed.ring_lag * (i + 1) * work.ring_force[i + 1, at]
            force[x + k] = factor * total if work.active[x + 2] > 0.0 else 0.0


@inlined
def ring_slopes(packed: Packed, work: Work) -> None:
    """All coefficients of dF/dq of the rings: k (1 - c / r) + k c x x / r^3 and so on, xx, xy, yy."""
    for r in range(packed.ring_stiffness.size):
        x = packed.m - ROWS * (packed.ring_stiffness.size - r)
        if work.active[x + 2] == 0.0:
            continue
        stiffness, play = packed.ring_stiffness[r], packed.ring_play[r]
        for i in range(work.order + 1):
            _power(work.ring_square, r, i, -1.5, work.ring_cube)
            for pair in range(3):
                one, two = x + pair // 2, x + (pair + 1) // 2
                product = 0.0
                for j in range(i + 1):
                    product += work.deflection[j, one] * work.deflection[i - j, two]
                work.ring_product[i, 3 * r + pair] = product
                total = 0.0
                for j in range(i + 1):
                    total += work.ring_product[j, 3 * r + pair] * work.ring_cube[i - j, r]
                if pair != 1:
                    total -= work.ring_inverse[i, r]
                whole = 1.0 if i == 0 and pair != 1 else 0.0
                work.ring_slope[i, 3 * r + pair] = stiffness * (whole + play * total)


@inlined
def ring_tangent_row(packed: Packed, work: Work, i: int, deflection: Array) -> None:
    """Coefficient i of the change of every ring's force with a tangent's `deflection`, into ring_force."""
    for r in range(packed.ring_stiffness.size):
        x = packed.m - ROWS * (packed.ring_stiffness.size - r)
        if work.active[x + 2] > 0.0:
            for k in range(2):
                total = 0.0
                for j in range(i + 1):
                    total += work.ring_slope[j, 3 * r + k] * deflection[i - j, x]
                    total += work.ring_slope[j, 3 * r + k + 1] * deflection[i - j, x + 1]
                work.ring_force[i, 2 * r + k] = total


@inlined
def ring_trace(packed: Packed, work: Work, length: float) -> float:
    """Integral over a step of the damping of all rings that are pressed: their part of the divergence."""
    total = 0.0
    for r in range(packed.ring_stiffness.size):
        x = packed.m - ROWS * (packed.ring_stiffness.size - r)
        if work.active[x + 2] > 0.0:
            power = packed.ring_lag
            for i in range(work.order + 1):
                power *= length
                along_x = packed.leverage[x] * work.ring_slope[i, 3 * r]
                along_y = packed.leverage[x + 1] * work.ring_slope[i, 3 * r + 2]
                total += power / (i + 1) * (along_x + along_y)
    return total


@inlined
def switch_ring(packed: Packed, work: Work, r: int, change: float, tangents: Array) -> None:
    """Saltation where ring r starts (change 1) or ends (-1) to press: only the damping along r jumps."""
    x = packed.m - ROWS * (packed.ring_stiffness.size - r)
    across, up = work.deflection[0, x], work.deflection[0, x + 1]
    damping = change * packed.ring_lag * packed.ring_stiffness[r] / (across * across + up * up)
    for column in range(tangents.shape[0]):
        along = 0.0
        for k in range(packed.n):
            lever = across * packed.transposed[x, k] + up * packed.transposed[x + 1, k]
            along += lever * tangents[column, 0, k]
        for k in range(packed.n):
            lever = across * packed.transposed[x, k] + up * packed.transposed[x + 1, k]
            tangents[column, 1, k] -= damping * along * lever


@inlined
def _power(base: Array, column: int, i: int, exponent: float, out: Array) -> None:
    """Coefficient i of base ** exponent, the ones before it known."""
    if i == 0:
        out[0, column] = base[0, column] ** exponent
        return
    total = 0.0
    for j in range(1, i + 1):
        total += (exponent * j - (i - j)) * base[j, column] * out[i - j, column]
    out[i, column] = total / (i * base[0, column])
