"""Teeth coupled through their cut faces: a full ring, or a sector with free or clamped ends.

All teeth are copies, so that only one is ever condensed. The teeth that carry no load are joined by doubling
(two equal chains in series make one). Cost: a few dense operations on the cut face dof, whatever the number
of teeth. Matrices (2s, 2s) hold the left face first, then the right one.
"""

import numpy as np

from facegear.arrays import Array
from facegear.contact.options import Ends
from facegear.sparse.matrices import cholesky, forward, inverse, plus_square, solve_factored

APART = 3e-9
"""Stiffness between the ends of a chain, over the largest of it, whose square is rounding."""
LEFT, RIGHT = 0, 1
"""Ends of a chain of teeth, as first index of arrays."""


def join_chains(first: Array, second: Array) -> Array:
    """Join two chains in series, right face of the first on the left face of the second.

    The shared face is eliminated: Schur complement onto the two outer faces.

    Parameters
    ----------
    first : (2s, 2s) array
        Stiffness of the first chain, N/m.
    second : (2s, 2s) array
        Stiffness of the second chain, N/m.

    Returns
    -------
    (2s, 2s) array
        Stiffness of the joined chain, N/m; left face of the first, then right face of the second.
    """
    s = len(first) // 2
    coupling, ends = np.empty((s, 2 * s), order="F"), np.zeros((2 * s, 2 * s), order="F")
    coupling[:, :s], coupling[:, s:] = first[:s, s:].T, second[:s, s:]
    ends[:s, :s], ends[s:, s:] = first[:s, :s], second[s:, s:]
    middle = cholesky(first[s:, s:] + second[:s, :s], overwrite=True)
    return plus_square(ends, forward(middle, coupling, overwrite=True), -1.0, overwrite=True)


def chain(faces: Array, teeth: int) -> Array:
    """Compute the stiffness of equal teeth in series, by binary powers.

    The coupling between the ends of a chain twice as long, and its influence on either end, is of the
    second order in that of a power. Once that is rounding, all longer chains have the power's ends.

    Parameters
    ----------
    faces : (2s, 2s) array
        Stiffness of one tooth, N/m.
    teeth : int
        Number of teeth, at least 1.

    Returns
    -------
    (2s, 2s) array
        Stiffness of the chain, N/m.
    """
    powers = [faces]
    while 2 ** len(powers) <= teeth:
        if _almost_apart(powers[-1]):
            return _ends(powers[-1])
        powers.append(join_chains(powers[-1], powers[-1]))
    result = powers[-1]
    for doublings in range(len(powers) - 1):
        if teeth >> doublings & 1:
            result = join_chains(result, powers[doublings])
    return result


def apart(stiffness: Array) -> bool:
    """Whether the coupling block between the two ends of a chain is exactly zero, as `chain` makes it for
    long ones.

    Parameters
    ----------
    stiffness : (2s, 2s) array
        Stiffness of the chain, N/m.

    Returns
    -------
    bool
        True without coupling.
    """
    s = len(stiffness) // 2
    return not stiffness[:s, s:].any()


def _almost_apart(stiffness: Array) -> bool:
    """Whether the largest coupling of a chain's two ends is at most APART of its largest diagonal
    stiffness.
    """
    s = len(stiffness) // 2
    return bool(np.abs(stiffness[:s, s:]).max(initial=0.0) <= APART * np.abs(stiffness.diagonal()).max())


def _ends(stiffness: Array) -> Array:
    """Return the stiffness (2s, 2s) of a chain with the coupling between its two ends set to zero."""
    s = len(stiffness) // 2
    alone = np.zeros_like(stiffness)
    alone[:s, :s], alone[s:, s:] = stiffness[:s, :s], stiffness[s:, s:]
    return alone


