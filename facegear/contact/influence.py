"""Compliance between candidate hats of a position: both bodies, own teeth and neighbours."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact import spreading
from facegear.contact.averages import Rows
from facegear.contact.bodies import surface
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.candidates import Candidates
from facegear.contact.spreading import Faces, Lattice, NodalLoads
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import (
    empty_integers,
    empty_numbers,
    empty_table,
    integers,
    marked,
    table,
    taken,
)

SOURCES = Path(spreading.__file__), Path(surface.__file__), Path(picked.__file__)
compiled, inlined, called = compiler(*SOURCES), for_callers(), for_callers(forceinline=False)
compiled_sums = compiler(*SOURCES, fastmath={"contract", "reassoc"}, error_model="numpy")
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
        for side, body in enumerate((pinion, gear)):
            add_own(matrix, int(ends[i]), first.loads(side, True).rows, body.own, body.scale)
        for j in range(i) if coupled else ():
            second = pairs[j]
            for side, body in enumerate((pinion, gear)):
                seen, loads = first.loads(side, False), second.loads(side, False)
                block = body.scale * product(seen, body.block(first.tooth - second.tooth), loads)
                matrix[ends[i] : ends[i + 1], ends[j] : ends[j + 1]] += block
    mirror(matrix)
    return matrix


@compiled
def mirror(matrix: Array) -> None:
    """Fill in what is above the diagonal by what is below it."""
    for i in range(len(matrix)):
        for j in range(i):
            matrix[j, i] = matrix[i, j]


def product(first: NodalLoads, compliance: Array | None, second: NodalLoads) -> Array:
    """Displacements (m, n) of rows of nodes by unit loads of others, touching only what they have entries
    for.
    """
    if compliance is None:
        return np.zeros((len(first.rows[0]) - 1, len(second.rows[0]) - 1))
    return _product(first.rows, compliance, second.rows)


@compiled_sums
def _product(first: Rows, compliance: Array, second: Rows) -> Array:
    half, slot = _half(first, compliance, second[1])
    pointer, index, weight = second
    at = taken(slot, index)
    result, line = empty_table(first[0].size - 1, pointer.size - 1), empty_numbers(half.shape[1])
    for j in range(result.shape[1]):
        _sum_of_rows((pointer[j], pointer[j + 1]), at, weight, half, line, line.size)
        for i in range(line.size):
            result[i, j] = line[i]
    return result


@compiled_sums
def add_own(matrix: Array, origin: int, rows: Rows, compliance: Array, scale: float) -> None:
    """Add `_product` of rows with themselves by a symmetric compliance times a scale, from row and column
    `origin` on, below the diagonal.

    Rows are taken in the order of their first nodes, so that each meets those after it, and of the first
    product only the columns from its own first node on.
    """
    pointer, index, weight = rows
    used, slot = used_of(index, compliance.shape[0])
    at, count = taken(slot, index), pointer.size - 1
    order, first, end = _by_first(pointer, at, used.size)
    half, part = empty_table(used.size, count), empty_table(used.size, BLOCK)
    line = empty_numbers(max(BLOCK, count))
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
        for i in range(j + 1):
            matrix[origin + max(row, order[i]), origin + min(row, order[i])] += line[i]


@inlined
def _sum_of_rows(
    span: tuple[int, int], index: Integers, weight: Array, rows: Array, total: Array, size: int
) -> None:
    """Fill in the sum of rows numbered `index` by weight, over a span of both, as far as `size`."""
    k, end = span
    for i in range(size):
        total[i] = 0.0
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


@called
def _by_first(pointer: Integers, index: Integers, columns: int) -> tuple[Integers, Integers, Integers]:
    """Numbers (m,) of rows in the order of their first column, and of each in that order its first column and
    where its columns end.
    """
    count = pointer.size - 1
    first, end = integers(count, columns), integers(count, 0)
    begin = integers(columns + 2, 0)
    for i in range(count):
        for k in range(pointer[i], pointer[i + 1]):
            first[i], end[i] = min(first[i], index[k]), max(end[i], index[k] + 1)
        begin[first[i] + 1] += 1
    for column in range(columns + 1):
        begin[column + 1] += begin[column]
    order = empty_integers(count)
    for i in range(count):
        order[begin[first[i]]] = i
        begin[first[i]] += 1
    return order, taken(first, order), taken(end, order)


@called
def _half(rows: Rows, compliance: Array, columns: Integers) -> tuple[Array, Integers]:
    """Rows times a compliance at the distinct `columns` (c, m), and the number (n,) of each column there."""
    pointer, index, weight = rows
    used, slot = used_of(index, compliance.shape[0])
    wanted, number = used_of(columns, compliance.shape[1])
    at, count = taken(slot, index), pointer.size - 1
    half = empty_table(wanted.size, count)
    part, line = empty_table(used.size, BLOCK), empty_numbers(BLOCK)
    for start in range(0, wanted.size, BLOCK):
        size = min(BLOCK, wanted.size - start)
        for a in range(used.size):
            for b in range(size):
                part[a, b] = compliance[used[a], wanted[start + b]]
        for i in range(count):
            _sum_of_rows((pointer[i], pointer[i + 1]), at, weight, part, line, size)
            for b in range(size):
                half[start + b, i] = line[b]
    return half, number


@called
def used_of(indices: Integers, count: int) -> tuple[Integers, Integers]:
    """The distinct indices, rising, and the index of each among them."""
    mark = integers(count, 0)
    for index in indices:
        mark[index] = 1
    return listed(mark)


@called
def listed(mark: Integers) -> tuple[Integers, Integers]:
    """The indices whose marks (n,) are not 0, rising, and the index of each among them."""
    used, slot = marked(mark), integers(mark.size, -1)
    for i in range(used.size):
        slot[used[i]] = i
    return used, slot


@called
def part_of(rows: Rows, begin: int, end: int) -> Rows:
    """Rows from `begin` to `end`."""
    pointer, index, weight = rows
    first, last = pointer[begin], pointer[end]
    here = empty_integers(end + 1 - begin)
    for i in range(here.size):
        here[i] = pointer[begin + i] - first
    return here, index[first:last], weight[first:last]


class Surface(NamedTuple):
    """Contact surface of a gear: its elements' `faces` on the refined nodes and on the `coarse` ones before
    refinement, and `own`, `others` and `scale` of its `FlankCompliance`.
    """

    faces: Faces
    coarse: Faces
    own: Array
    others: Array
    scale: float


@compiled
def influence(
    ends: Integers,
    teeth: Integers,
    surfaces: tuple[Surface, Surface],
    loads: tuple[Rows, Rows],
    coarse: tuple[Rows, Rows],
    coupled: bool,
) -> Array:
    """`influence_matrix` of the hats of pairs `teeth` (p,) that end at `ends` (p + 1,), 0 first.

    Loads of all of them on the nodes of both surfaces, and on those before refinement.
    """
    matrix = table(ends[-1], ends[-1])
    for i in range(teeth.size):
        for side in range(2):
            body = surfaces[side]
            own = part_of(loads[side], ends[i], ends[i + 1])
            add_own(matrix, ends[i], own, body.own, body.scale)
            reach = len(body.others) // 2
            for j in range(i if coupled else 0):
                if abs(teeth[i] - teeth[j]) <= reach:
                    seen = part_of(coarse[side], ends[i], ends[i + 1])
                    other = part_of(coarse[side], ends[j], ends[j + 1])
                    block = _product(seen, body.others[teeth[i] - teeth[j] + reach], other)
                    for a in range(block.shape[0]):
                        for b in range(block.shape[1]):
                            matrix[ends[i] + a, ends[j] + b] += body.scale * block[a, b]
    mirror(matrix)
    return matrix


def surface_of(lattice: Lattice, body: FlankCompliance) -> Surface:
    """Of nodes and compliance of one gear, whose arrays are those of the other in kind."""
    own, others = (
        np.require(array, requirements=["C", "W"]) for array in (_rows_first(body.own), body.others)
    )
    return Surface(lattice.faces(True), lattice.faces(False), own, others, body.scale)


def _rows_first(symmetric: Array) -> Array:
    """A symmetric matrix in the order of its rows, without a copy where it is in that of its columns."""
    return symmetric.T if symmetric.flags.f_contiguous else symmetric
