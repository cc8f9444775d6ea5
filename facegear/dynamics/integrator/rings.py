"""Bearings with radial clearance: a body's x and y inside a ring, exact in two dimensions.

    F = k (1 - c / r) (x, y) beyond the clearance c, none inside, and the bearing's damping beta dF/dt.

Each ring has three rows among the meshes, none with a force of its own: x, y, and (r^2 - c^2) / (2 c), near
the rim the way beyond it, whose zeros are the switches. Powers of series follow from the recurrence of
f g' = p f' g for g = f^p. Series stand row after row with the rings side by side, four at a time.
Machines without bearing clearance pass None for both rings and series; what stands behind that question is
then not compiled.
"""

from facegear.arrays import Array
from facegear.dynamics.integrator.compiled import Packed, Rings
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.work import RingSeries, Work
from facegear.machine_code.lanes import (
    LANES,
    add,
    load,
    multiply,
    multiply_add,
    splat,
    store,
)

ROWS = 3


@inlined
def ring_row(rings: Rings | None, series: RingSeries | None, work: Work, i: int) -> None:
    """Coefficient i of every ring's third row, and of its force where that is pressed."""
    if rings is None or series is None:
        return
    width = rings.clearance.size
    _gather(rings, work.deflection, i, series.x, series.y)
    for c in range(0, width, LANES):
        along, up = splat(0.0), splat(0.0)
        for j in range(i + 1):
            first, second = j * width + c, (i - j) * width + c
            along = multiply_add(load(series.x, first), load(series.x, second), along)
            up = multiply_add(load(series.y, first), load(series.y, second), up)
        store(series.square, i * width + c, add(along, up))
    for r in range(rings.number):
        rim = rings.first + ROWS * r + 2
        square, clearance = series.square[i, r], rings.clearance[r]
        work.deflection[i, rim] = 0.5 * square / clearance - (0.5 * clearance if i == 0 else 0.0)
        if i == 0:
            series.reciprocal[r] = 1.0 / square if work.active[rim] > 0.0 else 0.0
    _power(series, i, -0.5, series.inverse)
    minus = splat(-1.0)
    for c in range(0, width, LANES):
        across, up = splat(0.0), splat(0.0)
        for j in range(i + 1):
            inverse = load(series.inverse, j * width + c)
            across = multiply_add(load(series.x, (i - j) * width + c), inverse, across)
            up = multiply_add(load(series.y, (i - j) * width + c), inverse, up)
        stiffness, held = load(rings.stiffness, c), multiply(minus, load(rings.clearance, c))
        at = i * width + c
        across = multiply_add(held, across, load(series.x, at))
        up = multiply_add(held, up, load(series.y, at))
        store(series.force_x, at, multiply(stiffness, across))
        store(series.force_y, at, multiply(stiffness, up))


@inlined
def ring_push(
    rings: Rings | None, series: RingSeries | None, active: Array, i: int, force: Array, factor: float
) -> None:
    """Put coefficient i of the rings' forces, spring and damping, times the factor into the meshes' `force`.

    Needs coefficients up to i + 1 of the rings' forces.
    """
    if rings is None or series is None:
        return
    lag = rings.lag * (i + 1)
    for r in range(rings.number):
        x = rings.first + ROWS * r
        pressed = factor * active[x + 2]
        force[x] = pressed * (series.force_x[i, r] + lag * series.force_x[i + 1, r])
        force[x + 1] = pressed * (series.force_y[i, r] + lag * series.force_y[i + 1, r])


@inlined
def ring_slopes(rings: Rings | None, series: RingSeries | None, order: int) -> None:
    """All coefficients of dF/dq of the rings: k (1 - c / r) + k c x x / r^3 and so on, xx, xy, yy."""
    if rings is None or series is None:
        return
    for i in range(order + 1):
        _power(series, i, -1.5, series.cube)
    _slope(rings, series, order, series.x, series.x, 1.0, series.slope_xx)
    _slope(rings, series, order, series.x, series.y, 0.0, series.slope_xy)
    _slope(rings, series, order, series.y, series.y, 1.0, series.slope_yy)


