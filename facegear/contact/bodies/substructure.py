"""Static condensation (Guyan 1965) of one tooth onto its loaded nodes and the faces shared with its
neighbours.

Split of a body that is its own mirror image into two bodies of half the size. Displacements that are even
across the middle plane do not mix with those that are odd. Either kind is known from the half before the
plane, where it is held along the plane's normal or across it. An element that the plane crosses counts half
and is not cut, so that both halves together are the whole to rounding.
"""

from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.layer import TiedSystem
from facegear.sparse.elimination import schur_complement
from facegear.sparse.matrices import Part, fill_upper_triangle


@dataclass(frozen=True, eq=False)
class Superelement:
    """A tooth seen from the k nodes of its refined flank and its two cut faces, each in its own turned frame.

    `flank` (k, k), m/N: normal displacements by unit normal forces with both faces clamped;
    `influence` (k, 2 s), s the free dof of a face: minus the normal displacement by unit face displacements
    (left, then right), which is also the force on the faces by unit normal forces; `faces` (2 s, 2 s), N/m:
    stiffness of the faces, flank unloaded. For g gauges, `gauge_flank` (g, k): readings by unit normal forces
    with both faces clamped; `gauge_faces` (g, 2 s): by unit face displacements, flank unloaded.
    """

    flank: Array
    influence: Array
    faces: Array
    gauge_flank: Array = field(default_factory=lambda: np.zeros((0, 0)))
    gauge_faces: Array = field(default_factory=lambda: np.zeros((0, 0)))


def condense(system: TiedSystem, gauges: sp.csr_matrix | None = None) -> Superelement:
    """Eliminate everything but the cut faces, and compute the normal displacements of the flank.

    Parameters
    ----------
    system : TiedSystem
        System of the tooth, with n masters.
    gauges : (g, 3 n) sparse matrix, optional
        Readings by the displacements of the masters; they cost as much as so many more flank nodes.

    Returns
    -------
    Superelement
        Condensed tooth, in SI units.

    Raises
    ------
    FacegearError
        If the body is not held.
    ValueError
        If the flank touches a held or a cut face.
    """
    turn, flank, faces = _rotate_dof(system)
    parts = [part.seen_by(turn.T) for part in system.parts]
    normal = (np.ones(flank.size), (np.arange(flank.size), flank))
    read = (system.spread @ sp.csr_matrix(normal, (flank.size, turn.shape[0]))).tocsr()
    last = faces.size + read.shape[0]
    if gauges is not None:
        read = sp.vstack([read, gauges @ turn.T], format="csr")
    schur = schur_complement(parts, faces, system.centres, read)
    loads, beyond = slice(faces.size, last), slice(last, None)
    return Superelement(
        flank=fill_upper_triangle(np.negative(schur[loads, loads])),
        influence=np.negative(schur[loads, : faces.size]),
        faces=fill_upper_triangle(schur[: faces.size, : faces.size].copy(order="F")),
        gauge_flank=np.negative(schur[beyond, loads]),
        gauge_faces=schur[beyond, : faces.size].copy(),
    )


def frames_of(normals: Array, is_held: Mask) -> Array:
    """Return orthonormal frames of flank nodes: unit normal, tangential axis, and the cross product of
    both.

    The tangential axis is a held coordinate axis, if the node has any, else the coordinate axis that is
    nearest to the tangent plane, projected on it.

    Parameters
    ----------
    normals : (n, 3) array
        Unit normals, dimensionless.
    is_held : (n, 3) array of bool
        Whether each displacement (x, y, z) is kept at zero.

    Returns
    -------
    (n, 3, 3) array
        Unit vectors as rows of each frame, dimensionless.

    Raises
    ------
    ValueError
        If a held axis is not tangential.
    """
    axis = np.where(is_held.any(axis=1), np.argmax(is_held, axis=1), np.argmin(np.abs(normals), axis=1))
    if np.abs(normals[is_held]).max(initial=0.0) > 1e-12:
        raise ValueError("a flank node is held along its normal: it cannot follow a load")
    along = np.eye(3)[axis]
    first = along - normals * np.sum(along * normals, axis=1)[:, None]
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([normals, first, np.cross(normals, first)], axis=1)


