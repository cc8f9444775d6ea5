"""Contact state of every mesh: open, or in which piece of its law, on which flank."""

import numpy as np

from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.work import Work
from facegear.mesh_law.terms import piece_ends, piece_of

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
OPEN, DRIVE, BACK = 0, 1, -1
"""Rows of a log's fractions, and the first piece of the law on each flank."""


@inlined
def flank_of(state: int) -> int:
    """Drive flank, back flank or open, whatever the piece of the law."""
    return DRIVE if state > 0 else BACK if state < 0 else OPEN


@inlined
def edge_margin(packed: Packed, rate: float) -> float:
    """How far a deflection with this rate may be from an edge and still counts as standing on it."""
    return EDGE * packed.scale + BRIEFEST * abs(rate)


@inlined
def _set_state(packed: Packed, work: Work, m: int, state: int) -> None:
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
def find_states(packed: Packed, work: Work) -> None:
    """Contact state of every mesh from deflection and, on a level of the law, its direction of motion."""
    for m in range(packed.m):
        work.at_level[m] = 0
        work.edge[m] = 0.0
        lower, upper = packed.lower[m], packed.upper[m]
        deflection, rate = work.deflection[0, m], work.deflection[1, m]
        margin = edge_margin(packed, rate)
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
        _set_state(packed, work, m, state)


@inlined
def _beside(level: int, direction: float) -> int:
    """State of a mesh that stands where piece `level` begins and moves in a direction."""
    if level > 0:
        return level if direction > 0.0 else level - 1
    return level if direction < 0.0 else level + 1


@inlined
def correct_states(packed: Packed, work: Work) -> bool:
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
            _set_state(packed, work, m, wanted)
            changed = True
    return changed


@inlined
def _rise(work: Work, m: int, ahead: float) -> float:
    """Mean rate of deflection m from now until `ahead` (rad), to third order."""
    bend = work.deflection[2, m] + ahead * work.deflection[3, m]
    return work.deflection[1, m] + ahead * bend


@inlined
def end_of_piece(packed: Packed, m: int, state: int, end: int) -> tuple[float, int]:
    """The level at which a piece begins (end 0) or ends, counted from its beginning, and the piece beyond."""
    if end == 0:
        return 0.0, state
    begin, finish = _ends(packed, m, abs(state))
    return (finish - begin, state + 1) if state > 0 else (begin - finish, state - 1)
