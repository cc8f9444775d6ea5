"""The plane-strain twin: two spur gears through the same bodies, influence matrix and contact solver.

The pinion is as in `facegear.geometry.design`, its axis the y axis; the gear is a second pinion body turned
by half a turn below it, so that both touch with their right sides. Involute flanks only; at any centre
distance the gear is turned until its backlash is closed on that side.
"""

from dataclasses import dataclass, replace
from math import acos, pi

import numpy as np

from facegear.arrays import Array
from facegear.contact.bodies.compliance import FlankCompliance, flank_compliance
from facegear.contact.candidates import Candidates, candidates_of
from facegear.contact.flanks import PinionSurface
from facegear.contact.influence import influence_matrix
from facegear.contact.lattice import Lattice
from facegear.contact.loads import flank_cover, flank_points
from facegear.contact.options import Ends, Refinement
from facegear.contact.position import LoadedPosition, first_turn, solve_position
from facegear.contact.position_solver import PositionContact
from facegear.contact.teeth import ContactSide, elastic_tooth
from facegear.geometry import pinion
from facegear.geometry.design import Material, PairDesign, involute
from facegear.geometry.placement import body_rotation
from facegear.geometry.unloaded import PAIRS
from facegear.mesh.sizes import MeshSizes
from facegear.mesh.tooth import FeTooth, pinion_tooth
from validation.contact.all_candidates import solve_candidates


@dataclass(frozen=True, eq=False)
class TwinModel:
    """Both gears (their own `pinion` counts), the pinion's surface and both compliances of one slab.

    `centre` distance in m. The blocks of the gear's compliance are ordered as the pinion's teeth are.
    """

    pinion: PairDesign
    gear: PairDesign
    centre: float
    surface: PinionSurface
    gear_side: ContactSide
    pinion_compliance: FlankCompliance
    gear_compliance: FlankCompliance


def twin_model(
    pinion_design: PairDesign,
    gear_design: PairDesign,
    sizes: tuple[MeshSizes, MeshSizes],
    refinement: Refinement,
    materials: tuple[Material, Material],
    teeth: int | None = None,
    ends: Ends = "ring",
    centre: float | None = None,
) -> TwinModel:
    """Slabs of both gears in plane strain, their whole rings or a sector of `teeth`.

    `centre` distance in m, None for that of standard gears.
    """
    sides, compliances = [], []
    layer = replace(refinement, width=1)
    for design, size, material in zip((pinion_design, gear_design), sizes, materials, strict=True):
        tooth = slab_tooth(design, size)
        elastic, side = elastic_tooth(design, tooth, material, "right")
        held = elastic.is_held.copy()
        held[:, 1] = True
        number = teeth or design.pinion.teeth
        compliances.append(flank_compliance(replace(elastic, is_held=held), layer, number, 2, ends))
        sides.append(side)
    gear = replace(compliances[1], neighbour_blocks=compliances[1].neighbour_blocks[::-1])
    return TwinModel(
        pinion=pinion_design,
        gear=gear_design,
        centre=centre or standard_centre(pinion_design, gear_design),
        surface=PinionSurface(
            pinion_design, sides[0], Lattice(sides[0].shape, layer, flank_rows=sides[0].flank_rows)
        ),
        gear_side=sides[1],
        pinion_compliance=compliances[0],
        gear_compliance=gear,
    )


