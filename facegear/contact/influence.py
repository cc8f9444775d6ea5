"""Compliance between candidate hats of a position: both bodies, own teeth and neighbours."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact import averages
from facegear.contact.averages import Faces, NodalLoads, Rows, functions_at
from facegear.contact.bodies import surface
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.candidates import Candidates
from facegear.machine_code.compiler import compiler, for_callers

compiled, inlined = compiler(), for_callers()
compiled_sums = compiler(
    Path(averages.__file__), Path(surface.__file__), fastmath={"contract", "reassoc"}, error_model="numpy"
)
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
        for side, body in enumerate((pinion, gear)):
            _add_symmetric(matrix, int(ends[i]), first.loads(side, True).rows, body.own, body.scale)
        for j in range(i) if coupled else ():
            second = pairs[j]
            other = slice(ends[j], ends[j + 1])
            teeth_apart = first.tooth - second.tooth
            block = np.zeros((len(first.hats), len(second.hats)))
            for side, body in enumerate((pinion, gear)):
                seen, loads = first.loads(side, False), second.loads(side, False)
                block += body.scale * product(seen, body.block(teeth_apart), loads)
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
    for side, body in enumerate((pinion, gear)):
        for refined in (True, False) if coupled and len(loads) > 1 else (True,):
            faces = here.lattices[side].faces(refined)
            base, values, used, slot = _functions(here.averages[1], here.at[side], faces)
            moved = np.zeros((used.size, total.shape[1]))
            for pair, force in loads:
                teeth_apart = here.tooth - pair.tooth
                compliance = body.own if refined else body.block(teeth_apart)
                if (teeth_apart == 0) == refined and compliance is not None:
                    pushed = np.ascontiguousarray(body.scale * force.T)
                    _move(moved, used, compliance, pair.loads(side, refined).rows, pushed)
            _add_averages(total, here.averages, base, values, faces, slot, moved)
    return total


@compiled_sums
def _functions(index: Integers, at: Array, faces: Faces) -> tuple[Integers, Array, Integers, Integers]:
    """`functions_at` points at coordinates (q, 2), the nodes (u,) of their faces, and the number of each node
    of the lattice among those.
    """
    base, values = functions_at(index, at, faces)
    offset = faces.steps[:, 0] * faces.shape[1] + faces.steps[:, 1]
    mark = np.zeros(faces.shape[0] * faces.shape[1], np.bool_)
    for first in base:
        for a in range(offset.size if first >= 0 else 0):
            mark[first + offset[a]] = True
    used, slot = _listed(mark)
    return base, values, used, slot


@compiled_sums
def _move(moved: Array, used: Integers, compliance: Array, loads: Rows, forces: Array) -> None:
    """Add to displacements (u, t) of nodes (u,) those by load cases (t, m) of rows of nodal loads."""
    loaded, nodal = _nodal(loads, forces, compliance.shape[1])
    line = np.empty(loaded.size)
    for a in range(used.size):
        row = compliance[used[a]]
        for b in range(loaded.size):
            line[b] = row[loaded[b]]
        for t in range(forces.shape[0]):
            total = 0.0
            for b in range(loaded.size):
                total += line[b] * nodal[t, b]
            moved[a, t] += total


@compiled_sums
def _add_averages(
    total: Array, rows: Rows, base: Integers, values: Array, faces: Faces, slot: Integers, moved: Array
) -> None:
    """Add to rows (k, t) over points the displacements (u, t) of the faces' nodes, numbered by `slot`."""
    pointer, index, weight = rows
    cases = total.shape[1]
    offset = faces.steps[:, 0] * faces.shape[1] + faces.steps[:, 1]
    there = np.zeros((base.size, cases))
    for point in range(base.size):
        for a in range(offset.size if base[point] >= 0 else 0):
            node, value = slot[base[point] + offset[a]], values[point, a]
            for t in range(cases):
                there[point, t] += value * moved[node, t]
    for i in range(pointer.size - 1):
        for k in range(pointer[i], pointer[i + 1]):
            for t in range(cases):
                total[i, t] += weight[k] * there[index[k], t]


