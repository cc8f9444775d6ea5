"""Schur complements of sparse positive definite matrices, front by front (Duff and Reid 1983).

Each front is a small dense matrix, and goes as soon as it is added to the next: no factor is kept. All of
them lie in one piece of memory, whose pages are asked of the system once: two stacks that grow from its ends
towards each other. A front stands on one of them, those that it takes from on top of the other.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import blas, lapack

from facegear._kernels import contact as kernels
from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.cellwise import Part, coupled, in_turn
from facegear.contact.bodies.dissection import Front, dissection
from facegear.errors import FacegearError

Entries = tuple[Array, Integers, Integers, Integers, Array]
"""Small matrices (k, a, a), their rows (k, a) of a sparse one, and its pointers, columns and values."""
BLOCK = 256
"""Columns that are cleared together."""
SINGULAR = "the stiffness matrix is singular: the body is not held or its mesh is broken"


@dataclass(frozen=True, eq=False)
class Step:
    """A front with the places in the elimination of its own dof, p in a row, and of those and of the readings
    (m,) that it is coupled to.

    It comes after the fronts `before`. In the memory of all fronts, counted from its end where negative, what
    it leaves begins at `left` and its own columns at `start`.
    """

    own: slice
    outside: Integers
    before: tuple[int, ...]
    start: int
    left: int

    @property
    def size(self) -> int:
        """Number of its own dof."""
        return int(self.own.stop - self.own.start)

    def columns(self, memory: Array) -> tuple[Array, Array]:
        """Of its own dof: the block (p, p) on the diagonal and the one below it (m, p)."""
        p, m = self.size, self.outside.size
        return _block(memory, self.start, p, p), _block(memory, self.start + p * p, m, p)

    def rest(self, memory: Array) -> Array:
        """Of what it is coupled to (m, m): what it adds to the front after it."""
        return _block(memory, self.left, self.outside.size, self.outside.size)


def _block(memory: Array, start: int, rows: int, columns: int) -> Array:
    """A matrix in memory, its columns contiguous."""
    start %= max(memory.size, 1)
    return memory[start : start + rows * columns].reshape((rows, columns), order="F")


def schur_complement(parts: Sequence[Part], kept: Integers, centres: Array, readings: sp.csr_matrix) -> Array:
    """Lower triangle of the dense Schur complement onto the `kept` dof k and g `readings` of all n dof.

    With r the other dof and R the `readings` (g, n), of the matrix A bordered by R it is (k + g, k + g)

        [ A_kk - A_kr A_rr^-1 A_rk              .           ]
        [ R_k - R_r A_rr^-1 A_rk      - R_r A_rr^-1 R_r^T   ]

    What is above the diagonal has no meaning. A, the sum of `parts`, is symmetric and positive definite on r;
    its cells lie around `centres` (m, 3). The result holds on to the memory that its making took. Raises
    FacegearError if A is not positive definite: the body is not held or its mesh is broken.
    """
    cells = coupled(parts, len(centres))
    fronts = dissection(cells, centres, kept)
    order = np.concatenate([*(front.dof for front in fronts), kept])
    number = np.empty(len(order), dtype=np.int64)
    number[order] = np.arange(len(order))
    read = readings.tocsc()[:, order]
    steps, size = _steps(cells, number, fronts, kept.size, read)
    del cells
    memory, row_of = np.empty(size), np.empty(sum(read.shape), dtype=np.int64)
    rest = memory[:0].reshape(0, 0)
    for step, added in zip(steps, _added(parts, number, fronts, len(centres)), strict=True):
        (pivot, below), rest = step.columns(memory), step.rest(memory)
        _sum_up(added, step, steps, memory, row_of, (pivot, below, rest))
        _add_readings(read, step.own, row_of[number.size :] - step.size, below)
        if step is steps[-1]:
            ends = slice(number.size - kept.size, number.size)
            _add_readings(read, ends, row_of[number.size :] - step.size, rest)
        _eliminate(pivot, below, rest)
    if not np.isfinite(rest.diagonal()).all():
        raise FacegearError(SINGULAR)
    return rest


def _added(
    parts: Sequence[Part], number: Integers, fronts: list[Front], cells: int
) -> Iterator[list[Entries]]:
    """What each front adds of the small matrices, their unknowns by their place in the elimination."""
    group = np.empty(cells, dtype=np.int64)
    for which, front in enumerate(fronts):
        group[front.cells] = which
    moved = [
        (part.moved.indptr.astype(np.int64), number[part.moved.indices], part.moved.data) for part in parts
    ]
    turns = zip(*(in_turn(part, group, len(fronts)) for part in parts), strict=True)
    for turn in turns:
        yield [(*small, *by) for small, by in zip(turn, moved, strict=True)]


def _steps(
    cells: sp.csr_matrix, number: Integers, fronts: list[Front], kept: int, read: sp.csc_matrix
) -> tuple[list[Step], int]:
    """What each front is coupled to among the dof that are eliminated after it or kept, and the readings.

    `read` (g, n) are the readings by the dof in the order of elimination. The last front is coupled to all
    that is kept and read. Also the size of the memory for all of them.
    """
    steps: list[Step] = []
    on_first = _on_first_stack(fronts)
    tops, size, begin = [0, 0], 0, 0
    for which, front in enumerate(fronts):
        last = which == len(fronts) - 1
        own = slice(begin, begin + front.dof.size)
        touched = np.zeros(sum(read.shape), dtype=np.bool_)
        for other in front.before:
            touched[steps[other].outside] = True
        touched[number[cells[front.cells].indices]] = True
        touched[number.size + read.indices[read.indptr[own.start] : read.indptr[own.stop]]] = True
        touched[number.size - kept :] |= last
        touched[own] = False
        outside = np.flatnonzero(touched)
        columns, rest = front.dof.size * (front.dof.size + outside.size), outside.size**2
        side = 0 if on_first[which] else 1
        size = max(size, sum(tops) + columns + rest)
        left, start = tops[side], tops[side] + rest
        if side:
            left, start = -left - rest, -start - columns
        steps.append(Step(own, outside, front.before, start, left))
        tops[side] += rest
        tops[1 - side] -= sum(steps[other].outside.size ** 2 for other in front.before)
        begin = own.stop
    return steps, size


def _on_first_stack(fronts: list[Front]) -> Mask:
    """Which fronts stand on the first of two stacks, so that those before a front stand on the other."""
    first = np.ones(len(fronts), dtype=bool)
    for which in reversed(range(len(fronts))):
        first[list(fronts[which].before)] = not first[which]
    return first


def _sum_up(
    added: list[Entries],
    step: Step,
    steps: list[Step],
    memory: Array,
    row_of: Integers,
    parts: tuple[Array, Array, Array],
) -> None:
    """Fill a front from the small matrices and from what the fronts before it left; lower triangles alone.

    `row_of` is filled with where in it each dof stands, by the place in the elimination, -1 if nowhere.
    """
    row_of[:] = -1
    row_of[step.own] = np.arange(step.size)
    row_of[step.outside] = step.size + np.arange(step.outside.size)
    pivot, below, rest = parts
    _clear(pivot)
    _clear(rest)
    below[:] = 0.0
    for entries in added:
        kernels.add_elements(*entries, row_of, *parts)
    for other in step.before:
        kernels.extend_add(steps[other].rest(memory), row_of[steps[other].outside], *parts)


def _add_readings(read: sp.csc_matrix, dof: slice, rows: Integers, block: Array) -> None:
    """Add the readings by some dof in a row, the columns of a block in which each reading has its row."""
    at = slice(read.indptr[dof.start], read.indptr[dof.stop])
    columns = np.repeat(np.arange(dof.stop - dof.start), np.diff(read.indptr[dof.start : dof.stop + 1]))
    block[rows[read.indices[at]], columns] += read.data[at]


def _eliminate(pivot: Array, below: Array, rest: Array) -> None:
    """Condense a front onto `rest`, of which only the lower triangle is used; all in place."""
    if not pivot.size:
        return
    _, failed = lapack.dpotrf(pivot, lower=1, clean=0, overwrite_a=1)
    if failed:
        raise FacegearError(SINGULAR)
    if below.size:
        blas.dtrsm(1.0, pivot, below, side=1, lower=1, trans_a=1, overwrite_b=1)
        blas.dsyrk(-1.0, below, beta=1.0, c=rest, lower=1, overwrite_c=1)


def _clear(square: Array) -> None:
    """Zero the lower triangle, and of the upper one no more than a block."""
    for start in range(0, len(square), BLOCK):
        square[start:, start : start + BLOCK] = 0.0
