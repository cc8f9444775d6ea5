"""Statics as the compiled solver takes it: three unknowns for each pinion, and a core for all else."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from facegear.arrays import Array, Integers
from facegear.transmission.block_statics import Springs
from facegear.transmission.layout import DOF_PER_BODY, Layout
from facegear.transmission.machine import Machine


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
    return _frame(machine.without_errors)


@lru_cache(maxsize=8)
def _frame(machine: Machine) -> _Frame:
    layout, linear = machine.layout, machine.linear
    stiffness, rows, lengths = linear.stiffness, linear.rows, linear.lengths
    coordinates, scale = _select_unknowns(layout, lengths)
    blocks, springs = (
        _blocks(layout, coordinates, stiffness, rows),
        _springs(layout, coordinates, scale, stiffness, rows),
    )
    return _Frame(blocks, coordinates, scale, springs)


def _blocks(layout: Layout, coordinates: Integers, stiffness: Array, rows: Array) -> bool:
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
