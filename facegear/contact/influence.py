"""Compliance between candidate hats of a position: both bodies, own teeth and neighbours."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers
from facegear.contact import averages, both_sides, spreading
from facegear.contact.averages import Rows
from facegear.contact.bodies import surface
from facegear.contact.bodies.compliance import FlankCompliance
from facegear.contact.both_sides import add_averages
from facegear.contact.candidates import Candidates
from facegear.contact.spreading import Faces, Lattice, NodalLoads
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import empty_integers, table
from facegear.machine_code.records import Record

SOURCES = (
    Path(spreading.__file__),
    Path(surface.__file__),
    Path(both_sides.__file__),
    Path(averages.__file__),
    *picked.SOURCES,
)
compiled, called = compiler(*SOURCES), for_callers(forceinline=False)

TILE = 16
"""Rows and columns of a matrix that are mirrored together."""


def influence_matrix(
    pairs: list[Candidates],
    pinion: FlankCompliance,
    gear: FlankCompliance,
    coupled: bool = True,
) -> Array:
    """Approach (m, m) of hat i by a unit force on hat j, m/N, hats of all pairs in order; symmetric.

    `coupled` False leaves out the coupling between neighbouring teeth, for comparison.
    """
    ends = np.cumsum([0] + [len(pair.hats) for pair in pairs])
    matrix = np.zeros((ends[-1], ends[-1]))
    for side, body in enumerate((pinion, gear)):
        loads = [[pair.loads(side, refined).rows for pair in pairs] for refined in (False, True)]
        for i, first in enumerate(pairs):
            begin, own = int(ends[i]), loads[True][i]
            add_averages(matrix, (begin, begin), body.scale, own, _rows_first(body.own), own, True)
            for j, second in enumerate(pairs[:i] if coupled else ()):
                block, corner = body.block(first.tooth - second.tooth), (int(ends[j]), begin)
                if block is not None:
                    rows = loads[False][i], loads[False][j]
                    add_averages(matrix, corner, body.scale, rows[0], block, rows[1], False)
    mirror(matrix)
    return matrix


def product(first: NodalLoads, compliance: Array | None, second: NodalLoads) -> Array:
    """Displacements (m, n) of rows of nodes by unit loads of others, touching only what they have entries
    for.
    """
    result = np.zeros((len(second.rows[0]) - 1, len(first.rows[0]) - 1))
    if compliance is not None:
        add_averages(result, (0, 0), 1.0, first.rows, compliance, second.rows, False)
    return result.T


@compiled
def mirror(matrix: Array) -> None:
    """Fill in what is below the diagonal by what is above it."""
    for above in range(0, len(matrix), TILE):
        for beside in range(above, len(matrix), TILE):
            for i in range(above, min(above + TILE, len(matrix))):
                for j in range(max(beside, i + 1), min(beside + TILE, len(matrix))):
                    matrix[j, i] = matrix[i, j]


@called
def part_of(rows: Rows, begin: int, end: int) -> Rows:
    """Rows from `begin` to `end`."""
    pointer, index, weight = rows
    first, last = pointer[begin], pointer[end]
    here = empty_integers(end + 1 - begin)
    for i in range(here.size):
        here[i] = pointer[begin + i] - first
    return here, index[first:last], weight[first:last]


@Record.register
class Surface(NamedTuple):
    """Contact surface of a gear: its elements' `faces` on the refined nodes, the `interpolation` to these
    from the nodes before refinement, and `own`, `others` and `scale` of its `FlankCompliance`.
    """

    faces: Faces
    interpolation: Rows
    own: Array
    others: Array
    scale: float


@compiled
def influence(
    ends: Integers,
    teeth: Integers,
    surfaces: tuple[Surface, Surface],
    loads: tuple[Rows, Rows],
    coarse: tuple[Rows, Rows],
    coupled: bool,
) -> Array:
    """`influence_matrix` of the hats of pairs `teeth` (p,) that end at `ends` (p + 1,), 0 first.

    Loads of all of them on the nodes of both surfaces, and on those before refinement.
    """
    matrix = table(ends[-1], ends[-1])
    for i in range(teeth.size):
        for side in range(2):
            body = surfaces[side]
            reach = len(body.others) // 2
            for j in range(0 if coupled else i, i + 1):
                own, places = i == j, teeth[i] - teeth[j]
                if abs(places) <= reach:
                    rows = loads[side] if own else coarse[side]
                    seen, other = part_of(rows, ends[i], ends[i + 1]), part_of(rows, ends[j], ends[j + 1])
                    block = body.own if own else body.others[places + reach]
                    add_averages(matrix, (ends[j], ends[i]), body.scale, seen, block, other, own)
    mirror(matrix)
    return matrix


def surface_of(lattice: Lattice, body: FlankCompliance) -> Surface:
    """Of nodes and compliance of one gear, whose arrays are those of the other in kind."""
    own, others = (
        np.require(array, requirements=["C", "W"]) for array in (_rows_first(body.own), body.others)
    )
    return Surface(lattice.faces(True), lattice.interpolated(), own, others, body.scale)


def _rows_first(symmetric: Array) -> Array:
    """A symmetric matrix in the order of its rows, without a copy where it is in that of its columns."""
    return symmetric.T if symmetric.flags.f_contiguous else symmetric
