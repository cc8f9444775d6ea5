"""Static equilibrium of pinions that touch each other through the gears only, by a compiled kernel.

The method stands in `facegear/_kernels/src/statics/settle.hpp`: a semismooth Newton method with an exact line
search, each pinion eliminated by itself.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from facegear._kernels import statics
from facegear.arrays import Array, Integers
from facegear.machine.layout import DOF_PER_BODY, Layout
from facegear.machine.machine import Machine
from facegear.meshing.law import LawAtPhases, LinearHeld, LoadDependentHeld

KERNELS: Mapping[type, Callable[..., Any]] = {
    LinearHeld: statics.settle_linear,
    LoadDependentHeld: statics.settle_load_dependent,
}
"""The kernel of each law."""


class Springs(NamedTuple):
    """One-sided flanks, bearings and forces of a machine. All unknowns are lengths.

    F flanks, P pinions, n unknowns: x, y, turn of every pinion, then w of every gear. N, m.

    Attributes
    ----------
    jacobian : (F, 3 + w)
        By the unknowns of the flank's pinion and its gear.
    pinion, gear : (F,)
        First unknown of that pinion and of that gear.
    pinion_bearing : (P, 3)
        Stiffness xx, xy, yy, N/m.
    clearance : (P,)
        Clearance of the bearing, m. Where it is positive, xx = yy and xy = 0.
    core_row, core_column, core_value : (E,)
        Entries, row <= column, of the symmetric stiffness among the other n - 3 P unknowns, counted from the
        first of them, N/m.
    loads : (n,)
        Forces on the unknowns, N.
    """

    jacobian: Array
    pinion: Integers
    gear: Integers
    pinion_bearing: Array
    clearance: Array
    core_row: Integers
    core_column: Integers
    core_value: Array
    loads: Array


def has_kernel(law: LawAtPhases) -> bool:
    """Tell whether the compiled kernel knows a law.

    Parameters
    ----------
    law
        A law at some phases.

    Returns
    -------
    bool
        False where statics has to ask the law itself.
    """
    return type(law) in KERNELS


def settle_all(
    springs: Springs, law: LawAtPhases, gap: Array, tolerance: float, start: Array
) -> tuple[Array, Array, Array]:
    """Settle a machine at K positions, each from where the one before was found.

    Parameters
    ----------
    springs
        The machine.
    law
        Law of the flanks at K phases, one that `has_kernel`.
    gap : (K, F)
        Flanks are pressed in by J q - gap, m.
    tolerance
        Imbalance over the largest force, dimensionless.
    start : (n,)
        Where the first search starts, m.

    Returns
    -------
    displacements : (K, n)
        m.
    forces : (K, F)
        Of the flanks, N.
    residuals : (K,)
        Largest imbalance over the largest force, above the tolerance where a position is not solved.
    """
    count, flanks = gap.shape
    displacements, forces = np.empty((count, start.size)), np.empty((count, flanks))
    residuals, settle = np.empty(count), KERNELS[type(law)]
    settle(springs, law, gap, tolerance, start, displacements, forces, residuals)
    return displacements, forces, residuals


@dataclass(frozen=True, eq=False)
class _Frame:
    """Data shared by machines with the same bodies, bearings and meshes: has_blocks() without loads,
    static_unknowns(), and the compiled problem without clearance and loads.
    """

    blocks: bool
    coordinates: Integers
    scale: Array
    springs: Springs


def has_blocks(machine: Machine) -> bool:
    """Whether bearings join no pinion with anything else, and each flank touches one pinion alone.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    bool
        True where the compiled solver of block_statics applies.
    """
    frame = _frame_of(machine)
    is_unknown = np.zeros(machine.linear.size, dtype=bool)
    is_unknown[frame.coordinates] = True
    return frame.blocks and not machine.linear.loads[~is_unknown].any()


def static_springs(machine: Machine) -> Springs:
    """Return the compiled problem in the unknowns of `static_unknowns`.

    Parameters
    ----------
    machine : Machine
        A machine that `has_blocks`.

    Returns
    -------
    Springs
        m and N.
    """
    frame, linear = _frame_of(machine), machine.linear
    loads = linear.loads[frame.coordinates] * frame.scale
    return frame.springs._replace(clearance=machine.imperfections.bearing_clearance, loads=loads)


def static_unknowns(machine: Machine) -> tuple[Integers, Array]:
    """Return the degrees of freedom that the compiled problem keeps, and the size of its unknowns.

    The pinions' motion along their own axes is left out, as no mesh feels it. If one gear may rock, another
    that may not is given tilts of no length. Coordinates beside those of the layout come last.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    pair of (n,) arrays
        Indices of the degrees of freedom, and what 1 m of each unknown is in m or rad.
    """
    frame = _frame_of(machine)
    return frame.coordinates, frame.scale


def _frame_of(machine: Machine) -> _Frame:
    """Return the factorised blocks of a machine, shared by machines that differ in errors alone."""
    return _frame(machine.without_errors)


@lru_cache(maxsize=8)
def _frame(machine: Machine) -> _Frame:
    """Divide the equations of statics into blocks of pinions that only the gears couple."""
    layout, linear = machine.layout, machine.linear
    stiffness, rows, lengths = linear.stiffness, linear.rows, linear.lengths
    coordinates, scale = _select_unknowns(layout, lengths)
    blocks, springs = (
        _blocks(layout, coordinates, stiffness, rows),
        _springs(layout, coordinates, scale, stiffness, rows),
    )
    return _Frame(blocks, coordinates, scale, springs)


def _blocks(layout: Layout, coordinates: Integers, stiffness: Array, rows: Array) -> bool:
    """Whether the pinions couple only through the gears and the springs of their own meshes."""
    size, pinions = len(stiffness), len(layout.pinions)
    group = np.full(size, -1)
    group[coordinates[: 3 * pinions]] = np.repeat(np.arange(pinions), 3)
    left_out = np.setdiff1d(np.arange(size), coordinates)
    group[left_out] = pinions + np.arange(left_out.size)
    turns = coordinates[2 : 3 * pinions : 3]
    has_coupling = (stiffness != 0.0) & (group[:, None] != group)
    pinion_of_row = np.array([i for i, _ in layout.meshes] * 2)[:, None]
    strange = (rows != 0.0) & (group != -1) & (group != pinion_of_row)
    return not (has_coupling.any() or strange.any() or stiffness[turns].any())


def _springs(layout: Layout, coordinates: Integers, scale: Array, bearing: Array, rows: Array) -> Springs:
    """Return the compiled problem without clearance and loads."""
    first, jacobian = 3 * len(layout.pinions), rows[:, coordinates] * scale
    window_starts, columns = _windows(layout, coordinates.size, len(bearing) == layout.dof)
    if np.count_nonzero(np.take_along_axis(jacobian, columns, axis=1)) < np.count_nonzero(jacobian):
        window_starts, columns = _windows(layout, coordinates.size, False)
    x, y = coordinates[0:first:3], coordinates[1:first:3]
    core = bearing[np.ix_(coordinates[first:], coordinates[first:])] * np.outer(scale[first:], scale[first:])
    row, column = np.nonzero(np.triu(core))
    return Springs(
        jacobian=np.take_along_axis(jacobian, columns, axis=1),
        pinion=window_starts[:, 0].copy(),
        gear=window_starts[:, 1].copy(),
        pinion_bearing=np.stack([bearing[x, x], bearing[x, y], bearing[y, y]], axis=1),
        clearance=np.zeros(len(layout.pinions)),
        core_row=row.copy(),  # np.nonzero gives them with strides, and every call would copy them
        core_column=column.copy(),
        core_value=core[row, column],
        loads=np.zeros(coordinates.size),
    )


def _select_unknowns(layout: Layout, every_length: Array) -> tuple[Integers, Array]:
    """Return coordinates that statics solves for, and a length scale for each."""
    coordinates: list[int] = []
    lengths: list[float] = []
    pinions, bodies = len(layout.pinions), len(layout.bodies)
    for body in range(bodies):
        body_coordinates = DOF_PER_BODY * body + np.array([0, 1, 3] if body < pinions else [0, 1, 2, 3])
        coordinates += body_coordinates.tolist()
        lengths += every_length[body_coordinates].tolist()
        if body >= pinions and layout.tilting:
            rocks = body - pinions in layout.tilting
            at = layout.first_tilts[body - pinions if rocks else layout.tilting[0]]
            coordinates += [at, at + 1]
            lengths += 2 * [every_length[at] if rocks else np.inf]
    added_coordinates = np.arange(layout.dof, every_length.size)
    return np.append(coordinates, added_coordinates), 1.0 / np.append(
        lengths, every_length[added_coordinates]
    )


def _windows(layout: Layout, size: int, by_gear: bool) -> tuple[Integers, Integers]:
    """Return where the unknowns of each flank start, of its pinion and beside the pinions (flanks, 2), and
    all of its unknowns (flanks, ...): those of its gear, or the whole core.
    """
    first = 3 * len(layout.pinions)
    width = (size - first) // len(layout.gears) if by_gear else size - first
    starts = [(3 * i, first + (width * g if by_gear else 0)) for i, g in layout.meshes]
    window_starts = np.array(starts * 2)
    columns = [window_starts[:, :1] + np.arange(3), window_starts[:, 1:] + np.arange(width)]
    return window_starts, np.concatenate(columns, axis=1)
