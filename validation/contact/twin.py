"""Plane-strain twin: two spur gears through the same bodies, influence matrix and contact solver.

The pinion is as in `facegear.teeth.design`, its axis the y axis; the gear is a second pinion body rotated
by half a turn below it, so that both touch with their right sides. Involute flanks only; at any centre
distance the gear is rotated until its backlash is closed on that side.
"""

from dataclasses import dataclass, replace
from math import acos, pi

import numpy as np

from facegear.arrays import Array
from facegear.contact.basis_functions import Lattice
from facegear.contact.bodies.compliance import FlankCompliance, flank_compliance
from facegear.contact.candidates import Candidates, candidates_of, flank_cover, flank_points, influence_matrix
from facegear.contact.flanks import PinionSurface
from facegear.contact.options import Ends, Refinement
from facegear.contact.position import LoadedPosition, first_turn, solve_position
from facegear.contact.position_solver import PositionContact
from facegear.contact.teeth import ContactSide, elastic_tooth
from facegear.teeth import pinion
from facegear.teeth.closest import PAIRS
from facegear.teeth.design import Material, PairDesign, involute
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.placement import body_rotation
from facegear.teeth.tooth_mesh import FeTooth, pinion_tooth
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
    """Build slabs of both gears in plane strain, their whole rings or a sector.

    Parameters
    ----------
    pinion_design, gear_design : PairDesign
        Both gears; their own `pinion` counts.
    sizes : tuple[MeshSizes, MeshSizes]
        Mesh sizes of both.
    refinement : Refinement
        Cuts of the flank layers.
    materials : tuple[Material, Material]
        Materials of both.
    teeth : int or None
        Number of teeth of a sector, None for whole rings.
    ends : Ends
        Support of the cut faces.
    centre : float or None
        Centre distance, m; None for that of standard gears.

    Returns
    -------
    TwinModel
        The twin.
    """
    sides, compliances = [], []
    layer = replace(refinement, width=1)
    for design, size, material in zip((pinion_design, gear_design), sizes, materials, strict=True):
        tooth = slab_tooth(design, size)
        elastic, side = elastic_tooth(design, tooth, material, "right")
        is_fixed = elastic.is_held.copy()
        is_fixed[:, 1] = True
        number = teeth or design.pinion.teeth
        compliances.append(flank_compliance(replace(elastic, is_held=is_fixed), layer, number, 2, ends))
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
    """Mesh the first layer of elements of a spur tooth along its axis.

    Parameters
    ----------
    design : PairDesign
        The gear.
    sizes : MeshSizes
        Mesh sizes.

    Returns
    -------
    FeTooth
        The tooth.
    """
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
    """Solve all positions at all loads; the torques in the results are those of the slab.

    Parameters
    ----------
    model : TwinModel
        The twin.
    positions : (n,) array
        Positions, fraction of a pitch.
    line_loads : list[float]
        Loads along the line of action, N/m.

    Returns
    -------
    list[LoadedPosition]
        Results by position, then by load.

    Raises
    ------
    NotConverged
        Naming position and torque.
    """
    thickness = float(np.ptp(model.surface.side.v))
    base = model.pinion.pinion_base_radius
    torques = [load * thickness * base for load in line_loads]
    guess, results = first_turn(torques, base, thickness), []
    for position in positions:
        solutions, guess = solve_position(_TwinAtPosition(model, float(position)), torques, guess)
        results += solutions
    return results


