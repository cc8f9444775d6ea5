"""Contact of a pair at one position, at every torque."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.position_solver import PositionContact, check_solved
from facegear.errors import NotConverged
from facegear.teeth.closest import PAIRS

STIFFNESS = 2e10
"""Stiffness of steel teeth in mesh over the width of the face, N/m2, as in ISO 6336.

It gives the approach that the candidates of the first solution must cover; later ones follow the
solutions."""

MARGIN = 1.15
"""Factor on the expected rotation up to which candidates are searched. Results do not depend on it: where the
rotation is larger the search is repeated."""

ENLARGEMENTS = 12
"""Largest number of searches at a position; more means that the teeth cannot touch. Free choice."""

UNKNOWN_REFERENCE = 0.01
"""Fraction of the approach by which unloaded teeth may overlap until their average stiffness is not given.

The approach counts from where the flanks alone would touch, and teeth that overlap there never stand so.
"""


class PairAtPosition(Protocol):
    """Two gears at one position: the data that the solution of their contact needs.

    `position` 0..1 of a pitch; `unloaded_error`: transmission error (m) there; `normal_arm` (m): torque on
    the pinion over the force along its flank's normal.
    """

    @property
    def position(self) -> float:
        """Position in the pitch, in pitches."""
        ...

    @property
    def unloaded_error(self) -> float:
        """Transmission error without load at this position, m."""
        ...

    @property
    def normal_arm(self) -> float:
        """Torque on the pinion over the force along its flank's normal, m."""
        ...

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
    """Loaded basis functions (m,) of one pair of teeth at one position and torque.

    `tooth`: number of the pair, -2..2. `hats` (m,): their nodes on the pinion's refined lattice, `force`
    (m,) N, `fillet` (m,): whether each presses on a fillet of either gear. `on_pinion` and `on_gear`: the
    same forces (N) on the nodes of both contact surfaces before refinement, positive where they press on
    the surface.
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
    ste, unloaded_error
        Transmission error under load and without, m; their difference is the normal arm times rotation.
    k_average, k_local
        Stiffness on the line of action, N/m: force over approach, and its derivative with the contact
        area following the load; k_average is nan where an overlap matters.
    load_share : (5,)
        Of the torque carried by the pairs -2..2.
    fillet_share
        Of the torque carried in fillets.
    overlap
        By how much teeth whose flanks just touch stand in each other elsewhere, m along the line of
        action.
    residual
        Largest relative violation of the contact conditions.
    steps
        Number of steps of the active-set solver.
    candidates, spots
        Number of basis functions that may touch, and the loads of each pair that carries any.
    """

    position: float
    torque: float
    ste: float
    unloaded_error: float
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
        """Number of tooth pairs that carry load."""
        return int(np.count_nonzero(self.load_share))


def first_turn(torques: Sequence[float], normal_arm: float, width: float) -> float:
    """Return a guess of the largest rotation: largest torque / (normal arm^2 width STIFFNESS).

    Parameters
    ----------
    torques : Sequence[float]
        On the pinion, N m.
    normal_arm : float
        Torque on the pinion over the force along its flank's normal, m.
    width : float
        Width over which its teeth mesh, m.

    Returns
    -------
    float
        Rotation, rad.
    """
    return max(torques) / (normal_arm**2 * width * STIFFNESS)


def solve_position(
    pair: PairAtPosition, torques: Sequence[float], guess: float
) -> tuple[list[LoadedPosition], float]:
    """Solve for the contact at all torques of a position.

    Parameters
    ----------
    pair : PairAtPosition
        Two gears at the position.
    torques : Sequence[float]
        On the pinion, N m.
    guess : float
        First guess of the largest rotation, rad.

    Returns
    -------
    tuple[list[LoadedPosition], float]
        Result at each torque, in SI units (N, m, rad); largest rotation found, rad, which is the next
        guess.

    Raises
    ------
    NotConverged
        Names position and torque.
    """
    contact = contact_at(pair, torques, MARGIN * guess)
    return results_of(pair, contact, torques), float(contact.rotation[0])


