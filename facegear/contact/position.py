"""The contact of a pair at one position, at every torque."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.solver import check_solved
from facegear.contact.touching import Touching
from facegear.errors import NotConverged
from facegear.geometry.unloaded import PAIRS

FIRST_GUESS = 40e-6
"""Approach (m) that the candidates of the first solution must cover; later ones follow the solutions."""

MARGIN = 1.15

ENLARGEMENTS = 12

UNKNOWN_REFERENCE = 0.01
"""Part of the approach by which unloaded teeth may overlap until their average stiffness is not known: it
counts from where the flanks alone would touch, and teeth that overlap there never stand so."""


class PairAtPosition(Protocol):
    """Two gears at one position: what the solution of their contact has to know about them.

    `position` 0..1 of a pitch; `unloaded` transmission error (m) there; the pinion's `base_radius` (m).
    """

    @property
    def position(self) -> float: ...

    @property
    def unloaded(self) -> float: ...

    @property
    def base_radius(self) -> float: ...

    def touching(self, torques: Array, limit: float) -> Touching:
        """Contact of what a turn of the pinion by `limit` (rad) would close, as `touching` has it."""


@dataclass(frozen=True, eq=False)
class Spot:
    """Loaded hats of one pair at one position and torque: lattice node, force (N), whether in a `fillet`.

    `on_pinion` and `on_gear`: the same forces (N) on the nodes of both contact surfaces before refinement.
    """

    tooth: int
    hats: Integers
    force: Array
    fillet: Mask
    on_pinion: Array
    on_gear: Array


@dataclass(frozen=True, eq=False)
class LoadedPosition:
    """One position at one torque.

    Transmission errors are along the line of action, the pinion ahead of the gear positive.

    Attributes
    ----------
    position
        0..1 of a pitch.
    torque
        On the pinion, N m.
    ste, unloaded
        Transmission error under load and without, m.
    k_average, k_local
        Stiffness on the line of action, N/m; k_average is nan where an overlap matters.
    load_share : (5,)
        Of the torque carried by the pairs -2..2.
    fillet_share
        Of the torque carried in fillets.
    overlap
        By how much teeth whose flanks just touch stand in each other elsewhere, m along the line of action.
    residual
        Of the contact conditions.
    steps
        Of the solver.
    candidates, spots
        Points that may touch, and what they carry.
    """

    position: float
    torque: float
    ste: float
    unloaded: float
    k_average: float
    k_local: float
    load_share: Array
    fillet_share: float
    overlap: float
    residual: float
    steps: int
    candidates: int
    spots: tuple[Spot, ...]

    @property
    def pairs_in_contact(self) -> int:
        return int(np.count_nonzero(self.load_share))


def solve_position(
    pair: PairAtPosition, torques: Sequence[float], guess: float
) -> tuple[list[LoadedPosition], float]:
    """All torques (N m) of a position.

    `guess` is a first guess of the largest turn (rad); the largest turn found is returned with the results,
    as the next guess. Raises NotConverged naming position and torque.
    """
    limit, order = MARGIN * guess, np.argsort(torques)[::-1]
    loads = np.array([float(torques[index]) for index in order])

    def where(torque: float) -> str:
        return f"position {pair.position:.6f}, torque {torque:g} N m"

    for _ in range(ENLARGEMENTS):
        contact = pair.touching(loads, limit)
        if not contact.candidates:
            limit *= 4.0
            continue
        if not contact.forward:
            raise NotConverged("contact", where(loads[0]), "no candidate point can carry the torque")
        if contact.rotation[0] > limit:
            limit = MARGIN * float(contact.rotation[0])
            continue
        for torque, steps, residual in zip(loads, contact.steps, contact.residual, strict=True):
            check_solved(int(steps), float(residual), contact.sought, where(torque))
        return [_result(pair, contact, loads, row) for row in np.argsort(order)], float(contact.rotation[0])
    tried = f"candidates of {ENLARGEMENTS} turns up to {limit:.2e} rad"
    raise NotConverged("contact", where(max(torques)), tried)


def _result(pair: PairAtPosition, contact: Touching, torques: Array, row: int) -> LoadedPosition:
    """That of the torque in a row of what was found."""
    base, torque, force, hats = pair.base_radius, float(torques[row]), contact.force[row], contact.hats
    part = force * hats.lever_arm / torque
    load_share = np.zeros(len(PAIRS))
    load_share[np.searchsorted(PAIRS, contact.teeth)] = np.bincount(hats.pair, part, contact.teeth.size)
    ends, spots = np.searchsorted(hats.pair, np.arange(contact.teeth.size + 1)), []
    for number, tooth in enumerate(contact.teeth.tolist()):
        on = ends[number] + np.flatnonzero(force[ends[number] : ends[number + 1]] > 0.0)
        if on.size:
            spots.append(
                Spot(
                    tooth=tooth,
                    hats=hats.node[on],
                    force=force[on],
                    fillet=hats.fillet[on],
                    on_pinion=contact.on_pinion[row, number],
                    on_gear=contact.on_gear[row, number],
                )
            )
    approach, overlap = base * float(contact.rotation[row]), base * contact.overlap
    return LoadedPosition(
        position=pair.position,
        torque=torque,
        ste=pair.unloaded + approach,
        unloaded=pair.unloaded,
        k_average=torque / base / approach if overlap <= UNKNOWN_REFERENCE * approach else np.nan,
        k_local=1.0 / (base**2 * float(contact.slope[row])),
        load_share=load_share,
        fillet_share=float(part[hats.fillet].sum()),
        overlap=overlap,
        residual=float(contact.residual[row]),
        steps=int(contact.steps[row]),
        candidates=contact.candidates,
        spots=tuple(spots),
    )
