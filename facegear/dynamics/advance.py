"""One step of the integration: as far as the Taylor polynomials hold, or to the next contact switch."""

import numpy as np
from numpy.typing import NDArray

from facegear.dynamics.compiled import Packed
from facegear.dynamics.kernel import kernel
from facegear.dynamics.lanes import LANES, larger, load, multiply_add, smaller, splat, store
from facegear.dynamics.roots import first_root
from facegear.dynamics.taylor import Work, deflect, evaluate, excitation, recurrence, step_length

Array = NDArray[np.float64]
EDGE = 2e-14
"""A deflection this close to an edge, in length scales, counts as standing on it."""
BRIEFEST = 1e-14
"""An edge that is crossed within this time (rad of mesh phase) is stood on: s itself is not known better."""
SHORTEST = 1e-10
"""Shortest time (rad of mesh phase) between two switches of one mesh that is followed."""
OPEN, DRIVE, BACK = 0, 1, -1


@kernel
def advance(
    packed: Packed, work: Work, s: float, stop: float, place: Array, velocity: Array, tolerance: float
) -> float:
    """Expand the motion at s and return the step length; work.y then holds the polynomials valid over it.

    place, velocity (n,) are read, not moved. The contact state is found from the motion itself.
    """
    piece = 0
    if packed.breaks.size > 0:
        while piece < packed.breaks.size - 2 and s >= packed.breaks[piece + 1] - 1e-13:
            piece += 1
        stop = min(stop, packed.breaks[piece + 1])
    for k in range(packed.n):
        work.y[0, k] = place[k]
        work.y[1, k] = velocity[k]
    excitation(packed, work, s, piece)
    deflect(packed, work.y, 0, work.error, work.deflection)
    deflect(packed, work.y, 1, work.error, work.deflection)
    _find_state(packed, work)
    recurrence(packed, work, work.error, work.load, work.y, work.deflection)
    for _ in range(3):
        if not _correct_state(packed, work):
            break
        recurrence(packed, work, work.error, work.load, work.y, work.deflection)
    longest = stop - s
    length = step_length(packed, work, tolerance)
    if length >= longest:
        length = longest
    elif 2.0 * length > longest:
        length = 0.5 * longest
    return _until_switch(packed, work, length)


@kernel
def set_state(packed: Packed, work: Work, m: int, state: int) -> None:
    """Give mesh m a contact state and what follows from it; row 0 of its deflection counts from the edge."""
    work.state[m] = state
    work.active[m] = 0.0 if state == OPEN else 1.0
    work.acting[m] = 0.0 if state == OPEN and not packed.damping_when_open else packed.mesh_damping[m]
    edge = packed.upper[m] if state == DRIVE else packed.lower[m] if state == BACK else 0.0
    work.deflection[0, m] += work.edge[m] - edge
    work.edge[m] = edge


@kernel
def _find_state(packed: Packed, work: Work) -> None:
    """Contact state of every mesh from deflection and, on an edge, its direction of motion."""
    for m in range(packed.m):
        work.at_edge[m] = 0
        work.edge[m] = 0.0
        lower, upper = packed.lower[m], packed.upper[m]
        if lower >= upper:
            set_state(packed, work, m, DRIVE)
            continue
        deflection, rate = work.deflection[0, m], work.deflection[1, m]
        margin = EDGE * packed.scale + BRIEFEST * abs(rate)
        if abs(deflection - upper) <= margin:
            work.at_edge[m] = 1
            set_state(packed, work, m, DRIVE if rate > 0.0 else OPEN)
        elif abs(deflection - lower) <= margin:
            work.at_edge[m] = -1
            set_state(packed, work, m, BACK if rate < 0.0 else OPEN)
        elif deflection > upper:
            set_state(packed, work, m, DRIVE)
        elif deflection < lower:
            set_state(packed, work, m, BACK)
        else:
            set_state(packed, work, m, OPEN)


@kernel
def _correct_state(packed: Packed, work: Work) -> bool:
    """Where a mesh stands on an edge with hardly any speed its acceleration decides; True if one changed."""
    changed = False
    for m in range(packed.m):
        if work.at_edge[m] == 0:
            continue
        soon = work.deflection[1, m] + SHORTEST * work.deflection[2, m]
        wanted = (DRIVE if soon > 0.0 else OPEN) if work.at_edge[m] == 1 else BACK if soon < 0.0 else OPEN
        if wanted != work.state[m]:
            set_state(packed, work, m, wanted)
            changed = True
    return changed


@kernel
def _until_switch(packed: Packed, work: Work, length: float) -> float:
    """Shorten the step to the first contact switch inside it."""
    _ranges(work, length)
    for m in range(packed.m):
        lower, upper = packed.lower[m], packed.upper[m]
        if lower >= upper:
            continue
        least, most = work.least[m], work.most[m]
        if work.state[m] != OPEN:
            if least <= 0.0 <= most:
                length = _crossing(work, m, 0.0, work.at_edge[m] != 0, length)
        else:
            if most >= upper:
                length = _crossing(work, m, upper, work.at_edge[m] == 1, length)
            if least <= lower:
                length = _crossing(work, m, lower, work.at_edge[m] == -1, length)
    return length


@kernel
def _ranges(work: Work, length: float) -> None:
    """Bounds of every deflection over the step: its least and largest Bernstein coefficient."""
    rows, wide = work.deflection.shape
    for c in range(0, wide, LANES):
        least = load(work.deflection, c)
        most = least
        for i in range(1, rows):
            total = load(work.deflection, c)
            power = length
            for k in range(1, i + 1):
                weight = splat(work.conversion[i, k] * power)
                total = multiply_add(load(work.deflection, k * wide + c), weight, total)
                power *= length
            least, most = smaller(least, total), larger(most, total)
        store(work.least, c, least)
        store(work.most, c, most)


@kernel
def _crossing(work: Work, m: int, level: float, on_it: bool, length: float) -> float:
    """First time within `length` at which deflection m passes the level; `length` itself if it does not.

    Standing on the level the known zero at the start is divided out.
    """
    order = work.order
    power = 1.0
    if on_it:
        for i in range(order):
            work.polynomial[i] = work.deflection[i + 1, m] * power
            power *= length
        # A zero of this quotient before SHORTEST was decided by the acceleration already.
        root = first_root(work.polynomial, order - 1, work.conversion_less, work.subdivision)
        if root * length < SHORTEST:
            return length if root >= 1.0 else _beyond(work, order - 1, root, length)
    else:
        for i in range(order + 1):
            work.polynomial[i] = work.deflection[i, m] * power
            power *= length
        work.polynomial[0] -= level
        root = first_root(work.polynomial, order, work.conversion, work.subdivision)
    return min(root, 1.0) * length


@kernel
def _beyond(work: Work, degree: int, root: float, length: float) -> float:
    """The next zero after a spurious one at the start: divide it out and search again."""
    carry = work.polynomial[degree]
    for i in range(degree - 1, -1, -1):
        value = work.polynomial[i]
        work.polynomial[i] = carry
        carry = value + root * carry
    work.polynomial[degree] = 0.0
    again = first_root(work.polynomial, degree, work.conversion_less, work.subdivision)
    return min(again, 1.0) * length


@kernel
def move(work: Work, length: float, place: Array, velocity: Array) -> None:
    """Move place and velocity (n,) to the end of the step."""
    evaluate(work.y, work.order, length, place, velocity)
