"""The first contact switch of every lane inside its step."""

from facegear.dynamics.abreast.functions import Wide
from facegear.dynamics.abreast.kernel import called, inlined
from facegear.dynamics.abreast.lanes import Lanes
from facegear.dynamics.abreast.rows import LOWER, UPPER, Structure
from facegear.dynamics.abreast.wide import (
    WIDTH,
    divide,
    load,
    positive_lanes,
    splat,
    store,
    subtract,
    where_positive,
)
from facegear.dynamics.integrator.contact_states import SHORTEST
from facegear.dynamics.integrator.roots import BESIDE, CLOSE, first_root, root_after
from facegear.machine_code.lanes import take
from facegear.machine_code.vectors import add, magnitude, multiply, multiply_add, smaller

NEVER = 2.0
ITERATIONS = 100


@called
def until_switch(shape: Structure, lanes: Lanes) -> None:
    """Shorten the step of each lane to the first contact switch inside it."""
    if not shape.opens:
        return
    store(lanes.first, 0, splat(1.0))
    for lane in range(WIDTH):
        lanes.ways[lane] = 0
    for m in range(shape.m):
        lower = load(lanes.values, shape.offsets[LOWER] + m)
        upper = load(lanes.values, shape.offsets[UPPER] + m)
        level, closes = load(lanes.level, m), subtract(upper, lower)
        size = put_down(shape, lanes, m)
        active, none = load(lanes.active, m), splat(0.0)
        # In contact deflections count from the edge, else an open mesh may reach either.
        above = where_positive(active, none, upper)
        able = where_positive(closes, splat(1.0), none)
        _look_at(lanes, above, where_positive(active, magnitude(level), level), able, size)
        able = where_positive(active, none, able)
        _look_at(lanes, lower, subtract(none, level), able, size)
    _stop_at_first(lanes)
    store(lanes.length, 0, multiply(load(lanes.length, 0), load(lanes.first, 0)))


@inlined
def put_down(shape: Structure, lanes: Lanes, m: int) -> Wide:
    """Write the terms of deflection m in powers of the fraction of the step; the sum of their sizes but for
    the first.
    """
    length, power, size = load(lanes.length, 0), splat(1.0), splat(0.0)
    store(lanes.scaled, 0, load(lanes.deflection, m))
    for i in range(1, lanes.order + 1):
        power = multiply(power, length)
        term = multiply(power, load(lanes.deflection, i * shape.m + m))
        store(lanes.scaled, i, term)
        size = add(size, magnitude(term))
    return size


@inlined
def _look_at(lanes: Lanes, level: Wide, standing: Wide, able: Wide, size: Wide) -> None:
    """Add to the ways of lanes that are able (1) that from a level, if it changes its sign within the step;
    where the deflection stands on the level (1) now, the known zero at the start is divided out.
    """
    start = subtract(load(lanes.scaled, 0), level)
    # Terms that together are smaller than the way to the level do not reach it; equality counts as reached.
    reach = subtract(multiply(size, splat(1.0 + 1e-12)), magnitude(start))
    reach = where_positive(standing, splat(1.0), reach)
    wanted = where_positive(able, reach, splat(0.0))
    if positive_lanes(wanted) == 0:
        return
    _polynomial(lanes, start, standing)
    changes = _sign_changes(lanes)
    candidates = positive_lanes(where_positive(wanted, changes, splat(0.0)))
    if candidates == 0:
        return
    store(lanes.wanted, 0, changes)
    stands = positive_lanes(standing)
    for lane in range(WIDTH):
        if (candidates >> lane) & 1:
            way = lanes.ways[lane]
            lanes.way_changes[way, lane] = lanes.wanted[lane]
            lanes.way_standing[way, lane] = float((stands >> lane) & 1)
            for i in range(lanes.order + 1):
                lanes.way_terms[way, i, lane] = lanes.terms[i, lane]
            lanes.ways[lane] = way + 1


@inlined
def _stop_at_first(lanes: Lanes) -> None:
    """Shorten the steps to the first zero of the ways of each lane.

    Lanes pass a level at different contacts: one way of each lane at a time leaves hardly a lane idle.
    """
    count = 0
    for lane in range(WIDTH):
        count = max(count, lanes.ways[lane])
    for way in range(count):
        for lane in range(WIDTH):
            lanes.wanted[lane] = 1.0 if lanes.ways[lane] > way else 0.0
        wanted = load(lanes.wanted, 0)
        several = subtract(load(lanes.way_changes, way), splat(1.5))
        root = _refined(lanes, way, where_positive(several, splat(0.0), wanted))
        # Standing on the level, what follows at once was decided by the acceleration already.
        early = subtract(splat(SHORTEST), multiply(root, load(lanes.length, 0)))
        spurious = where_positive(load(lanes.way_standing, way), early, splat(-1.0))
        root = where_positive(spurious, splat(NEVER), root)
        store(lanes.first, 0, smaller(load(lanes.first, 0), root))
        alone = positive_lanes(where_positive(spurious, wanted, where_positive(several, wanted, splat(0.0))))
        for lane in range(WIDTH):
            if (alone >> lane) & 1:
                _look_alone(lanes, way, lane)


