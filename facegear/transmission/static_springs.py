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
    """What machines of the same bodies, bearings and meshes have in common, shared by them: has_blocks()
    without loads, what unknowns() gives, and the compiled problem without clearance and loads.
    """

    blocks: bool
    kept: Integers
    scale: Array
    springs: Springs


def has_blocks(machine: Machine) -> bool:
    """Whether bearings join no pinion with anything else, and each flank touches one pinion alone."""
    frame = _frame_of(machine)
    kept = np.zeros(machine.linear.size, dtype=bool)
    kept[frame.kept] = True
    return frame.blocks and not machine.linear.loads[~kept].any()


def static_springs(machine: Machine) -> Springs:
    """The compiled problem in the unknowns of `unknowns`."""
    frame, linear = _frame_of(machine), machine.linear
    loads = linear.loads[frame.kept] * frame.scale
    return frame.springs._replace(clearance=machine.imperfections.bearing_clearance, loads=loads)


def unknowns(machine: Machine) -> tuple[Integers, Array]:
    """Degrees of freedom (n,) that the compiled problem keeps, and the m or rad of its unknowns (n,).

    Left out is the pinions' motion along their own axes, which no mesh feels. If one gear may
    rock, another that may not is given tilts of no length. Coordinates beside those of the layout come last.
    """
    frame = _frame_of(machine)
    return frame.kept, frame.scale


def _frame_of(machine: Machine) -> _Frame:
    return _frame(machine.alike)


@lru_cache(maxsize=8)
def _frame(machine: Machine) -> _Frame:
    layout, linear = machine.layout, machine.linear
    stiffness, rows, lengths = linear.stiffness, linear.rows, linear.lengths
    kept, scale = _unknowns(layout, lengths)
    blocks, springs = _blocks(layout, kept, stiffness, rows), _springs(layout, kept, scale, stiffness, rows)
    return _Frame(blocks, kept, scale, springs)


def _blocks(layout: Layout, kept: Integers, stiffness: Array, rows: Array) -> bool:
    size, pinions = len(stiffness), len(layout.pinions)
    group = np.full(size, -1)
    group[kept[: 3 * pinions]] = np.repeat(np.arange(pinions), 3)
    left_out = np.setdiff1d(np.arange(size), kept)
    group[left_out] = pinions + np.arange(left_out.size)
    turns = kept[2 : 3 * pinions : 3]
    joined = (stiffness != 0.0) & (group[:, None] != group)
    own = np.array([i for i, _ in layout.meshes] * 2)[:, None]
    strange = (rows != 0.0) & (group != -1) & (group != own)
    return not (joined.any() or strange.any() or stiffness[turns].any())


def _springs(layout: Layout, kept: Integers, scale: Array, bearing: Array, rows: Array) -> Springs:
    """Without clearance and loads."""
    first, jacobian = 3 * len(layout.pinions), rows[:, kept] * scale
    touched, columns = _windows(layout, kept.size, len(bearing) == layout.dof)
    if np.count_nonzero(np.take_along_axis(jacobian, columns, axis=1)) < np.count_nonzero(jacobian):
        touched, columns = _windows(layout, kept.size, False)
    x, y = kept[0:first:3], kept[1:first:3]
    core = bearing[np.ix_(kept[first:], kept[first:])] * np.outer(scale[first:], scale[first:])
    row, column = np.nonzero(np.triu(core))
    return Springs(
        jacobian=np.take_along_axis(jacobian, columns, axis=1),
        pinion=touched[:, 0].copy(),
        gear=touched[:, 1].copy(),
        pinion_bearing=np.stack([bearing[x, x], bearing[x, y], bearing[y, y]], axis=1),
        clearance=np.zeros(len(layout.pinions)),
        core_row=row.copy(),  # np.nonzero gives them with strides, and every call would copy them
        core_column=column.copy(),
        core_value=core[row, column],
        loads=np.zeros(kept.size),
    )


def _unknowns(layout: Layout, every_length: Array) -> tuple[Integers, Array]:
    kept: list[int] = []
    lengths: list[float] = []
    pinions, bodies = len(layout.pinions), len(layout.bodies)
    for body in range(bodies):
        own = DOF_PER_BODY * body + np.array([0, 1, 3] if body < pinions else [0, 1, 2, 3])
        kept += own.tolist()
        lengths += every_length[own].tolist()
        if body >= pinions and layout.tilting:
            rocks = body - pinions in layout.tilting
            at = layout.first_tilts[body - pinions if rocks else layout.tilting[0]]
            kept += [at, at + 1]
            lengths += 2 * [every_length[at] if rocks else np.inf]
    added = np.arange(layout.dof, every_length.size)
    return np.append(kept, added), 1.0 / np.append(lengths, every_length[added])


def _windows(layout: Layout, size: int, by_gear: bool) -> tuple[Integers, Integers]:
    """Where the unknowns that each flank touches start, of its pinion and beside the pinions (flanks, 2), and
    all of them (flanks, ...): those of its own gear, or the whole core.
    """
    first = 3 * len(layout.pinions)
    width = (size - first) // len(layout.gears) if by_gear else size - first
    starts = [(3 * i, first + (width * g if by_gear else 0)) for i, g in layout.meshes]
    touched = np.array(starts * 2)
    columns = [touched[:, :1] + np.arange(3), touched[:, 1:] + np.arange(width)]
    return touched, np.concatenate(columns, axis=1)