@inlined
def _nodal(loads: Rows, forces: Array, nodes: int) -> tuple[Integers, Array]:
    """The nodes (l,) that load cases (t, m) of rows load, and the loads (t, l) on them."""
    pointer, index, weight = loads
    every = np.zeros((nodes, forces.shape[0]))
    mark = np.zeros(nodes, np.bool_)
    for i in range(forces.shape[1]):
        pushes = False
        for t in range(forces.shape[0]):
            pushes |= forces[t, i] != 0.0
        for k in range(pointer[i], pointer[i + 1] if pushes else pointer[i]):
            mark[index[k]] = True
            for t in range(forces.shape[0]):
                every[index[k], t] += weight[k] * forces[t, i]
    loaded = np.flatnonzero(mark)
    return loaded, np.ascontiguousarray(every[loaded].T)


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


@compiled_sums
def _add_symmetric(matrix: Array, origin: int, rows: Rows, compliance: Array, scale: float) -> None:
    """Add `_product` of rows with themselves by a symmetric compliance times a scale, from row and column
    `origin` on.

    Rows are taken in the order of their first nodes, so that each meets those after it, and of the first
    product only the columns from its own first node on.
    """
    pointer, index, weight = rows
    used, slot = _used(index, compliance.shape[0])
    at, count = slot[index], pointer.size - 1
    order, first, end = _by_first(pointer, at, used.size)
    half, part = np.empty((used.size, count)), np.empty((used.size, BLOCK))
    line = np.empty(max(BLOCK, count))
    for start in range(0, used.size, BLOCK):
        size = min(BLOCK, used.size - start)
        begun = filled = 0
        while begun < count and first[begun] < start + size:
            for a in range(filled, end[begun]):
                for b in range(size):
                    part[a, b] = scale * compliance[used[a], used[start + b]]
            filled = max(filled, end[begun])
            row = order[begun]
            _sum_of_rows((pointer[row], pointer[row + 1]), at, weight, part, line, size)
            for b in range(size):
                half[start + b, begun] = line[b]
            begun += 1
    for j in range(count):
        row = order[j]
        _sum_of_rows((pointer[row], pointer[row + 1]), at, weight, half, line, j + 1)
        for i in range(j):
            matrix[origin + row, origin + order[i]] += line[i]
            matrix[origin + order[i], origin + row] += line[i]
        matrix[origin + row, origin + row] += line[j]


@inlined
def _sum_of_rows(
    span: tuple[int, int], index: Integers, weight: Array, rows: Array, total: Array, size: int
) -> None:
    """Fill in the sum of rows numbered `index` by weight, over a span of both, as far as `size`."""
    k, end = span
    total[:size] = 0.0
    while k + 3 < end:
        a, b, c, d = index[k], index[k + 1], index[k + 2], index[k + 3]
        u, v, w, x = weight[k], weight[k + 1], weight[k + 2], weight[k + 3]
        for i in range(size):
            total[i] += u * rows[a, i] + v * rows[b, i] + w * rows[c, i] + x * rows[d, i]
        k += 4
    while k < end:
        a, u = index[k], weight[k]
        for i in range(size):
            total[i] += u * rows[a, i]
        k += 1


@inlined
def _by_first(pointer: Integers, index: Integers, columns: int) -> tuple[Integers, Integers, Integers]:
    """Numbers (m,) of rows in the order of their first column, and of each in that order its first column and
    where its columns end.
    """
    count = pointer.size - 1
    first, end = np.full(count, columns), np.zeros(count, np.int64)
    begin = np.zeros(columns + 2, np.int64)
    for i in range(count):
        for k in range(pointer[i], pointer[i + 1]):
            first[i], end[i] = min(first[i], index[k]), max(end[i], index[k] + 1)
        begin[first[i] + 1] += 1
    begin = np.cumsum(begin)
    order = np.empty(count, np.int64)
    for i in range(count):
        order[begin[first[i]]] = i
        begin[first[i]] += 1
    return order, first[order], end[order]


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
