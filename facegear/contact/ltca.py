"""Loaded tooth contact analysis: every position of a pitch at every torque."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from facegear.contact.candidates import Candidates, PinionSurface, find_candidates
from facegear.contact.compliance import FlankCompliance
from facegear.contact.influence import influence_matrix
from facegear.contact.options import ContactOptions
from facegear.contact.solver import Contact, solve
from facegear.contact.teeth import GearLattice
from facegear.errors import NotConverged
from facegear.geometry.design import PairDesign
from facegear.geometry.unloaded import PAIRS, unloaded_contact
from facegear.progress import Progress

FIRST_GUESS = 40e-6
"""Approach (m) that the candidates of the first solution must cover; later ones follow the solutions."""

MARGIN = 1.15


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
        solved, guess = _position(model, float(position), angles, error, torques, guess, options)
        results += solved
        progress.step()
    return results


def _position(
    model: ContactModel,
    position: float,
    angles: tuple[float, float],
    unloaded: float,
    torques: Sequence[float],
    guess: float,
    options: ContactOptions,
) -> tuple[list[LoadedPosition], float]:
    """All torques of a position, the largest first; returns also the largest turn (rad)."""
    limit = MARGIN * guess
    order = np.argsort(torques)[::-1]
    for _ in range(12):
        pairs = find_candidates(model.surface, model.lattice, *angles, PAIRS, limit, options.fillet)
        if pairs:
            matrix = influence_matrix(pairs, model.pinion, model.gear, options.coupled)
            gap, arm = (np.concatenate([getattr(pair, name) for pair in pairs]) for name in ("gap", "arm"))
            where = f"position {position:.6f}, torque {max(torques):g} N m"
            largest = solve(matrix, gap, arm, float(torques[order[0]]), where=where)
            if largest.rotation <= limit:
                break
            limit = MARGIN * largest.rotation
        else:
            limit *= 4.0
    else:
        where = f"position {position:.6f}, torque {max(torques):g} N m"
        raise NotConverged("contact", where, f"candidates up to a turn of {limit:.2e} rad")
    results: dict[int, LoadedPosition] = {}
    last = largest
    for index in order:
        torque = float(torques[index])
        if index != order[0]:
            keep = gap < last.rotation * arm
            where = f"position {position:.6f}, torque {torque:g} N m"
            inner = solve(matrix[np.ix_(keep, keep)], gap[keep], arm[keep], torque, last.active[keep], where)
            force = np.zeros_like(gap)
            force[keep] = inner.force
            last = Contact(force, inner.rotation, inner.slope, inner.residual, inner.steps)
        results[int(index)] = _result(model, position, torque, unloaded, pairs, arm, last)
    return [results[index] for index in range(len(torques))], largest.rotation


def _result(
    model: ContactModel,
    position: float,
    torque: float,
    unloaded: float,
    pairs: list[Candidates],
    arm: NDArray[np.float64],
    contact: Contact,
) -> LoadedPosition:
    base = model.design.pinion_base_radius
    share = np.zeros(len(PAIRS))
    spots, start = [], 0
    for pair in pairs:
        rows = slice(start, start + len(pair.hats))
        start = rows.stop
        force = contact.force[rows]
        share[np.searchsorted(PAIRS, pair.tooth)] = force @ arm[rows] / torque
        on = force > 0.0
        if on.any():
            spots.append(
                Spot(pair.tooth, pair.hats[on], force[on], force[on] / pair.area[on], pair.whole[on])
            )
    approach = base * contact.rotation
    return LoadedPosition(
        position,
        torque,
        unloaded + approach,
        unloaded,
        torque / base / approach,
        1.0 / (base**2 * contact.slope),
        share,
        contact.residual,
        contact.steps,
        len(arm),
        tuple(spots),
    )
