"""A sector of few teeth, several of them loaded, its cut faces free: the model that other solvers are given.

The chain instead puts each loaded tooth into the middle of a ring or sector of its own.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product as pairs_of
from math import pi

import numpy as np

from facegear.arrays import Array
from facegear.contact.bodies.layer import tied_system
from facegear.contact.bodies.ring import plane_compliance
from facegear.contact.bodies.substructure import condense
from facegear.contact.candidates import Candidates, product
from facegear.contact.flanks import FlankPair, flank_pair
from facegear.contact.gear_flank import BUILDERS
from facegear.contact.options import ContactOptions, Refinement
from facegear.contact.position import LoadedPosition, first_turn, solve_position
from facegear.contact.position_solver import PositionContact
from facegear.contact.search import find_candidates
from facegear.contact.teeth import LOADED_SIDE, contact_side, elastic_tooth
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.tooth_mesh import FeTooth
from facegear.teeth.unloaded_contact import unloaded_contact
from validation.contact.all_candidates import solve_candidates

Blocks = dict[tuple[int, int], Array]


@dataclass(frozen=True, eq=False)
class SectorPair:
    """Surfaces of both gears and the compliance blocks of their sectors."""

    flanks: FlankPair
    pinion: Blocks
    gear: Blocks

    def solve(self, position: float, torques: Sequence[float]) -> list[LoadedPosition]:
        """Solve contact at a position, unloaded transmission error left in.

        Parameters
        ----------
        position : float
            Position, fraction of a pitch.
        torques : Sequence[float]
            Torques on the pinion, N m.

        Returns
        -------
        list[LoadedPosition]
            Result at each torque.

        Raises
        ------
        NotConverged
            Naming position and torque.
        """
        pair = _SectorAtPosition(self, position)
        guess = first_turn(torques, pair.normal_arm, self.flanks.pinion.width)
        return solve_position(pair, torques, guess)[0]


@dataclass(frozen=True, eq=False)
class _SectorAtPosition:
    """`facegear.contact.position.PairAtPosition` of two sectors."""

    sectors: SectorPair
    position: float
    unloaded_error = 0.0

    @property
    def normal_arm(self) -> float:
        return self.sectors.flanks.design.normal_arm

    def contact(self, torques: Array, limit: float) -> PositionContact:
        sectors, flanks = self.sectors, self.sectors.flanks
        teeth = np.array(sorted({tooth for tooth, _ in sectors.pinion}))
        placement = angles_at(flanks.design, self.position)
        pairs = find_candidates(flanks, placement, teeth, limit, ContactOptions())

        def influence() -> Array:
            return _influence(pairs, sectors.pinion, sectors.gear)

        return solve_candidates(pairs, influence, torques, f"position {self.position:.6f}")


def angles_at(design: PairDesign, position: float) -> tuple[float, float]:
    """Return the angles of the unloaded pinion and gear at a position.

    Parameters
    ----------
    design : PairDesign
        The pair.
    position : float
        Position, fraction of a pitch.

    Returns
    -------
    float, float
        Angles, rad.
    """
    phi1 = (position - 0.5) * 2 * pi / design.pinion.teeth
    return phi1, float(unloaded_contact(design, [phi1]).phi2[0])


def sector_pair(
    design: PairDesign,
    sizes: MeshSizes,
    materials: tuple[Material, Material],
    teeth: int,
    loaded_teeth: Sequence[int],
    refinement: Refinement,
) -> SectorPair:
    """Build the sectors of both gears.

    Parameters
    ----------
    design : PairDesign
        The pair.
    sizes : MeshSizes
        Mesh sizes.
    materials : tuple[Material, Material]
        Materials of pinion and gear.
    teeth : int
        Number of teeth of each sector.
    loaded_teeth : Sequence[int]
        Numbers of the teeth that may carry load.
    refinement : Refinement
        Cuts of the flank layers.

    Returns
    -------
    SectorPair
        Surfaces and compliances.
    """
    bodies = [build(design, sizes) for build in BUILDERS.values()]
    pinion, gear = (
        sector_blocks(design, tooth, material, teeth, loaded_teeth, refinement)
        for tooth, material in zip(bodies, materials, strict=True)
    )
    first, second = (contact_side(design, tooth) for tooth in bodies)
    return SectorPair(flank_pair(design, (first, second), (refinement, refinement)), pinion, gear)


def sector_blocks(
    design: PairDesign,
    tooth: FeTooth,
    material: Material,
    teeth: int,
    loaded_teeth: Sequence[int],
    refinement: Refinement,
) -> Blocks:
    """Return the flank compliance for each pair of loaded teeth of a sector around tooth 0, cut faces free.

    Equal to that of the sector meshed whole, from one condensed tooth.

    Parameters
    ----------
    design : PairDesign
        The pair.
    tooth : FeTooth
        Mesh of a tooth.
    material : Material
        Its material.
    teeth : int
        Number of teeth of the sector.
    loaded_teeth : Sequence[int]
        Numbers of the loaded teeth.
    refinement : Refinement
        Cuts of the flank layer.

    Returns
    -------
    Blocks
        Compliance (n, n), m/N, by number of the displaced and of the loaded tooth.
    """
    elastic, _ = elastic_tooth(design, tooth, material, LOADED_SIDE[tooth.body])
    condensed_body = condense(tied_system(elastic, refinement))
    planes = plane_compliance(condensed_body.faces, teeth)
    influence, flank_compliance = condensed_body.influence, condensed_body.flank
    size = influence.shape[1]
    starts = {number: size // 2 * (number + teeth // 2) for number in loaded_teeth}
    faces = {number: slice(start, start + size) for number, start in starts.items()}
    return {
        (first, second): influence @ planes[faces[first], faces[second]] @ influence.T
        + (flank_compliance if first == second else 0.0)
        for first, second in pairs_of(loaded_teeth, repeat=2)
    }


def _influence(pairs: list[Candidates], pinion: Blocks, gear: Blocks) -> Array:
    """Approach (m, m) of all candidates by unit forces on each, m/N."""
    matrix = np.block(
        [
            [
                product(first.loads(0, True), pinion[first.tooth, second.tooth], second.loads(0, True))
                + product(first.loads(1, True), gear[first.tooth, second.tooth], second.loads(1, True))
                for second in pairs
            ]
            for first in pairs
        ]
    )
    return 0.5 * (matrix + matrix.T)