@inlined
def _polynomial(lanes: Lanes, start: Wide, standing: Wide) -> None:
    """Write the way from the level, over the fraction of the step where the deflection stands on it."""
    store(lanes.terms, 0, where_positive(standing, load(lanes.scaled, 1), start))
    for i in range(1, lanes.order):
        term, following = load(lanes.scaled, i), load(lanes.scaled, i + 1)
        store(lanes.terms, i, where_positive(standing, following, term))
    last = load(lanes.scaled, lanes.order)
    store(lanes.terms, lanes.order, where_positive(standing, splat(0.0), last))


@inlined
def _sign_changes(lanes: Lanes) -> Wide:
    """How often the Bernstein coefficients of the polynomials over the step change their sign."""
    rows = lanes.order + 1
    start = load(lanes.terms, 0)
    changes, last = splat(0.0), start
    for i in range(1, rows):
        value, other = start, splat(0.0)
        for k in range(1, i, 2):
            value = multiply_add(load(lanes.terms, k), splat(take(lanes.conversion, i * rows + k)), value)
            weight = splat(take(lanes.conversion, i * rows + k + 1))
            other = multiply_add(load(lanes.terms, k + 1), weight, other)
        if i % 2 == 1:
            value = multiply_add(load(lanes.terms, i), splat(take(lanes.conversion, i * rows + i)), value)
        value = add(value, other)
        # Zeros are passed over: they are neither larger than zero times one sign nor the other.
        opposite = multiply(where_positive(last, splat(-1.0), splat(1.0)), value)
        changes = where_positive(opposite, add(changes, splat(1.0)), changes)
        last = where_positive(magnitude(value), value, last)
    return changes


@inlined
def _refined(lanes: Lanes, way: int, wanted: Wide) -> Wide:
    """The one zero before `first` of a way of wanted lanes, NEVER of the others and where it comes
    later: Newton's method kept inside a shrinking bracket.
    """
    terms, at = lanes.way_terms, way * (lanes.order + 1)
    low, high = splat(0.0), load(lanes.first, 0)
    at_low = load(terms, at)
    at_high = load(terms, at + lanes.order)
    for i in range(lanes.order - 1, -1, -1):
        at_high = multiply_add(at_high, high, load(terms, at + i))
    sign = where_positive(at_high, splat(1.0), splat(-1.0))
    below = multiply(sign, subtract(splat(0.0), at_low))
    pending = where_positive(below, where_positive(wanted, splat(1.0), splat(0.0)), splat(0.0))
    root = splat(NEVER)
    if positive_lanes(pending) == 0:
        return root
    t = divide(multiply(high, at_low), subtract(at_low, at_high))
    beside = subtract(multiply(splat(1.0 - BESIDE), high), t)
    t = where_positive(beside, t, multiply(splat(0.5), high))
    for _ in range(ITERATIONS):
        value, slope = load(terms, at + lanes.order), splat(0.0)
        for i in range(lanes.order - 1, -1, -1):
            slope = multiply_add(slope, t, value)
            value = multiply_add(value, t, load(terms, at + i))
        rise = multiply(sign, value)
        high = where_positive(rise, t, high)
        low = where_positive(rise, low, t)
        step = subtract(t, divide(value, slope))
        inside = smaller(subtract(step, low), subtract(high, step))
        close = subtract(splat(CLOSE), magnitude(subtract(step, t)))
        narrow = subtract(splat(4e-16), subtract(high, low))
        met = where_positive(magnitude(value), where_positive(inside, close, narrow), splat(1.0))
        middle = multiply(splat(0.5), add(low, high))
        following = where_positive(inside, step, middle)
        t = where_positive(magnitude(value), following, t)
        root = where_positive(pending, t, root)
        pending = where_positive(met, splat(0.0), pending)
        if positive_lanes(pending) == 0:
            break
    return root


@inlined
def _look_alone(lanes: Lanes, way: int, lane: int) -> None:
    """The first of several zeros of a way of one lane, by bounds that are halved."""
    for i in range(lanes.order + 1):
        lanes.polynomial[i] = lanes.way_terms[way, i, lane]
    root = first_root(lanes.polynomial, lanes.order, lanes.conversion, lanes.subdivision)
    if lanes.way_standing[way, lane] > 0.0 and root * lanes.length[lane] < SHORTEST:
        root = root_after(lanes.polynomial, lanes.order, root, lanes.conversion, lanes.subdivision)
    lanes.first[lane] = min(lanes.first[lane], root)
