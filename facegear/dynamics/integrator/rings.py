"""Bearings with radial play: a body's x and y inside a ring, exact in two dimensions.

    F = k (1 - c / r) (x, y) beyond the play c, none inside, and the bearing's damping beta dF/dt.

Each ring has three rows among the meshes, none with a force of its own: x, y, and (r^2 - c^2) / (2 c), near
the rim the way beyond it, whose zeros are the switches. Powers of series follow from the recurrence of
f g' = p f' g for g = f^p. Series stand row after row with the rings side by side, four at a time.
"""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.lanes import (
    LANES,
    add,
    load,
    multiply,
    multiply_add,
    splat,
    store,
)
from facegear.dynamics.integrator.work import Work

Array = NDArray[np.float64]
ROWS = 3


@inlined
def ring_row(packed: Packed, work: Work, i: int) -> None:
    """Coefficient i of every ring's third row, and of its force where that is pressed."""
    wide = packed.ring_play.size
    _gather(packed, work.deflection, i, work.ring_x, work.ring_y)
    for c in range(0, wide, LANES):
        along, up = splat(0.0), splat(0.0)
        for j in range(i + 1):
            one, two = j * wide + c, (i - j) * wide + c
            along = multiply_add(load(work.ring_x, one), load(work.ring_x, two), along)
            up = multiply_add(load(work.ring_y, one), load(work.ring_y, two), up)
        store(work.ring_square, i * wide + c, add(along, up))
    for r in range(packed.rings):
        x = packed.m - ROWS * (packed.rings - r)
        square, play = work.ring_square[i, r], packed.ring_play[r]
        work.deflection[i, x + 2] = 0.5 * square / play - (0.5 * play if i == 0 else 0.0)
        if i == 0:
            work.ring_reciprocal[r] = 1.0 / square if work.active[x + 2] > 0.0 else 0.0
    _power(work, i, -0.5, work.ring_inverse)
    minus = splat(-1.0)
    for c in range(0, wide, LANES):
        across, up = splat(0.0), splat(0.0)
        for j in range(i + 1):
            inverse = load(work.ring_inverse, j * wide + c)
            across = multiply_add(load(work.ring_x, (i - j) * wide + c), inverse, across)
            up = multiply_add(load(work.ring_y, (i - j) * wide + c), inverse, up)
        stiffness, held = load(packed.ring_stiffness, c), multiply(minus, load(packed.ring_play, c))
        at = i * wide + c
        across = multiply_add(held, across, load(work.ring_x, at))
        up = multiply_add(held, up, load(work.ring_y, at))
        store(work.ring_force_x, at, multiply(stiffness, across))
        store(work.ring_force_y, at, multiply(stiffness, up))


@inlined
def ring_push(packed: Packed, work: Work, i: int, force: Array, factor: float) -> None:
    """Put coefficient i of the rings' forces, spring and damping, times the factor into the meshes' `force`.

    Needs coefficients up to i + 1 of the rings' forces.
    """
    lag = packed.ring_lag * (i + 1)
    for r in range(packed.rings):
        x = packed.m - ROWS * (packed.rings - r)
        pressed = factor * work.active[x + 2]
        force[x] = pressed * (work.ring_force_x[i, r] + lag * work.ring_force_x[i + 1, r])
        force[x + 1] = pressed * (work.ring_force_y[i, r] + lag * work.ring_force_y[i + 1, r])


@inlined
def ring_slopes(packed: Packed, work: Work) -> None:
    """All coefficients of dF/dq of the rings: k (1 - c / r) + k c x x / r^3 and so on, xx, xy, yy."""
    if packed.rings == 0:
        return
    for i in range(work.order + 1):
        _power(work, i, -1.5, work.ring_cube)
    _slope(packed, work, work.ring_x, work.ring_x, 1.0, work.ring_slope_xx)
    _slope(packed, work, work.ring_x, work.ring_y, 0.0, work.ring_slope_xy)
    _slope(packed, work, work.ring_y, work.ring_y, 1.0, work.ring_slope_yy)


