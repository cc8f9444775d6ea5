"""The contact of a pair at one position, at every torque."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.position_solver import PositionContact
from facegear.contact.solver import check_solved
from facegear.errors import NotConverged
from facegear.geometry.unloaded import PAIRS

STIFFNESS = 2e10
"""Of teeth of steel in mesh over the width of the face (N/m2), as ISO 6336 takes it: for the approach that
the candidates of the first solution must cover; later ones follow the solutions."""

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

    def contact(self, torques: Array, limit: float) -> PositionContact:
        """Solve for the contact of what a rotation of the pinion would close.

        Parameters
        ----------
        torques : Array
            Torques (t,) N m, the largest first.
        limit : float
            Rotation, rad.

        Returns
        -------
        PositionContact
            Contact under these torques (t,), in SI units (N, m, rad).
        """


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


def first_turn(torques: Sequence[float], base_radius: float, width: float) -> float:
    """A guess of the largest turn (rad) under torques (N m) of a pinion whose teeth mesh over a width (m)."""
    return max(torques) / (base_radius**2 * width * STIFFNESS)


def solve_position(
    pair: PairAtPosition, torques: Sequence[float], guess: float
) -> tuple[list[LoadedPosition], float]:
    """All torques (N m) of a position.

    `guess` is a first guess of the largest turn (rad); the largest turn found is returned with the results,
    as the next guess. Raises NotConverged naming position and torque.
    """
    contact = contact_at(pair, torques, MARGIN * guess)
    return results_of(pair, contact, torques), float(contact.rotation[0])


def contact_at(pair: PairAtPosition, torques: Sequence[float], limit: float) -> PositionContact:
    """The contact of a position under all torques (N m), the largest first.

    It is sought for turns up to `limit` (rad), and farther where it turns farther. Raises NotConverged naming
    position and torque.
    """
    loads = np.sort(np.array(torques, float))[::-1].copy()

    def where(torque: float) -> str:
        return f"position {pair.position:.6f}, torque {torque:g} N m"

    for _ in range(ENLARGEMENTS):
        contact = pair.contact(loads, limit)
        if not contact.candidates:
            limit *= 4.0
            continue
        if not contact.forward:
            raise NotConverged("contact", where(loads[0]), "no candidate point can carry the torque")
        if contact.rotation[0] > limit:
            limit = MARGIN * float(contact.rotation[0])
            continue
        for torque, steps, residual in zip(loads, contact.steps, contact.residual, strict=True):
            check_solved(int(steps), float(residual), contact.strip_size, where(torque))
        return contact
    tried = f"candidates of {ENLARGEMENTS} turns up to {limit:.2e} rad"
    raise NotConverged("contact", where(max(torques)), tried)


def results_of(
    pair: PairAtPosition, contact: PositionContact, torques: Sequence[float]
) -> list[LoadedPosition]:
    """Return the result at each torque (N m), in the order of the torques."""
    order = np.argsort(torques)[::-1]
    results = _results(pair, contact, np.array([float(torques[index]) for index in order]))
    return [results[row] for row in np.argsort(order)]


def _results(pair: PairAtPosition, contact: PositionContact, torques: Array) -> list[LoadedPosition]:
    """Return the result at each torque (t,), in N m, in the order of the contact."""
    base, teeth = pair.base_radius, contact.teeth
    approach, overlap = base * contact.rotation, base * contact.overlap
    average = np.where(overlap <= UNKNOWN_REFERENCE * approach, torques / base / approach, np.nan)
    local, part = 1.0 / (base**2 * contact.slope), contact.force * contact.lever_arm / torques[:, None]
    of_pair = contact.pair[:, None] == np.arange(teeth.size)
    load_share = np.zeros((torques.size, len(PAIRS)))
    load_share[:, np.searchsorted(PAIRS, teeth)] = part @ of_pair
    spots = _spots(contact)
    columns = (
        torques,
        pair.unloaded + approach,
        average,
        local,
        part @ contact.fillet,
        contact.residual,
        contact.steps,
    )
    return [
        LoadedPosition(
            position=pair.position,
            torque=torque,
            ste=ste,
            unloaded=pair.unloaded,
            k_average=k_average,
            k_local=k_local,
            load_share=load_share[row],
            fillet_share=fillet_share,
            overlap=overlap,
            residual=residual,
            steps=steps,
            candidates=contact.candidates,
            spots=spots[row],
        )
        for row, (torque, ste, k_average, k_local, fillet_share, residual, steps) in enumerate(
            zip(*(column.tolist() for column in columns), strict=True)
        )
    ]


def _spots(contact: PositionContact) -> list[tuple[Spot, ...]]:
    """Of each torque, tooth by tooth."""
    torques, pairs = contact.on_pinion.shape[:2]
    row, on = np.nonzero(contact.force > 0.0)
    node, force, fillet = contact.node[on], contact.force[row, on], contact.fillet[on]
    begun = np.searchsorted(row * pairs + contact.pair[on], np.arange(torques * pairs + 1)).tolist()
    tooth, spots = contact.teeth.tolist(), [list[Spot]() for _ in range(torques)]
    for number, (first, last) in enumerate(pairwise(begun)):
        torque, pair = divmod(number, pairs)
        if last > first:
            spot = Spot(
                tooth=tooth[pair],
                hats=node[first:last],
                force=force[first:last],
                fillet=fillet[first:last],
                on_pinion=contact.on_pinion[torque, pair],
                on_gear=contact.on_gear[torque, pair],
            )
            spots[torque].append(spot)
    return [tuple(some) for some in spots]
