"""Teeth coupled through their cut faces: a full ring, or a sector with free or clamped ends.

All teeth are copies, so that only one is ever factorised. The teeth that carry no load are joined by doubling
(two equal chains in series make one). Cost: a few dense operations on the cut face dof, whatever the number
of teeth.
"""

import numpy as np
import scipy.linalg as sl
from numpy.typing import NDArray

from facegear.contact.options import Ends


def joined(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Stiffness (2s, 2s) of two chains in series, right face of the first on the left face of the second."""
    s = len(first) // 2
    middle = sl.cho_factor(first[s:, s:] + second[:s, :s], lower=True)
    coupling = np.concatenate([first[:s, s:].T, second[:s, s:]], axis=1)
    outer = np.zeros((2 * s, 2 * s))
    outer[:s, :s], outer[s:, s:] = first[:s, :s], second[s:, s:]
    chain = outer - coupling.T @ sl.cho_solve(middle, coupling)
    return 0.5 * (chain + chain.T)


def chain(faces: NDArray[np.float64], teeth: int) -> NDArray[np.float64]:
    """Stiffness (2s, 2s) of `teeth` >= 1 equal teeth in series, by binary powers."""
    result, power = None, faces
    while True:
        if teeth & 1:
            result = power if result is None else joined(result, power)
        teeth >>= 1
        if not teeth:
            return result
        power = joined(power, power)


def face_compliance(
    faces: NDArray[np.float64], neighbours: int, teeth: int, ends: Ends
) -> NDArray[np.float64]:
    """Displacements of the cut faces of a tooth and its neighbours by forces on the tooth's own faces.

    `faces` (2s, 2s) is one tooth's stiffness, `teeth` the number in the ring or sector. Returns
    (2 neighbours + 1, 2s, 2s): block t maps a force on both faces of the middle tooth to the face
    displacements of the tooth t - neighbours places further. Raises ValueError if there are too few teeth.
    """
    loaded, s = 2 * neighbours + 1, len(faces) // 2
    if loaded > teeth - (ends == "ring"):
        raise ValueError(f"{loaded} teeth next to each other in a {ends} of {teeth}")
    if s == 0:
        return np.zeros((loaded, 0, 0))
    planes = _ring(faces, neighbours, teeth) if ends == "ring" else _sector(faces, neighbours, teeth, ends)
    return np.stack([np.concatenate([planes[tooth], planes[tooth + 1]]) for tooth in range(loaded)])


def _ring(faces: NDArray[np.float64], neighbours: int, teeth: int) -> list[NDArray[np.float64]]:
    """Outwards from the loaded tooth, each plane from the two before it and the chain that closes the ring."""
    s = len(faces) // 2
    near, far = slice(0, s), slice(s, None)
    rests = [chain(faces, teeth - 1 - neighbours)]
    for _ in range(neighbours):
        rests.append(joined(faces, rests[-1]))
    rests.reverse()
    whole = faces.copy()
    whole[far, far] += rests[0][near, near]
    whole[near, near] += rests[0][far, far]
    whole[far, near] += rests[0][near, far]
    whole[near, far] += rests[0][far, near]
    inverse = sl.cho_solve(sl.cho_factor(whole, lower=True), np.eye(2 * s))
    left, right = [inverse[near]], [inverse[far]]
    first, last = inverse[near], inverse[far]
    for rest in rests[1:]:
        push = faces[far, near] @ right[-1] + rest[near, far] @ first
        right.append(-sl.solve(faces[far, far] + rest[near, near], push, assume_a="pos"))
        push = faces[near, far] @ left[-1] + rest[far, near] @ last
        left.append(-sl.solve(faces[near, near] + rest[far, far], push, assume_a="pos"))
    return left[::-1] + right


def _sector(faces: NDArray[np.float64], neighbours: int, teeth: int, ends: Ends) -> list[NDArray[np.float64]]:
    """All planes of the loaded teeth at once, the others seen from the two ends."""
    loaded, s = 2 * neighbours + 1, len(faces) // 2
    size = (loaded + 1) * s
    stiffness = np.zeros((size, size))
    for tooth in range(loaded):
        block = slice(tooth * s, (tooth + 2) * s)
        stiffness[block, block] += faces
    before = (teeth - loaded) // 2
    after = teeth - loaded - before
    near, far = slice(0, s), slice(s, None)
    if before:
        stiffness[:s, :s] += _seen_from_end(chain(faces, before), far, near, ends)
    if after:
        stiffness[-s:, -s:] += _seen_from_end(chain(faces, after), near, far, ends)
    clamped = ends == "clamped"
    free = np.arange(0 if before or not clamped else s, size if after or not clamped else size - s)
    columns = np.zeros((size, 2 * s))
    columns[neighbours * s : (neighbours + 2) * s] = np.eye(2 * s)
    moved = np.zeros_like(columns)
    moved[free] = sl.cho_solve(sl.cho_factor(stiffness[np.ix_(free, free)], lower=True), columns[free])
    return list(moved.reshape(loaded + 1, s, 2 * s))


def _seen_from_end(
    stiffness: NDArray[np.float64], near: slice, far: slice, ends: Ends
) -> NDArray[np.float64]:
    """Stiffness (s, s) of a chain at its near end, the far one free or clamped."""
    if ends == "clamped":
        return stiffness[near, near]
    follow = sl.solve(stiffness[far, far], stiffness[far, near], assume_a="pos")
    return stiffness[near, near] - stiffness[near, far] @ follow
