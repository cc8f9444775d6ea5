"""Natural frequencies, shapes and names of modes with the mean mesh stiffness, equations (23), (24).

Name each mode by what moves in it: the paper's symbols and three classes, read from the mode shapes. Both are
taken over all modes of one frequency together, so they do not depend on the arbitrary basis that an
eigenvalue solver returns for a repeated frequency.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy.linalg

from facegear.arrays import AnyArray, Array
from facegear.errors import NotConverged
from facegear.machine.casing_coordinates import CASING, CASING_MODE
from facegear.machine.layout import DOF_LETTERS, TILT_LETTERS, Layout, Role
from facegear.machine.linear_model import LinearModel

EQUAL = 1e-8
"""Difference of neighbouring frequencies, over the largest of all, up to which they count as equal."""


@dataclass(frozen=True, eq=False)
class Modes:
    """Frequencies in Hz, shape (n,), ascending; shapes (n, n) by column with unit modal mass. Of turning
    bodies shapes are complex, their largest entry real: displacements are the real part of shape e^(i w t).

    `groups` holds runs of equal frequencies as (start, stop); shapes within a run are one basis of many.
    """

    frequencies: Array
    shapes: AnyArray
    groups: tuple[tuple[int, int], ...]


def drive_flanks(layout: Layout, linear: LinearModel, mesh_stiffness: float) -> Array:
    """Return the stiffness matrix of the meshes with every drive flank closed.

    Parameters
    ----------
    layout : Layout
        Bodies and mesh geometry.
    linear : LinearModel
        Linear model with n coordinates.
    mesh_stiffness : float
        Stiffness of each mesh, N/m.

    Returns
    -------
    (n, n) array
        N/m.
    """
    rows = linear.rows[: len(layout.meshes)]
    return np.asarray(mesh_stiffness * rows.T @ rows)


def modes_of(linear: LinearModel, meshes: Array, speed: float = 0.0) -> Modes:
    """Compute all undamped modes.

    Parameters
    ----------
    linear : LinearModel
        Bodies and bearings.
    meshes : (n, n) array
        Stiffness matrix of the meshes, N/m.
    speed : float
        Speed of the pinions, rad/s.

    Returns
    -------
    Modes
        Frequencies in Hz.

    Raises
    ------
    NotConverged
        If the machine has no position to vibrate about at the speed.
    """
    stiffness = linear.stiffness + meshes
    if linear.spin is not None and speed != 0.0:
        return _turning(linear, stiffness, speed)
    if (motions := _massive_motions(linear)) is not None:
        mass = motions.T @ linear.mass @ motions
        omega_squared, shapes = scipy.linalg.eigh(motions.T @ stiffness @ motions, mass)
        shapes = motions @ shapes
    elif linear.masses is None:
        omega_squared, shapes = scipy.linalg.eigh(stiffness, linear.mass)
    else:
        root = np.sqrt(linear.masses)
        omega_squared, vectors = scipy.linalg.eigh(stiffness / np.outer(root, root))
        shapes = vectors / root[:, None]
    frequencies = np.sqrt(_stable(omega_squared, speed)) / (2.0 * np.pi)
    return Modes(frequencies, shapes, _equal_runs(frequencies))


MASSLESS = 1e-14
"""Eigenvalue of a mass matrix, rows scaled to a unit diagonal, up to which a motion counts as one without
mass.
"""


def _massive_motions(linear: LinearModel) -> Array | None:
    """Return motions (n, k) of all n coordinates by k independent ones with mass, which those without mass
    follow statically: first the coordinates that no mass joins with others, in their order; None where every
    motion has mass.

    A casing without mass has such coordinates. No flank may touch them but through coordinates with mass.
    """
    diagonal, mass = np.diagonal(linear.mass), linear.mass
    is_alone = (diagonal > 0.0) & (np.count_nonzero(mass, axis=1) == 1)
    with_partners = np.flatnonzero(~is_alone)
    if not with_partners.size:
        return None
    scale = np.where(diagonal > 0.0, 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0)), 0.0)[
        with_partners
    ]
    values, vectors = np.linalg.eigh(mass[np.ix_(with_partners, with_partners)] * np.outer(scale, scale))
    is_massless = values <= MASSLESS
    if not is_massless.any():
        return None
    # Coordinates with zero mass have no scale; the others are independent of them.
    vectors *= np.where(scale > 0.0, scale, 1.0 / linear.lengths[with_partners])[:, None]
    massless = np.zeros((linear.size, int(is_massless.sum())))
    massive = np.zeros((linear.size, linear.size - massless.shape[1]))
    alone_count = int(is_alone.sum())
    massive[is_alone, :alone_count] = np.eye(alone_count)
    massless[with_partners], massive[with_partners, alone_count:] = (
        vectors[:, is_massless],
        vectors[:, ~is_massless],
    )
    stiffness = massless.T @ linear.stiffness
    return np.asarray(massive - massless @ np.linalg.solve(stiffness @ massless, stiffness @ massive))


def _stable(omega_squared: Array, speed: float) -> Array:
    """Return ascending squared angular frequencies (n,), 1/s2, with rounding set to zero.

    Raises NotConverged, naming the speed (rad/s), if one is negative, as the position is then not stable.
    """
    noise = omega_squared.size * np.finfo(float).eps * omega_squared[-1]
    omega_squared = np.where(np.abs(omega_squared) < 10.0 * noise, 0.0, omega_squared)
    if omega_squared[0] < 0.0:
        problem = (
            f"the stiffness is not positive, as little as {omega_squared[0]:.3g} 1/s2 in its softest motion"
        )
        raise NotConverged("modes", f"{speed:.6g} rad/s", problem)
    return omega_squared


def _turning(linear: LinearModel, stiffness: Array, speed: float) -> Modes:
    """Compute the modes of rotating bodies: x'' + G x' + K x = 0 in mass-normalised coordinates x.

    stiffness (n, n): bearings and meshes, N/m; speed of the pinions, rad/s. Damping is left out. With u =
    K^(1/2) x and v = x' this is (u, v)' = S (u, v), S = [[0, K^(1/2)], [-K^(1/2), -G]], which is
    skew-symmetric: all motions are harmonic, with complex shapes (Meirovitch 1974).
    """
    assert linear.spin is not None
    inverse = np.linalg.inv(np.linalg.cholesky(linear.mass))
    whole = stiffness + speed**2 * linear.spin.centrifugal
    omega_squared, vectors = scipy.linalg.eigh(inverse @ whole @ inverse.T)
    omega_squared = _stable(omega_squared, speed)
    size, half = linear.size, (vectors * np.sqrt(omega_squared)) @ vectors.T
    gyroscopic = speed * inverse @ linear.spin.gyroscopic @ inverse.T
    system = np.block([[np.zeros_like(half), half], [-half, -gyroscopic]])
    speeds, states = scipy.linalg.eigh(-1j * system)
    speeds, velocities = speeds[size:], states[size:, size:]
    speeds[speeds < 10.0 * size * np.finfo(float).eps * speeds[-1]] = 0.0
    # Kinetic and potential energy together are those of unit modal mass at rest.
    shapes = -1j * np.sqrt(2.0) * velocities
    rigid_count = np.count_nonzero(speeds == 0.0)
    shapes[:, :rigid_count] = vectors[:, :rigid_count]
    shapes = inverse.T @ shapes
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=0)[None], axis=0)
    frequencies = speeds / (2.0 * np.pi)
    return Modes(frequencies, shapes * np.abs(largest) / largest, _equal_runs(frequencies))


def _equal_runs(frequencies: Array) -> tuple[tuple[int, int], ...]:
    """Split ascending frequencies (n,) into runs (start, stop) whose neighbours differ by at most EQUAL
    times the largest of all.
    """
    gaps = np.diff(frequencies) > EQUAL * frequencies[-1]
    edges = [0, *(np.flatnonzero(gaps) + 1).tolist(), frequencies.size]
    return tuple(itertools.pairwise(edges))


ENERGY_FRACTION = 0.01
"""A part takes part in a mode if it holds at least this share of the kinetic energy."""
AMPLITUDE_FRACTION = 0.01
"""A motion is named if its amplitude (a rotation: at the mesh) is this share of the largest in the mode."""


class ModeClass(StrEnum):
    """Classes of modes of section 3.1 of the source paper, by which bodies have the kinetic energy, and those
    of a casing.
    """

    RIGID = "rigid body"
    PINION = "pinion"
    GEAR = "face gear"
    PINION_AND_GEAR = "pinion coupled face gear"
    CASING = "casing"


@dataclass(frozen=True)
class ModeName:
    """Name of a mode.

    - mode_class: which bodies move
    - symbols: how they move, such as `input, idler T-R; face gear T(y)`; T: translation, R: rotation
      about the own axis, A: motion along it
    - pinion_energy_fraction: part of the kinetic energy in the pinions
    """

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
    """Return class, symbols and pinion energy fraction of the modes of one frequency (Hz) from shapes (n,
    modes), summed over these modes.
    """
    energy = np.real(shapes.conj() * linear.momentum(shapes)).sum(axis=1)
    pinions = np.concatenate([linear.of_body(pinion.name) for pinion in layout.pinions])
    pinion_fraction = float(energy[pinions].sum() / energy.sum())
    is_casing = np.array([label.startswith(f"{CASING}:") for label in linear.labels])
    if frequency == 0.0:
        mode_class = ModeClass.RIGID
    elif energy[is_casing].sum() >= CASING_MODE * energy.sum():
        mode_class = ModeClass.CASING
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
    """Return symbols of the bodies that move in a mode and how, such as `input, idler T-R; face gear
    T(y)`.

    labels: `body:letter` of each coordinate; amplitudes (n,) of all coordinates as lengths, m.
    Coordinates with more than AMPLITUDE_FRACTION of the largest count; roles of pinions with the same
    motion share an entry.
    """
    letters_of_body: dict[str, set[str]] = {name: set() for name in (*layout.body_names, CASING)}
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
    symbols = [f"{', '.join(who)} {motion.strip()}" for motion, who in parts.items()]
    return "; ".join([*symbols, CASING] if letters_of_body[CASING] else symbols)


def _motion(moves: set[str]) -> str:
    """Return the symbol of a body's motion, such as `T-R-A-tilt`, from the letters of its coordinates
    that move.

    T is translation, T(x) or T(y) in one direction alone, R rotation, A axial motion. A motion that the
    rigid body does not have is named by its letters up to the first blank, such as n2 for two nodal
    diameters.
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
