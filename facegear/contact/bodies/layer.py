"""Refinement of the elements under the contact surface, tied to the coarse rest by interpolation.

The contact strip is a few tenths of a millimetre wide, the tooth several millimetres: only the first layer of
elements is cut into smaller ones, and its nodes on faces shared with coarse elements follow those faces.
The space is a conforming one, so that the compliance converges from below.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from skfem import ElementHex2, MeshHex1, MeshHex2

from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.elements import ElasticBody, elements_of, hex_values
from facegear.contact.options import Element, Refinement
from facegear.sparse.matrices import Part

ROUNDING = 1e-12
"""Below this the value of a function is that of a node on another face."""


@dataclass(frozen=True, eq=False)
class TiedSystem:
    """Stiffness of a body with refined flank layer, on its free (master) nodes.

    The stiffness (3n, 3n) in N/m on the masters at `points` (n, 3), of which `is_held` (n, 3) marks dof
    kept at zero, is the sum of `parts`, whose cells are the elements of the body around `centres` (m, 3),
    whole or cut. `coarse` maps a node of the body to its master, -1 if it was refined away. The refined
    surface has nodes `surface` (nu, nv, 3) with normals `normals` of that shape; its normal displacement
    is `spread` (nu nv, k) times that of the master nodes `loaded_nodes` (k,), whose normals are
    `loaded_normals` (k, 3). `left` and `right` (s,) are the masters of the cut faces, and `turn` rotates
    the left ones to the right ones. `mirror` (n,) is the master behind the middle plane of each master.
    All three are defined as in `ElasticBody`.
    """

    parts: tuple[Part, ...]
    points: Array
    is_held: Mask
    coarse: Integers
    surface: Array
    normals: Array
    loaded_nodes: Integers
    loaded_normals: Array
    spread: sp.csr_matrix
    centres: Array
    left: Integers
    right: Integers
    turn: Array
    mirror: Integers

    def node_displacements(self, body: ElasticBody, refinement: Refinement) -> sp.csr_matrix:
        """Return the displacements of the body's nodes by those of the masters, for nodes on its surfaces.

        Nodes of the flank that were refined away follow the refined surface; those inside get no row.

        Parameters
        ----------
        body : ElasticBody
            Body of the system, with m nodes.
        refinement : Refinement
            Refinement of its flank layer.

        Returns
        -------
        (m, n) sparse matrix
            Dimensionless weights of the n masters.
        """
        coarse_nodes = np.flatnonzero(self.coarse >= 0)
        lattice = np.arange(self.spread.shape[0]).reshape(self.surface.shape[:2])
        surface = self.spread[lattice[:: refinement.profile, :: refinement.width].ravel()].tocoo()
        nodes, is_refined_away = body.flank.ravel(), self.coarse[body.flank.ravel()] < 0
        on = is_refined_away[surface.row]
        rows = np.concatenate([coarse_nodes, nodes[surface.row[on]]])
        columns = np.concatenate([self.coarse[coarse_nodes], self.loaded_nodes[surface.col[on]]])
        values = np.concatenate([np.ones(coarse_nodes.size), surface.data[on]])
        return sp.csr_matrix((values, (rows, columns)), shape=(len(body.points), len(self.points)))


@dataclass(frozen=True, eq=False)
class FlankElements:
    """Elements (a, b) under the flank, and where the flank's directions run in their unit cubes.

    `elements` (a, b) are numbers in the body's mesh: a across the profile, b along the width. A point u
    along the profile, v along the width and w in depth of an element (0..1 each) is at the local position
    corner + (u, v, w) @ axes, with `corner` (a, b, 3) and `axes` (a, b, 3, 3).
    """

    elements: Integers
    corner: Array
    axes: Array


@dataclass(frozen=True, eq=False)
class Layer:
    """The flank's elements cut into smaller ones.

    `mesh` has its nodes at refined lattice positions `lattice` (n, 3) across the profile, along the width and
    in depth; `number` (nu, nv, nw) is the node at each. Node n lies in the element of the body with nodes
    `parents` (n, 27), whose functions have the values `weights` (n, 27) there.
    """

    mesh: MeshHex2
    lattice: Integers
    number: Integers
    parents: Integers
    weights: Array

    @property
    def points(self) -> Array:
        """Positions (n, 3) of the nodes, m."""
        return self.mesh.doflocs.T

    @property
    def surface(self) -> Integers:
        """Nodes (nu nv,) of the refined contact surface."""
        return self.number[:, :, 0].ravel()


def flank_elements(body: ElasticBody) -> FlankElements:
    """Find the elements under the flank.

    Parameters
    ----------
    body : ElasticBody
        Body with its flank.

    Returns
    -------
    FlankElements
        Elements and the flank's directions in them.

    Raises
    ------
    ValueError
        Where a facet of the flank is not the face of one element.
    """
    dofs, flank = body.mesh.dofs, body.flank
    facets = flank[1::2, 1::2] - dofs.facet_dofs[0, 0]
    if facets.min() < 0 or facets.max() >= dofs.facet_dofs.shape[1]:
        raise ValueError("a flank facet is not the face of one element")
    elements = body.mesh.f2t[0, facets].astype(np.int64)

    def local(nodes: Integers) -> Array:
        """Return the positions (a, b, 3) of flank nodes (a, b) in the unit cubes of their `elements`."""
        is_same_node = dofs.element_dofs[:, elements] == nodes
        if not is_same_node.any(axis=0).all():
            raise ValueError("a flank facet is not the face of one element")
        return ElementHex2.doflocs[is_same_node.argmax(axis=0)]

    corner = local(flank[:-1:2, :-1:2])
    profile, width = local(flank[2::2, :-1:2]) - corner, local(flank[:-1:2, 2::2]) - corner
    depth = (1 - np.abs(profile) - np.abs(width)) * (1 - 2 * corner)
    return FlankElements(elements, corner, np.stack([profile, width, depth], axis=-2))


def depth_stations(refinement: Refinement) -> Array:
    """Return the depths of the 2 depth + 1 planes of nodes in the refined layer under the flank.

    Element sizes grow by the factor `grading` from each element to the next away from the surface.
    Stations are ends and middles of the elements.

    Parameters
    ----------
    refinement : Refinement
        Number of elements in depth and their grading.

    Returns
    -------
    (2 depth + 1,) array
        Depth as a fraction of the layer, 0 at the surface, 1 at its bottom.
    """
    sizes = refinement.grading ** np.arange(refinement.depth)
    ends = np.concatenate([[0.0], np.cumsum(sizes) / sizes.sum()])
    stations = np.empty(2 * refinement.depth + 1)
    stations[::2] = ends
    stations[1::2] = 0.5 * (ends[1:] + ends[:-1])
    return stations


def refined_layer(body: ElasticBody, under: FlankElements, refinement: Refinement) -> Layer:
    """Cut the elements under the flank into smaller ones, with nodes on the same quadratic geometry.

    Parameters
    ----------
    body : ElasticBody
        Body with its flank.
    under : FlankElements
        Elements under the flank.
    refinement : Refinement
        Number of smaller elements that replace one, in each direction.

    Returns
    -------
    Layer
        Mesh of the layer alone, and how its nodes lie in the body's elements.
    """
    cuts = np.array([refinement.profile, refinement.width, refinement.depth])
    shape = 2 * cuts * np.array([*under.elements.shape, 1]) + 1
    mesh = MeshHex2.from_mesh(MeshHex1.init_tensor(*(np.arange(0.0, count, 2.0) for count in shape)))
    lattice = np.rint(mesh.doflocs.T).astype(np.int64)
    row, column = np.minimum(lattice[:, :2] // (2 * cuts[:2]), np.array(under.elements.shape) - 1).T
    along = lattice[:, :2] / (2 * cuts[:2]) - np.stack([row, column], axis=1)
    inside = np.column_stack([along, depth_stations(refinement)[lattice[:, 2]]])
    local = under.corner[row, column] + np.einsum("nd,ndi->ni", inside, under.axes[row, column])
    weights = hex_values(local)
    weights[np.abs(weights) < ROUNDING] = 0.0
    parents = body.mesh.dofs.element_dofs[:, under.elements[row, column]].T.astype(np.int64)
    points = np.ascontiguousarray(np.einsum("na,nai->in", weights, body.points[parents]))
    number = np.empty(shape, dtype=np.int64)
    number[tuple(lattice.T)] = np.arange(len(lattice))
    return Layer(
        mesh=replace(mesh, doflocs=points),
        lattice=lattice,
        number=number,
        parents=parents,
        weights=weights,
    )


def tied_system(body: ElasticBody, refinement: Refinement, element: Element = "hex27") -> TiedSystem:
    """Assemble a body whose flank layer is cut into smaller elements.

    Nodes of the layer on faces shared with whole elements are no unknowns: they take the displacement
    that the whole element's functions have there. All other nodes are the masters.

    Parameters
    ----------
    body : ElasticBody
        Body with its flank.
    refinement : Refinement
        Number of cuts in each direction.
    element : Element
        Other elements than hex27 are linear elements on the same nodes, for comparison.

    Returns
    -------
    TiedSystem
        Stiffness on the master nodes.
    """
    under = flank_elements(body)
    layer = refined_layer(body, under, refinement)
    parents, weights = layer.parents, layer.weights

    stays = np.ones(body.mesh.nelements, dtype=bool)
    stays[under.elements] = False
    is_used = np.zeros(len(body.points), dtype=bool)
    is_used[body.mesh.dofs.element_dofs[:, stays]] = True
    coarse = np.where(is_used, np.cumsum(is_used) - 1, -1)
    is_tied = _tied_nodes(layer, is_used)
    fine = np.where(is_tied, -1, is_used.sum() + np.cumsum(~is_tied) - 1)

    free = sp.csr_matrix(
        (np.ones((~is_tied).sum()), (np.flatnonzero(~is_tied), fine[~is_tied])),
        shape=(is_tied.size, is_used.sum() + (~is_tied).sum()),
    )
    rows, slots = np.nonzero(np.where(is_tied[:, None], weights, 0.0))
    tie = sp.csr_matrix((weights[rows, slots], (rows, coarse[parents[rows, slots]])), shape=free.shape)
    follow = (free + tie).tocsr()
    top, shape = layer.surface, layer.number.shape[:2]
    all_normals = np.zeros_like(body.points)
    all_normals[body.flank] = body.normals
    normals = np.einsum("na,nai->ni", weights[top], all_normals[parents[top]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    loaded_nodes = np.unique(follow[top].indices)
    loaded_normals = np.zeros((follow.shape[1], 3))
    loaded_normals[coarse[body.flank]] = body.normals
    is_free_surface = ~is_tied[top]
    loaded_normals[fine[top[is_free_surface]]] = normals[is_free_surface]
    is_held = np.concatenate(
        [body.is_held[is_used], (body.is_held[parents] | (weights == 0.0)[..., None]).all(axis=1)[~is_tied]]
    )
    return TiedSystem(
        parts=_parts(body, under, np.flatnonzero(stays), coarse, layer, follow, refinement, element),
        points=np.concatenate([body.points[is_used], layer.points[~is_tied]]),
        is_held=is_held,
        coarse=coarse,
        surface=layer.points[top].reshape(*shape, 3),
        normals=normals.reshape(*shape, 3),
        loaded_nodes=loaded_nodes,
        loaded_normals=loaded_normals[loaded_nodes],
        spread=follow[top][:, loaded_nodes].tocsr(),
        centres=_centres(body)[np.concatenate([np.flatnonzero(stays), under.elements.ravel()])],
        left=coarse[body.left],
        right=coarse[body.right],
        turn=body.turn,
        mirror=_mirror_masters(body, layer, coarse, fine),
    )


def _parts(
    body: ElasticBody,
    under: FlankElements,
    stays: Integers,
    coarse: Integers,
    layer: Layer,
    follow: sp.csr_matrix,
    refinement: Refinement,
    element: Element,
) -> tuple[Part, Part]:
    """Return the stiffness of the whole elements and of the layer's small elements, each as a Part.

    `stays` are the numbers of the whole elements, each a cell of its own; small elements share the cell
    of the element they were cut from. `coarse` maps the body's nodes to masters, -1 if refined away;
    `follow` (layer nodes, masters) holds the weights of masters in each layer node's displacement.
    """
    members = layer.mesh.dofs.element_dofs.T
    cuts = 2 * np.array([refinement.profile, refinement.width])
    row, column = (layer.lattice[members, :2].min(axis=1) // cuts).T
    cell = len(stays) + row * under.elements.shape[1] + column
    coarse_nodes = np.flatnonzero(coarse >= 0)
    coarse_map = sp.csr_matrix(
        (np.ones(coarse_nodes.size), (coarse_nodes, coarse[coarse_nodes])),
        shape=(len(body.points), follow.shape[1]),
    )
    whole, cut = (sp.kron(nodes, sp.eye(3), format="csr") for nodes in (coarse_map, follow))
    return (
        elements_of(body.mesh, stays, np.arange(len(stays)), whole, body.material, element),
        elements_of(layer.mesh, np.arange(len(members)), cell, cut, body.material, element),
    )


def _mirror_masters(body: ElasticBody, layer: Layer, coarse: Integers, fine: Integers) -> Integers:
    """Return the number (n,) of each master's mirror image at the mid-width plane; empty for an
    asymmetric body.

    `coarse` and `fine` give the master of each node of the body and of the layer, -1 where it has none.
    """
    if not body.mirror.size:
        return body.mirror
    mirror = np.full(max(coarse.max(), fine.max()) + 1, -1)
    coarse_nodes, behind = np.flatnonzero(coarse >= 0), np.flatnonzero(fine >= 0)
    mirror[coarse[coarse_nodes]] = coarse[body.mirror[coarse_nodes]]
    across, along, deep = layer.lattice[behind].T
    mirror[fine[behind]] = fine[layer.number[across, layer.number.shape[1] - 1 - along, deep]]
    return mirror


def _centres(body: ElasticBody) -> Array:
    """Return the centre (m, 3), m, of each of the body's elements: the mean position of its 27 nodes."""
    return body.points[body.mesh.dofs.element_dofs].mean(axis=0)


def _tied_nodes(layer: Layer, is_used: Mask) -> Mask:
    """Mark the layer's nodes (n,) that follow whole elements: on its boundary, with all parents still in
    use.

    Parents are the nodes of the original element with a non-zero weight; `is_used` marks the body's nodes
    that belong to whole elements.
    """
    at, ends = layer.lattice, np.array(layer.number.shape) - 1
    edge = (at[:, :2] == 0).any(axis=1) | (at == ends).any(axis=1)
    return edge & (is_used[layer.parents] | (layer.weights == 0.0)).all(axis=1)
