"""Averages over points under hats, and the nodal loads that unit forces spread by them make; compiled."""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies import surface
from facegear.contact.bodies.surface import LINEAR_STEPS, QUADRATIC_STEPS, locate
from facegear.contact.options import Refinement
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import (
    empty_integers,
    empty_numbers,
    empty_table,
    integers,
    marked,
    numbers,
    taken,
)

compiled = compiler(Path(surface.__file__), Path(picked.__file__))
inlined, called = for_callers(), for_callers(forceinline=False)

ROUNDING = 1e-6
"""Of coordinates on a lattice."""
ALIKE = 1e-12
"""Difference of weights that count as equal."""

Rows = tuple[Integers, Integers, Array]
"""Row i takes `index` by `weight` from pointer[i] to pointer[i + 1]: pointer, index and weight."""


@dataclass(frozen=True, eq=False)
class NodalLoads:
    """Forces on `nodes` nodes of a lattice by m unit forces, one a row."""

    rows: Rows
    nodes: int

    def by(self, forces: Array) -> Array:
        """Forces (nodes,) N on the nodes by forces (m,) N."""
        return _by(*self.rows, forces, self.nodes)


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


@compiled
def _by(pointer: Integers, index: Integers, weight: Array, forces: Array, nodes: int) -> Array:
    total = np.zeros(nodes)
    for i in range(forces.size):
        if forces[i] != 0.0:
            for k in range(pointer[i], pointer[i + 1]):
                total[index[k]] += weight[k] * forces[i]
    return total


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
    on = np.empty(area.size, np.bool_)
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
    fillet, near = np.zeros(chosen.size, np.bool_), np.zeros(chosen.size, np.bool_)
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


class Faces(NamedTuple):
    """Elements' faces on a lattice of a `shape`, whose nodes stand `steps` (a, 2) from their corner; lattice
    coordinates are `scale` times finer.
    """

    scale: tuple[int, int]
    shape: tuple[int, int]
    steps: Integers


@compiled
def spread(rows: Rows, which: Integers, at: Array, faces: Faces) -> Rows:
    """Rows `which` (r,) over points at lattice coordinates (q, 2) as rows (r,) over the nodes of faces."""
    shape, steps = faces.shape, faces.steps
    pointer, index, weight = rows
    width, columns = steps.shape[0], shape[1]
    base, values = functions_at(rows, which, at, faces)
    offset, room = offsets(faces), 0
    for row in which:
        room += width * (pointer[row + 1] - pointer[row])
    nodes, load = empty_integers(room), empty_numbers(room)
    ends, slot = integers(which.size + 1, 0), integers(shape[0] * columns, -1)
    on_face, filled = numbers(width, 0.0), 0
    for number in range(which.size):
        row, first = which[number], filled
        for k in range(pointer[row], pointer[row + 1]):
            point, w = index[k], weight[k]
            for a in range(width):
                on_face[a] += w * values[point, a]
            if k + 1 == pointer[row + 1] or base[index[k + 1]] != base[point]:
                for a in range(width):
                    node = base[point] + offset[a]
                    at_node = slot[node]
                    if at_node < first:
                        at_node = slot[node] = filled
                        nodes[filled], load[filled] = node, 0.0
                        filled += 1
                    load[at_node] += on_face[a]
                    on_face[a] = 0.0
        ends[number + 1] = filled
    return ends, nodes[:filled].copy(), load[:filled].copy()


@called
def offsets(faces: Faces) -> Integers:
    """Numbers (a,) of a face's nodes less that of its first."""
    result = integers(faces.steps.shape[0], 0)
    for a in range(result.size):
        result[a] = faces.steps[a, 0] * faces.shape[1] + faces.steps[a, 1]
    return result


@called
def functions_at(rows: Rows, which: Integers, at: Array, faces: Faces) -> tuple[Integers, Array]:
    """First node (q,) of the face that each point of the rows `which` lies on, -1 of other points, and the
    face's functions (q, a) there.
    """
    scale, shape, steps = faces
    pointer, index, _ = rows
    size, columns = 0, shape[1]
    for a in range(steps.shape[0]):
        size = max(size, steps[a, 0])
    base, values = integers(at.shape[0], -1), empty_table(at.shape[0], steps.shape[0])
    value, slope = empty_table(2, size + 1), empty_table(2, size + 1)
    corner = integers(2, 0)
    for row in which:
        for k in range(pointer[row], pointer[row + 1]):
            point = index[k]
            if base[point] < 0:
                locate(at[point, 0] / scale[0], at[point, 1] / scale[1], shape, size, corner, value, slope)
                base[point] = corner[0] * columns + corner[1]
                for a in range(steps.shape[0]):
                    values[point, a] = value[0, steps[a, 0]] * value[1, steps[a, 1]]
    return base, values


@dataclass(frozen=True)
class Lattice:
    """Nodes of a contact surface: their numbers before refinement both ways, and how they are refined.

    `linear` where the body is of elements linear between nodes; `flank_rows`: how many of the rows before
    refinement belong to the flank, None for all; the others lie in the fillet.
    """

    coarse: tuple[int, int]
    refinement: Refinement
    linear: bool = False
    flank_rows: int | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of nodes across the profile and along the width, refined."""
        nu, nv = self.coarse
        return (nu - 1) * self.refinement.profile + 1, (nv - 1) * self.refinement.width + 1

    @property
    def factors(self) -> Integers:
        """Refined nodes a coarse one, both ways."""
        return np.array([self.refinement.profile, self.refinement.width])

    @property
    def flank_end(self) -> float:
        """The refined row beyond which points lie in the fillet."""
        rows = self.coarse[0] if self.flank_rows is None else self.flank_rows
        return (rows - 1) * self.refinement.profile + ROUNDING

    def in_fillet(self, at: Array) -> Mask:
        """Which points at refined coordinates (q, 2) lie beyond the flank."""
        return np.asarray(at[:, 0] > self.flank_end)

    def faces(self, refined: bool = True) -> Faces:
        """The elements' faces on the refined nodes, or on the coarse ones."""
        steps = LINEAR_STEPS if self.linear else QUADRATIC_STEPS
        if refined:
            return Faces((1, 1), self.shape, steps)
        return Faces((self.refinement.profile, self.refinement.width), self.coarse, steps)

    def loads(self, rows: Rows, at: Array, refined: bool = True) -> NodalLoads:
        """Nodal loads of unit forces, spread by `rows` over points at refined coordinates (q, 2)."""
        faces = self.faces(refined)
        return NodalLoads(
            spread(rows, np.arange(rows[0].size - 1), at, faces), faces.shape[0] * faces.shape[1]
        )
