"""Two spur gears in plane strain by plain finite elements: the reference for the twin, sharing none of its
parts.

Contact acts at Gauss points of the pinion's flank facets by a penalty so stiff that it gives way by
nanometres; Newton's method on the whole sparse system of `brute_mesh`. No condensation, no influence matrix,
no hats.
"""

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp
from scipy.optimize import brentq
from skfem import ElementLineP2
from skfem.quadrature import get_quadrature

from facegear.arrays import Array, Integers
from facegear.errors import NotConverged
from facegear.sparse.matrices import solve_sparse
from facegear.teeth import pinion
from facegear.teeth.closest import PAIRS
from facegear.teeth.design import Material
from validation.contact.brute_mesh import FacetChain, FlatGear, FlatMesh, flat_gear, refine
from validation.contact.twin import involute_separation, rotate, standard_centre

PENALTIES = (1e14, 1e15, 1e16, 1e17, 1e18)
"""Pa per m, each the start of the next: by the last a pressure of 1 GPa gives way by 1 nm."""
STEPS = 60
"""Largest number of Newton steps."""
DEGREE = 11
"""Degree of the quadrature along a facet: six Gauss points."""
CLOSE = 3e-4
"""Points with larger gaps (m) are left out."""
REFINED_BELOW = 40e-6
"""Pairs closer than this (m) when unloaded are refined around their closest point."""


def gears_at(
    meshes: tuple[FlatMesh, FlatMesh], position: float, material: Material, radius: float, halvings: int
) -> tuple[FlatGear, FlatGear]:
    """Mesh both gears, refined where they touch at a position.

    Parameters
    ----------
    meshes : tuple[FlatMesh, FlatMesh]
        Meshes before refinement.
    position : float
        Position, fraction of a pitch.
    material : Material
        Material of both.
    radius : float
        Distance from the contact within which triangles are halved, m.
    halvings : int
        Number of halvings.

    Returns
    -------
    tuple[FlatGear, FlatGear]
        Both gears.
    """
    first, second = (mesh.design for mesh in meshes)
    facets = [len(mesh.flanks[0]) - 1 for mesh in meshes]
    at = np.linspace(0.0, facets[0], 40 * facets[0] + 1)
    phi1 = _angle(first, position)
    spots: tuple[list[tuple[int, float]], list[tuple[int, float]]] = ([], [])
    for tooth in PAIRS.tolist():
        _, gap, hit = _separation((first, second), facets, at, phi1, tooth)
        gap = np.where(np.isfinite(hit), gap, np.inf)
        nearest = np.argmin(gap)
        if gap[nearest] < REFINED_BELOW:
            spots[0].append((tooth, float(at[nearest])))
            spots[1].append((-tooth, float(_flank_position(second, facets[1], hit[nearest]))))
    first_gear, second_gear = (
        flat_gear(mesh, refine(mesh, contact_points, radius, halvings), material, PAIRS.tolist())
        for mesh, contact_points in zip(meshes, spots, strict=True)
    )
    return first_gear, second_gear


def loaded_rotations(
    gears: tuple[FlatGear, FlatGear], position: float, line_loads: Sequence[float]
) -> list[tuple[float, Array]]:
    """Solve for the rotation of the pinion's bore under each load, and the pairs' shares.

    Newton's method on a convex energy with an exact search along each step, hence no cycling.

    Parameters
    ----------
    gears : tuple[FlatGear, FlatGear]
        Both gears.
    position : float
        Position, fraction of a pitch.
    line_loads : Sequence[float]
        Loads along the line of action, N/m.

    Returns
    -------
    list of (float, (pairs,) array)
        Rotation, rad, and share of the load of each pair.

    Raises
    ------
    NotConverged
        Naming position and load.
    """
    first, second = gears
    base = first.design.pinion_base_radius
    phi1 = _angle(first.design, position)
    rows, gaps, weights, owner = _constraints(gears, phi1)
    stiffness = sp.block_diag([first.stiffness, second.stiffness], format="csc")
    free = np.concatenate([first.free, second.free])
    stiffness = stiffness[free][:, free].tocsr()
    rows = sp.hstack([rows[:, free], np.full((len(gaps), 1), -base)], format="csr")
    state = np.zeros(free.sum() + 1)
    state[-1] = gaps.min() / base + line_loads[0] / (1e10 * base)
    rotations = []
    for load in line_loads:
        for penalty in PENALTIES if load == line_loads[0] else PENALTIES[-1:]:
            springs = penalty * weights
            state = _solve_balance(
                stiffness, rows, springs, gaps, state, load * base, f"position {position:g}"
            )
        force = springs * np.maximum(-gaps - rows @ state, 0.0)
        rotations.append(
            (float(state[-1]), np.array([force[owner == tooth].sum() for tooth in PAIRS]) / load)
        )
    return rotations


def _solve_balance(stiffness, rows, springs, gaps, state, torque, position_name):  # type: ignore[no-untyped-def]
    """Displacements and rotation at balance."""
    for _ in range(STEPS):
        depth = -gaps - rows @ state
        active = depth > 0
        step = _newton_step(stiffness, rows[active], springs[active], depth[active], state, torque)
        state = state + _length(stiffness, rows, springs, depth, state, step, torque) * step
        is_pressed = -gaps - rows @ state > 0
        if np.array_equal(is_pressed, active) and np.abs(step).max() < 1e-10 * np.abs(state).max():
            return state
    raise NotConverged("brute force", f"{position_name}, {torque:g} N m per m", f"{STEPS} Newton steps")


