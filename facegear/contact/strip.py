"""Contact at all candidates, solved in the strip that can be expected to touch and checked on the rest.

A load at a hat moves all hats away from the other gear, so that only hats whose gap a rigid turn would close
can touch. Most of those do not: the bodies give way around the strip that does. The influence matrix of the
strip alone is many times cheaper, and one product shows whether the rest stays clear.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Protocol

import numpy as np

from facegear.arrays import AnyArray, Array, Mask
from facegear.contact.candidates import Candidates
from facegear.contact.solver import TOLERANCE, ContactSolution, solve_contact

GAP, BAND = 0.8, 0.15
"""Parts of the rigid approach within which contact is sought: the least gap of a column of hats (the bodies
give way by the rest) and, above that, the gap of the others in it (the strip's half-width)."""

WIDER = 1.6
"""Factor on the second part where contact is missed beside the strip."""

START_GAP, START_WIDTH = 0.6, 0.055
"""The same parts for the first guess of what touches."""


class Bodies(Protocol):
    """How two elastic bodies answer loads; with `in_strip`, a solution is sought in a strip and checked."""

    @property
    def in_strip(self) -> bool: ...

    def influence(self, pairs: list[Candidates]) -> Array:
        """Influence matrix (m, m) of candidates, m/N."""

    def approach(self, seen: list[Candidates], pairs: list[Candidates], forces: Array) -> Array:
        """Approach (k, t) m at the k candidates `seen` by forces (m, t) N on those of `pairs`."""


@dataclass(frozen=True, eq=False)
class _Turns:
    """Turn (n,) of the pinion that closes each candidate's gap, and the least (n,) in its column of hats."""

    own: Array
    column_min: Array

    def within(self, min_turn: float, band: float) -> Mask:
        return (self.own < self.column_min + band) & (self.column_min < min_turn)


def _turns(pairs: list[Candidates]) -> _Turns:
    own, low = [], []
    for pair in pairs:
        forward = pair.lever_arm > 0
        turn = np.where(forward, pair.gap / np.where(forward, pair.lever_arm, 1.0), np.inf)
        column_min = np.full(pair.column.max() + 1, np.inf)
        np.minimum.at(column_min, pair.column, turn)
        own.append(turn)
        low.append(column_min[pair.column])
    return _Turns(np.concatenate(own), np.concatenate(low))


def only(pairs: list[Candidates], keep: Mask) -> list[Candidates]:
    """Those marked (n,), pairs without any left out."""
    parts = zip(pairs, parts_of(pairs, keep), strict=True)
    return [pair.only(marked) for pair, marked in parts if marked.any()]


def parts_of(pairs: list[Candidates], values: AnyArray) -> list[AnyArray]:
    """Values of all candidates (n,), pair by pair."""
    ends = np.cumsum([0, *(len(pair.hats) for pair in pairs)])
    return [values[start:end] for start, end in pairwise(ends)]


def solve_torques(
    pairs: list[Candidates],
    limit: float,
    torques: Sequence[float],
    bodies: Bodies,
    where: Callable[[float], str],
) -> list[ContactSolution]:
    """Contact (forces (n,) of all candidates) under torques (N m), the largest first.

    `pairs` are those that a turn by `limit` (rad) would close. If the first torque turns further, only its
    contact is returned. Unless `bodies.in_strip`, all candidates take part in the solution.
    Raises NotConverged with `where(torque)`.
    """
    gap, lever_arm = (
        np.concatenate([getattr(pair, name) for pair in pairs]) for name in ("gap", "lever_arm")
    )
    turns = _turns(pairs)
    band = BAND * limit
    keep = turns.within(GAP * limit, band) if bodies.in_strip else np.ones(len(gap), dtype=bool)
    if not (keep & (lever_arm > 0)).any():
        keep[:] = True
    while True:
        chosen = only(pairs, keep)
        matrix = bodies.influence(chosen)
        contacts: list[ContactSolution] = []
        turn = limit
        for torque in torques:
            if contacts:
                turn = contacts[-1].rotation * torque / contacts[-1].torque
            start = turns.within(START_GAP * turn, START_WIDTH * turn)[keep]
            contacts.append(solve_contact(matrix, gap[keep], lever_arm[keep], torque, start, where(torque)))
            if contacts[0].rotation > limit:
                break
        left = ~keep & (gap < contacts[0].rotation * lever_arm)
        worst = np.zeros(len(contacts))
        if left.any():
            forces = np.stack([contact.force for contact in contacts], axis=1)
            turned = np.array([contact.rotation for contact in contacts])
            moved = bodies.approach(only(pairs, left), chosen, forces)
            distance = gap[left, None] + moved - lever_arm[left, None] * turned
            inside = -distance / (turned * np.abs(lever_arm).max())
            worst = inside.max(axis=0)
            if worst.max() > TOLERANCE:
                band *= WIDER
                keep |= left & turns.within(GAP * limit, band)
                keep[left] |= inside.max(axis=1) > TOLERANCE
                continue
        return [_whole(contact, keep, value) for contact, value in zip(contacts, worst, strict=True)]


def _whole(contact: ContactSolution, keep: Mask, worst: float) -> ContactSolution:
    force = np.zeros(len(keep))
    force[keep] = contact.force
    return replace(contact, force=force, residual=max(contact.residual, float(worst)))
