"""Averages over points under hats, and the hats that a turn closes; compiled."""

from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import (
    empty_integers,
    empty_numbers,
    integers,
    marked,
    marks,
    numbers,
    taken,
)
from facegear.machine_code.records import Record

compiled = compiler(*picked.SOURCES)
inlined, called = for_callers(), for_callers(forceinline=False)

ALIKE = 1e-12
"""Difference of weights that count as equal."""

Rows = tuple[Integers, Integers, Array]
"""Row i takes `index` by `weight` from pointer[i] to pointer[i + 1]: pointer, index and weight."""


@Record.register
class HatPoints(NamedTuple):
    """Points (q,) of one tooth that may face a tooth of the other gear, and the hats that they lie under.

    gap (q,) m, lever_arm (q,) m, and refined lattice coordinates `pinion` and `gear` (q, 2) on both teeth,
    nan or inf where nothing is opposite; `hats` and `values` (q, 4): hats that a point lies under and their
    values there, and `area` (q,) that it stands for.
    """

    gap: Array
    lever_arm: Array
    pinion: Array
    gear: Array
    hats: Integers
    values: Array
    area: Array

    def part(self, rows: slice) -> "HatPoints":
        """Some of the points."""
        gap, lever_arm, pinion, gear, hats, values, area = self
        return HatPoints(
            gap[rows], lever_arm[rows], pinion[rows], gear[rows], hats[rows], values[rows], area[rows]
        )


@compiled
def rows_of(pointer: Integers, index: Integers, weight: Array, keep: Mask) -> Rows:
    """The rows marked (m,)."""
    chosen = integers(marked(keep).size + 1, 0)
    row = 0
    for i in range(keep.size):
        if keep[i]:
            chosen[row + 1] = chosen[row] + pointer[i + 1] - pointer[i]
            row += 1
    kept, values = empty_integers(chosen[row]), empty_numbers(chosen[row])
    row = 0
    for i in range(keep.size):
        if keep[i]:
            for k in range(pointer[i + 1] - pointer[i]):
                kept[chosen[row] + k] = index[pointer[i] + k]
                values[chosen[row] + k] = weight[pointer[i] + k]
            row += 1
    return chosen, kept, values


class Hats(NamedTuple):
    """Hats (m,) of the pairs of teeth of a position that may touch, pair by pair.

    `pair` (m,) numbers them; lattice `node` (m,) of each, gap (m,) m, lever_arm (m,) m, whether it presses on
    a `fillet` (m,); `rows`: averages over the points of all pairs.
    """

    pair: Integers
    node: Integers
    gap: Array
    lever_arm: Array
    fillet: Mask
    rows: Rows


@inlined
def _facing(points: HatPoints, q: int) -> bool:
    sum_of_all = points.pinion[q, 0] + points.pinion[q, 1] + points.gear[q, 0] + points.gear[q, 1]
    return bool(np.isfinite(points.gap[q] + sum_of_all))


@called
def _hat_averages(points: HatPoints, starts: Integers, min_area: Array) -> tuple[Rows, Integers]:
    """Averages by area over the points under each hat, and the hats (m,) of which enough is covered, those of
    pair k numbered from k times the number of hats on.
    """
    hats, values, area = points.hats, points.values, points.area
    size, pairs = min_area.size, starts.size - 1
    covered, count = numbers(pairs * size, 0.0), integers(pairs * size, 0)
    on = marks(area.size, False)
    for pair in range(pairs):
        for q in range(starts[pair], starts[pair + 1]):
            on[q] = _facing(points, q)
            for h in range(hats.shape[1] if on[q] else 0):
                if values[q, h] != 0.0:
                    covered[pair * size + hats[q, h]] += values[q, h] * area[q]
                    count[pair * size + hats[q, h]] += 1
    chosen, slot = empty_integers(covered.size), integers(covered.size, -1)
    pointer, filled = integers(covered.size + 1, 0), 0
    for hat in range(covered.size):
        if covered[hat] > min_area[hat % size]:
            chosen[filled], slot[hat] = hat, pointer[filled]
            pointer[filled + 1] = pointer[filled] + count[hat]
            filled += 1
    index, weight = empty_integers(pointer[filled]), empty_numbers(pointer[filled])
    for pair in range(pairs):
        for q in range(starts[pair], starts[pair + 1]):
            for h in range(hats.shape[1] if on[q] else 0):
                hat = pair * size + hats[q, h]
                if values[q, h] != 0.0 and slot[hat] >= 0:
                    index[slot[hat]] = q
                    weight[slot[hat]] = values[q, h] * area[q] / covered[hat]
                    slot[hat] += 1
    return (pointer[: filled + 1], index, weight), chosen[:filled]


@inlined
def _nearest_node(rows: Rows, row: int, at: Array, columns: int) -> int:
    """The lattice node nearest to the heaviest point of a row, the first of those alike."""
    pointer, index, weight = rows
    best = pointer[row]
    for k in range(pointer[row], pointer[row + 1]):
        if weight[k] > weight[best] + ALIKE:
            best = k
    point = index[best]
    return int(np.rint(at[point, 0])) * columns + int(np.rint(at[point, 1]))


@compiled
def closing(
    points: HatPoints,
    starts: Integers,
    min_area: Array,
    first: int,
    shape: tuple[int, int],
    flank_ends: tuple[float, float],
    limit: float,
) -> Hats:
    """The hats that a turn by `limit` (rad) closes, of pairs whose points begin at `starts` (p + 1,).

    Of each pair the hats from `first` on are those of the nodes of the lattice of that shape, before and
    after them those of edges. flank_ends: the refined rows beyond which the fillets of both gears begin.
    """
    rows, chosen = _hat_averages(points, starts, min_area)
    pointer, index, weight = rows
    pair, node = empty_integers(chosen.size), empty_integers(chosen.size)
    gap, lever_arm = numbers(chosen.size, 0.0), numbers(chosen.size, 0.0)
    fillet, near = marks(chosen.size, False), marks(chosen.size, False)
    for i in range(chosen.size):
        beyond, pair[i], node[i] = 0.0, chosen[i] // min_area.size, chosen[i] % min_area.size - first
        for k in range(pointer[i], pointer[i + 1]):
            q, w = index[k], weight[k]
            gap[i] += w * points.gap[q]
            lever_arm[i] += w * points.lever_arm[q]
            if points.pinion[q, 0] > flank_ends[0] or points.gear[q, 0] > flank_ends[1]:
                beyond += w
        fillet[i] = beyond > 0.5
        near[i] = gap[i] < limit * lever_arm[i]
        if near[i] and not 0 <= node[i] < shape[0] * shape[1]:
            node[i] = _nearest_node(rows, i, points.pinion, shape[1])
    kept = rows_of(pointer, index, weight, near)
    some = marked(near)
    pair, node, fillet = taken(pair, some), taken(node, some), taken(fillet, some)
    return Hats(pair, node, taken(gap, some), taken(lever_arm, some), fillet, kept)