def _rotate_dof(system: TiedSystem) -> tuple[sp.csr_matrix, Integers, Integers]:
    """Return the rotation of the displacements to the free dof (f, 3 n), and the positions of flank and face
    dof in it.

    Displacements of flank nodes are along their normals and axes across, those of right faces in the
    left's frame. The positions are those of the flank's normal dof, and of the faces' dof (left, then
    right).
    """
    count = len(system.points)
    frames = np.tile(np.eye(3), (count, 1, 1))
    is_held = system.is_held.copy()
    frames[system.loaded_nodes] = frames_of(system.loaded_normals, is_held[system.loaded_nodes])
    is_held[system.loaded_nodes] = is_held[system.loaded_nodes].sum(axis=1)[:, None] > np.array([3, 0, 1])
    frames[system.right] = system.turn.T
    turn = sp.bsr_matrix((frames, np.arange(count), np.arange(count + 1)), shape=(3 * count, 3 * count))
    free = ~is_held.ravel()
    turn = turn.tocsr()[free]
    turn.eliminate_zeros()
    position = np.cumsum(free) - 1
    faces = np.concatenate(
        [(3 * face[:, None] + np.arange(3)).ravel() for face in (system.left, system.right)]
    )
    if np.intersect1d(3 * system.loaded_nodes, faces).size:
        raise ValueError("a flank node lies on a cut face")
    left_free, right_free = np.split(free[faces], 2)
    if not np.array_equal(left_free, right_free):
        raise ValueError("the two cut faces are not held alike")
    return turn, position[3 * system.loaded_nodes], position[faces[free[faces]]]


IMAGE = np.array([1.0, -1.0, 1.0])
"""Signs of a vector's mirror image."""
ON_THE_PLANE = 1e-6
"""Distance of an element's centre from the middle plane over the width of the body."""


@dataclass(frozen=True, eq=False)
class Half:
    """The half of a system before its middle plane, for even (`sign` 1) or odd (-1) displacements.

    `fold` (3n, 3h): displacements of all n masters by those of its h masters. `system` is the whole one where
    there is no such plane, with `sign` 0.
    """

    system: TiedSystem
    sign: float
    fold: sp.csr_matrix


def halves(system: TiedSystem) -> list[Half]:
    """Split a system that is its own mirror image at mid-width into an even and an odd half.

    Parameters
    ----------
    system : TiedSystem
        The whole system.

    Returns
    -------
    list[Half]
        Even and odd half; one entry, the system itself, if it is not its own mirror image.
    """
    if not system.mirror.size:
        return [Half(system, 0.0, sp.eye(3 * len(system.points), format="csr"))]
    parts, centres = _before_the_plane(system)
    return [_half(replace(system, parts=parts, centres=centres), sign) for sign in (1.0, -1.0)]


def unfold_matrix(even: Array, odd: Array, shape: tuple[int, int], rows: bool = True) -> Array:
    """Return the matrix of the whole lattice from those of both halves.

    Blocks on one side of the middle plane are (even + odd) / 2, blocks across it (even - odd) / 2.

    Parameters
    ----------
    even : (..., nu h, nu h) array
        Matrix of the even half, any unit.
    odd : (..., nu h, nu h) array
        Matrix of the odd half, same unit.
    shape : tuple[int, int]
        Lattice (nu, h) of a half, the middle column included; the whole has nv = 2 h - 1 columns.
    rows : bool
        Whether rows stand for nodes of the lattice, too; if not, the shapes are (..., g, nu h) and (...,
        g, nu nv).

    Returns
    -------
    (..., nu nv, nu nv) array
        Matrix, same unit.
    """
    across, half = shape
    whole, before, behind = 2 * half - 1, slice(0, half), slice(half, None)
    image = slice(half - 2, None, -1) if half > 1 else slice(0, 0)
    ends = (across, half, across, half) if rows else (even.shape[-2], 1, across, half)
    same_side, across_plane = (
        0.5 * combination.reshape(*even.shape[:-2], *ends) for combination in (even + odd, even - odd)
    )
    row_width = whole if rows else 1
    result = np.empty((*even.shape[:-2], ends[0], row_width, across, whole))
    for at, from_row in ((before, before), (behind, image)) if rows else ((before, before),):
        near, far = (same_side, across_plane) if at is before else (across_plane, same_side)
        result[..., at, :, before] = near[..., from_row, :, :]
        result[..., at, :, behind] = far[..., from_row, :, image]
    return result.reshape(*even.shape[:-2], -1, across * whole)


