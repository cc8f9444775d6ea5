"""The first contact switch of every lane inside its step."""

from facegear.dynamics.abreast.kernel import inlined
from facegear.dynamics.abreast.lanes import Lanes
from facegear.dynamics.abreast.rows import LOWER, UPPER, Structure
from facegear.dynamics.abreast.wide import (
    WIDTH,
    add,
    larger,
    load,
    magnitude,
    multiply,
    multiply_add,
    positive_lanes,
    smaller,
    splat,
    store,
    subtract,
    where_positive,
)
from facegear.dynamics.integrator.contact_states import BACK, DRIVE
from facegear.dynamics.integrator.switches import _crossing
from facegear.machine_code.lanes import take


@inlined
def until_switch(shape: Structure, lanes: Lanes) -> None:
    """Shorten the step of each lane to the first contact switch inside it."""
    if not shape.opens:
        return
    for lane in range(WIDTH):
        lanes.first[lane] = 1.0
    for m in range(shape.m):
        able = _able(shape, lanes, m)
        if able == 0:
            continue
        _bound(lanes)
        for lane in range(WIDTH):
            if (able >> lane) & 1:
                _shorten(shape, lanes, m, lane)
    store(lanes.length, 0, multiply(load(lanes.length, 0), load(lanes.first, 0)))


@inlined
def _able(shape: Structure, lanes: Lanes, m: int) -> int:
    """Lanes, as bits, in which contact m may reach an edge by the size of its terms, which are put down in
    powers of the fraction of the step.
    """
    length = load(lanes.length, 0)
    power, size = splat(1.0), splat(0.0)
    start = load(lanes.deflection, m)
    store(lanes.scaled, 0, start)
    for i in range(1, lanes.order + 1):
        power = multiply(power, length)
        term = multiply(power, load(lanes.deflection, i * shape.m + m))
        store(lanes.scaled, i, term)
        size = add(size, magnitude(term))
    lower = load(lanes.values, shape.offsets[LOWER] + m)
    upper = load(lanes.values, shape.offsets[UPPER] + m)
    nearer = smaller(magnitude(subtract(start, upper)), magnitude(subtract(start, lower)))
    gap = where_positive(load(lanes.active, m), magnitude(start), nearer)
    # Equal counts too: the bound may be reached.
    size = multiply(size, splat(1.0 + 1e-12))
    return positive_lanes(where_positive(subtract(upper, lower), subtract(size, gap), splat(0.0)))


@inlined
def _bound(lanes: Lanes) -> None:
    """Bernstein coefficients over the step, and their extremes."""
    rows = lanes.order + 1
    start = load(lanes.scaled, 0)
    low, high = start, start
    store(lanes.bernstein, 0, start)
    for i in range(1, rows):
        total, other = start, splat(0.0)
        for k in range(1, i, 2):
            total = multiply_add(load(lanes.scaled, k), splat(take(lanes.conversion, i * rows + k)), total)
            weight = splat(take(lanes.conversion, i * rows + k + 1))
            other = multiply_add(load(lanes.scaled, k + 1), weight, other)
        if i % 2 == 1:
            total = multiply_add(load(lanes.scaled, i), splat(take(lanes.conversion, i * rows + i)), total)
        total = add(total, other)
        store(lanes.bernstein, i, total)
        low, high = smaller(low, total), larger(high, total)
    store(lanes.low, 0, low)
    store(lanes.high, 0, high)


@inlined
def _shorten(shape: Structure, lanes: Lanes, m: int, lane: int) -> None:
    """Shorten the step of one lane to the first switch of contact m."""
    standing = lanes.level[m, lane]
    if lanes.side[m, lane] != 0.0:
        _stop(lanes, lane, 0.0, standing != 0.0)
        return
    _stop(lanes, lane, lanes.values[shape.offsets[UPPER] + m, lane], standing == DRIVE)
    _stop(lanes, lane, lanes.values[shape.offsets[LOWER] + m, lane], standing == BACK)


@inlined
def _stop(lanes: Lanes, lane: int, level: float, on_it: bool) -> None:
    if lanes.low[lane] <= level <= lanes.high[lane]:
        lanes.first[lane] = _crossing(lanes, lane, level, on_it, lanes.length[lane], lanes.first[lane])