@inlined
def _slope(packed: Packed, work: Work, one: Array, two: Array, same: float, out: Array) -> None:
    """k (same (1 - c / r) + c one two / r^3) into out."""
    wide = packed.ring_play.size
    for c in range(0, wide, LANES):
        stiffness, play = load(packed.ring_stiffness, c), load(packed.ring_play, c)
        for i in range(work.order + 1):
            product = splat(0.0)
            for j in range(i + 1):
                product = multiply_add(load(one, j * wide + c), load(two, (i - j) * wide + c), product)
            store(work.ring_product, i * wide + c, product)
            total = multiply(splat(-same), load(work.ring_inverse, i * wide + c))
            for j in range(i + 1):
                cube = load(work.ring_cube, (i - j) * wide + c)
                total = multiply_add(load(work.ring_product, j * wide + c), cube, total)
            whole = splat(same if i == 0 else 0.0)
            store(out, i * wide + c, multiply(stiffness, multiply_add(play, total, whole)))


@inlined
def ring_tangent_row(packed: Packed, work: Work, i: int, deflection: Array) -> None:
    """Coefficient i of the change of every ring's force with a tangent's `deflection`, into the forces."""
    wide = packed.ring_play.size
    _gather(packed, deflection, i, work.ring_dx, work.ring_dy)
    for c in range(0, wide, LANES):
        across, up = splat(0.0), splat(0.0)
        for j in range(i + 1):
            dx = load(work.ring_dx, (i - j) * wide + c)
            dy = load(work.ring_dy, (i - j) * wide + c)
            at = j * wide + c
            across = multiply_add(load(work.ring_slope_xx, at), dx, across)
            across = multiply_add(load(work.ring_slope_xy, at), dy, across)
            up = multiply_add(load(work.ring_slope_xy, at), dx, up)
            up = multiply_add(load(work.ring_slope_yy, at), dy, up)
        store(work.ring_force_x, i * wide + c, across)
        store(work.ring_force_y, i * wide + c, up)


@inlined
def ring_trace(packed: Packed, work: Work, length: float) -> float:
    """Integral over a step of the damping of all rings that are pressed: their part of the divergence."""
    total = 0.0
    for r in range(packed.rings):
        x = packed.m - ROWS * (packed.rings - r)
        power = packed.ring_lag * work.active[x + 2]
        for i in range(work.order + 1):
            power *= length
            along_x = packed.leverage[x] * work.ring_slope_xx[i, r]
            along_y = packed.leverage[x + 1] * work.ring_slope_yy[i, r]
            total += power / (i + 1) * (along_x + along_y)
    return total


@inlined
def switch_ring(packed: Packed, work: Work, r: int, change: float, tangents: Array) -> None:
    """Saltation where ring r starts (change 1) or ends (-1) to press: only the damping along r jumps."""
    x = packed.m - ROWS * (packed.rings - r)
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
def _gather(packed: Packed, deflection: Array, i: int, x: Array, y: Array) -> None:
    """Row i of the rings' x and y from their rows among the meshes."""
    first = packed.m - ROWS * packed.rings
    for r in range(packed.rings):
        x[i, r] = deflection[i, first + ROWS * r]
        y[i, r] = deflection[i, first + ROWS * r + 1]


@inlined
def _power(work: Work, i: int, exponent: float, out: Array) -> None:
    """Coefficient i of the rings' r^2 to a power, the ones before it known; zeros where none is pressed."""
    wide = work.ring_reciprocal.size
    if i == 0:
        for r in range(wide):
            out[0, r] = work.ring_reciprocal[r] ** -exponent
        return
    for c in range(0, wide, LANES):
        total = splat(0.0)
        for j in range(1, i + 1):
            weight = splat((exponent * j - (i - j)) / i)
            square = multiply(weight, load(work.ring_square, j * wide + c))
            total = multiply_add(square, load(out, (i - j) * wide + c), total)
        store(out, i * wide + c, multiply(total, load(work.ring_reciprocal, c)))
