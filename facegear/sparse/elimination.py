"""Schur complements of sparse positive definite matrices, front by front (Duff and Reid 1983).

Each front is a small dense matrix, which is dropped as soon as it is added to the next: no factor is kept.
All fronts lie in one block of memory, whose pages are requested from the system once: two stacks that grow
from its ends towards each other. A front is on one stack, and the fronts that it takes from are on top of
the other.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import blas, lapack

from facegear._kernels import contact as kernels
from facegear.arrays import Array, Integers, Mask
from facegear.errors import FacegearError
from facegear.sparse.dissection import Front, dissection
from facegear.sparse.matrices import Part, cell_unknowns, in_turn

Entries = tuple[Array, Integers, Integers, Integers, Array]
"""Small matrices (k, a, a), their rows (k, a) of a sparse one, and its pointers, columns and values."""
BLOCK = 256
"""Number of columns that are cleared together."""
SINGULAR = "the stiffness matrix is singular: the body is not held or its mesh is broken"
"""Message for a matrix that has no factor."""


@dataclass(frozen=True, eq=False)
class Step:
    """A front with the positions of its dof in the elimination order.

    `pivots`: consecutive dof that the front eliminates, p of them; `boundary` (m,): dof and readings that
    these are coupled to. The step comes after the fronts `before`. In the memory of all fronts, counted
    from its end where negative, the matrix that it leaves begins at `left` and the columns of its pivots
    at `start`.
    """

    pivots: slice
    boundary: Integers
    before: tuple[int, ...]
    start: int
    left: int

    @property
    def size(self) -> int:
        """Number of pivots."""
        return int(self.pivots.stop - self.pivots.start)

    def columns(self, memory: Array) -> tuple[Array, Array]:
        """Return the columns of this step's pivots from the memory of all fronts.

        Parameters
        ----------
        memory : (n,) array
            Memory of all fronts, N/m.

        Returns
        -------
        tuple of arrays
            Block (p, p) on the diagonal and block (m, p) below it, N/m.
        """
        p, m = self.size, self.boundary.size
        return _block(memory, self.start, p, p), _block(memory, self.start + p * p, m, p)

    def rest(self, memory: Array) -> Array:
        """Return the matrix of the boundary, which is added to the front after this one.

        Parameters
        ----------
        memory : (n,) array
            Memory of all fronts, N/m.

        Returns
        -------
        (m, m) array
            N/m.
        """
        return _block(memory, self.left, self.boundary.size, self.boundary.size)


def _block(memory: Array, start: int, rows: int, columns: int) -> Array:
    """Return the view (rows, columns) of `memory` from position `start` on, stored column by column.

    A negative start counts from the end of the memory.
    """
    start %= max(memory.size, 1)
    return memory[start : start + rows * columns].reshape((rows, columns), order="F")


def schur_complement(
    parts: Sequence[Part], kept_dof: Integers, centres: Array, readings: sp.csr_matrix
) -> Array:
    """Compute the lower triangle of the dense Schur complement onto dof that are kept and readings of all n
    dof.

    With k the kept dof, r the other dof and R the `readings` (g, n), of the matrix A bordered by R it is
    (k + g, k + g)

        [ A_kk - A_kr A_rr^-1 A_rk              .           ]
        [ R_k - R_r A_rr^-1 A_rk      - R_r A_rr^-1 R_r^T   ]

    Entries above the diagonal have no meaning. A, the sum of `parts`, is symmetric and positive definite
    on r. The result keeps the memory of its computation alive.

    Parameters
    ----------
    parts : Sequence[Part]
        Parts of A, N/m.
    kept_dof : (k,) array of int
        Numbers of the dof that are kept.
    centres : (m, 3) array
        Positions of the cells, m.
    readings : (g, n) sparse matrix
        Readings by displacements of all dof.

    Returns
    -------
    (k + g, k + g) array
        Lower triangle, N/m for dof.

    Raises
    ------
    FacegearError
        If A is not positive definite: the body is not held or its mesh is broken.
    """
    cells = cell_unknowns(parts, len(centres))
    fronts = dissection(cells, centres, kept_dof)
    order = np.concatenate([*(front.dof for front in fronts), kept_dof])
    number = np.empty(len(order), dtype=np.int64)
    number[order] = np.arange(len(order))
    read = readings.tocsc()[:, order]
    steps, size = _steps(cells, number, fronts, kept_dof.size, read)
    del cells
    memory, row_of = np.empty(size), np.empty(sum(read.shape), dtype=np.int64)
    rest = memory[:0].reshape(0, 0)
    for step, entry_lists in zip(steps, _front_entries(parts, number, fronts, len(centres)), strict=True):
        (pivot, below), rest = step.columns(memory), step.rest(memory)
        _sum_up(entry_lists, step, steps, memory, row_of, (pivot, below, rest))
        _add_readings(read, step.pivots, row_of[number.size :] - step.size, below)
        if step is steps[-1]:
            ends = slice(number.size - kept_dof.size, number.size)
            _add_readings(read, ends, row_of[number.size :] - step.size, rest)
        _eliminate(pivot, below, rest)
    if not np.isfinite(rest.diagonal()).all():
        raise FacegearError(SINGULAR)
    return rest


def _front_entries(
    parts: Sequence[Part], number: Integers, fronts: list[Front], cells: int
) -> Iterator[list[Entries]]:
    """Yield for each front the entries of all parts' small matrices in its cells, one Entries a part.

    `number` (n,) gives the position of each dof in the elimination order; the columns of each
    `transformation` are renumbered by it. `cells` is the number of cells.
    """
    group = np.empty(cells, dtype=np.int64)
    for front_number, front in enumerate(fronts):
        group[front.cells] = front_number
    transformations = [
        (
            part.transformation.indptr.astype(np.int64),
            number[part.transformation.indices],
            part.transformation.data,
        )
        for part in parts
    ]
    turns = zip(*(in_turn(part, group, len(fronts)) for part in parts), strict=True)
    for turn in turns:
        yield [(*small, *by) for small, by in zip(turn, transformations, strict=True)]


def _steps(
    cells: sp.csr_matrix, number: Integers, fronts: list[Front], kept_count: int, read: sp.csc_matrix
) -> tuple[list[Step], int]:
    """Return the steps of all fronts, and the size of their memory in numbers.

    `cells` (cells, n) marks the dof of each cell, `number` (n,) gives each dof's position in the
    elimination order, the `kept_count` kept dof last. The boundary of a step consists of dof that are
    eliminated after it or kept, and of readings, numbered after all dof. `read` (g, n): readings by the
    dof in the order of elimination. The last front is coupled to all kept dof and readings.
    """
    steps: list[Step] = []
    on_first = _on_first_stack(fronts)
    tops, size, begin = [0, 0], 0, 0
    for front_number, front in enumerate(fronts):
        last = front_number == len(fronts) - 1
        pivots = slice(begin, begin + front.dof.size)
        is_coupled = np.zeros(sum(read.shape), dtype=np.bool_)
        for child in front.before:
            is_coupled[steps[child].boundary] = True
        is_coupled[number[cells[front.cells].indices]] = True
        is_coupled[number.size + read.indices[read.indptr[pivots.start] : read.indptr[pivots.stop]]] = True
        is_coupled[number.size - kept_count :] |= last
        is_coupled[pivots] = False
        boundary = np.flatnonzero(is_coupled)
        columns, rest = front.dof.size * (front.dof.size + boundary.size), boundary.size**2
        side = 0 if on_first[front_number] else 1
        size = max(size, sum(tops) + columns + rest)
        left, start = tops[side], tops[side] + rest
        if side:
            left, start = -left - rest, -start - columns
        steps.append(Step(pivots, boundary, front.before, start, left))
        tops[side] += rest
        tops[1 - side] -= sum(steps[child].boundary.size ** 2 for child in front.before)
        begin = pivots.stop
    return steps, size


def _on_first_stack(fronts: list[Front]) -> Mask:
    """Mark the fronts on the first of two stacks, so that the fronts that a front takes from are on the
    other one.
    """
    first = np.ones(len(fronts), dtype=bool)
    for front_number in reversed(range(len(fronts))):
        first[list(fronts[front_number].before)] = not first[front_number]
    return first


def _sum_up(
    entry_lists: list[Entries],
    step: Step,
    steps: list[Step],
    memory: Array,
    row_of: Integers,
    parts: tuple[Array, Array, Array],
) -> None:
    """Fill a front from the small matrices and from the rests of the fronts before it; lower triangles
    alone.

    `parts`: views of the memory to fill, the pivot block (p, p), the block (m, p) below it and the rest
    (m, m), N/m. `row_of` (n + g,) is filled with the row of each dof and reading in the front, by its
    position in the elimination order, -1 if none.
    """
    row_of[:] = -1
    row_of[step.pivots] = np.arange(step.size)
    row_of[step.boundary] = step.size + np.arange(step.boundary.size)
    pivot, below, rest = parts
    _clear(pivot)
    _clear(rest)
    below[:] = 0.0
    for entries in entry_lists:
        kernels.add_elements(*entries, row_of, *parts)
    for child in step.before:
        kernels.extend_add(steps[child].rest(memory), row_of[steps[child].boundary], *parts)


def _add_readings(read: sp.csc_matrix, dof: slice, rows: Integers, block: Array) -> None:
    """Add the readings of consecutive dof to a block, in place.

    `read` (g, n): readings by dof in the elimination order; `dof`: the columns of the block; `rows` (g,):
    row of the block for each reading.
    """
    at = slice(read.indptr[dof.start], read.indptr[dof.stop])
    columns = np.repeat(np.arange(dof.stop - dof.start), np.diff(read.indptr[dof.start : dof.stop + 1]))
    block[rows[read.indices[at]], columns] += read.data[at]


def _eliminate(pivot: Array, below: Array, rest: Array) -> None:
    """Condense a front: subtract below @ inverse(pivot) @ below.T from `rest`, lower triangle only.

    All three are changed in place: `pivot` (p, p) into its Cholesky factor L, `below` (m, p) into below @
    inverse(L).T. Raise FacegearError if the pivot block is not positive definite.
    """
    if not pivot.size:
        return
    _, error_code = lapack.dpotrf(pivot, lower=1, clean=0, overwrite_a=1)
    if error_code:
        raise FacegearError(SINGULAR)
    if below.size:
        blas.dtrsm(1.0, pivot, below, side=1, lower=1, trans_a=1, overwrite_b=1)
        blas.dsyrk(-1.0, below, beta=1.0, c=rest, lower=1, overwrite_c=1)


def _clear(square: Array) -> None:
    """Zero the lower triangle of a square array in place, and of the upper one no more than BLOCK
    columns.
    """
    for start in range(0, len(square), BLOCK):
        square[start:, start : start + BLOCK] = 0.0
