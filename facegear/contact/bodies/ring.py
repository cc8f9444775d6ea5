"""Teeth coupled through their cut faces: a full ring, or a sector with free or clamped ends.

All teeth are copies, so that only one is ever condensed. The teeth that carry no load are joined by doubling
(two equal chains in series make one). Cost: a few dense operations on the cut face dof, whatever the number
of teeth. Matrices (2s, 2s) hold the left face first, then the right one.
"""

import numpy as np
import scipy.linalg as sl

from facegear.arrays import Array
from facegear.contact.bodies.dense import cholesky, inverse, solved
from facegear.contact.options import Ends

APART = 1e-14
"""Stiffness between the ends of a chain, over the largest of it, that is rounding."""


def joined(first: Array, second: Array) -> Array:
    """Stiffness (2s, 2s) of two chains in series, right face of the first on the left face of the second."""
    s = len(first) // 2
    middle = cholesky(first[s:, s:] + second[:s, :s])
    coupling = np.concatenate([first[:s, s:].T, second[:s, s:]], axis=1)
    half = sl.solve_triangular(middle, coupling, lower=True, check_finite=False)
    chain = half.T @ half
    np.negative(chain, out=chain)
    chain[:s, :s] += first[:s, :s]
    chain[s:, s:] += second[s:, s:]
    return chain


def chain(faces: Array, teeth: int) -> Array:
    """Stiffness (2s, 2s) of `teeth` >= 1 equal teeth in series, by binary powers.

    Once the ends of a power do not feel each other, those of all longer chains are its own to rounding.
    """
    powers = [faces]
    while 2 ** len(powers) <= teeth:
        if apart(powers[-1]):
            return powers[-1]
        powers.append(joined(powers[-1], powers[-1]))
    result = powers[-1]
    for doublings in range(len(powers) - 1):
        if teeth >> doublings & 1:
            result = joined(result, powers[doublings])
    return result


def apart(stiffness: Array) -> bool:
    """Whether the two ends of a chain feel each other less than rounding, as those of a long one do."""
    s = len(stiffness) // 2
    return bool(np.abs(stiffness[:s, s:]).max(initial=0.0) <= APART * np.abs(stiffness.diagonal()).max())


def rest_stiffness(faces: Array, neighbours: int, teeth: int, ends: Ends) -> list[tuple[Array, Array]]:
    """What the faces of 1 + k adjoining teeth feel from the others, k = 0..neighbours.

    For k further teeth to the right, and for k to the left, the stiffness (2s, 2s) that joins the row's left
    and right face from outside. Raises ValueError if no tooth would be left outside.
    """
    s = len(faces) // 2
    if teeth < 2 * neighbours + 3:
        raise ValueError(f"{2 * neighbours + 1} loaded teeth and two more do not fit in a {ends} of {teeth}")
    swap = np.r_[s : 2 * s, 0:s]
    rests = []
    if ends == "ring":
        outside = chain(faces, teeth - 1 - neighbours)
        for k in range(neighbours, -1, -1):
            around = outside[np.ix_(swap, swap)]
            rests.append((around, around))
            if k and not apart(outside):
                outside = joined(faces, outside)
        return rests[::-1]
    before = (teeth - 1) // 2
    after = teeth - 1 - before
    for k in range(neighbours + 1):
        sides = []
        for left, right in ((before, after - k), (before - k, after)):
            rest = np.zeros((2 * s, 2 * s))
            rest[:s, :s] = _seen_from_end(chain(faces, left), slice(s, None), slice(0, s), ends)
            rest[s:, s:] = _seen_from_end(chain(faces, right), slice(0, s), slice(s, None), ends)
            sides.append(rest)
        rests.append((sides[0], sides[1]))
    return rests


def moved_faces(faces: Array, rests: list[tuple[Array, Array]], force: Array) -> Array:
    """Displacements of the cut faces of a tooth and its neighbours by forces on the tooth's own faces.

    `faces` (2s, 2s) is one tooth's stiffness, `rests` from `rest_stiffness` for n neighbours on each side,
    `force` (2s, m) on the left and right face of the middle tooth. Returns (2 n + 1, 2s, m): block t holds
    the faces of the tooth t - n places further.
    """
    s = len(faces) // 2
    low, high = slice(0, s), slice(s, None)
    held = solved(cholesky(faces + rests[0][0]), force)
    left, right = [held[low]], [held[high]]
    for to_right, to_left in rests[1:]:
        push = faces[high, low] @ right[-1] + to_right[high, low] @ held[low]
        right.append(-solved(cholesky(faces[high, high] + to_right[high, high]), push))
        push = faces[low, high] @ left[-1] + to_left[low, high] @ held[high]
        left.append(-solved(cholesky(faces[low, low] + to_left[low, low]), push))
    planes = left[::-1] + right
    return np.stack([np.concatenate(planes[tooth : tooth + 2]) for tooth in range(len(planes) - 1)])


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
