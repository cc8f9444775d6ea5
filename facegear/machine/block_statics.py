"""Static equilibrium of pinions that touch each other through the gears only, by a compiled kernel.

The method stands in `facegear/_kernels/src/statics/settle.hpp`: a semismooth Newton method with an exact line
search, each pinion eliminated by itself. On a casing the unknowns of a body are its motions against its seat,
so that no bearing joins a pinion with anything else; the seats stand among the unknowns of the gears.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from facegear._kernels import statics
from facegear.arrays import Array, Integers
from facegear.machine.casing_coordinates import SeatMotion
from facegear.machine.layout import DOF_PER_BODY, Layout
from facegear.machine.machine import Machine
from facegear.meshing.law import LawAtPhases, LinearHeld, LoadDependentHeld

KERNELS: Mapping[type, Callable[..., Any]] = {
    LinearHeld: statics.settle_linear,
    LoadDependentHeld: statics.settle_load_dependent,
}
"""The kernel of each law."""


class Springs(NamedTuple):
    """One-sided flanks, bearings and forces of a machine, as the compiled solver takes them. SI units.

    All n unknowns are lengths: x, y and turn of each of P pinions, then w unknowns of every gear, then
    any others, such as the places along their axes of pinions that flanks push there. There are F flanks.

    Attributes
    ----------
    jacobian : (F, 3 + w)
        Derivative of each flank's deflection by the three unknowns of its pinion, then by the w from
        `gear` on.
    pinion, gear : (F,)
        Index of the first unknown of that pinion and of that gear; if flanks depend on more than
        one gear, of the first unknown behind the pinions, with w = n - 3 P.
    pinion_bearing : (P, 3)
        Stiffness xx, xy, yy, N/m.
    clearance : (P,)
        Clearance of the bearing, m. Where it is positive, xx = yy and xy = 0.
    core_row, core_column, core_value : (E,)
        Entries, row <= column, of the symmetric stiffness among the other n - 3 P unknowns, counted from
        the first of them, N/m.
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
    """Compute the equilibrium of a machine at K positions, each search starting at the solution before.

    Parameters
    ----------
    springs
        The machine.
    law
        Law of the flanks at K phases, one that `has_kernel`.
    gap : (K, F)
        A flank is compressed by J q - gap where that is positive, m.
    tolerance
        Imbalance over the largest force at which a search ends, dimensionless.
    start : (n,)
        Where the first search starts, m.

    Returns
    -------
    displacements : (K, n)
        Unknowns of `springs`, m.
    forces : (K, F)
        Forces of the flanks, positive in compression, N.
    residuals : (K,)
        Largest imbalance over the largest force; above the tolerance where a position is not solved.
        Nothing is raised.
    """
    count, flanks = gap.shape
    displacements, forces = np.empty((count, start.size)), np.empty((count, flanks))
    residuals, settle = np.empty(count), KERNELS[type(law)]
    settle(springs, law, gap, tolerance, start, displacements, forces, residuals)
    return displacements, forces, residuals


@dataclass(frozen=True, eq=False)
class StaticBlocks:
    """The compiled problem of a machine, and how its unknowns map to the degrees of freedom.

    The motion of spur pinions along their own axes is left out, as no mesh feels it; that of others stands
    behind the gears' unknowns. If one gear may rock, another that may not is given tilts of no length.
    Coordinates beside those of the layout come last.

    Attributes
    ----------
    springs : Springs
        The compiled problem, m and N.
    coordinates : (n,) array of int
        Degree of freedom of each unknown.
    scale : (n,) array
        What 1 m of each unknown is in m or rad.
    size : int
        Number of all degrees of freedom.
    seat_motions : SeatMotion or None
        Motion of bodies with their seats, which is taken off their unknowns; None where seats stand still.
    """

    springs: Springs
    coordinates: Integers
    scale: Array
    size: int
    seat_motions: SeatMotion | None = None

    def displacements(self, solution: Array) -> Array:
        """Return the displacements of all degrees of freedom.

        Parameters
        ----------
        solution : (K, n) array
            Unknowns at K positions, m.

        Returns
        -------
        (K, dof) array
            m and rad; 0 for what is left out.
        """
        displacements = np.zeros((len(solution), self.size))
        np.add.at(displacements.T, self.coordinates, (solution * self.scale).T)
        return displacements if self.seat_motions is None else self.seat_motions.absolute(displacements)