def contact_at(pair: PairAtPosition, torques: Sequence[float], limit: float) -> PositionContact:
    """Solve for the contact of a position under all torques.

    The search is enlarged where the pinion rotates farther than `limit`.

    Parameters
    ----------
    pair : PairAtPosition
        Two gears at the position.
    torques : Sequence[float]
        On the pinion, N m.
    limit : float
        Rotation up to which contact is searched first, rad.

    Returns
    -------
    PositionContact
        Contact under these torques, the largest first.

    Raises
    ------
    NotConverged
        Names position and torque.
    """
    loads = np.sort(np.array(torques, float))[::-1].copy()

    def place_text(torque: float) -> str:
        """Name the position and a torque (N m) for an error message."""
        return f"position {pair.position:.6f}, torque {torque:g} N m"

    for _ in range(ENLARGEMENTS):
        contact = pair.contact(loads, limit)
        if not contact.candidates:
            # No gap closes, so that there is no rotation to go by: a large factor finds contact soon.
            limit *= 4.0
            continue
        if not contact.forward:
            raise NotConverged("contact", place_text(loads[0]), "no candidate point can carry the torque")
        if contact.rotation[0] > limit:
            # Candidates beyond the limit were left out. They could only have held the pinion back, so that
            # this rotation is an upper bound, and a search up to it misses none.
            limit = MARGIN * float(contact.rotation[0])
            continue
        for torque, steps, residual in zip(loads, contact.steps, contact.residual, strict=True):
            check_solved(int(steps), float(residual), contact.strip_size, place_text(torque))
        return contact
    attempts = f"candidates of {ENLARGEMENTS} turns up to {limit:.2e} rad"
    raise NotConverged("contact", place_text(max(torques)), attempts)


def results_of(
    pair: PairAtPosition, contact: PositionContact, torques: Sequence[float]
) -> list[LoadedPosition]:
    """Return the result at each torque, in the order of the torques.

    Parameters
    ----------
    pair : PairAtPosition
        Two gears at the position.
    contact : PositionContact
        Contact under the torques, the largest first.
    torques : Sequence[float]
        On the pinion, N m.

    Returns
    -------
    list[LoadedPosition]
        Result at each torque, in SI units (N, m, rad).
    """
    order = np.argsort(torques)[::-1]
    results = _results(pair, contact, np.array([float(torques[index]) for index in order]))
    return [results[row] for row in np.argsort(order)]


def _results(pair: PairAtPosition, contact: PositionContact, torques: Array) -> list[LoadedPosition]:
    """Return the result at each torque (t,), N m, in the order of `contact`, the largest first.

    Approach is the normal arm times rotation, k_average = torque / (normal arm approach), k_local = 1 /
    (normal arm^2 d rotation / d torque). k_average is nan where the overlap is above UNKNOWN_REFERENCE
    of the approach.
    """
    arm, teeth = pair.normal_arm, contact.teeth
    approach, overlap = arm * contact.rotation, arm * contact.overlap
    average = np.where(overlap <= UNKNOWN_REFERENCE * approach, torques / arm / approach, np.nan)
    local, part = 1.0 / (arm**2 * contact.slope), contact.force * contact.lever_arm / torques[:, None]
    of_pair = contact.pair[:, None] == np.arange(teeth.size)
    load_share = np.zeros((torques.size, len(PAIRS)))
    load_share[:, np.searchsorted(PAIRS, teeth)] = part @ of_pair
    spots = _spots(contact)
    columns = (
        torques,
        pair.unloaded_error + approach,
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
            unloaded_error=pair.unloaded_error,
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
    """Return a tuple of loaded pairs for each torque, in the order of `contact`; pairs without load are
    left out.
    """
    torques, pairs = contact.on_pinion.shape[:2]
    row, on = np.nonzero(contact.force > 0.0)
    node, force, fillet = contact.node[on], contact.force[row, on], contact.fillet[on]
    bounds = np.searchsorted(row * pairs + contact.pair[on], np.arange(torques * pairs + 1)).tolist()
    tooth, spots = contact.teeth.tolist(), [list[Spot]() for _ in range(torques)]
    for number, (first, last) in enumerate(pairwise(bounds)):
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
    return [tuple(pair_loads) for pair_loads in spots]
