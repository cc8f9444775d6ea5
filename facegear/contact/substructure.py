"""One piece of a gear condensed onto what is loaded and what is shared with its neighbours."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import lapack

from facegear.contact.body import Piece
from facegear.contact.factor import schur_complement
from facegear.contact.layer import TiedSystem
from facegear.errors import FacegearError


@dataclass(frozen=True, eq=False)
class Superelement:
    """A tooth seen from its loaded flank and its two cut faces, each face in its own turned frame.

    `flank` (k, k), m/N: normal displacements by unit normal forces with both faces clamped;
    `influence` (k, 2 s), s the free dof of a face: minus the normal displacement by unit face displacements
    (left, then right), which is also the force on the faces by unit normal forces; `faces` (2 s, 2 s), N/m:
    stiffness of the faces, flank unloaded.
    """

    flank: NDArray[np.float64]
    influence: NDArray[np.float64]
    faces: NDArray[np.float64]


def frames_of(normals: NDArray[np.float64], held: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Orthonormal rows (n, 3, 3): the unit normal (n, 3), then the held axis (n, 3) of a node that has one.

    Raises ValueError if a held axis is not tangential: the node could not follow a load.
    """
    axis = np.where(held.any(axis=1), np.argmax(held, axis=1), np.argmin(np.abs(normals), axis=1))
    if (held.sum(axis=1) > 1).any() or np.abs(normals[held]).max(initial=0.0) > 1e-12:
        raise ValueError("a flank node is held along its normal or along more than one axis")
    along = np.eye(3)[axis]
    first = along - normals * np.sum(along * normals, axis=1)[:, None]
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([normals, first, np.cross(normals, first)], axis=1)


def condense(piece: Piece, system: TiedSystem) -> Superelement:
    """Eliminate everything but the normal displacements of the flank and the cut faces.

    Raises FacegearError if a flank node is held or lies on a cut face, or the body is not held.
    """
    count = len(system.points)
    frames = np.tile(np.eye(3), (count, 1, 1))
    held = system.held.copy()
    frames[system.loaded] = frames_of(system.loaded_normals, held[system.loaded])
    held[system.loaded] = np.array([False, True, False]) & held[system.loaded].any(axis=1)[:, None]
    left, right = system.coarse[piece.left], system.coarse[piece.right]
    frames[right] = piece.turn.T
    turn = sp.bsr_matrix(
        (frames, np.arange(count), np.arange(count + 1)), shape=(3 * count, 3 * count)
    ).tocsr()
    stiffness = (turn @ system.stiffness @ turn.T).tocsr()

    free = ~held.ravel()
    position = np.cumsum(free) - 1
    axes = np.arange(3)
    faces = np.concatenate([(3 * face[:, None] + axes).ravel() for face in (left, right)])
    kept = np.concatenate([3 * system.loaded, faces])
    if np.unique(kept).size != kept.size:
        raise ValueError("a flank node lies on a cut face")
    if not np.array_equal(*np.split(free[faces], 2)):
        raise ValueError("the two cut faces are not held alike")
    schur = schur_complement(stiffness[free][:, free], position[kept[free[kept]]])
    return _eliminate_flank(schur, system.loaded.size)


def _eliminate_flank(schur: NDArray[np.float64], loaded: int) -> Superelement:
    flank = _inverse(schur[:loaded, :loaded])
    influence = flank @ schur[:loaded, loaded:]
    faces = schur[loaded:, loaded:] - schur[loaded:, :loaded] @ influence
    return Superelement(flank, influence, 0.5 * (faces + faces.T))


def _inverse(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Inverse of a symmetric positive definite matrix at half the cost of solving for the unit matrix."""
    factor, failed = lapack.dpotrf(matrix, lower=1, clean=0)
    if failed:
        raise FacegearError("the flank's stiffness is not positive definite: the body is not held")
    lower, _ = lapack.dpotri(factor, lower=1, overwrite_c=1)
    inverse = np.tril(lower)
    inverse += np.tril(lower, -1).T
    return inverse
