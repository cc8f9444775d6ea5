"""One step of the integration: as far as the Taylor polynomials hold, or to the next contact switch."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.integrator.compiled import TAU, Packed
from facegear.dynamics.integrator.excitation import excitation
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.parting import correct_parting, find_parting, parting_time
from facegear.dynamics.integrator.rings import ring_row
from facegear.dynamics.integrator.roots import first_root, refine_root, root_after
from facegear.dynamics.integrator.taylor import deflect, evaluate, recurrence, step_length
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
from facegear.mesh_law.terms import force_terms, is_curved, piece_ends, piece_of

Array = NDArray[np.float64]
EDGE = 2e-14
"""A deflection this close to an edge, in length scales, counts as standing on it."""
BRIEFEST = 1e-14
"""An edge that is crossed within this time (rad of mesh phase) is stood on: s itself is not known better."""
SHORTEST = 1e-10
"""Shortest time (rad of mesh phase) between two switches of one mesh that is followed."""
LATEST = 1e-4
"""How far ahead (rad of mesh phase) a mesh that stands on an edge is looked at."""
STILL = 1e-14
"""A rate (length scales per rad) that rounding explains."""
ROUNDING = 1e-13
"""A step that ends this close to the end of a period (rad) ends there."""
MOST_GUESSES = 4
OPEN, DRIVE, BACK = 0, 1, -1
"""Rows of a log's shares, and the first piece of the law on each flank."""


@inlined
def advance(
    packed: Packed, work: Work, s: float, stop: float, displacement: Array, velocity: Array, tolerance: float
) -> float:
    """Expand the motion at s and return the step length; work.y then holds the polynomials valid over it.

    displacement, velocity (n,) are read, not moved. The contact state is found from the motion itself.
    """
    piece = 0
    if packed.breaks.size > 0:
        while piece < packed.breaks.size - 2 and s >= packed.breaks[piece + 1] - 1e-13:
            piece += 1
        stop = min(stop, packed.breaks[piece + 1])
    for k in range(packed.n):
        work.y[0, k] = displacement[k]
        work.y[1, k] = velocity[k]
    excitation(packed, work, s, piece, work.order + 1)
    for m in range(packed.m):
        work.active[m] = 0.0
    for row in range(2):
        deflect(packed, work.y, row, work.error, work.deflection)
        ring_row(packed.rings, work.rings, work, row)
    _find_state(packed, work)
    if packed.push_only:
        find_parting(packed, work)
    for _ in range(MOST_GUESSES):
        recurrence(packed, work, work.order, work.error, work.load, work.y, work.deflection, False)
        changed = _correct_state(packed, work)
        if packed.push_only:
            changed = correct_parting(packed, work, SHORTEST) or changed
        if not changed:
            break
    if is_curved(packed.law):
        for i in range(work.order - 1, work.order + 1):
            for c in range(0, packed.contacts, LANES):
                force_terms(packed.law, work.law, work.state, work.deflection, i, c)
    longest = stop - s
    length = step_length(packed, work, tolerance)
    if length >= longest:
        length = longest
    elif 2.0 * length > longest:
        length = 0.5 * longest
    return _until_switch(packed, work, length)


@inlined
def flank_of(state: int) -> int:
    """Drive flank, back flank or open, whatever the piece of the law."""
    return DRIVE if state > 0 else BACK if state < 0 else OPEN


@inlined
def set_state(packed: Packed, work: Work, m: int, state: int) -> None:
    """Give mesh m a contact state and what follows from it; row 0 of its deflection counts from the level at
    which the piece of the law begins.
    """
    work.state[m] = state
    work.side[m] = float(flank_of(state))
    work.active[m] = 0.0 if state == OPEN else 1.0
    work.acting[m] = 0.0 if state == OPEN and not packed.damping_when_open else packed.mesh_damping[m]
    edge = 0.0
    if state > 0:
        edge = packed.upper[m] + _ends(packed, m, state)[0]
    elif state < 0:
        edge = packed.lower[m] - _ends(packed, m, -state)[0]
    work.deflection[0, m] += work.edge[m] - edge
    work.edge[m] = edge


@inlined
def _ends(packed: Packed, m: int, piece: int) -> tuple[float, float]:
    """Where a piece of the law of mesh m begins and ends; rows of rings have one."""
    if m >= packed.contacts:
        return 0.0, np.inf
    return piece_ends(packed.law, m, piece)


@inlined
def _level_near(packed: Packed, m: int, amount: float, margin: float) -> tuple[int, int]:
    """The piece that holds an amount beyond the edge, and the piece at whose beginning it stands, if any."""
    if m >= packed.contacts:
        return 1, 0
    piece = piece_of(packed.law, m, amount)
    begin, end = piece_ends(packed.law, m, piece)
    if piece > 1 and amount - begin <= margin:
        return piece, piece
    return piece, piece + 1 if end - amount <= margin else 0


