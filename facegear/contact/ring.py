"""Teeth coupled through their cut faces: a full ring, or a sector with free or clamped ends.

All teeth are copies, so that only one is ever factorised. The teeth that carry no load are joined by doubling
(two equal chains in series make one), the loaded ones are written out. Cost: a few dense operations on the
cut face dof, whatever the number of teeth.
"""

from typing import Literal

import numpy as np
import scipy.linalg as sl
from numpy.typing import NDArray

from facegear.contact.substructure import Superelement

Ends = Literal["ring", "free", "clamped"]


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
    faces: NDArray[np.float64], loaded_teeth: int, teeth: int, ends: Ends
) -> NDArray[np.float64]:
    """Displacements of the cut faces of `loaded_teeth` teeth by forces on the faces of the middle one.

    `faces` (2s, 2s) is one tooth's stiffness, `teeth` the number in the ring or sector. Returns
    (loaded_teeth, 2s, 2s): block t maps a force on both faces of the middle tooth to the face displacements of
    tooth t. Raises ValueError if the ring has fewer teeth than are loaded.
    """
    if not 1 <= loaded_teeth <= teeth or loaded_teeth % 2 == 0:
        raise ValueError(f"{loaded_teeth} loaded teeth in a ring of {teeth}")
    s = len(faces) // 2
    if s == 0:
        return np.zeros((loaded_teeth, 0, 0))
    planes = loaded_teeth + 1
    stiffness = np.zeros((planes * s, planes * s))
    for tooth in range(loaded_teeth):
        block = slice(tooth * s, (tooth + 2) * s)
        stiffness[block, block] += faces
    _close(stiffness, faces, teeth - loaded_teeth, ends)
    middle = loaded_teeth // 2
    columns = np.zeros((planes * s, 2 * s))
    columns[middle * s : (middle + 2) * s] = np.eye(2 * s)
    if ends == "clamped" and teeth == loaded_teeth:
        free = np.arange(s, loaded_teeth * s)
    else:
        free = np.arange(planes * s)
    moved = np.zeros_like(columns)
    moved[free] = sl.cho_solve(sl.cho_factor(stiffness[np.ix_(free, free)], lower=True), columns[free])
    return np.stack([moved[tooth * s : (tooth + 2) * s] for tooth in range(loaded_teeth)])


def _close(stiffness: NDArray[np.float64], faces: NDArray[np.float64], others: int, ends: Ends) -> None:
    """Add the teeth that carry no load: all on one side of a ring, half on each side of a sector."""
    s = len(faces) // 2
    last = len(stiffness) - s
    if ends == "ring":
        if others < 1:
            raise ValueError("a ring needs at least one tooth that carries no load")
        where = np.r_[last : last + s, 0:s]
        stiffness[np.ix_(where, where)] += chain(faces, others)
        return
    before, after = others // 2, others - others // 2
    if before:
        stiffness[:s, :s] += _seen_from_end(chain(faces, before), slice(s, None), slice(0, s), ends)
    if after:
        stiffness[last:, last:] += _seen_from_end(chain(faces, after), slice(0, s), slice(s, None), ends)


def _seen_from_end(
    stiffness: NDArray[np.float64], near: slice, far: slice, ends: Ends
) -> NDArray[np.float64]:
    """Stiffness (s, s) of a chain at its near end, the far one free or clamped."""
    if ends == "clamped":
        return stiffness[near, near]
    follow = sl.solve(stiffness[far, far], stiffness[far, near], assume_a="pos")
    return stiffness[near, near] - stiffness[near, far] @ follow
