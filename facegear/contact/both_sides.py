"""A compliance averaged on both of its sides by rows of few nodes, compiled."""

from pathlib import Path

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact import averages
from facegear.contact.averages import Rows
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.lanes import load, multiply_add, splat, store, take
from facegear.machine_code.memory import LANES
from facegear.machine_code.picked import empty_integers, empty_table, integers, table, taken

SOURCES = Path(averages.__file__), *picked.SOURCES
compiled = compiler(*SOURCES, fastmath={"contract", "reassoc"}, error_model="numpy")
"""For sums of products, whose terms may be added in any order."""
inlined, called = for_callers(), for_callers(forceinline=False)

Ends = tuple[np.uint64, np.uint64]
"""Two columns, numbers without a sign: compiled loops look for one at every use of others."""

BLOCK = 128
"""Columns that stay in the processor's cache while they are averaged."""
TOGETHER = 16
"""Rows whose averages are put in columns together: they fill whole lines of the cache."""


@compiled
def add_averages(
    matrix: Array,
    corner: tuple[int, int],
    scale: float,
    seen: Rows,
    compliance: Array,
    loads: Rows,
    own: bool,
) -> None:
    """Add to a matrix from a corner on, at [j, i], the compliance between row i of `seen` (m,) and row j of
    `loads` (n,) times a scale.

    own: both are the same rows and the compliance is symmetric; only j <= i are added. Row i then needs the
    columns of those up to itself alone. A compliance has LANES columns or more.
    """
    begin, slot = fours(loads[1], compliance.shape[1])
    to, first, count = taken(slot, loads[1]), seen[0], seen[0].size - 1
    width, last = LANES * begin.size, loads[0].size - 1
    low, high = _reached(loads[0], to, width, own)
    half, lines = empty_table(width, count + TOGETHER), table(TOGETHER, BLOCK)
    for start in range(0, width, BLOCK):
        size = min(BLOCK, width - start)
        for group in range(0, count, TOGETHER):
            met = min(group + TOGETHER, last) if own else last
            ends = _clipped(low[met], high[met], start, size)
            for i in range(min(TOGETHER, count - group)):
                span = first[group + i], first[group + i + 1]
                _sum_rows(lines, i, span, seen, compliance, begin[start // LANES :], ends)
            for b in range(ends[0], ends[1]):
                for i in range(TOGETHER):
                    half[np.uint64(start) + b, group + i] = lines[i, b]
    for start in range(0, count, BLOCK):
        end = min(start + BLOCK, count)
        for j in range(min(end, last) if own else last):
            ends = _clipped(max(j, start) if own else start, end, 0, end)
            span, begun = (loads[0][j], loads[0][j + 1]), (corner[0] + j, corner[1])
            _add_rows(matrix, begun, scale, span, to, loads[2], half, ends)


@called
def fours(indices: Integers, count: int) -> tuple[Integers, Integers]:
    """The first (f,) of every LANES neighbours among `count` columns, rising, that hold the given ones, and
    at which of their LANES f columns each stands (n,).
    """
    mark, begin, slot = integers(count, 0), empty_integers(indices.size), integers(count, -1)
    for index in indices:
        mark[index] = 1
    filled, end = 0, 0
    for index in range(count):
        if mark[index]:
            if index >= end:
                begin[filled] = min(index, count - LANES)
                end = begin[filled] + LANES
                filled += 1
            slot[index] = LANES * filled - (end - index)
    return begin[:filled], slot


@inlined
def _sum_rows(
    lines: Array, i: int, span: tuple[int, int], rows: Rows, compliance: Array, begin: Integers, ends: Ends
) -> None:
    """Set line i to the sum of a compliance's rows over a span, between two of the columns of `fours`."""
    _, index, weight = rows
    line, width, k = i * BLOCK, compliance.shape[1], span[0]
    some = range(np.int64(ends[0]) // LANES, -(-np.int64(ends[1]) // LANES))
    for q in some:
        store(lines, line + LANES * q, splat(0.0))
    while k + 3 < span[1]:
        a, b, c, d = index[k] * width, index[k + 1] * width, index[k + 2] * width, index[k + 3] * width
        u, v, w, x = splat(weight[k]), splat(weight[k + 1]), splat(weight[k + 2]), splat(weight[k + 3])
        for q in some:
            at, to = take(begin, q), line + LANES * q
            total = multiply_add(u, load(compliance, a + at), load(lines, to))
            total = multiply_add(v, load(compliance, b + at), total)
            total = multiply_add(w, load(compliance, c + at), total)
            store(lines, to, multiply_add(x, load(compliance, d + at), total))
        k += 4
    while k < span[1]:
        a, u = index[k] * width, splat(weight[k])
        for q in some:
            to = line + LANES * q
            store(lines, to, multiply_add(u, load(compliance, a + take(begin, q)), load(lines, to)))
        k += 1


@inlined
def _add_rows(
    matrix: Array,
    begin: tuple[int, int],
    scale: float,
    span: tuple[int, int],
    index: Integers,
    weight: Array,
    rows: Array,
    ends: Ends,
) -> None:
    """Add to a matrix, in the row and from the column `begin` on, the sum of rows numbered `index` by weight
    and scale, over a span of both, between two columns.
    """
    k, end = span
    line, shift = begin[0], np.uint64(begin[1])
    while k + 3 < end:
        a, b, c, d = index[k], index[k + 1], index[k + 2], index[k + 3]
        u, v, w, x = scale * weight[k], scale * weight[k + 1], scale * weight[k + 2], scale * weight[k + 3]
        for i in range(ends[0], ends[1]):
            matrix[line, shift + i] += u * rows[a, i] + v * rows[b, i] + w * rows[c, i] + x * rows[d, i]
        k += 4
    while k < end:
        a, u = index[k], scale * weight[k]
        for i in range(ends[0], ends[1]):
            matrix[line, shift + i] += u * rows[a, i]
        k += 1


@inlined
def _clipped(low: int, high: int, start: int, size: int) -> Ends:
    """A range of columns as part of `size` columns from `start` on; empty ranges end where they begin."""
    begin = min(max(low - start, 0), size)
    return np.uint64(begin), np.uint64(max(min(high - start, size), begin))


@called
def _reached(pointer: Integers, column: Integers, columns: int, own: bool) -> tuple[Integers, Integers]:
    """Between which columns the first 0, 1 ... n rows have theirs (n + 1,), if they are `own`, else all."""
    low, high = integers(pointer.size, columns), integers(pointer.size, 0)
    for j in range(pointer.size - 1):
        low[j + 1], high[j + 1] = low[j], high[j]
        for k in range(pointer[j], pointer[j + 1]):
            low[j + 1], high[j + 1] = min(low[j + 1], column[k]), max(high[j + 1], column[k] + 1)
    for j in range(0 if own else pointer.size):
        low[j], high[j] = 0, columns
    return low, high
