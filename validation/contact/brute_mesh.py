"""Sectors of spur teeth in plane strain as plain scikit-fem meshes, refined where the flanks touch.

Quadratic triangles with straight sides; red-green-blue refinement halves them around the points of contact,
so that the strip is resolved to micrometres while the rest of the teeth stays as it is.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementTriP2, ElementVector, MeshQuad, MeshTri
from skfem.models.elasticity import lame_parameters, linear_elasticity

from facegear.arrays import Array, Integers, Mask
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.tooth_mesh import sector
from validation.contact.twin import slab_tooth


@dataclass(frozen=True, eq=False)
class FacetChain:
    """Facets of a flank: places (n + 1,) of their ends, in facets of the mesh before refinement from tip to
    root, the facets' `length` (n,) m, and the x and z dof (2 n + 1, 2) of ends and middles.
    """

    ends: Array
    length: Array
    dofs: Integers


@dataclass(frozen=True, eq=False)
class FlatMesh:
    """Triangles of a sector, and by tooth the nodes (n + 1, 2) of its flank before refinement, m."""

    design: PairDesign
    mesh: MeshTri
    bore_radius: float
    flanks: dict[int, Array]


@dataclass(frozen=True, eq=False)
class FlatGear:
    """Stiffness (N/m per m) of a sector on all dof, which of them are free, and the flanks by tooth."""

    design: PairDesign
    stiffness: sp.csc_matrix
    free: Mask
    chains: dict[int, FacetChain]


def flat_mesh(design: PairDesign, sizes: MeshSizes, teeth: int) -> FlatMesh:
    """Mesh a sector of spur teeth, right flanks to be loaded.

    Parameters
    ----------
    design : PairDesign
        The gear.
    sizes : MeshSizes
        Mesh sizes.
    teeth : int
        Number of teeth.

    Returns
    -------
    FlatMesh
        The mesh before refinement.
    """
    slab = sector(slab_tooth(design, sizes), teeth, -(teeth // 2))
    quads = slab.hexes[:, [0, 2, 8, 6]]
    nodes_used, local = np.unique(quads, return_inverse=True)
    points = slab.nodes[nodes_used][:, [0, 2]]
    corners = local.reshape(-1, 4)
    (ax, az), (bx, bz) = ((points[corners[:, i]] - points[corners[:, 0]]).T for i in (1, 2))
    is_inverted = ax * bz - az * bx < 0
    corners[is_inverted] = corners[is_inverted][:, ::-1]
    grid = slab.tooth.surfaces["flank_right"].nodes[::2, 0]
    flanks = {slab.first + j: slab.nodes[nodes[grid]][:, [0, 2]] for j, nodes in enumerate(slab.tooth_nodes)}
    mesh = MeshQuad(points.T.copy(), corners.T.copy()).to_meshtri()
    return FlatMesh(design, mesh, design.pinion.bore_radius, flanks)


def refine(flat: FlatMesh, spots: Sequence[tuple[int, float]], radius: float, halvings: int) -> MeshTri:
    """Halve the triangles near spots of the flanks.

    Parameters
    ----------
    flat : FlatMesh
        The mesh before refinement.
    spots : Sequence[tuple[int, float]]
        Tooth, and position along its flank in units of facets from the tip.
    radius : float
        Distance from a spot within which triangles are halved, m.
    halvings : int
        Number of halvings.

    Returns
    -------
    MeshTri
        The refined mesh.
    """
    centres = np.array([_at(flat.flanks[tooth], spot) for tooth, spot in spots])
    mesh = flat.mesh
    for _ in range(halvings):
        middle = mesh.p[:, mesh.t].mean(axis=1).T
        near = np.linalg.norm(middle[:, None] - centres, axis=2).min(axis=1) < radius
        mesh = mesh.refined(np.flatnonzero(near))
    return mesh


def flat_gear(flat: FlatMesh, mesh: MeshTri, material: Material, teeth: Sequence[int]) -> FlatGear:
    """Assemble a (refined) mesh, bore clamped and cut faces free.

    Parameters
    ----------
    flat : FlatMesh
        The mesh before refinement.
    mesh : MeshTri
        The mesh to assemble.
    material : Material
        Its material.
    teeth : Sequence[int]
        Teeth whose flanks are returned.

    Returns
    -------
    FlatGear
        Stiffness and flanks.
    """
    basis = Basis(mesh, ElementVector(ElementTriP2()), intorder=2)
    lame = lame_parameters(material.young_modulus, material.poisson_ratio)
    stiffness = linear_elasticity(*lame).assemble(basis).tocsc()
    is_fixed = np.zeros(mesh.p.shape[1], dtype=bool)
    boundary = mesh.boundary_facets()
    ends = mesh.facets[:, boundary]
    # straight facets of the bore: their ends lie on the circle, their middles inside it
    on_bore = np.abs(np.hypot(*mesh.p[:, ends]) - flat.bore_radius).max(axis=0) < 1e-9
    is_fixed[ends[:, on_bore]] = True
    free = np.ones(basis.N, dtype=bool)
    free[basis.nodal_dofs[:, is_fixed]] = False
    free[basis.facet_dofs[:, boundary[on_bore]]] = False
    chains = {tooth: _chain(basis, boundary, flat.flanks[tooth]) for tooth in teeth}
    return FlatGear(flat.design, stiffness, free, chains)


def _at(line: Array, position: float) -> Array:
    facet = min(int(position), len(line) - 2)
    return line[facet] + (position - facet) * (line[facet + 1] - line[facet])


def _chain(basis: Basis, boundary: Integers, line: Array) -> FacetChain:
    """Boundary facets on a broken line (n + 1, 2), in its order."""
    ends = basis.mesh.facets[:, boundary]
    middle = basis.mesh.p[:, ends].mean(axis=1).T
    start, along = line[:-1], np.diff(line, axis=0)
    length = np.linalg.norm(along, axis=1)
    away = middle[:, None] - start
    fraction = np.sum(away * along, axis=2) / length**2
    beside = np.abs(away[..., 0] * along[:, 1] - away[..., 1] * along[:, 0]) / length
    hit = (fraction > 0) & (fraction < 1) & (beside < 1e-10)
    on, owner = np.nonzero(hit)
    order = np.argsort(owner + fraction[on, owner])
    on, owner = on[order], owner[order]
    facets = boundary[on]
    pair = basis.mesh.facets[:, facets]
    position = owner + np.sum(
        (basis.mesh.p[:, pair] - start[owner].T[:, None]) * along[owner].T[:, None], axis=0
    ) / (length[owner] ** 2)
    first = np.argmin(position, axis=0)
    left, right = (pair[row, np.arange(len(on))] for row in (first, 1 - first))
    if not np.array_equal(left[1:], right[:-1]):
        raise ValueError("the flank's facets do not join")
    dofs = np.empty((2 * len(on) + 1, 2), dtype=np.int64)
    dofs[:-1:2] = basis.nodal_dofs[:, left].T
    dofs[-1] = basis.nodal_dofs[:, right[-1]]
    dofs[1::2] = basis.facet_dofs[:, facets].T
    at = np.append(position.min(axis=0), position[:, -1].max())
    return FacetChain(at, np.diff(at) * length[owner], dofs)
