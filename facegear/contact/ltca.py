"""Loaded tooth contact analysis: every position of a pitch at every torque."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact.basis_functions import FacingPairs
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.flanks import FlankPair
from facegear.contact.known_contact import KnownContact
from facegear.contact.options import ContactOptions
from facegear.contact.path import pairs_to_try
from facegear.contact.position import MARGIN, LoadedPosition, contact_at, first_turn, results_of
from facegear.contact.position_solver import PositionContact, PositionSolver
from facegear.contact.search import cover_of, facing_points
from facegear.contact.search_strip import (
    GAP,
    KNOWN_WIDTH,
    START_GAP,
    START_WIDTH,
    WIDER,
    WIDTH,
    SearchStrip,
)
from facegear.geometry.design import AssemblyErrors, PairDesign
from facegear.geometry.placement import pinion_angle
from facegear.geometry.unloaded import PAIRS, unloaded_motion
from facegear.progress import Progress

AT_ONCE = 8
"""Positions whose candidates are searched together."""
ROOM = 1.12
"""By how much farther they are searched than the position before needed."""
KNOWN_MARGIN, KNOWN_ROOM = 1.02, 1.01
"""In place of MARGIN and ROOM where it is known how the contact of a pair that differs little goes on from
position to position."""


@dataclass(frozen=True, eq=False)
class ContactModel:
    """A pair ready for contact: exact surfaces and the compliance of both gears."""

    flanks: FlankPair
    pinion: FlankCompliance
    gear: FlankCompliance

    @property
    def design(self) -> PairDesign:
        return self.flanks.design

    def assembled(self, errors: AssemblyErrors) -> "ContactModel":
        """The same bodies in another assembly, which moves no node of theirs."""
        return self.of(replace(self.design, assembly=errors))

    def of(self, design: PairDesign) -> "ContactModel":
        """The same bodies of a design that differs in what moves no node of theirs."""
        pinion, gear = self.flanks.pinion, self.flanks.gear
        flanks = FlankPair(replace(pinion, design=design), replace(gear, design=design))
        return replace(self, flanks=flanks)


def even_positions(count: int) -> list[float]:
    """Positions 0, 1/n, 2/n ... of a pitch."""
    return [i / count for i in range(count)]


def loaded_contact(
    model: ContactModel,
    positions: Sequence[float],
    torques: Sequence[float],
    options: ContactOptions | None = None,
    known: KnownContact | None = None,
) -> list[LoadedPosition]:
    """Solve all torques (N m) at all positions (0..1 of a pitch, 0.5 where phi1 = 0), position by position.

    `known`: the contact of a pair that differs little, at the same positions and torques.
    Raises NotConverged naming the position and the torque.
    """
    options = options or ContactOptions()
    design, face = model.design, model.design.face_gear
    phi1 = pinion_angle(design, positions)
    phi2, unloaded = unloaded_motion(design, phi1)
    first = first_turn(torques, design.pinion_base_radius, face.outer_radius - face.inner_radius)
    progress = Progress("loaded contact", len(phi1))
    placements = list(zip(phi1.tolist(), phi2.tolist(), strict=True))
    searched = _Searched(model, options, placements, known)
    pairs = [
        _PairAtPosition(searched, row, position=float(position), unloaded=-float(unloaded[row]))
        for row, position in enumerate(positions)
    ]
    contacts, turned = [], 0.0
    for row, pair in enumerate(pairs):
        turn = turned if turned > 0.0 else first  # fillets in the way turn the pinion back
        if known is not None:
            turn = known.turn[row] * (turned / known.turn[row - 1] if turned > 0.0 else 1.0)
        contacts.append(contact_at(pair, torques, searched.margin(row) * turn))
        turned = float(contacts[-1].rotation[0])
        progress.step()
    # all at once: each finds what Python needs in the processor's cache, where a solution has cleared it
    solved = [results_of(*each, torques) for each in zip(pairs, contacts, strict=True)]
    return [result for of_position in solved for result in of_position]


@dataclass(eq=False)
class _Searched:
    """What may touch at all positions, searched several at once: `ahead` by row, for a turn `limit` (rad)."""

    model: ContactModel
    options: ContactOptions
    placements: list[tuple[float, float]]
    known: KnownContact | None
    ahead: dict[int, FacingPairs] = field(default_factory=dict)
    limit: float = 0.0

    def at(self, row: int, limit: float) -> FacingPairs:
        """Points of a position that a turn by `limit` (rad) would close, and perhaps a few more."""
        if row not in self.ahead or limit > self.limit:
            last = row + (AT_ONCE if row else 1)  # the first position says how far teeth give way
            some, self.limit = self.placements[row:last], self._room(row, last) * limit
            teeth = [pairs_to_try(self.model.design, phi1, self.options) for phi1, _ in some]
            seen = facing_points(self.model.flanks, some, teeth, self.limit, self.options)
            self.ahead = dict(enumerate(seen, row))
        return self.ahead[row]

    def _room(self, row: int, last: int) -> float:
        """By how much farther positions up to `last` are searched than the one in a row needs."""
        if self.known is None:
            return ROOM
        return KNOWN_ROOM * float(self.known.turn[row:last].max() / self.known.turn[row])

    def margin(self, row: int) -> float:
        """By how much farther contact is sought than a position is expected to turn: less where it is known
        how another contact went on from the position before.
        """
        return KNOWN_MARGIN if row and self.known is not None else MARGIN

    def strip(self, row: int, teeth: Integers) -> SearchStrip:
        """In which contact of the pairs `teeth` (p,) is sought at first."""
        margin, width, near = self.margin(row), WIDTH, np.zeros((0, 0), bool)
        if self.known is not None:
            width, near = KNOWN_WIDTH, self.known.near[row, np.searchsorted(PAIRS, teeth)]
        return SearchStrip(GAP * MARGIN / margin, width, WIDER, START_GAP / margin, START_WIDTH, near)

    @cached_property
    def solver(self) -> PositionSolver:
        """The solver of the pair's positions, with memory that serves all of them."""
        model = self.model
        lattices = model.flanks.pinion.lattice, model.flanks.gear.lattice
        cover = cover_of(model.flanks, self.options)
        return PositionSolver(cover, lattices, (model.pinion, model.gear), self.options.coupled)


@dataclass(frozen=True, eq=False)
class _PairAtPosition:
    """`facegear.contact.position.PairAtPosition` of whole gears, at a row of what was searched."""

    searched: _Searched
    row: int
    position: float
    unloaded: float

    @property
    def base_radius(self) -> float:
        return self.searched.model.design.pinion_base_radius

    def contact(self, torques: Array, limit: float) -> PositionContact:
        """Solve for the contact of what a rotation of the pinion by `limit` (rad) would close."""
        facing_pairs = self.searched.at(self.row, limit)
        strip = self.searched.strip(self.row, facing_pairs.teeth)
        return self.searched.solver.solve(facing_pairs, torques, limit, strip)