@dataclass(frozen=True, eq=False)
class _TwinAtPosition:
    """`facegear.contact.position.PairAtPosition` of the twin."""

    model: TwinModel
    position: float
    unloaded_error = 0.0

    @property
    def normal_arm(self) -> float:
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
    """Return the gap along the normals of pinion points, and the gear's roll there.

    Parameters
    ----------
    model_pinion, model_gear : PairDesign
        Both gears.
    points : (n, 3) array
        Points of the pinion, m.
    normals : (n, 3) array
        Unit normals there, dimensionless.
    phi1 : float
        Angle of the pinion, rad.
    tooth : int
        Number of the tooth pair.
    centre : float
        Centre distance, m.

    Returns
    -------
    (n,) array, (n,) array
        Gap, m (infinite where there is no flank), and roll, rad (nan there).
    """
    teeth, gear_teeth = model_pinion.pinion.teeth, model_gear.pinion.teeth
    turn = phi1 + (tooth - 0.5) * 2 * pi / teeth
    back = (
        phi1 * teeth / gear_teeth
        + tooth * 2 * pi / gear_teeth
        - _rotary_backlash(model_pinion, model_gear, centre)
    )
    start, along = rotate(points[:, [0, 2]], turn), rotate(normals[:, [0, 2]], turn)
    start, along = (rotate(-vector, back) for vector in (start + np.array([0.0, centre]), along))
    low, high = float(pinion.junction_roll(model_gear, model_gear.middle)), model_gear.pinion_tip_roll
    roll, distance = np.full(len(points), 0.5 * (low + high)), np.zeros(len(points))
    base = model_gear.pinion_base_radius
    for _ in range(50):
        radius, angle = pinion.involute_point(model_gear, roll, model_gear.middle)
        surface = np.stack([radius * np.sin(angle), -radius * np.cos(angle)], axis=1)
        nx, _, nz = np.moveaxis(pinion.involute_normal(model_gear, roll, model_gear.middle), -1, 0)
        tangent = base * roll[:, None] * np.stack([nz, -nx], axis=1)
        miss = start + distance[:, None] * along - surface
        determinant = tangent[:, 0] * along[:, 1] - tangent[:, 1] * along[:, 0]
        step = (miss[:, 0] * along[:, 1] - miss[:, 1] * along[:, 0]) / determinant
        move = (miss[:, 0] * tangent[:, 1] - miss[:, 1] * tangent[:, 0]) / determinant
        step = np.clip(step, -0.1, 0.1)
        roll, distance = np.clip(roll + step, 0.02, high + 0.2), distance + move
        if np.abs(step).max() < 1e-14:
            break
    is_facing = np.sum(along * np.stack([nx, nz], axis=1), axis=1) < -0.5
    on = is_facing & (roll >= low) & (roll <= high) & (np.abs(step) < 1e-11) & (np.abs(distance) < 1e-3)
    return np.where(on, distance, np.inf), np.where(on, roll, np.nan)


def standard_centre(first: PairDesign, second: PairDesign) -> float:
    """Return the centre distance of gears without profile shift.

    Parameters
    ----------
    first, second : PairDesign
        Both gears.

    Returns
    -------
    float
        Distance, m.
    """
    return first.pinion_pitch_radius + second.pinion_pitch_radius


def _rotary_backlash(first: PairDesign, second: PairDesign, centre: float) -> float:
    """Turn (rad) of the second gear that closes the gap between the flanks of centred teeth and spaces."""
    base, other_base = first.pinion_base_radius, second.pinion_base_radius
    involute_angle = involute(acos((base + other_base) / centre))
    space = pi / first.pinion.teeth - first.pinion_half_base_angle + involute_angle
    return (base * space - other_base * (second.pinion_half_base_angle - involute_angle)) / other_base


def rotate(vectors: Array, angle: float) -> Array:
    """Rotate x and z of vectors as the pinion turns.

    Parameters
    ----------
    vectors : (n, 2) array
        Vectors, any unit.
    angle : float
        Angle, rad.

    Returns
    -------
    (n, 2) array
        Rotated vectors, in the same unit.
    """
    return vectors @ body_rotation("pinion", angle)[np.ix_([0, 2], [0, 2])].T


def _candidates(model: TwinModel, phi1: float, limit: float) -> list[Candidates]:
    surface, side = model.surface, model.gear_side
    lattice = Lattice(side.shape, surface.lattice.refinement, flank_rows=side.flank_rows)
    on_flank = ~surface.lattice.in_fillet(surface.at)
    low, high = float(pinion.junction_roll(model.gear, model.gear.middle)), model.gear.pinion_tip_roll
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
