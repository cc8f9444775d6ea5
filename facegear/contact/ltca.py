"""Loaded tooth contact analysis: every position of a pitch at every torque."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.basis_functions import FacingPairs
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.flanks import FlankPair
from facegear.contact.options import ContactOptions
from facegear.contact.position import MARGIN, LoadedPosition, contact_at, first_turn, results_of
from facegear.contact.position_solver import (
    GAP,
    KNOWN_WIDTH,
    START_GAP,
    START_WIDTH,
    WIDER,
    WIDTH,
    PositionContact,
    PositionSolver,
    SearchStrip,
)
from facegear.contact.search import cover_of, facing_points
from facegear.errors import InvalidInput
from facegear.progress import Progress
from facegear.teeth.closest import PAIRS
from facegear.teeth.design import AssemblyErrors, PairDesign
from facegear.teeth.pinion import junction_roll, tip_roll
from facegear.teeth.placement import pinion_angle
from facegear.teeth.unloaded_contact import unloaded_contact, unloaded_motion


@dataclass(frozen=True, eq=False)
class KnownContact:
    """Contact solved at p positions: largest rotation `turn` (p,) rad of the pinion under any load, and
    loaded nodes.

    `near` (p, 5, nodes) marks the nodes of the pinion's refined lattice, for the pairs -2..2, that carry
    load under any torque or are next to one that does across the profile.
    """

    turn: Array
    near: Mask


def known_contact(
    results: Sequence[LoadedPosition], positions: Sequence[float], shape: tuple[int, int], normal_arm: float
) -> KnownContact | None:
    """Extract the rotation and the loaded nodes from results of a pair, to speed up a pair that differs
    little.

    Parameters
    ----------
    results : Sequence[LoadedPosition]
        Contact by position and torque.
    positions : Sequence[float]
        All positions, in pitches.
    shape : tuple[int, int]
        Refined lattice of the pinion.
    normal_arm : float
        Torque on the pinion over the force along its flank's normal, m.

    Returns
    -------
    KnownContact, optional
        Known contact; None where fillets in the way turn the pinion back.
    """
    row_of = {position: row for row, position in enumerate(positions)}
    turn, is_loaded = np.zeros(len(positions)), np.zeros((len(positions), PAIRS.size, *shape), bool)
    for result in results:
        row = row_of[result.position]
        turn[row] = max(turn[row], (result.ste - result.unloaded_error) / normal_arm)
        for spot in result.spots:
            is_loaded[row, np.searchsorted(PAIRS, spot.tooth)].flat[spot.hats] = True
    if turn.min() <= 0.0:
        return None
    near = is_loaded.copy()
    near[:, :, 1:] |= is_loaded[:, :, :-1]
    near[:, :, :-1] |= is_loaded[:, :, 1:]
    return KnownContact(turn, near.reshape(len(positions), PAIRS.size, -1))


TOUCHING_GAP = 1e-9
"""Gap (m) of conjugate flanks below which they count as touching; off the path it grows by micrometres."""


def check_overlap(design: PairDesign) -> None:
    """Refuse a pair of which other pairs of teeth than PAIRS may touch while they pass through the mesh.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.

    Raises
    ------
    InvalidInput
        Where a tooth stays in mesh for too long a turn before or after the middle of its passage.
    """
    flank, half = design.family.pinion_flanks[0], design.pinion.width / 2
    y = design.middle + np.array([-half, half])
    rolls = np.stack([np.broadcast_to(ends(design, y), y.shape) for ends in (junction_roll, tip_roll)])
    # turn at which a place of the flank has the normal of the pitch line
    turns = rolls + flank.lead / flank.base_radius * (y - flank.middle) - flank.pressure_angle - flank.phase
    pitches = float(np.abs(turns).max()) * design.pinion.teeth / (2 * np.pi)
    if pitches > PAIRS[-1] + 0.5:
        raise InvalidInput(
            "overlap of the teeth",
            f"a tooth in mesh up to {pitches:.3g} pitches from its middle",
            f"at most {PAIRS[-1] + 0.5:g}: a smaller helix angle or a narrower pinion is needed",
        )


def pairs_to_try(design: PairDesign, phi1: float, options: ContactOptions) -> Integers:
    """Return the tooth pairs that may carry load at a pinion angle.

    They are all of -2..2, or with `path_only` those whose unloaded gap in the nominal assembly is below
    TOUCHING_GAP: between the tips of pinion and gear at the radius m N2 / 2, m the module and N2 the
    gear's teeth.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    phi1 : float
        Angle of the pinion, rad.
    options : ContactOptions
        Whether only pairs on the path count.

    Returns
    -------
    (p,) array of int
        Numbers of the pairs.
    """
    if not options.path_only:
        return PAIRS
    gaps = unloaded_contact(replace(design, assembly=AssemblyErrors()), [phi1]).gap[0]
    return PAIRS[gaps < TOUCHING_GAP]


AT_ONCE = 8
"""Positions whose candidates are searched together."""
SEARCH_MARGIN = 1.12
"""Factor by which candidates are searched farther than the position before needed."""
KNOWN_MARGIN, KNOWN_SEARCH_MARGIN = 1.02, 1.01
"""Values in place of MARGIN and SEARCH_MARGIN where the contact of a pair that differs little shows how the
rotation changes from position to position."""


@dataclass(frozen=True, eq=False)
class ContactModel:
    """A pair ready for contact: exact surfaces and the compliance of both gears."""

    flanks: FlankPair
    pinion: FlankCompliance
    gear: FlankCompliance

    @property
    def design(self) -> PairDesign:
        """Design of the pair of gears."""
        return self.flanks.design

    def with_assembly(self, errors: AssemblyErrors) -> "ContactModel":
        """Return the same bodies in another assembly, which moves no node of theirs.

        Parameters
        ----------
        errors : AssemblyErrors
            Errors of the assembly.

        Returns
        -------
        ContactModel
            Same compliances, other positions of the gears.
        """
        return self.of(replace(self.design, assembly=errors))

    def of(self, design: PairDesign) -> "ContactModel":
        """Return the same bodies for a design that differs only in properties that move no node of
        theirs.

        Such are assembly errors and deviations of the flanks.

        Parameters
        ----------
        design : PairDesign
            Design with the same nodes.

        Returns
        -------
        ContactModel
            Same compliances, other surfaces.
        """
        pinion, gear = self.flanks.pinion, self.flanks.gear
        flanks = FlankPair(replace(pinion, design=design), replace(gear, design=design))
        return replace(self, flanks=flanks)


def even_positions(count: int) -> list[float]:
    """Return evenly spaced positions 0, 1/n, 2/n ... of a pitch.

    Parameters
    ----------
    count : int
        Number n of positions.

    Returns
    -------
    list[float]
        Positions, in pitches.
    """
    return [i / count for i in range(count)]


def loaded_contact(
    model: ContactModel,
    positions: Sequence[float],
    torques: Sequence[float],
    options: ContactOptions | None = None,
    known_contact: KnownContact | None = None,
) -> list[LoadedPosition]:
    """Solve for the contact at all positions and torques, position by position.

    A `known_contact` changes how far contact is searched first, not the results beyond rounding.

    Parameters
    ----------
    model : ContactModel
        Exact surfaces and compliances of the pair.
    positions : Sequence[float]
        In pitches, 0 to 1; 0.5 where phi1 = 0.
    torques : Sequence[float]
        On the pinion, N m, above 0, in any order.
    options : ContactOptions, optional
        Surfaces and couplings that take part; the default options if None.
    known_contact : KnownContact, optional
        Contact of a pair that differs little, at the same positions and torques.

    Returns
    -------
    list[LoadedPosition]
        Result at each position and torque, in SI units (N, m, rad); all torques of the first position in
        their order, then those of the next.

    Raises
    ------
    NotConverged
        Names the position and the torque.
    InvalidInput
        As `check_overlap` does.
    """
    options = options or ContactOptions()
    design, face = model.design, model.design.face_gear
    check_overlap(design)
    phi1 = pinion_angle(design, positions)
    phi2, unloaded_error = unloaded_motion(design, phi1)
    first = first_turn(torques, design.normal_arm, face.outer_radius - face.inner_radius)
    progress = Progress("loaded contact", len(phi1))
    placements = list(zip(phi1.tolist(), phi2.tolist(), strict=True))
    position_search = _PositionSearch(model, options, placements, known_contact)
    pairs = [
        _PairAtPosition(
            position_search, row, position=float(position), unloaded_error=-float(unloaded_error[row])
        )
        for row, position in enumerate(positions)
    ]
    contacts, last_turn = [], 0.0
    for row, pair in enumerate(pairs):
        turn = last_turn if last_turn > 0.0 else first  # fillets in the way turn the pinion back
        if known_contact is not None:
            turn = known_contact.turn[row] * (
                last_turn / known_contact.turn[row - 1] if last_turn > 0.0 else 1.0
            )
        contacts.append(contact_at(pair, torques, position_search.margin(row) * turn))
        last_turn = float(contacts[-1].rotation[0])
        progress.step()
    # all at once: each finds what Python needs in the processor's cache, where a solution has cleared it
    position_results = [
        results_of(*pair_and_contact, torques) for pair_and_contact in zip(pairs, contacts, strict=True)
    ]
    return [result for of_position in position_results for result in of_position]


@dataclass(eq=False)
class _PositionSearch:
    """Points of the teeth that face each other at all positions, found for several positions at once.

    `placements`: unloaded angles phi1, phi2 (rad) of each position; a row is an index of them. `ahead`:
    points by row, found for a rotation `limit` (rad) of the pinion and kept until a row beyond them or a
    larger limit is asked for.
    """

    model: ContactModel
    options: ContactOptions
    placements: list[tuple[float, float]]
    known_contact: KnownContact | None
    ahead: dict[int, FacingPairs] = field(default_factory=dict)
    limit: float = 0.0

    def at(self, row: int, limit: float) -> FacingPairs:
        """Return the points of position `row` that a rotation of the pinion by `limit` (rad) would close.

        A few more may be among them. Points of the next AT_ONCE positions are computed together and kept.
        """
        if row not in self.ahead or limit > self.limit:
            last = row + (AT_ONCE if row else 1)  # the first position says how far teeth give way
            placements, self.limit = self.placements[row:last], self._search_margin(row, last) * limit
            teeth = [pairs_to_try(self.model.design, phi1, self.options) for phi1, _ in placements]
            facing_pairs = facing_points(self.model.flanks, placements, teeth, self.limit, self.options)
            self.ahead = dict(enumerate(facing_pairs, row))
        return self.ahead[row]

    def _search_margin(self, row: int, last: int) -> float:
        """Return the factor on `limit` with which the points of positions `row` to `last` - 1 are found
        together.

        It is SEARCH_MARGIN; with `known_contact` it is KNOWN_SEARCH_MARGIN times the largest known
        rotation of these positions over that of `row`.
        """
        if self.known_contact is None:
            return SEARCH_MARGIN
        return KNOWN_SEARCH_MARGIN * float(
            self.known_contact.turn[row:last].max() / self.known_contact.turn[row]
        )

    def margin(self, row: int) -> float:
        """Return the factor on the expected rotation up to which contact is searched at position `row`.

        It is MARGIN, or the smaller KNOWN_MARGIN from the second position on where `known_contact`, that
        of a pair that differs little, shows how the rotation changes from position to position.
        """
        return KNOWN_MARGIN if row and self.known_contact is not None else MARGIN

    def strip(self, row: int, teeth: Integers) -> SearchStrip:
        """Return the strip in which contact of the pairs `teeth` (p,) is searched first."""
        margin, width, near = self.margin(row), WIDTH, np.zeros((0, 0), bool)
        if self.known_contact is not None:
            width, near = KNOWN_WIDTH, self.known_contact.near[row, np.searchsorted(PAIRS, teeth)]
        # The kernel counts in parts of the limit, which a smaller margin makes smaller: the factor keeps the
        # same rotation.
        return SearchStrip(GAP * MARGIN / margin, width, WIDER, START_GAP / margin, START_WIDTH, near)

    @cached_property
    def solver(self) -> PositionSolver:
        """Solver of the contact of this pair at any position; all positions use its work arrays, and no
        position's solution starts from another's.
        """
        model = self.model
        lattices = model.flanks.pinion.lattice, model.flanks.gear.lattice
        cover = cover_of(model.flanks, self.options)
        return PositionSolver(cover, lattices, (model.pinion, model.gear), self.options.is_coupled)


@dataclass(frozen=True, eq=False)
class _PairAtPosition:
    """Both whole gears at one position, as `facegear.contact.position.contact_at` takes them.

    `row` is the position's index in the search, `position` in pitches, `unloaded_error` (m) positive
    where the pinion is ahead.
    """

    position_search: _PositionSearch
    row: int
    position: float
    unloaded_error: float

    @property
    def normal_arm(self) -> float:
        """Torque on the pinion over the force along its flank's normal, m."""
        return self.position_search.model.design.normal_arm

    def contact(self, torques: Array, limit: float) -> PositionContact:
        """Solve for the contact under `torques` (t,) N m, the largest first, of all that a rotation by
        `limit` closes.

        `limit` (rad) is a rotation of the pinion from the unloaded position.
        """
        facing_pairs = self.position_search.at(self.row, limit)
        strip = self.position_search.strip(self.row, facing_pairs.teeth)
        return self.position_search.solver.solve(facing_pairs, torques, limit, strip)
