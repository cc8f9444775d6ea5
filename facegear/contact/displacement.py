"""Approach of hats by the forces on others, without the influence of each on each."""

from pathlib import Path

from facegear.arrays import Array, Integers
from facegear.contact import both_sides, influence
from facegear.contact.averages import Rows
from facegear.contact.both_sides import fours
from facegear.contact.influence import Surface, part_of
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.lanes import load, multiply_add, splat, store, take
from facegear.machine_code.memory import LANES
from facegear.machine_code.picked import cube, integers, listed, table, taken

SOURCES = Path(influence.__file__), Path(both_sides.__file__), *picked.SOURCES
compiled, called = compiler(*SOURCES), for_callers(forceinline=False)
compiled_sums = compiler(*SOURCES, fastmath={"contract", "reassoc"}, error_model="numpy")
"""For sums of products, whose terms may be added in any order."""

Loads = tuple[tuple[Rows, Rows], tuple[Rows, Rows]]
"""Loads of hats on the nodes of both surfaces, and on those before refinement."""

Asked = tuple[Integers, Integers, Integers]
"""Which of all hats are asked for (k,), pair by pair, where those of each pair end (p + 1,), 0 first, and for
how many of the load cases (k,), from the first on."""


@compiled
def displacement(
    asked: Asked,
    every: tuple[Rows, Rows],
    surfaces: tuple[Surface, Surface],
    teeth: Integers,
    loaded: tuple[Integers, Loads],
    forces: Array,
    coupled: bool,
) -> Array:
    """Approach (k, t) m at hats by forces (t, m) N on others, of pairs `teeth` (p,); 0 in cases that are not
    asked for.

    `every`: loads of all hats on the nodes of both surfaces; loaded: where the m hats of each pair end
    (p + 1,), 0 first, and their loads.
    """
    which, asked_ends, cases = asked
    ends, loads = loaded
    total, whole = table(which.size, forces.shape[0]), LANES * (-(-forces.shape[0] // LANES))
    for i in range(teeth.size):
        here = slice(asked_ends[i], asked_ends[i + 1])
        for side in range(2 if which[here].size else 0):
            body, rows = surfaces[side], every[side]
            nodes = _nodes_of(rows, which[here], cases[here], body.own.shape[0])
            moved = table(nodes[0].size, whole)
            if ends[i + 1] > ends[i]:
                pushing = part_of(loads[0][side], ends[i], ends[i + 1])
                _move(moved, nodes[0], body.own, pushing, forces[:, ends[i] : ends[i + 1]])
            reach = len(body.others) // 2
            before = _nodes_of(body.interpolation, nodes[0], nodes[2], body.others.shape[1])
            beside = table(before[0].size, whole)
            for j in range(teeth.size if coupled else 0):
                if i != j and ends[j + 1] > ends[j] and abs(teeth[i] - teeth[j]) <= reach:
                    pushing = part_of(loads[1][side], ends[j], ends[j + 1])
                    # what teeth do to each other is symmetric: this block has a row for each loaded node
                    push, block = forces[:, ends[j] : ends[j + 1]], teeth[j] - teeth[i] + reach
                    _move(beside, before[0], body.others[block], pushing, push)
            _add_averages(moved, body.interpolation, nodes[0], nodes[2], before[1], beside, 1.0)
            _add_averages(total[here], rows, which[here], cases[here], nodes[1], moved, body.scale)
    return total


@called
def _nodes_of(rows: Rows, which: Integers, cases: Integers, count: int) -> Asked:
    """The nodes (u,) of some rows, the number of each of all nodes among those, and how many load cases (u,)
    are asked for at each, of (k,) at each row.
    """
    pointer, index, _ = rows
    asked = integers(count, 0)
    for number in range(which.size):
        for k in range(pointer[which[number]], pointer[which[number] + 1]):
            asked[index[k]] = max(asked[index[k]], cases[number])
    used, slot = listed(asked)
    return used, slot, taken(asked, used)


@compiled
def _move(moved: Array, used: Integers, compliance: Array, loads: Rows, forces: Array) -> None:
    """Add to displacements (u, c) of nodes `used` (u,), rising, those by load cases (t, m) of rows of nodal
    loads, in whole LANES c >= t of cases.

    What a loaded node does stands in a row of the compliance, where neighbours are read together.
    """
    begin, slot = fours(used, compliance.shape[1])
    pushing, pushed = _nodal(loads, forces, moved.shape[1], compliance.shape[0])
    width, cases = compliance.shape[1], moved.shape[1]
    result = cube(begin.size, cases, LANES)
    for t in range(0, cases, LANES):
        for k in range(0, pushing.size, 2):
            row, other = pushing[k] * width, pushing[k + 1] * width
            a, b = splat(pushed[k, t]), splat(pushed[k + 1, t])
            c, d = splat(pushed[k, t + 1]), splat(pushed[k + 1, t + 1])
            e, f = splat(pushed[k, t + 2]), splat(pushed[k + 1, t + 2])
            g, h = splat(pushed[k, t + 3]), splat(pushed[k + 1, t + 3])
            for q in range(begin.size):
                at, to = take(begin, q), LANES * (q * cases + t)
                x, y = load(compliance, row + at), load(compliance, other + at)
                store(result, to, multiply_add(a, x, multiply_add(b, y, load(result, to))))
                to += LANES
                store(result, to, multiply_add(c, x, multiply_add(d, y, load(result, to))))
                to += LANES
                store(result, to, multiply_add(e, x, multiply_add(f, y, load(result, to))))
                to += LANES
                store(result, to, multiply_add(g, x, multiply_add(h, y, load(result, to))))
    for number in range(used.size):
        at = slot[used[number]]
        for t in range(forces.shape[0]):
            moved[number, t] += result[at // LANES, t, at % LANES]


@compiled_sums
def _add_averages(
    total: Array,
    rows: Rows,
    which: Integers,
    cases: Integers,
    slot: Integers,
    moved: Array,
    scale: float,
) -> None:
    """Add to the first `cases` (k,) of rows `which` (k, t) the displacements (u, t) of nodes, each in the row
    that `slot` says, by a scale.
    """
    pointer, index, weight = rows
    for number in range(which.size):
        for k in range(pointer[which[number]], pointer[which[number] + 1]):
            for t in range(cases[number]):
                total[number, t] += scale * weight[k] * moved[slot[index[k]], t]


@called
def _nodal(loads: Rows, forces: Array, cases: int, nodes: int) -> tuple[Integers, Array]:
    """The nodes (f,) that load cases (t, m) of rows load, and the loads (f, c) on them in `cases` c >= t: an
    even number, with a node without load where they are odd.
    """
    pointer, index, weight = loads
    mark = integers(nodes, 0)
    for i in range(forces.shape[1]):
        for t in range(forces.shape[0]):
            for k in range(pointer[i], pointer[i + 1] if forces[t, i] != 0.0 else pointer[i]):
                mark[index[k]] = 1
    loaded, slot = listed(mark)
    even = loaded.size + loaded.size % 2
    pushing, pushed = integers(even, 0), table(even, cases)
    for i in range(loaded.size):
        pushing[i] = loaded[i]
    for i in range(forces.shape[1]):
        for t in range(forces.shape[0]):
            for k in range(pointer[i], pointer[i + 1] if forces[t, i] != 0.0 else pointer[i]):
                pushed[slot[index[k]], t] += weight[k] * forces[t, i]
    return pushing, pushed
