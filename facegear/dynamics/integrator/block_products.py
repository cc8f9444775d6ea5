"""Compiled products with the matrices of blocks.py."""

from facegear.arrays import Array
from facegear.dynamics.integrator.blocks import Blocks, Coupled, Strips
from facegear.dynamics.integrator.compiled import Packed
from facegear.dynamics.integrator.kernel import inlined
from facegear.dynamics.integrator.work import Pressing, Work
from facegear.machine_code.lanes import (
    LANES,
    add,
    load,
    multiply,
    multiply_add,
    splat,
    spread,
    store,
    sums,
    swap_ends,
    swap_halves,
    swap_neighbours,
    take,
)
from facegear.mesh_law.terms import Lanes


@inlined
def find_pressing(coupled: Coupled | None, pressing: Pressing | None, packed: Packed, work: Work) -> None:
    """List the rows of every block that may hold a force: contacts that act, and all rows of rings."""
    if coupled is None or pressing is None:
        return
    blocks, count = coupled.blocks, 0
    for block in range(blocks.first.size):
        for at in range(blocks.starts[block], blocks.starts[block + 1]):
            row = blocks.rows[at]
            if row >= packed.contacts or work.active[row] != 0.0 or work.acting[row] != 0.0:
                pressing.rows[count] = row
                count += 1
        pressing.starts[block + 1] = count


@inlined
def push(blocks: Blocks, pressing: Pressing, transposed: Array, force: Array, y: Array, i: int) -> None:
    """Add what the forces (m,) of the rows that press give every coordinate to row i of y."""
    for block in range(blocks.first.size):
        begin, end = pressing.starts[block], pressing.starts[block + 1]
        first, last = blocks.first[block], blocks.last[block]
        triples = first + (last - first) // (3 * LANES) * (3 * LANES)
        for c in range(first, triples, 3 * LANES):
            _push_triple(pressing, begin, end, transposed, force, y, i, c)
        for c in range(triples, last, LANES):
            _push_single(pressing, begin, end, transposed, force, y, i, c)


@inlined
def _push_triple(
    pressing: Pressing, begin: int, end: int, transposed: Array, force: Array, y: Array, i: int, c: int
) -> None:
    n = y.shape[1]
    to = i * n + c
    sum_1, sum_2, sum_3 = load(y, to), load(y, to + LANES), load(y, to + 2 * LANES)
    sum_4, sum_5, sum_6 = splat(0.0), splat(0.0), splat(0.0)
    for at in range(begin, end - 1, 2):
        row, other = take(pressing.rows, at), take(pressing.rows, at + 1)
        factor, second = spread(force, row), spread(force, other)
        row, other = row * n + c, other * n + c
        sum_1 = multiply_add(load(transposed, row), factor, sum_1)
        sum_2 = multiply_add(load(transposed, row + LANES), factor, sum_2)
        sum_3 = multiply_add(load(transposed, row + 2 * LANES), factor, sum_3)
        sum_4 = multiply_add(load(transposed, other), second, sum_4)
        sum_5 = multiply_add(load(transposed, other + LANES), second, sum_5)
        sum_6 = multiply_add(load(transposed, other + 2 * LANES), second, sum_6)
    if (end - begin) % 2 == 1:
        row = take(pressing.rows, end - 1)
        factor = spread(force, row)
        row = row * n + c
        sum_1 = multiply_add(load(transposed, row), factor, sum_1)
        sum_2 = multiply_add(load(transposed, row + LANES), factor, sum_2)
        sum_3 = multiply_add(load(transposed, row + 2 * LANES), factor, sum_3)
    store(y, to, add(sum_1, sum_4))
    store(y, to + LANES, add(sum_2, sum_5))
    store(y, to + 2 * LANES, add(sum_3, sum_6))


@inlined
def _push_single(
    pressing: Pressing, begin: int, end: int, transposed: Array, force: Array, y: Array, i: int, c: int
) -> None:
    n = y.shape[1]
    total = load(y, i * n + c)
    for at in range(begin, end):
        row = take(pressing.rows, at)
        total = multiply_add(load(transposed, row * n + c), spread(force, row), total)
    store(y, i * n + c, total)


@inlined
def feel(blocks: Blocks, transposed: Array, y: Array, i: int, error: Array, deflection: Array) -> None:
    """Row i of the deflections, less the error: LANES rows at a time."""
    width, n = error.shape[1], y.shape[1]
    minus = splat(-1.0)
    for k in range(width // LANES):
        row_1 = LANES * k * n
        row_2, row_3, row_4 = row_1 + n, row_1 + 2 * n, row_1 + 3 * n
        sum_1, sum_2, sum_3, sum_4 = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
        for tile in range(take(blocks.tiles, k), take(blocks.tiles, k + 1)):
            c = take(blocks.columns, tile)
            factor = load(y, i * n + c)
            sum_1 = multiply_add(load(transposed, row_1 + c), factor, sum_1)
            sum_2 = multiply_add(load(transposed, row_2 + c), factor, sum_2)
            sum_3 = multiply_add(load(transposed, row_3 + c), factor, sum_3)
            sum_4 = multiply_add(load(transposed, row_4 + c), factor, sum_4)
        at = i * width + LANES * k
        total = sums(sum_1, sum_2, sum_3, sum_4)
        store(deflection, at, multiply_add(minus, load(error, at), total))


@inlined
def couple(own: Array, strips: Strips, factors: Array, y: Array, i: int) -> None:
    """Add what couples coordinates beside the meshes to row i + 2 of y from the two rows before it."""
    n = y.shape[1]
    by_rate, by_displacement = splat(-1.0 / (i + 2)), splat(-1.0 / ((i + 1) * (i + 2)))
    for c in range(0, n, LANES):
        store(factors, c, multiply(by_rate, load(y, (i + 1) * n + c)))
        store(factors, n + c, multiply(by_displacement, load(y, i * n + c)))
    to = (i + 2) * n
    for k in range(own.shape[0]):
        total_1, total_2 = load(y, to + LANES * k), splat(0.0)
        at = 2 * LANES * LANES * k
        total_1, total_2 = _couple_own(own, at, load(factors, LANES * k), total_1, total_2)
        at += LANES * LANES
        total_1, total_2 = _couple_own(own, at, load(factors, n + LANES * k), total_1, total_2)
        for strip in range(take(strips.starts, k), take(strips.starts, k + 1), 2):
            value, other = load(strips.values, LANES * strip), load(strips.values, LANES * (strip + 1))
            total_1 = multiply_add(value, spread(factors, take(strips.columns, strip)), total_1)
            total_2 = multiply_add(other, spread(factors, take(strips.columns, strip + 1)), total_2)
        store(y, to + LANES * k, add(total_1, total_2))


@inlined
def _couple_own(own: Array, at: int, factor: Lanes, total_1: Lanes, total_2: Lanes) -> tuple[Lanes, Lanes]:
    """Add the products of the block on the diagonal from index `at` on with its lanes of the factors."""
    total_1 = multiply_add(load(own, at), factor, total_1)
    total_2 = multiply_add(load(own, at + LANES), swap_neighbours(factor), total_2)
    total_1 = multiply_add(load(own, at + 2 * LANES), swap_halves(factor), total_1)
    return total_1, multiply_add(load(own, at + 3 * LANES), swap_ends(factor), total_2)
