"""Compliance between candidate hats of a position: both bodies, own teeth and neighbours."""

from collections.abc import Sequence

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.averages import NodalLoads, Rows
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.candidates import Candidates
from facegear.machine_code.compiler import compiler, for_callers

compiled, inlined = compiler(), for_callers()
compiled_sums = compiler(fastmath={"contract", "reassoc"})
"""For sums of products, whose terms may be added in any order."""

BLOCK = 128
"""Columns of a compliance that stay in the processor's cache while they are averaged."""


def influence_matrix(
    pairs: list[Candidates],
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool = True,
) -> Array:
    """Approach (m, m) of hat i by a unit force on hat j, m/N, hats of all pairs in order; symmetric.

    `coupled` False leaves out the coupling between neighbouring teeth, for comparison.
    """
    ends = np.cumsum([0] + [len(pair.hats) for pair in pairs])
    matrix = np.zeros((ends[-1], ends[-1]))
    for i, first in enumerate(pairs):
        own = slice(ends[i], ends[i + 1])
        matrix[own, own] = _symmetric(first.pinion.rows, pinion.own) + _symmetric(first.gear.rows, gear.own)
        for j in range(i) if coupled else ():
            second = pairs[j]
            other = slice(ends[j], ends[j + 1])
            teeth_apart = first.tooth - second.tooth
            block = product(first.pinion_coarse, pinion.block(teeth_apart), second.pinion_coarse)
            block += product(first.gear_coarse, gear.block(teeth_apart), second.gear_coarse)
            matrix[own, other] = block
            matrix[other, own] = block.T
    return matrix


def displacement(
    seen: list[Candidates],
    pairs: list[Candidates],
    forces: Array,
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool = True,
) -> Array:
    """Approach (k, t) m at the hats of `seen` by forces (m, t) N on those of `pairs`, t load cases."""
    ends = np.cumsum([len(pair.hats) for pair in pairs])[:-1]
    loads = list(zip(pairs, np.split(forces, ends), strict=True))
    return np.concatenate([_approach(here, loads, pinion, gear, coupled) for here in seen])


def _approach(
    here: Candidates,
    loads: Sequence[tuple[Candidates, Array]],
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool,
) -> Array:
    total = np.zeros((len(here.hats), loads[0][1].shape[1]))
    for pair, force in loads:
        teeth_apart = here.tooth - pair.tooth
        if teeth_apart == 0:
            total += _response(here.pinion, pinion.own, pair.pinion, force)
            total += _response(here.gear, gear.own, pair.gear, force)
        elif coupled:
            total += _response(here.pinion_coarse, pinion.block(teeth_apart), pair.pinion_coarse, force)
            total += _response(here.gear_coarse, gear.block(teeth_apart), pair.gear_coarse, force)
    return total


def _response(seen: NodalLoads, compliance: Array | None, loads: NodalLoads, forces: Array) -> Array:
    if compliance is None:
        return np.zeros((len(seen.rows[0]) - 1, forces.shape[1]))
    return _moved(seen.rows, compliance, loads.rows, np.ascontiguousarray(forces.T))