def rest_stiffness(faces: Array, neighbours: int, teeth: int, ends: Ends) -> list[tuple[Array, Array]]:
    """Compute the stiffness that the other teeth add to the outer faces of a row of adjoining teeth.

    The row is the loaded tooth with k further ones on one side, k = 0..neighbours. In a ring the rest is
    one chain that joins the row's left and right face from outside. In a sector it is a chain at each
    face, whose far end is free or clamped, and the loaded tooth is in the middle.

    Parameters
    ----------
    faces : (2s, 2s) array
        Stiffness of one tooth, N/m.
    neighbours : int
        Largest number k of neighbours.
    teeth : int
        Number of teeth of the ring or sector.
    ends : Ends
        `ring`, or the far ends of a sector: `free` or `clamped`.

    Returns
    -------
    list of tuples of (2s, 2s) arrays
        Entry k: for k further teeth to the left, and for k to the right, N/m. Rows and columns belong to
        the left face of the row, then to its right face.

    Raises
    ------
    ValueError
        If no tooth would be left outside.
    """
    s = len(faces) // 2
    if teeth < 2 * neighbours + 3:
        raise ValueError(f"{2 * neighbours + 1} loaded teeth and two more do not fit in a {ends} of {teeth}")
    rests = []
    if ends == "ring":
        outside = chain(faces, teeth - 1 - neighbours)
        around = _from_outside(outside)
        rests.append((around, around))
        for _ in range(neighbours):
            if not apart(outside):
                outside = join_chains(faces, outside)
                around = _from_outside(outside)
            rests.append((around, around))
        return rests[::-1]
    before = (teeth - 1) // 2
    after = teeth - 1 - before
    for k in range(neighbours + 1):
        sides = []
        for left, right in ((before - k, after), (before, after - k)):
            rest = np.zeros((2 * s, 2 * s))
            rest[:s, :s] = _seen_from_end(chain(faces, left), slice(s, None), slice(0, s), ends)
            rest[s:, s:] = _seen_from_end(chain(faces, right), slice(0, s), slice(s, None), ends)
            sides.append(rest)
        rests.append((sides[0], sides[1]))
    return rests


def _from_outside(chain: Array) -> Array:
    """Swap the two faces of a chain's stiffness (2s, 2s): its right face is the left face of the row it
    closes.
    """
    s = len(chain) // 2
    return np.roll(chain, (s, s), axis=(0, 1))


def moved_faces(faces: Array, rests: list[tuple[Array, Array]], tooth_faces: Array, side: int) -> list[Array]:
    """Compute the displacements of the cut faces of the teeth on one side of a tooth, from it outwards.

    Only the displacements of the tooth's own faces are prescribed. Nothing else is loaded. Faces are
    found one after the other, each with the rest of the gear beyond it as `rests` gives it.

    Parameters
    ----------
    faces : (2s, 2s) array
        Stiffness of one tooth, N/m.
    rests : list of tuples of (2s, 2s) arrays
        Result of `rest_stiffness` for n neighbours on each side, N/m.
    tooth_faces : (2s, m) array
        Displacements of the tooth's own faces (left, then right) in m load cases, m.
    side : int
        LEFT or RIGHT.

    Returns
    -------
    list of (2s, m) arrays
        Displacements of both faces (left, then right) for each of the n teeth, nearest first, m.
    """
    s = len(faces) // 2
    halves = slice(0, s), slice(s, None)
    near, far = halves[1 - side], halves[side]
    planes = [tooth_faces[far]]
    for rest in (sides[side] for sides in rests[1:]):
        push = -faces[far, near] @ planes[-1]
        if not apart(rest):
            push -= rest[far, near] @ tooth_faces[near]
        middle = cholesky(faces[far, far] + rest[far, far], overwrite=True)
        planes.append(solve_factored(middle, np.asfortranarray(push), overwrite=True))
    order = slice(None) if side == RIGHT else slice(None, None, -1)
    return [np.concatenate(planes[tooth : tooth + 2][order]) for tooth in range(len(planes) - 1)]


def plane_compliance(faces: Array, teeth: int) -> Array:
    """Compute the displacements of all cut planes of teeth in a row, ends free, by forces on them.

    Parameters
    ----------
    faces : (2s, 2s) array
        Stiffness of one tooth, N/m.
    teeth : int
        Number of teeth.

    Returns
    -------
    ((teeth + 1) s, (teeth + 1) s) array
        m/N, planes from the left end to the right.
    """
    s = len(faces) // 2
    stiffness = np.zeros(((teeth + 1) * s, (teeth + 1) * s))
    for tooth in range(teeth):
        face_dof = slice(tooth * s, (tooth + 2) * s)
        stiffness[face_dof, face_dof] += faces
    return inverse(cholesky(stiffness))


def _seen_from_end(stiffness: Array, near: slice, far: slice, ends: Ends) -> Array:
    """Return the stiffness (s, s), N/m, of a chain (2s, 2s) at its near end, with the far end free or
    clamped.

    `near` and `far` are the dof of the two ends. Free: the far end is condensed away; clamped: it stays
    at zero.
    """
    if ends == "clamped":
        return stiffness[near, near]
    follow = solve_factored(cholesky(stiffness[far, far]), stiffness[far, near])
    return stiffness[near, near] - stiffness[near, far] @ follow
