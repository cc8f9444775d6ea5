"""Name each mode by what moves in it: the paper's symbols and three classes, read from the mode shapes.

Both are taken over all modes of one frequency together, so they do not depend on the arbitrary basis that an
eigenvalue solver returns for a repeated frequency.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import Array, Mask
from facegear.transmission.layout import DOF_PER_BODY, Layout, Role
from facegear.transmission.matrices import mass_diagonal
from facegear.transmission.modes import Modes

ENERGY_SHARE = 0.01
"""A part takes part in a mode if it holds at least this share of the kinetic energy."""
AMPLITUDE_SHARE = 0.01
"""A motion is named if its amplitude (a rotation: at the mesh) is this share of the largest in the mode."""


class ModeClass(StrEnum):
    """Classes of section 3.1."""

    RIGID = "rigid body"
    PINION = "pinion"
    GEAR = "face gear"
    COUPLED = "pinion coupled face gear"


@dataclass(frozen=True)
class ModeName:
    """Class, symbols such as `input, idler T-R; face gear T(y)`, kinetic energy share of the pinions."""

    mode_class: ModeClass
    symbols: str
    pinion_share: float


def name_modes(layout: Layout, modes: Modes) -> tuple[ModeName, ...]:
    """One name for each mode, in the order of the frequencies."""
    names: list[ModeName] = []
    for start, stop in modes.groups:
        names += [_name(layout, modes.frequencies[start], modes.shapes[:, start:stop])] * (stop - start)
    return tuple(names)


def _name(layout: Layout, frequency: float, shapes: Array) -> ModeName:
    squares = (shapes**2).sum(axis=1)
    energy = mass_diagonal(layout) * squares
    first_gear = DOF_PER_BODY * len(layout.pinions)
    share = float(energy[:first_gear].sum() / energy.sum())
    if frequency == 0.0:
        mode_class = ModeClass.RIGID
    elif share >= 1.0 - ENERGY_SHARE:
        mode_class = ModeClass.PINION
    elif share <= ENERGY_SHARE:
        mode_class = ModeClass.GEAR
    else:
        mode_class = ModeClass.COUPLED
    return ModeName(mode_class, _symbols(layout, squares), share)


def _symbols(layout: Layout, squares: Array) -> str:
    """Who moves and how, from the squared amplitudes of all DOF, shape (dof,)."""
    reach = np.ones_like(squares)
    pinions, last = len(layout.pinions), DOF_PER_BODY * len(layout.bodies)
    reach[3 : 4 * pinions : 4] = layout.pinion_radius
    reach[4 * pinions + 3 : last : 4] = layout.gear_radius
    reach[last:] = layout.mesh_radius
    amplitudes = np.sqrt(squares) * reach
    above = amplitudes > AMPLITUDE_SHARE * amplitudes.max()
    moves = above[:last].reshape(-1, DOF_PER_BODY)
    parts: dict[str, list[str]] = {}
    for role in Role:
        rows = [i for i, pinion in enumerate(layout.pinions) if pinion.role is role]
        if motion := _motion(moves[rows].any(axis=0)):
            parts.setdefault(motion, []).append(role.value)
    motion = _motion(moves[pinions:].any(axis=0))
    if motion := "-".join(filter(None, (motion, "tilt" if above[last:].any() else ""))):
        parts.setdefault(f"{motion} ", []).append("face gear")
    return "; ".join(f"{', '.join(who)} {motion.strip()}" for motion, who in parts.items())


def _motion(moves: Mask) -> str:
    """`T-R-A` from which of x, y, z, theta move; a single direction of translation is named."""
    x, y, z, theta = moves
    letters = []
    if x or y:
        letters.append("T" if x and y else "T(x)" if x else "T(y)")
    if theta:
        letters.append("R")
    if z:
        letters.append("A")
    return "-".join(letters)
