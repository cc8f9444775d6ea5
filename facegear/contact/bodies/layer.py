"""Refinement of the elements under the contact surface, tied to the coarse rest by interpolation.

The contact strip is a few tenths of a millimetre wide, the tooth several millimetres: only the first layer of
elements is cut into smaller ones, and its nodes on faces shared with coarse elements follow those faces.
The space is a conforming one, so that the compliance converges from below.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from facegear.contact.bodies.assembly import stiffness_matrix
from facegear.contact.bodies.body import Piece
from facegear.contact.bodies.elements import block_hexes, hex_shapes
from facegear.contact.options import Element, Refinement

ALL_NODES = np.arange(27).reshape(3, 3, 3).transpose(2, 1, 0)


@dataclass(frozen=True, eq=False)
class TiedSystem:
    """Stiffness of a piece with refined flank layer, on its free (master) nodes.

    `stiffness` (3n, 3n) in N/m on the masters at `points` (n, 3), of which `held` (n, 3) stay at zero;
    `coarse` maps a node of the piece to its master, -1 if it was refined away. The refined surface has nodes
    `surface` (nu, nv, 3) with normals `normals` of that shape; its normal displacement is `spread` (nu nv, k)
    times that of the master nodes `loaded` (k,), whose normals are `loaded_normals` (k, 3).
    """

    stiffness: sp.csr_matrix
    points: NDArray[np.float64]
    held: NDArray[np.bool_]
    coarse: NDArray[np.int64]
    surface: NDArray[np.float64]
    normals: NDArray[np.float64]
    loaded: NDArray[np.int64]
    loaded_normals: NDArray[np.float64]
    spread: sp.csr_matrix


def flank_elements(piece: Piece) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Elements under the flank (a, b) and their nodes (a, b, 27) turned to (profile, width, depth) order."""
    middle = piece.flank[1::2, 1::2]
    owner = np.full(len(piece.points), -1)
    owner[piece.hexes.ravel()] = np.repeat(np.arange(len(piece.hexes)), piece.hexes.shape[1])
    elements = owner[middle]
    turned = np.empty((*middle.shape, 27), dtype=np.int64)
    for i, j in np.ndindex(middle.shape):
        turned[i, j] = _turn(piece.hexes[elements[i, j]], piece.flank[2 * i : 2 * i + 3, 2 * j : 2 * j + 3])
    return elements, turned


def _turn(element: NDArray[np.int64], face: NDArray[np.int64]) -> NDArray[np.int64]:
    """Reorder a hexahedron so that its face at local z = 0 is `face` (3, 3)."""
    lattice = element[ALL_NODES]
    for axes in ((0, 1, 2), (1, 0, 2), (0, 2, 1), (2, 0, 1), (1, 2, 0), (2, 1, 0)):
        moved = lattice.transpose(axes)
        for signs in np.ndindex(2, 2, 2):
            flipped = moved[:: 1 - 2 * signs[0], :: 1 - 2 * signs[1], :: 1 - 2 * signs[2]]
            if np.array_equal(flipped[:, :, 0], face):
                return flipped.transpose(2, 1, 0).ravel()
    raise ValueError("a flank facet is not the face of one element")


def depth_stations(refinement: Refinement) -> NDArray[np.float64]:
    """Positions 0..1 of the 2 depth + 1 node planes, elements growing by `grading` away from the surface."""
    sizes = refinement.grading ** np.arange(refinement.depth)
    ends = np.concatenate([[0.0], np.cumsum(sizes) / sizes.sum()])
    stations = np.empty(2 * refinement.depth + 1)
    stations[::2] = ends
    stations[1::2] = 0.5 * (ends[1:] + ends[:-1])
    return stations


