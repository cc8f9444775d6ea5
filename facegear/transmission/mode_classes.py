"""Name each mode by what moves in it: the paper's symbols and three classes, read from the mode shapes.

Both are taken over all modes of one frequency together, so they do not depend on the arbitrary basis that an
eigenvalue solver returns for a repeated frequency.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from facegear.arrays import Array
from facegear.transmission.layout import DOF_LETTERS, TILT_LETTERS, Layout, Role
from facegear.transmission.linear_model import LinearModel
from facegear.transmission.modes import Modes

ENERGY_FRACTION = 0.01
"""A part takes part in a mode if it holds at least this share of the kinetic energy."""
AMPLITUDE_FRACTION = 0.01
"""A motion is named if its amplitude (a rotation: at the mesh) is this share of the largest in the mode."""


class ModeClass(StrEnum):
    """Classes of section 3.1."""

    RIGID = "rigid body"
    PINION = "pinion"
    GEAR = "face gear"
    PINION_AND_GEAR = "pinion coupled face gear"


@dataclass(frozen=True)
class ModeName:
    """Class, symbols as `input, idler T-R; face gear T(y)`, fraction of the kinetic energy in the pinions."""

    mode_class: ModeClass
    symbols: str
    pinion_energy_fraction: float


def name_modes(layout: Layout, linear: LinearModel, modes: Modes) -> tuple[ModeName, ...]:
    """Name each mode by the bodies that move in it.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    linear : LinearModel
        Linear model of the machine.
    modes : Modes
        Its modes.

    Returns
    -------
    tuple of ModeName
        One name for each mode, in the order of the frequencies.
    """
    names: list[ModeName] = []
    for start, stop in modes.groups:
        name = _name(layout, linear, modes.frequencies[start], modes.shapes[:, start:stop])
        names += [name] * (stop - start)
    return tuple(names)


def _name(layout: Layout, linear: LinearModel, frequency: float, shapes: Array) -> ModeName:
    energy = np.real(shapes.conj() * linear.momentum(shapes)).sum(axis=1)
    pinions = np.concatenate([linear.of_body(pinion.name) for pinion in layout.pinions])
    pinion_fraction = float(energy[pinions].sum() / energy.sum())
    if frequency == 0.0:
        mode_class = ModeClass.RIGID
    elif pinion_fraction >= 1.0 - ENERGY_FRACTION:
        mode_class = ModeClass.PINION
    elif pinion_fraction <= ENERGY_FRACTION:
        mode_class = ModeClass.GEAR
    else:
        mode_class = ModeClass.PINION_AND_GEAR
    squared = (np.abs(shapes) ** 2).sum(axis=1)
    return ModeName(
        mode_class, _symbols(layout, linear.labels, np.sqrt(squared) * linear.lengths), pinion_fraction
    )


def _symbols(layout: Layout, labels: Sequence[str], amplitudes: Array) -> str:
    """Who moves and how, from the amplitudes of all DOF as lengths, shape (dof,)."""
    letters_of_body: dict[str, set[str]] = {name: set() for name in layout.body_names}
    for label in np.array(labels)[amplitudes > AMPLITUDE_FRACTION * amplitudes.max()]:
        body, _, letter = label.rpartition(":")
        letters_of_body[body].add(letter)
    parts: dict[str, list[str]] = {}
    for role in Role:
        names = [pinion.name for pinion in layout.pinions if pinion.role is role]
        if motion := _motion(set().union(*(letters_of_body[name] for name in names))):
            parts.setdefault(motion, []).append(role.value)
    if motion := _motion(set().union(*(letters_of_body[gear.name] for gear in layout.gears))):
        parts.setdefault(f"{motion} ", []).append("face gear")
    return "; ".join(f"{', '.join(who)} {motion.strip()}" for motion, who in parts.items())


def _motion(moves: set[str]) -> str:
    """`T-R-A-tilt` from the letters of the coordinates that move; a single direction of translation is named,
    and so is what is neither a motion nor a tilt of the rigid body, up to its first blank.
    """
    letters = []
    if moves & {"x", "y"}:
        letters.append("T" if {"x", "y"} <= moves else "T(x)" if "x" in moves else "T(y)")
    if "theta" in moves:
        letters.append("R")
    if "z" in moves:
        letters.append("A")
    if moves & set(TILT_LETTERS):
        letters.append("tilt")
    elastic_letters = {letter.split()[0] for letter in moves - {*DOF_LETTERS, *TILT_LETTERS}}
    return "-".join([*letters, *sorted(elastic_letters)])
