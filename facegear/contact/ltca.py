"""Loaded tooth contact analysis: every position of a pitch at every torque."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import pi

import numpy as np
from numpy.typing import NDArray

from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.candidates import Candidates, PinionSurface
from facegear.contact.influence import displacement, influence_matrix
from facegear.contact.options import ContactOptions
from facegear.contact.path import pairs_to_try
from facegear.contact.search import find_candidates
from facegear.contact.solver import Contact
from facegear.contact.strip import Combine, Displace, solve_torques
from facegear.contact.teeth import GearLattice
from facegear.errors import NotConverged
from facegear.geometry.design import PairDesign
from facegear.geometry.unloaded import PAIRS, unloaded_contact
from facegear.progress import Progress

FIRST_GUESS = 40e-6
"""Approach (m) that the candidates of the first solution must cover; later ones follow the solutions."""

MARGIN = 1.15

ENLARGEMENTS = 12


@dataclass(frozen=True, eq=False)
class ContactModel:
    """A pair ready for contact: exact surfaces and the compliance of both gears."""

    design: PairDesign
    surface: PinionSurface
    lattice: GearLattice
    pinion: FlankCompliance
    gear: FlankCompliance


@dataclass(frozen=True, eq=False)
class Spot:
    """Loaded hats of one pair at one position and torque: lattice node, force (N), pressure (Pa).

    `whole` marks hats that no edge of either tooth cuts.
    """

    tooth: int
    hats: NDArray[np.int64]
    force: NDArray[np.float64]
    pressure: NDArray[np.float64]
    whole: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class LoadedPosition:
    """One position at one torque.

    `position` 0..1 of a pitch; `torque` N m on the pinion; transmission errors (m) along the line of action,
    the pinion ahead of the gear positive, `ste` loaded and `unloaded`; stiffnesses (N/m) on the line of
    action; `share` (5,) of the torque carried by the pairs -2..2; `residual` of the contact conditions.
    """

    position: float
    torque: float
    ste: float
    unloaded: float
    k_average: float
    k_local: float
    share: NDArray[np.float64]
    residual: float
    steps: int
    candidates: int
    spots: tuple[Spot, ...]

    @property
    def pairs_in_contact(self) -> int:
        return int(np.count_nonzero(self.share))

    @property
    def peak_pressure(self) -> float:
        """Largest pressure away from edges, Pa."""
        return max((float(spot.pressure[spot.whole].max(initial=0.0)) for spot in self.spots), default=0.0)

    @property
    def edge_pressure(self) -> float:
        """Largest pressure at an edge, Pa; without relief it grows as the mesh is refined."""
        return max((float(spot.pressure[~spot.whole].max(initial=0.0)) for spot in self.spots), default=0.0)


def even_positions(count: int) -> NDArray[np.float64]:
    """Positions 0, 1/n, 2/n ... of a pitch."""
    return np.arange(count) / count


def analyse(
    model: ContactModel,
    positions: Sequence[float],
    torques: Sequence[float],
    options: ContactOptions | None = None,
) -> list[LoadedPosition]:
    """Solve all torques (N m) at all positions (0..1 of a pitch, 0.5 where phi1 = 0), position by position.

    Raises NotConverged naming the position and the torque.
    """
    options = options or ContactOptions()
    phi1 = (np.asarray(positions, dtype=float) - 0.5) * 2 * pi / model.design.pinion.teeth
    unloaded = unloaded_contact(model.design, phi1)
    guess = FIRST_GUESS / model.design.pinion_base_radius
    progress = Progress("loaded contact", len(phi1))
    results: list[LoadedPosition] = []
    for row, position in enumerate(positions):
        angles = float(phi1[row]), float(unloaded.phi2[row])
        error = -float(unloaded.transmission_error[row])
        find = partial(_candidates, model, angles, options)
        bodies = {"pinion": model.pinion, "gear": model.gear, "coupled": options.coupled}
        combine, displace = partial(influence_matrix, **bodies), partial(displacement, **bodies)
        place = Place(float(position), error, model.design.pinion_base_radius)
        solved, guess = solve_position(find, combine, place, torques, guess, displace)
        results += solved
        progress.step()
    return results


def _candidates(
    model: ContactModel, angles: tuple[float, float], options: ContactOptions, limit: float
) -> list[Candidates]:
    teeth = pairs_to_try(model.design, angles[0], options)
    return find_candidates(model.surface, model.lattice, *angles, teeth, limit, options)


@dataclass(frozen=True)
class Place:
    """Position 0..1 of a pitch, unloaded transmission error (m) there, and the pinion's base radius (m)."""

    position: float
    unloaded: float
    base_radius: float


def solve_position(
    find: Callable[[float], list[Candidates]],
    combine: Combine,
    place: Place,
    torques: Sequence[float],
    guess: float,
    displace: Displace | None = None,
) -> tuple[list[LoadedPosition], float]:
    """All torques of a position.

    `find` gives the candidates that a turn (rad) would close, `combine` their influence matrix; with
    `displace` it is made for a strip of them only, and the others are checked. `guess` is a first guess of
    the largest turn; the largest turn found is returned with the results, as the next guess.
    Raises NotConverged naming position and torque.
    """
    limit = MARGIN * guess
    order = np.argsort(torques)[::-1]

    def where(torque: float) -> str:
        return f"position {place.position:.6f}, torque {torque:g} N m"

    for _ in range(ENLARGEMENTS):
        pairs = find(limit)
        if not pairs:
            limit *= 4.0
            continue
        loads = [float(torques[index]) for index in order]
        contacts = solve_torques(pairs, limit, loads, combine, displace, where)
        if contacts[0].rotation <= limit:
            break
        limit = MARGIN * contacts[0].rotation
    else:
        tried = f"candidates of {ENLARGEMENTS} turns up to {limit:.2e} rad"
        raise NotConverged("contact", where(max(torques)), tried)
    results = [_result(place, pairs, contacts[i]) for i in np.argsort(order)]
    return results, contacts[0].rotation


def _result(
    place: Place,
    pairs: list[Candidates],
    contact: Contact,
) -> LoadedPosition:
    base = place.base_radius
    share = np.zeros(len(PAIRS))
    spots, start = [], 0
    for pair in pairs:
        rows = slice(start, start + len(pair.hats))
        start = rows.stop
        force = contact.force[rows]
        share[np.searchsorted(PAIRS, pair.tooth)] = force @ pair.arm / contact.torque
        on = force > 0.0
        if on.any():
            spots.append(
                Spot(pair.tooth, pair.hats[on], force[on], force[on] / pair.area[on], pair.whole[on])
            )
    approach = base * contact.rotation
    return LoadedPosition(
        place.position,
        contact.torque,
        place.unloaded + approach,
        place.unloaded,
        contact.torque / base / approach,
        1.0 / (base**2 * contact.slope),
        share,
        contact.residual,
        contact.steps,
        len(contact.force),
        tuple(spots),
    )
