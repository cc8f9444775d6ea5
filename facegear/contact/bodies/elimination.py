"""Schur complements of sparse positive definite matrices, front by front (Duff and Reid 1983).

Each front is a small dense matrix, and goes as soon as it is added to the next: no factor is kept. All of
them lie in one piece of memory, a stack, whose pages are asked of the system once.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import blas, lapack

from facegear.arrays import Array, Integers, Mask
from facegear.contact.bodies.dissection import Front, dissection
from facegear.errors import FacegearError
from facegear.machine_code.compiler import compiler

compiled = compiler()

SINGULAR = "the stiffness matrix is singular: the body is not held or its mesh is broken"
Sparse = tuple[Integers, Integers, Array, Integers]
"""Rows of a symmetric matrix: pointers, columns, values; and the place of each dof in the elimination."""


@dataclass(frozen=True, eq=False)
class Step:
    """A front with the places in the elimination of its own dof (p,) and of those it is coupled to (m,).

    `base` and `left` say where in the stack the front begins, and where its remainder is put afterwards.
    """

    front: Front
    own: Integers
    outside: Integers
    base: int
    left: int

    def columns(self, stack: Array) -> tuple[Array, Array]:
        """Of its own dof: the block (p, p) on the diagonal and the one below it (m, p)."""
        p, m = self.own.size, self.outside.size
        return _block(stack, self.base, p, p), _block(stack, self.base + p * p, m, p)

    def rest(self, stack: Array) -> Array:
        """Of the dof it is coupled to (m, m)."""
        p, m = self.own.size, self.outside.size
        return _block(stack, self.base + p * (p + m), m, m)

    def remainder(self, stack: Array) -> Array:
        """What it adds to the front after it (m, m)."""
        return _block(stack, self.left, self.outside.size, self.outside.size)


def _block(stack: Array, start: int, rows: int, columns: int) -> Array:
    """A matrix of the stack, its columns contiguous."""
    return stack[start : start + rows * columns].reshape((rows, columns), order="F")


def schur_complement(matrix: sp.csr_matrix, kept: Integers, cells: sp.csr_matrix, centres: Array) -> Array:
    """Dense A_kk - A_kr A_rr^-1 A_rk with k the `kept` dof and r the others, shape (k, k), ordered as `kept`.

    `matrix` (n, n) is symmetric and positive definite on r. Row i of `cells` (m, n) has an entry for each dof
    of a cell around `centres` (m, 3); dof that share no cell are not coupled. Raises FacegearError if the
    matrix is not positive definite: the body is not held or its mesh is broken.
    """
    fronts = dissection(cells, centres, kept)
    order = np.concatenate([*(front.dof for front in fronts), kept])
    number = np.empty(len(order), dtype=np.int64)
    number[order] = np.arange(len(order))
    sparse = matrix.indptr, matrix.indices, matrix.data, number
    steps, size = _steps(sparse, fronts, kept)
    stack = np.empty(size)
    for step in steps[:-1]:
        (pivot, below), rest = step.columns(stack), step.rest(stack)
        _sum_up(sparse, step, steps, stack, (pivot, below, rest))
        _eliminate(pivot, below, rest)
        _move_down(rest.ravel(order="F"), step.remainder(stack).ravel(order="F"))
    last = steps[-1]
    pivot, below = last.columns(stack)
    complement = np.empty((kept.size, kept.size), order="F")
    row_of = _sum_up(sparse, last, steps, stack, (pivot, below, complement))
    _add_entries(*sparse, kept, row_of, last.own.size, complement, below[:0])
    _eliminate(pivot, below, complement)
    _mirror(complement)
    if not np.isfinite(complement).all():
        raise FacegearError(SINGULAR)
    return complement


def _steps(sparse: Sparse, fronts: list[Front], kept: Integers) -> tuple[list[Step], int]:
    """What each front is coupled to among the dof that are eliminated after it or kept, and its memory.

    Also the size of the stack. The last front is coupled to all that is kept, which lies elsewhere.
    """
    number = sparse[-1]
    steps: list[Step] = []
    top = size = 0
    for which, front in enumerate(fronts):
        last = which == len(fronts) - 1
        own = number[front.dof]
        touched = np.zeros(number.size, dtype=np.bool_)
        for other in front.before:
            touched[steps[other].outside] = True
        touched[number[kept]] |= last
        _touch(*sparse, front.dof, touched)
        first = own[-1] + 1 if own.size else 0
        outside = first + np.flatnonzero(touched[first:])
        left = steps[front.before[0]].left if front.before else top
        steps.append(Step(front, own, outside, top, left))
        size = max(size, top + own.size * (own.size + outside.size) + (0 if last else outside.size**2))
        top = left + outside.size**2
    return steps, size


def _sum_up(
    sparse: Sparse, step: Step, steps: list[Step], stack: Array, parts: tuple[Array, Array, Array]
) -> Integers:
    """Fill a front from the matrix and from what the fronts before it left; lower triangles alone.

    Returns where in it each dof stands, by the place in the elimination, -1 if nowhere.
    """
    pivot, below, rest = parts
    row_of = np.full(len(sparse[-1]), -1, dtype=np.int64)
    row_of[step.own] = np.arange(step.own.size)
    row_of[step.outside] = step.own.size + np.arange(step.outside.size)
    _clear(pivot)
    _clear(rest)
    below[:] = 0.0
    _add_entries(*sparse, step.front.dof, row_of, 0, pivot, below)
    for other in step.front.before:
        _add_front(steps[other].remainder(stack), row_of[steps[other].outside], *parts)
    return row_of


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


@compiled
def _touch(
    indptr: Integers, indices: Integers, data: Array, number: Integers, dof: Integers, touched: Mask
) -> None:
    """Mark what is coupled to some dof, by its place in the elimination."""
    for column in dof:
        for entry in range(indptr[column], indptr[column + 1]):
            touched[number[indices[entry]]] = True


@compiled
def _add_entries(
    indptr: Integers,
    indices: Integers,
    data: Array,
    number: Integers,
    dof: Integers,
    row_of: Integers,
    first: int,
    square: Array,
    below: Array,
) -> None:
    """Add the columns of some dof, the first of which has the place `first` in the front.

    Their own rows to the lower triangle of `square`, rows of a larger one to `below`.
    """
    size = square.shape[0]
    for column in range(dof.shape[0]):
        for entry in range(indptr[dof[column]], indptr[dof[column] + 1]):
            row = row_of[number[indices[entry]]] - first
            if row >= size:
                below[row - size, column] += data[entry]
            elif row >= column:
                square[row, column] += data[entry]


@compiled
def _add_front(added: Array, at: Integers, pivot: Array, below: Array, rest: Array) -> None:
    """Add the lower triangle of a front before to the places (m,), ascending, of its dof in this one."""
    size, count = pivot.shape[0], added.shape[0]
    inside = np.searchsorted(at, size)
    start = 0
    while start < count:
        stop = start + 1
        limit = inside if start < inside else count
        while stop < limit and at[stop] == at[stop - 1] + 1:
            stop += 1
        row = at[start]
        for j in range(stop):
            column, begin = at[j], max(start, j)
            if column >= size:
                target = rest[row + begin - start - size : row + stop - start - size, column - size]
            elif row >= size:
                target = below[row + begin - start - size : row + stop - start - size, column]
            else:
                target = pivot[row + begin - start : row + stop - start, column]
            for i in range(begin, stop):
                target[i - begin] += added[i, j]
        start = stop


@compiled
def _clear(square: Array) -> None:
    """Zero the lower triangle."""
    for column in range(square.shape[0]):
        for row in range(column, square.shape[0]):
            square[row, column] = 0.0


@compiled
def _move_down(source: Array, target: Array) -> None:
    """Copy numbers (n,) to where they may overlap with themselves, from the first to the last."""
    for i in range(source.size):
        target[i] = source[i]


@compiled
def _mirror(square: Array) -> None:
    """Copy the lower triangle of a square to its upper one, block by block."""
    size, block = square.shape[0], 64
    for top in range(0, size, block):
        for left in range(0, top + 1, block):
            for j in range(left, min(left + block, size)):
                for i in range(max(top, j + 1), min(top + block, size)):
                    square[j, i] = square[i, j]
