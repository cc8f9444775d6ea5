"""The first contact switch inside a step, by the polynomials of the deflections."""

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.contact_states import BACK, DRIVE, OPEN, SHORTEST, end_of_piece
from facegear.dynamics.integrator.kernel import called, inlined
from facegear.dynamics.integrator.parting import parting_time
from facegear.dynamics.integrator.roots import first_root, refine_root, root_after
from facegear.dynamics.integrator.work import Work
from facegear.machine_code.lanes import (
    LANES,
    larger,
    load,
    multiply,
    multiply_add,
    smaller,
    splat,
    spread,
    store,
)


@called
def until_switch(packed: Packed, work: Work, length: float) -> float:
    """Shorten the step to the first contact switch inside it."""
    _over_step(work, length)
    first = 1.0
    for m in range(packed.m):
        lower, upper = packed.lower[m], packed.upper[m]
        if lower >= upper:
            continue
        state, standing = work.state[m], work.at_level[m]
        for end in range(2):
            # Open, a mesh may reach either edge; in contact, both ends of the piece of the law.
            if state == OPEN:
                level, number = (upper, DRIVE) if end == 0 else (lower, BACK)
            else:
                level, number = end_of_piece(packed, m, state, end)
            if work.lower_bound[m] <= level <= work.upper_bound[m]:
                first = _crossing(work, m, level, standing == number, length, first)
        if packed.push_only and state != OPEN and m < packed.contacts:
            first = min(first, parting_time(packed, work, m, length))
    return first * length


@inlined
def _over_step(work: Work, length: float) -> None:
    """Every deflection in powers of the fraction of the step and in Bernstein form, with its bounds."""
    rows, width = work.deflection.shape
    power = 1.0
    for i in range(rows):
        for c in range(0, width, LANES):
            store(work.scaled, i * width + c, multiply(splat(power), load(work.deflection, i * width + c)))
        power *= length
    for c in range(0, width, LANES):
        start = load(work.scaled, c)
        lower_bound, upper_bound = start, start
        store(work.bernstein, c, start)
        for i in range(1, rows):
            total = start
            for k in range(1, i + 1):
                weight = spread(work.conversion, i * rows + k)
                total = multiply_add(load(work.scaled, k * width + c), weight, total)
            store(work.bernstein, i * width + c, total)
            lower_bound, upper_bound = smaller(lower_bound, total), larger(upper_bound, total)
        store(work.lower_bound, c, lower_bound)
        store(work.upper_bound, c, upper_bound)


@inlined
def _crossing(work: Work, m: int, level: float, on_it: bool, length: float, before: float) -> float:
    """Fraction of the step at which deflection m first passes the level, if that is `before` a given one.

    Standing on the level the known zero at the start is divided out.
    """
    order = work.order
    if on_it:
        for i in range(order):
            work.polynomial[i] = work.scaled[i + 1, m]
        # A zero of this quotient before SHORTEST was decided by the acceleration already.
        root = first_root(work.polynomial, order - 1, work.conversion_less, work.subdivision)
        if root * length < SHORTEST:
            root = root_after(work.polynomial, order - 1, root, work.conversion_less, work.subdivision)
        return min(root, before)
    for i in range(order + 1):
        work.polynomial[i] = work.scaled[i, m]
    work.polynomial[0] -= level
    changes, last = 0, work.polynomial[0]
    for i in range(1, order + 1):
        value = work.bernstein[i, m] - level
        if value != 0.0 and (last > 0.0) != (value > 0.0):
            changes += 1
            last = value
    if changes != 1:
        root = first_root(work.polynomial, order, work.conversion, work.subdivision) if changes > 1 else 2.0
        return min(root, before)
    # Only one zero: it comes first only if the sign has changed by `before`.
    value = work.bernstein[order, m] - level
    if before < 1.0:
        value = work.polynomial[order]
        for i in range(order - 1, -1, -1):
            value = value * before + work.polynomial[i]
        if (value > 0.0) == (work.polynomial[0] > 0.0):
            return before
    return refine_root(work.polynomial, order, 0.0, before, work.polynomial[0], value)
