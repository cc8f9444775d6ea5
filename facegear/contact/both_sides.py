"""A compliance averaged on both of its sides by rows of few nodes, compiled."""

from pathlib import Path

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact import averages
from facegear.contact.averages import Rows
from facegear.machine_code import picked, prefetch
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import empty_table, integers, listed, table, taken, unsigned
from facegear.machine_code.prefetch import LINE, request

SOURCES = Path(averages.__file__), Path(picked.__file__), Path(prefetch.__file__)
compiled = compiler(*SOURCES, fastmath={"contract", "reassoc"}, error_model="numpy")
"""For sums of products, whose terms may be added in any order."""
inlined, called = for_callers(), for_callers(forceinline=False)

Ends = tuple[np.uint64, np.uint64]
"""Two columns, numbers without a sign: compiled loops look for one at every use of others."""

BLOCK = 128
"""Columns that stay in the processor's cache while they are averaged."""
AHEAD = 2
"""Rows of the compliance ahead of use that are requested from memory."""
HALF_LINE = np.uint64(LINE // 2)
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
    columns of those up to itself alone.
    """
    used, slot = used_of(seen[1], compliance.shape[0])
    wanted, number = used_of(loads[1], compliance.shape[1])
    at, to, column = taken(slot, seen[1]), taken(number, loads[1]), unsigned(wanted)
    first, count, last = seen[0], seen[0].size - 1, loads[0].size - 1
    low, high = _reached(loads[0], to, wanted.size, own)
    low_of, high_of = _needed(first, at, used.size, (low, high), own)
    half, part = empty_table(wanted.size, count + TOGETHER), empty_table(used.size, BLOCK)
    lines = table(TOGETHER, BLOCK)
    for start in range(0, wanted.size, BLOCK):
        size = min(BLOCK, wanted.size - start)
        for a in range(used.size):
            following = np.uint64(used[min(a + AHEAD, used.size - 1)])
            row, ends = used[a], _clipped(low_of[a], high_of[a], start, size)
            for b in range(ends[0], ends[1], HALF_LINE):
                request(compliance, following, column[np.uint64(start) + b])
            for b in range(ends[0], ends[1]):
                part[a, b] = compliance[row, column[np.uint64(start) + b]]
        for group in range(0, count, TOGETHER):
            met = min(group + TOGETHER, last) if own else last
            ends = _clipped(low[met], high[met], start, size)
            for i in range(min(TOGETHER, count - group)):
                for b in range(ends[0], ends[1]):
                    lines[i, b] = 0.0
                span = first[group + i], first[group + i + 1]
                _add_rows(lines, (i, 0), 1.0, span, at, seen[2], part, ends)
            for b in range(ends[0], ends[1]):
                for i in range(TOGETHER):
                    half[np.uint64(start) + b, group + i] = lines[i, b]
    for start in range(0, count, BLOCK):
        end = min(start + BLOCK, count)
        for j in range(min(end, last) if own else last):
            ends = _clipped(max(j, start) if own else start, end, 0, end)
            span, begin = (loads[0][j], loads[0][j + 1]), (corner[0] + j, corner[1])
            _add_rows(matrix, begin, scale, span, to, loads[2], half, ends)


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


@called
def _needed(
    pointer: Integers, node: Integers, nodes: int, reached: tuple[Integers, Integers], own: bool
) -> tuple[Integers, Integers]:
    """Between which columns each node (u,) is asked for by rows, TOGETHER of which take what is `_reached` by
    the last of them.
    """
    low, high = integers(nodes, reached[1][-1]), integers(nodes, 0)
    last = reached[0].size - 1
    for i in range(pointer.size - 1):
        met = min(i - i % TOGETHER + TOGETHER, last) if own else last
        for k in range(pointer[i], pointer[i + 1]):
            low[node[k]] = min(low[node[k]], reached[0][met])
            high[node[k]] = max(high[node[k]], reached[1][met])
    return low, high


@called
def used_of(indices: Integers, count: int) -> tuple[Integers, Integers]:
    """The distinct indices, rising, and the index of each among them."""
    mark = integers(count, 0)
    for index in indices:
        mark[index] = 1
    return listed(mark)