@inlined
def _find_state(packed: Packed, work: Work) -> None:
    """Contact state of every mesh from deflection and, on a level of the law, its direction of motion."""
    for m in range(packed.m):
        work.at_level[m] = 0
        work.edge[m] = 0.0
        lower, upper = packed.lower[m], packed.upper[m]
        deflection, rate = work.deflection[0, m], work.deflection[1, m]
        margin = EDGE * packed.scale + BRIEFEST * abs(rate)
        state, level = OPEN, 0
        if lower >= upper:
            state = DRIVE
        elif abs(deflection - upper) <= margin:
            level = DRIVE
        elif abs(deflection - lower) <= margin:
            level = BACK
        elif deflection > upper:
            state, level = _level_near(packed, m, deflection - upper, margin)
        elif deflection < lower:
            state, level = _level_near(packed, m, lower - deflection, margin)
            state, level = -state, -level
        if level != 0:
            work.at_level[m] = level
            state = _beside(level, rate)
        set_state(packed, work, m, state)


@inlined
def _beside(level: int, direction: float) -> int:
    """State of a mesh that stands where piece `level` begins and moves in a direction."""
    if level > 0:
        return level if direction > 0.0 else level - 1
    return level if direction < 0.0 else level + 1


@inlined
def _correct_state(packed: Packed, work: Work) -> bool:
    """Where a mesh stands on a level with hardly any speed, its place a little later decides; True if one
    changed.

    After SHORTEST, or later where rounding would decide: a body at rest that is just being touched starts
    with the cube of time.
    """
    changed = False
    for m in range(packed.m):
        if work.at_level[m] == 0:
            continue
        ahead = SHORTEST
        soon = _rise(work, m, ahead)
        while ahead < LATEST and abs(soon) <= STILL * packed.scale:
            ahead *= 1e2
            soon = _rise(work, m, ahead)
        wanted = _beside(work.at_level[m], soon)
        if wanted != work.state[m]:
            set_state(packed, work, m, wanted)
            changed = True
    return changed


@inlined
def _rise(work: Work, m: int, ahead: float) -> float:
    """Mean rate of deflection m from now until `ahead` (rad), to third order."""
    bend = work.deflection[2, m] + ahead * work.deflection[3, m]
    return work.deflection[1, m] + ahead * bend


@inlined
def _until_switch(packed: Packed, work: Work, length: float) -> float:
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
                level, number = _end_of_piece(packed, m, state, end)
            if work.least[m] <= level <= work.most[m]:
                first = _crossing(work, m, level, standing == number, length, first)
        if packed.push_only and state != OPEN and m < packed.contacts:
            first = min(first, parting_time(packed, work, m, length, SHORTEST))
    return first * length


@inlined
def _end_of_piece(packed: Packed, m: int, state: int, end: int) -> tuple[float, int]:
    """The level at which a piece begins (end 0) or ends, counted from its beginning, and the piece beyond."""
    if end == 0:
        return 0.0, state
    begin, finish = _ends(packed, m, abs(state))
    return (finish - begin, state + 1) if state > 0 else (begin - finish, state - 1)


@inlined
def _over_step(work: Work, length: float) -> None:
    """Every deflection in powers of the share of the step and in Bernstein form, with the bounds it gives."""
    rows, wide = work.deflection.shape
    power = 1.0
    for i in range(rows):
        for c in range(0, wide, LANES):
            store(work.scaled, i * wide + c, multiply(splat(power), load(work.deflection, i * wide + c)))
        power *= length
    for c in range(0, wide, LANES):
        start = load(work.scaled, c)
        least, most = start, start
        store(work.bernstein, c, start)
        for i in range(1, rows):
            total = start
            for k in range(1, i + 1):
                weight = spread(work.conversion, i * rows + k)
                total = multiply_add(load(work.scaled, k * wide + c), weight, total)
            store(work.bernstein, i * wide + c, total)
            least, most = smaller(least, total), larger(most, total)
        store(work.least, c, least)
        store(work.most, c, most)


@inlined
def _crossing(work: Work, m: int, level: float, on_it: bool, length: float, before: float) -> float:
    """Share of the step at which deflection m first passes the level, if that is `before` a given share.

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


@inlined
def after(s: float, length: float) -> float:
    """The phase at the end of a step, which is the period's end if it lies within rounding of it."""
    return TAU if TAU - (s + length) < ROUNDING else s + length


@inlined
def move(work: Work, length: float, displacement: Array, velocity: Array) -> None:
    """Move displacement and velocity (n,) to the end of the step."""
    evaluate(work.y, work.order, length, displacement, velocity)