def static_blocks(machine: Machine) -> StaticBlocks | None:
    """Return the compiled problem of a machine, or None where the compiled solver does not apply.

    It applies where bearings join no pinion with anything else, each flank touches one pinion alone, and
    no degree of freedom that is left out is loaded.

    Parameters
    ----------
    machine : Machine
        The machine.

    Returns
    -------
    StaticBlocks or None
        The problem with the machine's loads and bearing clearances; flank gaps are given to `settle_all`.
    """
    blocks, loads = _unloaded_blocks(machine.without_errors), machine.linear.loads
    if blocks is not None and blocks.seat_motions is not None:
        loads = blocks.seat_motions.along_relative(loads)
    if blocks is None or np.delete(loads, blocks.coordinates).any():
        return None
    springs = blocks.springs._replace(
        clearance=machine.imperfections.bearing_clearance,
        loads=loads[blocks.coordinates] * blocks.scale,
    )
    return replace(blocks, springs=springs)


@lru_cache(maxsize=8)
def _unloaded_blocks(machine: Machine) -> StaticBlocks | None:
    """Return `static_blocks` with clearances and loads of zero, or None; machines with the same bodies,
    bearings and meshes share it.
    """
    layout, linear = machine.layout, machine.linear
    stiffness, rows, seat_motions = linear.stiffness, linear.rows, None
    coordinates, scale = _select_unknowns(layout, linear.lengths, rows)
    if machine.casing is not None and machine.casing.frequency_limit is None:
        seat_motions = machine.casing.seat_motion(linear, machine.drive_line)
        stiffness, rows = seat_motions.relative_stiffness(stiffness), seat_motions.along_relative(rows)
        # A mode of the casing takes no load at rest.
        is_moved = ~np.isin(coordinates, seat_motions.modes)
        coordinates, scale = coordinates[is_moved], scale[is_moved]
    if not _has_blocks(layout, coordinates, stiffness, rows):
        return None
    springs = _springs(layout, coordinates, scale, stiffness, rows)
    return StaticBlocks(springs, coordinates, scale, linear.size, seat_motions)


def _has_blocks(layout: Layout, coordinates: Integers, stiffness: Array, rows: Array) -> bool:
    """Whether the pinions couple only through the gears, and each flank touches one pinion alone.

    coordinates (n,): degrees of freedom that statics solves for; stiffness (dof, dof) of the bearings;
    rows (flanks, dof). A spring on a pinion's rotation also gives False.
    """
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
    """Return the compiled problem without clearance and loads.

    coordinates, scale (n,): degree of freedom of each unknown and what 1 m of it is in m or rad; bearing
    (dof, dof): stiffness, N/m; rows (F, dof): derivative of the flanks' deflections.
    """
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


def _select_unknowns(layout: Layout, every_length: Array, rows: Array) -> tuple[Integers, Array]:
    """Return the degree of freedom of each unknown (n,), and what 1 m of it is in m or rad (n,).

    Unknowns are x, y, theta of each pinion, then x, y, z, theta and tilts of each gear, then z of each pinion
    that a flank pushes along its axis, then coordinates added to the layout. `every_length` (dof,): length of
    a unit of each degree of freedom, m; `rows` (flanks, dof): derivative of the flanks' deflections. If some
    gear tilts, the others get tilts of scale 0.
    """
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
    axial = DOF_PER_BODY * np.arange(pinions) + 2
    behind_gears = np.append(axial[rows[:, axial].any(axis=0)], np.arange(layout.dof, every_length.size))
    lengths += every_length[behind_gears].tolist()
    return np.append(coordinates, behind_gears), 1.0 / np.array(lengths)


def _windows(layout: Layout, size: int, by_gear: bool) -> tuple[Integers, Integers]:
    """Return which of `size` unknowns each flank depends on.

    Returns the first unknown of its pinion and the first beside the pinions (flanks, 2), then all of its
    unknowns (flanks, 3 + w): those of its gear if `by_gear`, else all that do not belong to pinions.
    """
    first = 3 * len(layout.pinions)
    width = (size - first) // len(layout.gears) if by_gear else size - first
    starts = [(3 * i, first + (width * g if by_gear else 0)) for i, g in layout.meshes]
    window_starts = np.array(starts * 2)
    columns = [window_starts[:, :1] + np.arange(3), window_starts[:, 1:] + np.arange(width)]
    return window_starts, np.concatenate(columns, axis=1)
