"""Loaded tooth contact analysis: every position of a pitch at every torque."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from threadpoolctl import threadpool_limits

from facegear.arrays import Array
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.candidates import Candidates
from facegear.contact.flanks import FlankPair
from facegear.contact.influence import displacement, influence_matrix
from facegear.contact.options import ContactOptions
from facegear.contact.path import pairs_to_try
from facegear.contact.position import FIRST_GUESS, LoadedPosition, solve_position
from facegear.contact.search import find_all
from facegear.geometry.design import AssemblyErrors, PairDesign
from facegear.geometry.placement import pinion_angle
from facegear.geometry.unloaded import unloaded_motion
from facegear.progress import Progress

AT_ONCE = 8
"""Positions whose candidates are searched together."""
ROOM = 1.12
"""By how much farther they are searched than the position before needed."""


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
) -> list[LoadedPosition]:
    """Solve all torques (N m) at all positions (0..1 of a pitch, 0.5 where phi1 = 0), position by position.

    One thread works on it: the matrices of a position are small, and threads of BLAS that wait for one
    another take several times the work. Raises NotConverged naming the position and the torque.
    """
    options = options or ContactOptions()
    phi1 = pinion_angle(model.design, positions)
    phi2, unloaded = unloaded_motion(model.design, phi1)
    guess = first = FIRST_GUESS / model.design.pinion_base_radius
    progress = Progress("loaded contact", len(phi1))
    searched = _Searched(model, options, list(zip(phi1.tolist(), phi2.tolist(), strict=True)))
    results: list[LoadedPosition] = []
    with threadpool_limits(1):
        for row, position in enumerate(positions):
            pair = _PairAtPosition(searched, row, position=float(position), unloaded=-float(unloaded[row]))
            solved, turned = solve_position(pair, torques, guess)
            guess = turned if turned > 0.0 else first  # fillets in the way turn the pinion back
            results += solved
            progress.step()
    return results


@dataclass(eq=False)
class _Searched:
    """What may touch at all positions, searched several at once: `ahead` by row, for a turn `limit` (rad)."""

    model: ContactModel
    options: ContactOptions
    placements: list[tuple[float, float]]
    ahead: dict[int, list[Candidates]] = field(default_factory=dict)
    limit: float = 0.0

    def at(self, row: int, limit: float) -> list[Candidates]:
        """Candidates of a position that a turn by `limit` (rad) would close, and perhaps a little more."""
        if row not in self.ahead or limit > self.limit:
            last = row + (AT_ONCE if row else 1)  # the first position says how far teeth give way
            some, self.limit = self.placements[row:last], ROOM * limit
            teeth = [pairs_to_try(self.model.design, phi1, self.options) for phi1, _ in some]
            seen = find_all(self.model.flanks, some, teeth, self.limit, self.options)
            self.ahead = dict(enumerate(seen, row))
        return self.ahead[row]


@dataclass(frozen=True, eq=False)
class _PairAtPosition:
    """`facegear.contact.position.PairAtPosition` of whole gears, at a row of what was searched."""

    searched: _Searched
    row: int
    position: float
    unloaded: float
    in_strip = True

    @property
    def model(self) -> ContactModel:
        return self.searched.model

    @property
    def options(self) -> ContactOptions:
        return self.searched.options

    @property
    def base_radius(self) -> float:
        return self.model.design.pinion_base_radius

    def candidates(self, limit: float) -> list[Candidates]:
        return self.searched.at(self.row, limit)

    def influence(self, pairs: list[Candidates]) -> Array:
        return influence_matrix(pairs, self.model.pinion, self.model.gear, self.options.coupled)

    def approach(self, seen: list[Candidates], pairs: list[Candidates], forces: Array) -> Array:
        return displacement(
            seen, pairs, forces, self.model.pinion, self.model.gear, coupled=self.options.coupled
        )