@compiled_sums
def _moved(seen: Rows, compliance: Array, loads: Rows, forces: Array) -> Array:
    """Rows over the displacements by load cases (t, m) of rows of loads: (k, t)."""
    cases = forces.shape[0]
    pushed = np.zeros(forces.shape[1], np.bool_)
    for t in range(cases):
        for i in range(pushed.size):
            pushed[i] |= forces[t, i] != 0.0
    pointer, index, weight = loads
    mark = np.zeros(compliance.shape[1], np.bool_)
    for i in range(pushed.size):
        for k in range(pointer[i], pointer[i + 1] if pushed[i] else pointer[i]):
            mark[index[k]] = True
    loaded, slot = _listed(mark)
    nodal = np.zeros((cases, loaded.size))
    for i in range(pushed.size):
        for k in range(pointer[i], pointer[i + 1] if pushed[i] else pointer[i]):
            for t in range(cases):
                nodal[t, slot[index[k]]] += weight[k] * forces[t, i]
    used, slot = _used(seen[1], compliance.shape[0])
    moved, line = np.empty((used.size, cases)), np.empty(loaded.size)
    for a in range(used.size):
        for b in range(loaded.size):
            line[b] = compliance[used[a], loaded[b]]
        for t in range(cases):
            total = 0.0
            for b in range(loaded.size):
                total += line[b] * nodal[t, b]
            moved[a, t] = total
    result = np.zeros((seen[0].size - 1, cases))
    for i in range(result.shape[0]):
        for k in range(seen[0][i], seen[0][i + 1]):
            for t in range(cases):
                result[i, t] += seen[2][k] * moved[slot[seen[1][k]], t]
    return result


def product(first: NodalLoads, compliance: Array | None, second: NodalLoads) -> Array:
    """Displacements (m, n) of rows of nodes by unit loads of others, touching only what they have entries
    for.
    """
    if compliance is None:
        return np.zeros((len(first.rows[0]) - 1, len(second.rows[0]) - 1))
    return _product(first.rows, compliance, second.rows)


@compiled
def _product(first: Rows, compliance: Array, second: Rows) -> Array:
    half, slot = _half(first, compliance, second[1])
    pointer, index, weight = second
    result = np.zeros((pointer.size - 1, half.shape[1]))
    for j in range(result.shape[0]):
        for k in range(pointer[j], pointer[j + 1]):
            row, w = slot[index[k]], weight[k]
            for i in range(half.shape[1]):
                result[j, i] += w * half[row, i]
    return np.ascontiguousarray(result.T)


@compiled
def _symmetric(rows: Rows, compliance: Array) -> Array:
    """`_product` of rows with themselves."""
    half, slot = _half(rows, compliance, rows[1])
    pointer, index, weight = rows
    result = np.zeros((pointer.size - 1, pointer.size - 1))
    for j in range(result.shape[0]):
        for k in range(pointer[j], pointer[j + 1]):
            row, w = slot[index[k]], weight[k]
            for i in range(j + 1):
                result[j, i] += w * half[row, i]
    for j in range(result.shape[0]):
        for i in range(j):
            result[i, j] = result[j, i]
    return result


@inlined
def _half(rows: Rows, compliance: Array, columns: Integers) -> tuple[Array, Integers]:
    """Rows times a compliance at the distinct `columns` (c, m), and the number (n,) of each column there."""
    pointer, index, weight = rows
    used, slot = _used(index, compliance.shape[0])
    wanted, number = _used(columns, compliance.shape[1])
    count = pointer.size - 1
    half = np.empty((wanted.size, count))
    part, line = np.empty((used.size, BLOCK)), np.empty(BLOCK)
    for start in range(0, wanted.size, BLOCK):
        size = min(BLOCK, wanted.size - start)
        for a in range(used.size):
            for b in range(size):
                part[a, b] = compliance[used[a], wanted[start + b]]
        for i in range(count):
            line[:size] = 0.0
            for k in range(pointer[i], pointer[i + 1]):
                row, w = slot[index[k]], weight[k]
                for b in range(size):
                    line[b] += w * part[row, b]
            for b in range(size):
                half[start + b, i] = line[b]
    return half, number


@inlined
def _used(indices: Integers, count: int) -> tuple[Integers, Integers]:
    """The distinct indices, rising, and the index of each among them."""
    mark = np.zeros(count, np.bool_)
    for index in indices:
        mark[index] = True
    return _listed(mark)


@inlined
def _listed(mark: Mask) -> tuple[Integers, Integers]:
    """The indices that are marked (n,), rising, and the index of each among them."""
    used = np.flatnonzero(mark)
    slot = np.full(mark.size, -1)
    slot[used] = np.arange(used.size)
    return used, slot