def _before_the_plane(system: TiedSystem) -> tuple[tuple[Part, ...], Array]:
    """Return the parts cut down to elements before the mid-width plane, and the centres (m, 3), m, of
    their cells.

    Elements whose centre lies on the plane stay, with half their stiffness. Cells are numbered anew.
    """
    width = np.ptp(system.points[:, 1])
    plane = system.points[:, 1].min() + 0.5 * width
    selections = []
    for part in system.parts:
        along = part.rows[:, part.rows.shape[1] // 3 : 2 * part.rows.shape[1] // 3]
        beyond = (part.transformation @ system.points.ravel())[along].mean(axis=1) - plane
        members = np.flatnonzero(beyond <= ON_THE_PLANE * width)
        weights = np.where(beyond[members] < -ON_THE_PLANE * width, 1.0, 0.5)
        selections.append((part, members, weights))
    cells = np.unique(np.concatenate([part.cell[members] for part, members, _ in selections]))
    number = np.full(len(system.centres), -1)
    number[cells] = np.arange(cells.size)
    parts = tuple(
        part.select(members, weights, number[part.cell[members]]) for part, members, weights in selections
    )
    return parts, system.centres[cells]


def _half(system: TiedSystem, sign: float) -> Half:
    """Build the symmetric (sign 1) or antisymmetric (-1) half of a mirror-symmetric system.

    `system` holds the parts before the plane (`_before_the_plane`). On the plane, y is held for sign 1, x
    and z for sign -1. Masters behind the plane move as `sign` times the mirror image of the masters
    before it.
    """
    behind, count = system.mirror, len(system.points)
    on_plane = behind == np.arange(count)
    before = on_plane | (system.points[:, 1] < system.points[behind, 1])
    half_nodes = np.flatnonzero(before)
    number = np.full(count, -1)
    number[half_nodes] = np.arange(half_nodes.size)
    image = np.where(before, number, number[behind])
    is_held = system.is_held.copy()
    is_held[np.ix_(on_plane, [1] if sign > 0 else [0, 2])] = True
    values = np.where(before[:, None], 1.0, sign * IMAGE)
    columns = 3 * image[:, None] + np.arange(3)
    fold = sp.csr_matrix(
        (values.ravel(), columns.ravel(), np.arange(3 * count + 1)), shape=(3 * count, 3 * half_nodes.size)
    )
    nu, nv = system.surface.shape[:2]
    lattice = slice(0, nv // 2 + 1)
    loaded_rows, spread = _loaded_masters(system, before & ~(on_plane & (sign < 0)), image, sign)
    rows = np.arange(nu * nv).reshape(nu, nv)[:, lattice].ravel()
    half = TiedSystem(
        parts=tuple(part.seen_by(fold) for part in system.parts),
        points=system.points[half_nodes],
        is_held=is_held[half_nodes],
        coarse=np.where(system.coarse >= 0, np.where(before, number, -1)[system.coarse], -1),
        surface=system.surface[:, lattice],
        normals=system.normals[:, lattice],
        loaded_nodes=number[system.loaded_nodes[loaded_rows]],
        loaded_normals=system.loaded_normals[loaded_rows],
        spread=(system.spread[rows] @ spread).tocsr(),
        centres=system.centres,
        left=number[system.left[before[system.left]]],
        right=number[system.right[before[system.right]]],
        turn=system.turn,
        mirror=behind[:0],
    )
    return Half(half, sign, fold)


def _loaded_masters(
    system: TiedSystem, moves: Mask, image: Integers, sign: float
) -> tuple[Integers, sp.csr_matrix]:
    """Return which loaded masters stay in a half, and the matrix (k, l) from their normal displacements
    to all k.

    `moves` (n,) marks the masters of the half that can move, `image` (n,) numbers each master's
    representative in the half. The first result (l,) holds positions in `loaded_nodes`; an image has the
    factor `sign`.
    """
    stay = np.flatnonzero(moves[system.loaded_nodes])
    column = np.full(image.max() + 1, -1)
    column[image[system.loaded_nodes[stay]]] = np.arange(stay.size)
    at = column[image[system.loaded_nodes]]
    rows = np.flatnonzero(at >= 0)
    values = np.where(moves[system.loaded_nodes[rows]], 1.0, sign)
    return stay, sp.csr_matrix((values, (rows, at[rows])), shape=(system.loaded_nodes.size, stay.size))
