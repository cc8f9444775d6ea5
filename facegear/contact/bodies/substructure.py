"""One tooth of a gear condensed onto what is loaded and what is shared with its neighbours (Guyan 1965)."""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.linalg import solve_triangular

from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.cellwise import Part
from facegear.contact.bodies.dense import cholesky, inverse
from facegear.contact.bodies.elimination import schur_complement
from facegear.contact.bodies.layer import TiedSystem


@dataclass(frozen=True, eq=False)
class Superelement:
    """A tooth seen from its loaded flank and its two cut faces, each face in its own turned frame.

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
    """Eliminate everything but the normal displacements of the flank and the cut faces.

    `gauges` (g, 3 n): readings by the displacements of the system's masters; they cost as much as so many
    more flank nodes.
    Raises FacegearError if the body is not held, ValueError if the flank touches a held or a cut face.
    """
    turn, flank, faces = _turned(system)
    kept = np.concatenate([flank, faces])
    parts, centres = [part.seen_by(turn.T) for part in system.parts], system.centres
    if gauges is not None:
        kept = np.concatenate([kept, turn.shape[0] + np.arange(gauges.shape[0])])
        read = (gauges @ turn.T).tocsr()
        at = system.points[turn.indices[turn.indptr[:-1]] // 3]
        parts, centres = _with_gauges(parts, centres, read, at)
    schur = schur_complement(parts, kept, centres)
    k, ends = flank.size, flank.size + faces.size
    readings, schur = schur[ends:, :ends].copy(), schur[:ends, :ends]
    lower = cholesky(schur[:k, :k])
    half = solve_triangular(lower, schur[:k, k:], lower=True, check_finite=False)
    outer = schur[k:, k:] - half.T @ half
    del schur
    influence = solve_triangular(lower, half, trans="T", lower=True, check_finite=False)
    own = inverse(lower)
    return Superelement(
        flank=own,
        influence=influence,
        faces=outer,
        gauge_flank=readings[:, :k] @ own,
        gauge_faces=readings[:, k:] - readings[:, :k] @ influence,
    )


def _with_gauges(
    parts: list[Part], centres: Array, read: sp.csr_matrix, points: Array
) -> tuple[list[Part], Array]:
    """The stiffness bordered by gauges, whose own part of a Schur complement has no meaning.

    `read` (g, n) are their readings by the n free dof at `points` (n, 3). Each gauge has a cell of its own.
    """
    count, free = read.shape
    reads = (read != 0.0).astype(float)
    number = np.maximum(reads.sum(axis=1), 1.0)
    middle = np.asarray((reads @ points) / np.asarray(number).reshape(-1, 1))
    moved = sp.block_array([[None, sp.eye(count)], [read, None]], format="csr")
    rows = np.arange(count)[:, None] + np.array([0, count])
    crossed = np.array([[0.0, 1.0], [1.0, 0.0]])

    def bordering(members: Integers) -> Array:
        return np.tile(crossed, (len(members), 1, 1))

    wider = [part.seen_by(sp.eye(free, free + count, format="csr")) for part in parts]
    return [*wider, Part(bordering, rows, moved, len(centres) + np.arange(count))], np.concatenate(
        [centres, middle]
    )


def held_by(tooth: Superelement, rest: Array) -> Array:
    """Normal displacements (k, k), m/N, of the flank by unit normal forces, faces held by `rest` (2s, 2s)."""
    if rest.size == 0:
        return tooth.flank
    half = solve_triangular(cholesky(tooth.faces + rest), tooth.influence.T, lower=True, check_finite=False)
    return tooth.flank + half.T @ half


def frames_of(normals: Array, held: Mask) -> Array:
    """Orthonormal rows (n, 3, 3): the unit normal (n, 3), then the held axes (n, 3) of a node that has any.

    Raises ValueError if a held axis is not tangential.
    """
    axis = np.where(held.any(axis=1), np.argmax(held, axis=1), np.argmin(np.abs(normals), axis=1))
    if np.abs(normals[held]).max(initial=0.0) > 1e-12:
        raise ValueError("a flank node is held along its normal: it cannot follow a load")
    along = np.eye(3)[axis]
    first = along - normals * np.sum(along * normals, axis=1)[:, None]
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([normals, first, np.cross(normals, first)], axis=1)


def _turned(system: TiedSystem) -> tuple[sp.csr_matrix, Integers, Integers]:
    """Turn of the displacements to the free dof (f, 3 n): those of flank nodes along their normals and axes
    across, those of right faces in the left's frame.

    Also the positions of the flank's normal dof and of the faces' dof (left, then right) in it.
    """
    count = len(system.points)
    frames = np.tile(np.eye(3), (count, 1, 1))
    held = system.held.copy()
    frames[system.loaded] = frames_of(system.loaded_normals, held[system.loaded])
    held[system.loaded] = held[system.loaded].sum(axis=1)[:, None] > np.array([3, 0, 1])
    frames[system.right] = system.turn.T
    turn = sp.bsr_matrix((frames, np.arange(count), np.arange(count + 1)), shape=(3 * count, 3 * count))
    free = ~held.ravel()
    turn = turn.tocsr()[free]
    turn.eliminate_zeros()
    position = np.cumsum(free) - 1
    faces = np.concatenate(
        [(3 * face[:, None] + np.arange(3)).ravel() for face in (system.left, system.right)]
    )
    if np.intersect1d(3 * system.loaded, faces).size:
        raise ValueError("a flank node lies on a cut face")
    left_free, right_free = np.split(free[faces], 2)
    if not np.array_equal(left_free, right_free):
        raise ValueError("the two cut faces are not held alike")
    return turn, position[3 * system.loaded], position[faces[free[faces]]]
