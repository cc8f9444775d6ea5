"""The contact of a pair at one position, at every torque."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.candidates import Candidates
from facegear.contact.solver import ContactSolution
from facegear.contact.strip import Bodies, only, parts_of, solve_torques
from facegear.errors import NotConverged
from facegear.geometry.unloaded import PAIRS

FIRST_GUESS = 40e-6
"""Approach (m) that the candidates of the first solution must cover; later ones follow the solutions."""

MARGIN = 1.15

ENLARGEMENTS = 12

UNKNOWN_REFERENCE = 0.01
"""Part of the approach by which unloaded teeth may overlap until their average stiffness is not known: it
counts from where the flanks alone would touch, and teeth that overlap there never stand so."""


class PairAtPosition(Bodies, Protocol):
    """Two gears at one position: what the solution of their contact has to know about them.

    `position` 0..1 of a pitch; `unloaded` transmission error (m) there; the pinion's `base_radius` (m).
    """

    @property
    def position(self) -> float: ...

    @property
    def unloaded(self) -> float: ...

    @property
    def base_radius(self) -> float: ...

    def candidates(self, limit: float) -> list[Candidates]:
        """Loads of all pairs of teeth that a turn of the pinion by `limit` (rad) would close."""


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
    limit = MARGIN * guess
    order = np.argsort(torques)[::-1]

    def where(torque: float) -> str:
        return f"position {pair.position:.6f}, torque {torque:g} N m"

    for _ in range(ENLARGEMENTS):
        candidates = pair.candidates(limit)
        if not candidates:
            limit *= 4.0
            continue
        loads = [float(torques[index]) for index in order]
        contacts = solve_torques(candidates, limit, loads, pair, where)
        if contacts[0].rotation <= limit:
            break
        limit = MARGIN * contacts[0].rotation
    else:
        tried = f"candidates of {ENLARGEMENTS} turns up to {limit:.2e} rad"
        raise NotConverged("contact", where(max(torques)), tried)
    loaded = np.any([contact.force > 0.0 for contact in contacts], axis=0)
    overlap = pair.base_radius * max(loads.overlap for loads in candidates)
    carrying = only(candidates, loaded)
    results = [_result(pair, carrying, overlap, contacts[i], loaded) for i in np.argsort(order)]
    return results, contacts[0].rotation


def _result(
    pair: PairAtPosition,
    carrying: list[Candidates],
    overlap: float,
    contact: ContactSolution,
    loaded: Mask,
) -> LoadedPosition:
    """Of the candidates that carry load at any torque, those marked among all (n,)."""
    base = pair.base_radius
    load_share = np.zeros(len(PAIRS))
    in_fillets = 0.0
    spots, forces = [], contact.force[loaded]
    for loads, force in zip(carrying, parts_of(carrying, forces), strict=True):
        part = force * loads.lever_arm / contact.torque
        load_share[np.searchsorted(PAIRS, loads.tooth)] = part.sum()
        in_fillets += float(part[loads.fillet].sum())
        on = force > 0.0
        if on.any():
            spots.append(
                Spot(
                    tooth=loads.tooth,
                    hats=loads.hats[on],
                    force=force[on],
                    fillet=loads.fillet[on],
                    on_pinion=loads.loads(0, False).by(force),
                    on_gear=loads.loads(1, False).by(force),
                )
            )
    approach = base * contact.rotation
    return LoadedPosition(
        position=pair.position,
        torque=contact.torque,
        ste=pair.unloaded + approach,
        unloaded=pair.unloaded,
        k_average=contact.torque / base / approach if overlap <= UNKNOWN_REFERENCE * approach else np.nan,
        k_local=1.0 / (base**2 * contact.slope),
        load_share=load_share,
        fillet_share=in_fillets,
        overlap=overlap,
        residual=contact.residual,
        steps=contact.steps,
        candidates=len(contact.force),
        spots=tuple(spots),
    )
