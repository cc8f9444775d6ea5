"""Two spur gears in plane strain by plain finite elements: the reference for the twin, sharing none of its
parts.

scikit-fem assembles two sectors of teeth with straight-sided quadratic quadrilaterals. Contact acts at Gauss
points of the pinion's flank facets by a penalty so stiff that it gives way by nanometres; Newton's method on
the whole sparse system. No condensation, no influence matrix, no hats.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import Basis, ElementQuad2, ElementVector, MeshQuad
from skfem.models.elasticity import lame_parameters, linear_elasticity

from facegear.contact.factor import solve
from facegear.contact.twin import involute_separation, slab_tooth
from facegear.errors import NotConverged
from facegear.geometry import pinion
from facegear.geometry.design import Material, PairDesign
from facegear.geometry.unloaded import PAIRS
from facegear.mesh.sector import sector
from facegear.mesh.sizes import MeshSizes

PENALTY = 1e18
"""Pa per m: a pressure of 1 GPa gives way by 1 nm."""
STEPS = 60
GAUSS_POINTS = 12
"""On a facet: many, so that a tip edge that ends the contact within a facet is seen where it is."""


@dataclass(frozen=True, eq=False)
class FlatGear:
    """A sector in plane strain: stiffness on all dof (N/m per m), free dof, and the dof along each tooth's
    flank.

    `flanks` maps a tooth to (2 n + 1, 2) x and z dof from tip to root, corners and middles of n straight
    facets; `corners` (n + 1, 2) are those of tooth 0.
    """

    design: PairDesign
    stiffness: sp.csc_matrix
    free: NDArray[np.bool_]
    flanks: dict[int, NDArray[np.int64]]
    corners: NDArray[np.float64]


def flat_gear(design: PairDesign, sizes: MeshSizes, material: Material, teeth: int) -> FlatGear:
    """Sector of `teeth` teeth with free cut faces, bore clamped; right flanks loaded."""
    slab = sector(slab_tooth(design, sizes), teeth, -(teeth // 2))
    count = len(slab.nodes)
    quads = slab.hexes[:, [0, 2, 8, 6]]
    used, local = np.unique(quads, return_inverse=True)
    points = slab.nodes[used][:, [0, 2]]
    corners = local.reshape(-1, 4)
    turn = np.cross(
        points[corners[:, 1]] - points[corners[:, 0]], points[corners[:, 2]] - points[corners[:, 0]]
    )
    corners[turn < 0] = corners[turn < 0][:, ::-1]
    mesh = MeshQuad(points.T.copy(), corners.T.copy())
    basis = Basis(mesh, ElementVector(ElementQuad2()), intorder=4)
    lame = lame_parameters(material.young_modulus, material.poisson_ratio)
    stiffness = linear_elasticity(*lame).assemble(basis).tocsc()
    renumber = np.full(count, -1)
    renumber[used] = np.arange(used.size)
    facet_of = {tuple(sorted(pair)): i for i, pair in enumerate(mesh.facets.T.tolist())}

    def chain(nodes: NDArray[np.int64]) -> NDArray[np.int64]:
        ends = renumber[nodes[::2]]
        dofs = np.empty((2 * ends.size - 1, 2), dtype=np.int64)
        dofs[::2] = basis.nodal_dofs[:, ends].T
        facets = [
            facet_of[tuple(sorted(pair))] for pair in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)
        ]
        dofs[1::2] = basis.facet_dofs[:, facets].T
        return dofs

    grid = slab.tooth.surfaces["flank_right"].nodes[:, 0]
    bore = np.unique(slab.tooth_nodes[:, slab.tooth.faces["bore"].ravel()])
    held_points = renumber[bore]
    free = np.ones(basis.N, dtype=bool)
    held = np.zeros(len(points), dtype=bool)
    held[held_points[held_points >= 0]] = True
    free[basis.nodal_dofs[:, held]] = False
    free[basis.facet_dofs[:, held[mesh.facets].all(axis=0)]] = False
    flanks = {slab.first + j: chain(slab.tooth_nodes[j][grid]) for j in range(teeth)}
    return FlatGear(design, stiffness, free, flanks, slab.tooth.nodes[grid[::2]][:, [0, 2]])


def loaded_rotation(
    gears: tuple[FlatGear, FlatGear], position: float, line_load: float
) -> tuple[float, NDArray[np.float64]]:
    """Rotation (rad) of the pinion's bore under a load (N/m along the line of action), and the pairs' shares.

    Raises NotConverged naming position and load.
    """
    first, second = gears
    base = first.design.pinion_base_radius
    phi1 = (position - 0.5) * 2 * np.pi / first.design.pinion.teeth
    rows, gaps, weights, owner = _constraints(gears, phi1)
    stiffness = sp.block_diag([first.stiffness, second.stiffness], format="csc")
    free = np.concatenate([first.free, second.free])
    stiffness, rows = stiffness[free][:, free], rows[:, free].tocsr()
    torque = line_load * base
    rotation, moved = 2.0 * torque / (1.5e10 * base**2), np.zeros(free.sum())
    for _ in range(STEPS):
        depth = rotation * base - gaps - rows @ moved
        active = depth > 0
        part = rows[active]
        scaled = sp.diags_array(PENALTY * weights[active]) @ part
        tangent = (stiffness + part.T @ scaled).tocsr()
        push = base * np.asarray(scaled.sum(axis=0)).ravel()
        both = solve(tangent, np.stack([push, -scaled.T @ gaps[active]], axis=1))
        own = PENALTY * weights[active]
        own_turn = base**2 * own.sum() - push @ both[:, 0]
        own_gap = -base * own @ gaps[active] - push @ both[:, 1]
        new_rotation = (torque - own_gap) / own_turn
        new_moved = new_rotation * both[:, 0] + both[:, 1]
        change = abs(new_rotation - rotation) / new_rotation
        rotation, moved = new_rotation, new_moved
        pressed = rotation * base - gaps - rows @ moved > 0
        if change < 1e-12 and np.array_equal(pressed, active):
            force = own * (rotation * base - gaps[active] - part @ moved)
            share = np.array([force[owner[active] == tooth].sum() for tooth in PAIRS]) * base / torque
            return float(rotation), share
    raise NotConverged("brute force", f"position {position:g}, {line_load:g} N/m", f"{STEPS} Newton steps")


def _constraints(
    gears: tuple[FlatGear, FlatGear], phi1: float
) -> tuple[sp.csr_matrix, NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Rows that give the normal approach spent on elastic displacement, gaps, lengths and teeth of all
    points.
    """
    first, second = gears
    top, bottom = first.design.pinion_tip_roll, pinion.junction_roll(first.design)
    facets = len(first.corners) - 1
    where, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    place = (np.arange(facets)[:, None] + (where + 1) / 2).ravel()
    roll = np.sqrt(top**2 + place / facets * (bottom**2 - top**2))
    points = pinion.cartesian(*pinion.involute_point(first.design, roll), 0.0)
    nx, nz = pinion.involute_normal(first.design, roll)
    normals = np.stack([nx, np.zeros_like(nx), nz], axis=1)
    lengths = np.linalg.norm(np.diff(first.corners, axis=0), axis=1)
    weights = (lengths[:, None] * weight / 2).ravel()
    low, high = pinion.junction_roll(second.design), second.design.pinion_tip_roll
    size, shift = first.stiffness.shape[0] + second.stiffness.shape[0], first.stiffness.shape[0]
    matrices, found_gaps, found_weights, owners = [], [], [], []
    for tooth in PAIRS:
        gap, hit = involute_separation(first.design, second.design, points, normals, phi1, int(tooth))
        on = np.isfinite(hit) & (gap < 3e-4)
        if not on.any():
            continue
        turned = normals[on][:, [0, 2]]
        own = _trace(
            place[on], first.flanks[int(tooth)], _turn(turned, tooth * 2 * np.pi / first.design.pinion.teeth)
        )
        angle = (high**2 - hit[on] ** 2) / (high**2 - low**2) * (len(second.corners) - 1)
        other_tooth = -int(tooth)
        n2 = np.stack(pinion.involute_normal(second.design, hit[on]), axis=1)
        body = _turn(n2, other_tooth * 2 * np.pi / second.design.pinion.teeth)
        other = _trace(angle, second.flanks[other_tooth], body)
        matrices.append(_rows(own, size, 0, -1.0) + _rows(other, size, shift, -1.0))
        found_gaps.append(gap[on])
        found_weights.append(weights[on])
        owners.append(np.full(on.sum(), tooth))
    return (
        sp.vstack(matrices, format="csr"),
        np.concatenate(found_gaps),
        np.concatenate(found_weights),
        np.concatenate(owners),
    )


def _turn(vectors: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * vectors[:, 0] - s * vectors[:, 1], s * vectors[:, 0] + c * vectors[:, 1]], axis=1)


def _trace(place, dofs, normal):  # type: ignore[no-untyped-def]
    """Dof and values of normal displacement at places along a chain of facets."""
    facets = (len(dofs) - 1) // 2
    facet = np.clip(place.astype(np.int64), 0, facets - 1)
    x = place - facet
    shapes = np.stack([(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)], axis=1)
    nodes = dofs[2 * facet[:, None] + np.arange(3)]
    return nodes, shapes[:, :, None] * normal[:, None, :]


def _rows(trace, size, shift, sign):  # type: ignore[no-untyped-def]
    nodes, values = trace
    index = np.repeat(np.arange(len(nodes)), 6)
    return sp.csr_matrix(
        (sign * values.ravel(), (index, shift + nodes.reshape(-1))), shape=(len(nodes), size)
    )