def tied_system(piece: Piece, refinement: Refinement, element: Element = "hex27") -> TiedSystem:
    """Assemble a piece whose flank layer is cut by `refinement`.

    `element` other than hex27 puts linear elements on the same nodes, for comparison.
    """
    elements, turned = flank_elements(piece)
    a, b = elements.shape
    shape = (2 * a * refinement.profile + 1, 2 * b * refinement.width + 1, 2 * refinement.depth + 1)
    lattice = np.arange(np.prod(shape)).reshape(shape)
    owner, local = _locate(shape, refinement, (a, b))
    weights, _ = hex_shapes(local)
    weights[np.abs(weights) < 1e-13] = 0.0
    parents = turned.reshape(-1, 27)[owner]
    fine_points = np.einsum("na,nai->ni", weights, piece.points[parents])

    stays = np.ones(len(piece.hexes), dtype=bool)
    stays[elements] = False
    used = np.zeros(len(piece.points), dtype=bool)
    used[piece.hexes[stays]] = True
    coarse = np.where(used, np.cumsum(used) - 1, -1)
    tied = _tied_nodes(lattice, parents, weights, used)
    fine = np.where(tied, -1, used.sum() + np.cumsum(~tied) - 1)

    free = sp.csr_matrix(
        (np.ones((~tied).sum()), (np.flatnonzero(~tied), fine[~tied])),
        shape=(lattice.size, used.sum() + (~tied).sum()),
    )
    rows, slots = np.nonzero(np.where(tied[:, None], weights, 0.0))
    tie = sp.csr_matrix((weights[rows, slots], (rows, coarse[parents[rows, slots]])), shape=free.shape)
    follow = (free + tie).tocsr()

    points = np.concatenate([piece.points[used], fine_points[~tied]])
    coarse_hexes = coarse[piece.hexes[stays]]
    fine_hexes = _right_handed(block_hexes(lattice), fine_points)
    matrix = _stiffness(piece, points, coarse_hexes, fine_hexes, fine, fine_points, follow, element)

    top = lattice[:, :, 0].ravel()
    all_normals = np.zeros_like(piece.points)
    all_normals[piece.flank] = piece.normals
    normals = np.einsum("na,nai->ni", weights[top], all_normals[parents[top]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    loaded = np.unique(follow[top].indices)
    loaded_normals = np.zeros((follow.shape[1], 3))
    loaded_normals[coarse[piece.flank]] = piece.normals
    own = ~tied[top]
    loaded_normals[fine[top[own]]] = normals[own]
    held = np.concatenate(
        [piece.held[used], (piece.held[parents] | (weights == 0.0)[..., None]).all(axis=1)[~tied]]
    )
    return TiedSystem(
        matrix,
        points,
        held,
        coarse,
        fine_points[top].reshape(*shape[:2], 3),
        normals.reshape(*shape[:2], 3),
        loaded,
        loaded_normals[loaded],
        follow[top][:, loaded].tocsr(),
    )


def _right_handed(hexes: NDArray[np.int64], points: NDArray[np.float64]) -> NDArray[np.int64]:
    """The (profile, width, depth) order is left-handed on one side of a tooth: turn it round there."""
    origin, along = points[hexes[0, 0]], points[hexes[0, [2, 6, 18]]]
    if np.linalg.det(along - origin) > 0:
        return hexes
    return hexes.reshape(-1, 9, 3)[:, :, ::-1].reshape(-1, 27)


def _locate(
    shape: tuple[int, ...], refinement: Refinement, blocks: tuple[int, int]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Element (flat index in the flank's element grid) and local position of every lattice node."""
    i, j, k = np.meshgrid(*[np.arange(n) for n in shape], indexing="ij")
    u, v = i / (2 * refinement.profile), j / (2 * refinement.width)
    row = np.minimum(i // (2 * refinement.profile), blocks[0] - 1)
    column = np.minimum(j // (2 * refinement.width), blocks[1] - 1)
    local = np.stack([u - row, v - column, depth_stations(refinement)[k]], axis=-1)
    return (row * blocks[1] + column).ravel(), local.reshape(-1, 3)


def _tied_nodes(
    lattice: NDArray[np.int64],
    parents: NDArray[np.int64],
    weights: NDArray[np.float64],
    used: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Fine nodes on the boundary of the layer whose coarse parents all belong to elements that stay."""
    edge = np.zeros(lattice.shape, dtype=bool)
    edge[[0, -1]] = edge[:, [0, -1]] = True
    edge[:, :, -1] = True
    return edge.ravel() & (used[parents] | (weights == 0.0)).all(axis=1)


def _stiffness(
    piece: Piece,
    points: NDArray[np.float64],
    coarse_hexes: NDArray[np.int64],
    fine_hexes: NDArray[np.int64],
    fine: NDArray[np.int64],
    fine_points: NDArray[np.float64],
    follow: sp.csr_matrix,
    element: Element,
) -> sp.csr_matrix:
    """Stiffness on the masters; only elements with tied nodes need the costly triple product."""
    touches = (fine[fine_hexes] < 0).any(axis=1)
    plain = np.concatenate([coarse_hexes, fine[fine_hexes[~touches]]])
    matrix = stiffness_matrix(points, plain, piece.material, element).tocsr()
    nodes, compact = np.unique(fine_hexes[touches], return_inverse=True)
    partial = stiffness_matrix(fine_points[nodes], compact.reshape(-1, 27), piece.material, element).tocsr()
    ties = sp.kron(follow[nodes], np.eye(3), format="csr")
    return (matrix + ties.T @ partial @ ties).tocsr()