@inlined
def _slope(
    rings: Rings, series: RingSeries, order: int, first: Array, second: Array, same: float, out: Array
) -> None:
    """k (same (1 - c / r) + c one two / r^3) into out."""
    width = rings.clearance.size
    for c in range(0, width, LANES):
        stiffness, clearance = load(rings.stiffness, c), load(rings.clearance, c)
        for i in range(order + 1):
            product = splat(0.0)
            for j in range(i + 1):
                product = multiply_add(load(first, j * width + c), load(second, (i - j) * width + c), product)
            store(series.product, i * width + c, product)
            total = multiply(splat(-same), load(series.inverse, i * width + c))
            for j in range(i + 1):
                cube = load(series.cube, (i - j) * width + c)
                total = multiply_add(load(series.product, j * width + c), cube, total)
            whole = splat(same if i == 0 else 0.0)
            store(out, i * width + c, multiply(stiffness, multiply_add(clearance, total, whole)))


@inlined
def ring_tangent_row(rings: Rings | None, series: RingSeries | None, deflection: Array, i: int) -> None:
    """Coefficient i of the change of every ring's force with a tangent's `deflection`, into the forces."""
    if rings is None or series is None:
        return
    width = rings.clearance.size
    _gather(rings, deflection, i, series.dx, series.dy)
    for c in range(0, width, LANES):
        across, up = splat(0.0), splat(0.0)
        for j in range(i + 1):
            dx = load(series.dx, (i - j) * width + c)
            dy = load(series.dy, (i - j) * width + c)
            at = j * width + c
            across = multiply_add(load(series.slope_xx, at), dx, across)
            across = multiply_add(load(series.slope_xy, at), dy, across)
            up = multiply_add(load(series.slope_xy, at), dx, up)
            up = multiply_add(load(series.slope_yy, at), dy, up)
        store(series.force_x, i * width + c, across)
        store(series.force_y, i * width + c, up)


@inlined
def ring_trace(
    rings: Rings | None, series: RingSeries | None, packed: Packed, work: Work, length: float
) -> float:
    """Integral over a step of the damping of all rings that are pressed: their part of the divergence."""
    if rings is None or series is None:
        return 0.0
    total = 0.0
    for r in range(rings.number):
        x = rings.first + ROWS * r
        power = rings.lag * work.active[x + 2]
        for i in range(work.order + 1):
            power *= length
            along_x = packed.leverage[x] * series.slope_xx[i, r]
            along_y = packed.leverage[x + 1] * series.slope_yy[i, r]
            total += power / (i + 1) * (along_x + along_y)
    return total


@inlined
def ring_switches(rings: Rings | None, packed: Packed, work: Work, acting: Array, tangents: Array) -> None:
    """Saltation where rings start or end to press: only the damping along r jumps.

    acting (m,): of the step before; in its place stands `active` for the rows of rings.
    """
    if rings is None:
        return
    for r in range(rings.number):
        x = rings.first + ROWS * r
        change = work.active[x + 2] - acting[x + 2]
        if change == 0.0:
            continue
        across, up = work.deflection[0, x], work.deflection[0, x + 1]
        damping = change * rings.lag * rings.stiffness[r] / (across * across + up * up)
        for column in range(tangents.shape[0]):
            along = 0.0
            for k in range(packed.n):
                lever = across * packed.transposed[x, k] + up * packed.transposed[x + 1, k]
                along += lever * tangents[column, 0, k]
            for k in range(packed.n):
                lever = across * packed.transposed[x, k] + up * packed.transposed[x + 1, k]
                tangents[column, 1, k] -= damping * along * lever


@inlined
def _gather(rings: Rings, deflection: Array, i: int, x: Array, y: Array) -> None:
    """Row i of the rings' x and y from their rows among the meshes."""
    for r in range(rings.number):
        x[i, r] = deflection[i, rings.first + ROWS * r]
        y[i, r] = deflection[i, rings.first + ROWS * r + 1]


@inlined
def _power(series: RingSeries, i: int, exponent: float, out: Array) -> None:
    """Coefficient i of the rings' r^2 to a power, the ones before it known; zeros where none is pressed."""
    width = series.reciprocal.size
    if i == 0:
        for r in range(width):
            out[0, r] = series.reciprocal[r] ** -exponent
        return
    for c in range(0, width, LANES):
        total = splat(0.0)
        for j in range(1, i + 1):
            weight = splat((exponent * j - (i - j)) / i)
            square = multiply(weight, load(series.square, j * width + c))
            total = multiply_add(square, load(out, (i - j) * width + c), total)
        store(out, i * width + c, multiply(total, load(series.reciprocal, c)))
