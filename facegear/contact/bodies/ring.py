"""Teeth coupled through their cut faces: a full ring, or a sector with free or clamped ends.

All teeth are copies, so that only one is ever condensed. The teeth that carry no load are joined by doubling
(two equal chains in series make one). Cost: a few dense operations on the cut face dof, whatever the number
of teeth. Matrices (2s, 2s) hold the left face first, then the right one.
"""

import numpy as np

from facegear.arrays import Array
from facegear.contact.bodies.dense import cholesky, forward, inverse, plus_square, solved
from facegear.contact.options import Ends

APART = 3e-9
"""Stiffness between the ends of a chain, over the largest of it, whose square is rounding."""
LEFT, RIGHT = 0, 1


def joined(first: Array, second: Array) -> Array:
    """Stiffness (2s, 2s) of two chains in series, right face of the first on the left face of the second."""
    s = len(first) // 2
    coupling, ends = np.empty((s, 2 * s), order="F"), np.zeros((2 * s, 2 * s), order="F")
    coupling[:, :s], coupling[:, s:] = first[:s, s:].T, second[:s, s:]
    ends[:s, :s], ends[s:, s:] = first[:s, :s], second[s:, s:]
    middle = cholesky(first[s:, s:] + second[:s, :s], overwrite=True)
    return plus_square(ends, forward(middle, coupling, overwrite=True), -1.0, overwrite=True)


def chain(faces: Array, teeth: int) -> Array:
    """Stiffness (2s, 2s) of `teeth` >= 1 equal teeth in series, by binary powers.

    What the ends of a chain twice as long feel of each other, and what they feel of its length, is of the
    second order in what those of a power do: once that is rounding, all longer chains have the power's ends.
    """
    powers = [faces]
    while 2 ** len(powers) <= teeth:
        if _almost_apart(powers[-1]):
            return _ends(powers[-1])
        powers.append(joined(powers[-1], powers[-1]))
    result = powers[-1]
    for doublings in range(len(powers) - 1):
        if teeth >> doublings & 1:
            result = joined(result, powers[doublings])
    return result


def apart(stiffness: Array) -> bool:
    """Whether the two ends of a chain do not feel each other, as those of a long one."""
    s = len(stiffness) // 2
    return not stiffness[:s, s:].any()


def _almost_apart(stiffness: Array) -> bool:
    s = len(stiffness) // 2
    return bool(np.abs(stiffness[:s, s:]).max(initial=0.0) <= APART * np.abs(stiffness.diagonal()).max())


def _ends(stiffness: Array) -> Array:
    """The stiffness without what its ends feel of each other."""
    s = len(stiffness) // 2
    alone = np.zeros_like(stiffness)
    alone[:s, :s], alone[s:, s:] = stiffness[:s, :s], stiffness[s:, s:]
    return alone


def rest_stiffness(faces: Array, neighbours: int, teeth: int, ends: Ends) -> list[tuple[Array, Array]]:
    """What the faces of 1 + k adjoining teeth feel from the others, k = 0..neighbours.

    For k further teeth to the left, and for k to the right, the stiffness (2s, 2s) that joins the row's left
    and right face from outside. Raises ValueError if no tooth would be left outside.
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
                outside = joined(faces, outside)
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
    """The stiffness of a chain whose right face is another row's left one, and the other way round."""
    s = len(chain) // 2
    return np.roll(chain, (s, s), axis=(0, 1))


def moved_faces(faces: Array, rests: list[tuple[Array, Array]], held: Array, side: int) -> list[Array]:
    """Displacements (2s, m) of the cut faces of each of n teeth on one side of a tooth, from it outwards.

    `faces` (2s, 2s) is one tooth's stiffness, `rests` from `rest_stiffness` for n neighbours on each side,
    `held` (2s, m) the displacements of the tooth's own faces. Nothing else is loaded.
    """
    s = len(faces) // 2
    halves = slice(0, s), slice(s, None)
    near, far = halves[1 - side], halves[side]
    planes = [held[far]]
    for rest in (sides[side] for sides in rests[1:]):
        push = -faces[far, near] @ planes[-1]
        if not apart(rest):
            push -= rest[far, near] @ held[near]
        middle = cholesky(faces[far, far] + rest[far, far], overwrite=True)
        planes.append(solved(middle, np.asfortranarray(push), overwrite=True))
    order = slice(None) if side == RIGHT else slice(None, None, -1)
    return [np.concatenate(planes[tooth : tooth + 2][order]) for tooth in range(len(planes) - 1)]


def plane_compliance(faces: Array, teeth: int) -> Array:
    """Displacements of all cut planes of `teeth` teeth in a row, ends free, by forces on them.

    Shape ((teeth + 1) s, (teeth + 1) s), m/N, planes from the left end to the right.
    """
    s = len(faces) // 2
    stiffness = np.zeros(((teeth + 1) * s, (teeth + 1) * s))
    for tooth in range(teeth):
        own = slice(tooth * s, (tooth + 2) * s)
        stiffness[own, own] += faces
    return inverse(cholesky(stiffness))


def _seen_from_end(stiffness: Array, near: slice, far: slice, ends: Ends) -> Array:
    """Stiffness (s, s) of a chain at its near end, the far one free or clamped."""
    if ends == "clamped":
        return stiffness[near, near]
    follow = solved(cholesky(stiffness[far, far]), stiffness[far, near])
    return stiffness[near, near] - stiffness[near, far] @ follow