def _newton_step(stiffness, rows, springs, depth, state, torque):  # type: ignore[no-untyped-def]
    """Change of displacements and rotation (the last) to the balance of the present contact points."""
    weighted_rows = sp.diags_array(springs) @ rows
    part, lever = rows[:, :-1], rows[:, -1].toarray().ravel()
    tangent = (stiffness + part.T @ weighted_rows[:, :-1]).tocsr()
    push = part.T @ (springs * lever)
    residual = -stiffness @ state[:-1] + part.T @ (springs * depth)
    solutions = solve_sparse(tangent, np.stack([push, residual], axis=1))
    short = torque + lever @ (springs * depth)
    turn = (short - push @ solutions[:, 1]) / (lever @ (springs * lever) - push @ solutions[:, 0])
    return np.append(solutions[:, 1] - turn * solutions[:, 0], turn)


def _length(stiffness, rows, springs, depth, state, step, torque):  # type: ignore[no-untyped-def]
    """Factor on the step at which the energy is least: the root of the energy's slope, which never falls."""
    elastic_force = stiffness @ step[:-1]
    start, rise = state[:-1] @ elastic_force - torque * step[-1], step[:-1] @ elastic_force
    approach = rows @ step

    def slope(length: float) -> float:
        return start + length * rise + (springs * approach) @ np.minimum(length * approach - depth, 0.0)

    high = 1.0
    while slope(high) < 0 and high < 1e6:
        high *= 2.0
    return brentq(slope, 0.0, high, xtol=1e-15, rtol=1e-14) if slope(0.0) < 0 < slope(high) else 1.0


def _angle(design, position):  # type: ignore[no-untyped-def]
    return (position - 0.5) * 2 * np.pi / design.pinion.teeth


def _roll(design, facets, at):  # type: ignore[no-untyped-def]
    """Roll angle along the flank, whose nodes are evenly spaced in its square, from tip to root."""
    top, bottom = design.pinion_tip_roll, float(pinion.junction_roll(design, design.middle))
    return np.sqrt(top**2 + at / facets * (bottom**2 - top**2))


def _flank_position(design, facets, roll):  # type: ignore[no-untyped-def]
    top, bottom = design.pinion_tip_roll, float(pinion.junction_roll(design, design.middle))
    return (top**2 - roll**2) / (top**2 - bottom**2) * facets


def _separation(designs, facets, at, phi1, tooth):  # type: ignore[no-untyped-def]
    """Normals (n, 3) of the pinion's flank at positions, gaps (n,) along them and the gear's positions, nan
    beside it.
    """
    roll = _roll(designs[0], facets[0], at)
    points = pinion.cartesian(*pinion.involute_point(designs[0], roll, 0.0), 0.0)
    nx, _, nz = pinion.involute_normal(designs[0], roll, 0.0).T
    normals = np.stack([nx, np.zeros_like(nx), nz], axis=1)
    centre = standard_centre(*designs)
    gap, hit = involute_separation(designs[0], designs[1], points, normals, phi1, tooth, centre)
    return normals, gap, hit


def _constraints(
    gears: tuple[FlatGear, FlatGear], phi1: float
) -> tuple[sp.csr_matrix, Array, Array, Integers]:
    """Rows that give the normal approach spent on elastic displacement, gaps, lengths and teeth of all
    points.
    """
    designs = gears[0].design, gears[1].design
    pitches = [2 * np.pi / design.pinion.teeth for design in designs]
    facets = [round(gear.chains[0].ends[-1]) for gear in gears]
    gauss_points, weight = get_quadrature(ElementLineP2, DEGREE)
    shift = gears[0].stiffness.shape[0]
    size = shift + gears[1].stiffness.shape[0]
    matrices, gaps, weights, owners = [], [], [], []
    for tooth in PAIRS.tolist():
        pinion_chain, gear_chain = gears[0].chains[tooth], gears[1].chains[-tooth]
        long = np.diff(pinion_chain.ends)
        at = (pinion_chain.ends[:-1, None] + long[:, None] * gauss_points).ravel()
        length = pinion_chain.length[:, None] * weight
        normals, gap, hit = _separation(designs, facets, at, phi1, tooth)
        on = np.isfinite(hit) & (gap < CLOSE)
        along = rotate(normals[on][:, [0, 2]], tooth * pitches[0])
        n2 = pinion.involute_normal(designs[1], hit[on], 0.0)[:, [0, 2]]
        matrices.append(
            _rows(pinion_chain, at[on], along, size, 0)
            + _rows(
                gear_chain,
                _flank_position(designs[1], facets[1], hit[on]),
                rotate(n2, -tooth * pitches[1]),
                size,
                shift,
            )
        )
        gaps.append(gap[on])
        weights.append(length.ravel()[on])
        owners.append(np.full(on.sum(), tooth))
    return (
        sp.vstack(matrices, format="csr"),
        np.concatenate(gaps),
        np.concatenate(weights),
        np.concatenate(owners),
    )


def _rows(chain: FacetChain, at, normal, size, shift):  # type: ignore[no-untyped-def]
    """Minus the displacement along `normal` (n, 2) at positions of a chain, as rows on all dof."""
    facet = np.clip(np.searchsorted(chain.ends, at, side="right") - 1, 0, len(chain.ends) - 2)
    x = (at - chain.ends[facet]) / np.diff(chain.ends)[facet]
    line = ElementLineP2()
    shapes = np.stack([line.lbasis(x[None], i)[0] for i in range(3)], axis=1)
    nodes = chain.dofs[2 * facet[:, None] + np.rint(2 * line.doflocs[:, 0]).astype(np.int64)]
    values = shapes[:, :, None] * normal[:, None, :]
    index = np.repeat(np.arange(len(nodes)), 6)
    return sp.csr_matrix((-values.ravel(), (index, shift + nodes.reshape(-1))), shape=(len(nodes), size))