def slab_tooth(design: PairDesign, sizes: MeshSizes) -> FeTooth:
    """First layer of elements of a spur tooth along its axis."""
    tooth = pinion_tooth(design, sizes)
    planes = tooth.surfaces["flank_right"].nodes.shape[1]
    layers, count = (planes - 1) // 2, len(tooth.nodes) // planes
    surfaces = {
        name: replace(grid, nodes=grid.nodes[:, :3], u=grid.u[:, :3], v=grid.v[:, :3])
        for name, grid in tooth.surfaces.items()
    }
    return replace(
        tooth,
        nodes=tooth.nodes[: 3 * count],
        hexes=tooth.hexes[: len(tooth.hexes) // layers],
        faces={name: face[(face < 3 * count).all(axis=1)] for name, face in tooth.faces.items()},
        surfaces=surfaces,
        cut_left=tooth.cut_left.reshape(-1, planes)[:, :3].ravel(),
        cut_right=tooth.cut_right.reshape(-1, planes)[:, :3].ravel(),
    )


def analyse_twin(model: TwinModel, positions: Array, line_loads: list[float]) -> list[LoadedPosition]:
    """Solve all positions (0..1 of a pitch) at all loads (N/m along the line of action).

    The torques in the results are those of the slab. Raises NotConverged naming position and torque.
    """
    thickness = float(np.ptp(model.surface.side.v))
    base = model.pinion.pinion_base_radius
    torques = [load * thickness * base for load in line_loads]
    guess, results = first_turn(torques, base, thickness), []
    for position in positions:
        solved, guess = solve_position(_TwinAtPosition(model, float(position)), torques, guess)
        results += solved
    return results


@dataclass(frozen=True, eq=False)
class _TwinAtPosition:
    """`facegear.contact.position.PairAtPosition` of the twin."""

    model: TwinModel
    position: float
    unloaded_error = 0.0

    @property
    def base_radius(self) -> float:
        return self.model.pinion.pinion_base_radius

    def contact(self, torques: Array, limit: float) -> PositionContact:
        model = self.model
        phi1 = (self.position - 0.5) * 2 * pi / model.pinion.pinion.teeth
        pairs = _candidates(model, phi1, limit)

        def influence() -> Array:
            return influence_matrix(pairs, model.pinion_compliance, model.gear_compliance)

        return solve_candidates(pairs, influence, torques, f"position {self.position:.6f}")


def involute_separation(
    model_pinion: PairDesign,
    model_gear: PairDesign,
    points: Array,
    normals: Array,
    phi1: float,
    tooth: int,
    centre: float,
) -> tuple[Array, Array]:
    """Gap (n,) m along the normals of pinion points (n, 3), and the gear's roll there (nan: no flank)."""
    teeth, other = model_pinion.pinion.teeth, model_gear.pinion.teeth
    turn = phi1 + (tooth - 0.5) * 2 * pi / teeth
    back = phi1 * teeth / other + tooth * 2 * pi / other - _rotary_backlash(model_pinion, model_gear, centre)
    start, along = turned(points[:, [0, 2]], turn), turned(normals[:, [0, 2]], turn)
    start, along = (turned(-vector, back) for vector in (start + np.array([0.0, centre]), along))
    low, high = pinion.junction_roll(model_gear), model_gear.pinion_tip_roll
    roll, distance = np.full(len(points), 0.5 * (low + high)), np.zeros(len(points))
    base = model_gear.pinion_base_radius
    for _ in range(50):
        radius, angle = pinion.involute_point(model_gear, roll)
        surface = np.stack([radius * np.sin(angle), -radius * np.cos(angle)], axis=1)
        nx, nz = pinion.involute_normal(model_gear, roll)
        tangent = base * roll[:, None] * np.stack([nz, -nx], axis=1)
        miss = start + distance[:, None] * along - surface
        determinant = tangent[:, 0] * along[:, 1] - tangent[:, 1] * along[:, 0]
        step = (miss[:, 0] * along[:, 1] - miss[:, 1] * along[:, 0]) / determinant
        move = (miss[:, 0] * tangent[:, 1] - miss[:, 1] * tangent[:, 0]) / determinant
        step = np.clip(step, -0.1, 0.1)
        roll, distance = np.clip(roll + step, 0.02, high + 0.2), distance + move
        if np.abs(step).max() < 1e-14:
            break
    facing = np.sum(along * np.stack([nx, nz], axis=1), axis=1) < -0.5
    on = facing & (roll >= low) & (roll <= high) & (np.abs(step) < 1e-11) & (np.abs(distance) < 1e-3)
    return np.where(on, distance, np.inf), np.where(on, roll, np.nan)


def standard_centre(first: PairDesign, second: PairDesign) -> float:
    """Centre distance (m) of gears without profile shift."""
    return first.pinion_pitch_radius + second.pinion_pitch_radius


def _rotary_backlash(first: PairDesign, second: PairDesign, centre: float) -> float:
    """Turn (rad) of the second gear that closes the gap between the flanks of centred teeth and spaces."""
    base, other = first.pinion_base_radius, second.pinion_base_radius
    lost = involute(acos((base + other) / centre))
    space = pi / first.pinion.teeth - first.pinion_half_base_angle + lost
    return (base * space - other * (second.pinion_half_base_angle - lost)) / other


def turned(vectors: Array, angle: float) -> Array:
    """x and z of vectors (n, 2) turned as the pinion turns."""
    return vectors @ body_rotation("pinion", angle)[np.ix_([0, 2], [0, 2])].T


def _candidates(model: TwinModel, phi1: float, limit: float) -> list[Candidates]:
    surface, side = model.surface, model.gear_side
    lattice = Lattice(side.shape, surface.lattice.refinement, flank_rows=side.flank_rows)
    on_flank = ~surface.lattice.in_fillet(surface.at)
    low, high = pinion.junction_roll(model.gear), model.gear.pinion_tip_roll
    depth = 3 * limit * model.pinion.pinion_base_radius + 20e-6
    candidates = []
    for tooth in PAIRS.tolist():
        gap, roll = involute_separation(
            *(model.pinion, model.gear, surface.points.position, surface.points.normal),
            *(phi1, tooth, model.centre),
        )
        fraction = (high**2 - roll**2) / (high**2 - low**2)
        row = fraction * (side.flank_rows - 1) * lattice.refinement.profile
        near = np.where(on_flank & (gap < depth), gap, np.inf)
        opposite = np.stack([row, surface.at[:, 1]], axis=1)
        points = flank_points(surface, np.arange(len(near)), near, surface.lever_arm, opposite)
        candidates += candidates_of(surface.lattice, lattice, tooth, points, flank_cover(surface), limit)
    return candidates
