"""Approach of hats by the forces on others, without the influence of each on each."""

from pathlib import Path

from facegear.arrays import Array, Integers
from facegear.contact import influence, spreading
from facegear.contact.averages import Rows
from facegear.contact.bodies import surface
from facegear.contact.influence import Surface, part_of
from facegear.contact.spreading import Faces, functions_at, offsets
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import empty_numbers, empty_table, integers, listed, marked, table, taken

SOURCES = Path(spreading.__file__), Path(influence.__file__), Path(surface.__file__), Path(picked.__file__)
compiled, called = compiler(*SOURCES), for_callers(forceinline=False)
compiled_sums = compiler(*SOURCES, fastmath={"contract", "reassoc"}, error_model="numpy")
"""For sums of products, whose terms may be added in any order."""


@compiled
def displacement(
    seen: tuple[Integers, Integers, Integers],
    rows: Rows,
    at: tuple[Array, Array],
    surfaces: tuple[Surface, Surface],
    teeth: Integers,
    loaded: tuple[Integers, tuple[Rows, Rows], tuple[Rows, Rows]],
    forces: Array,
    coupled: bool,
) -> Array:
    """Approach (k, t) m at hats by forces (t, m) N on others, of pairs `teeth` (p,).

    seen: which of all `rows` over points the k hats have, pair by pair, where those of each pair end
    (p + 1,), 0 first, and how many of the load cases (k,), from the first on, are asked for at each; beyond
    them the result is 0. Points stand at refined coordinates `at` (q, 2) on both surfaces.
    loaded: where the m hats of each pair end (p + 1,), and their loads on the nodes of both surfaces, and on
    those before refinement.
    """
    which, seen_ends, cases = seen
    ends, loads, coarse = loaded
    total = table(which.size, forces.shape[0])
    for i in range(teeth.size):
        here = slice(seen_ends[i], seen_ends[i + 1])
        for side in range(2 if which[here].size else 0):
            body = surfaces[side]
            nodes = _nodes_under(rows, which[here], cases[here], at[side], body.faces)
            moved = table(nodes[2].size, forces.shape[0])
            if ends[i + 1] > ends[i]:
                pushing = part_of(loads[side], ends[i], ends[i + 1])
                _move(moved, nodes[2], nodes[4], body.own, pushing, forces[:, ends[i] : ends[i + 1]])
            _add_averages(total[here], rows, which[here], cases[here], nodes, body.faces, moved, body.scale)
            if not coupled or teeth.size < 2:
                continue
            reach = len(body.others) // 2
            nodes = _nodes_under(rows, which[here], cases[here], at[side], body.coarse)
            moved = table(nodes[2].size, forces.shape[0])
            for j in range(teeth.size):
                if i != j and ends[j + 1] > ends[j] and abs(teeth[i] - teeth[j]) <= reach:
                    pushing, block = part_of(coarse[side], ends[j], ends[j + 1]), teeth[i] - teeth[j] + reach
                    push = forces[:, ends[j] : ends[j + 1]]
                    _move(moved, nodes[2], nodes[4], body.others[block], pushing, push)
            _add_averages(total[here], rows, which[here], cases[here], nodes, body.coarse, moved, body.scale)
    return total


@compiled_sums
def _nodes_under(
    rows: Rows, which: Integers, cases: Integers, at: Array, faces: Faces
) -> tuple[Integers, Array, Integers, Integers, Integers]:
    """`functions_at` the points of rows `which` (k,), the nodes (u,) of their faces, the number of each node
    of the lattice among those, and how many load cases (u,) are asked for at each, of (k,) at each row.
    """
    pointer, index, _ = rows
    base, values = functions_at(rows, which, at, faces)
    offset = offsets(faces)
    asked = integers(faces.shape[0] * faces.shape[1], 0)
    for number in range(which.size):
        last = -1
        for k in range(pointer[which[number]], pointer[which[number] + 1]):
            first = base[index[k]]
            for a in range(offset.size if first != last else 0):
                asked[first + offset[a]] = max(asked[first + offset[a]], cases[number])
            last = first
    used, slot = listed(asked)
    return base, values, used, slot, taken(asked, used)


@compiled_sums
def _move(
    moved: Array, used: Integers, cases: Integers, compliance: Array, loads: Rows, forces: Array
) -> None:
    """Add to displacements (u, t) of nodes (u,) those by the first `cases` (u,) of load cases (t, m) of rows
    of nodal loads.
    """
    loaded, nodal = _nodal(loads, forces, compliance.shape[1])
    line = empty_numbers(loaded.size)
    for a in range(used.size):
        row = compliance[used[a]]
        for b in range(loaded.size):
            line[b] = row[loaded[b]]
        for t in range(cases[a]):
            total = 0.0
            for b in range(loaded.size):
                total += line[b] * nodal[t, b]
            moved[a, t] += total


@compiled_sums
def _add_averages(
    total: Array,
    rows: Rows,
    which: Integers,
    cases: Integers,
    nodes: tuple[Integers, Array, Integers, Integers, Integers],
    faces: Faces,
    moved: Array,
    scale: float,
) -> None:
    """Add to the first `cases` (k,) of rows `which` (k, t) over points the displacements (u, t) of nodes by a
    scale, as `_nodes_under` has them.
    """
    pointer, index, weight = rows
    base, values, _, slot, _ = nodes
    offset = offsets(faces)
    asked, there = integers(base.size, 0), empty_table(base.size, moved.shape[1])
    for number in range(which.size):
        for k in range(pointer[which[number]], pointer[which[number] + 1]):
            asked[index[k]] = max(asked[index[k]], cases[number])
    for point in range(base.size):
        for t in range(asked[point]):
            mean = 0.0
            for a in range(offset.size):
                mean += values[point, a] * moved[slot[base[point] + offset[a]], t]
            there[point, t] = scale * mean
    for number in range(which.size):
        for k in range(pointer[which[number]], pointer[which[number] + 1]):
            for t in range(cases[number]):
                total[number, t] += weight[k] * there[index[k], t]


@called
def _nodal(loads: Rows, forces: Array, nodes: int) -> tuple[Integers, Array]:
    """The nodes (l,) that load cases (t, m) of rows load, and the loads (t, l) on them."""
    pointer, index, weight = loads
    every, mark = table(nodes, forces.shape[0]), integers(nodes, 0)
    for i in range(forces.shape[1]):
        pushes = False
        for t in range(forces.shape[0]):
            pushes |= forces[t, i] != 0.0
        for k in range(pointer[i], pointer[i + 1] if pushes else pointer[i]):
            mark[index[k]] = 1
            for t in range(forces.shape[0]):
                every[index[k], t] += weight[k] * forces[t, i]
    loaded = marked(mark)
    result = empty_table(forces.shape[0], loaded.size)
    for t in range(forces.shape[0]):
        for i in range(loaded.size):
            result[t, i] = every[loaded[i], t]
    return loaded, result
