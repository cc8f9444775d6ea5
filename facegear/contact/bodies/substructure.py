"""Static condensation (Guyan 1965) of one tooth onto its loaded nodes and the faces shared with its
neighbours.
"""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.dense import fill_upper_triangle
from facegear.contact.bodies.elimination import schur_complement
from facegear.contact.bodies.layer import TiedSystem


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
    """Return orthonormal frames of flank nodes: the unit normal first, then the held axes of a node that has
    any.

    Parameters
    ----------
    normals : (n, 3) array
        Unit normals, dimensionless.
    is_held : (n, 3) array of bool
        Whether each displacement is kept at zero.

    Returns
    -------
    (n, 3, 3) array
        Rows of each frame, dimensionless.

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
