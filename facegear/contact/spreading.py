"""The nodal loads that unit forces make which averages over points spread on elements' faces; compiled."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.averages import Rows
from facegear.contact.bodies import surface
from facegear.contact.bodies.surface import LINEAR_STEPS, QUADRATIC_STEPS, interpolation, locate
from facegear.contact.options import Refinement
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import empty_integers, empty_numbers, empty_table, integers, numbers
from facegear.machine_code.records import Record

compiled = compiler(Path(surface.__file__), *picked.SOURCES)
called = for_callers(forceinline=False)

ROUNDING = 1e-6
"""Of coordinates on a lattice."""


@dataclass(frozen=True, eq=False)
class NodalLoads:
    """Forces on `nodes` nodes of a lattice by m unit forces, one a row."""

    rows: Rows
    nodes: int

    def by(self, forces: Array) -> Array:
        """Forces (nodes,) N on the nodes by forces (m,) N."""
        return _by(*self.rows, forces, self.nodes)


@compiled
def _by(pointer: Integers, index: Integers, weight: Array, forces: Array, nodes: int) -> Array:
    total = np.zeros(nodes)
    for i in range(forces.size):
        if forces[i] != 0.0:
            for k in range(pointer[i], pointer[i + 1]):
                total[index[k]] += weight[k] * forces[i]
    return total


@Record.register
class Faces(NamedTuple):
    """Elements' faces on a lattice of a `shape`, whose nodes stand `steps` (a, 2) from their corner; lattice
    coordinates are `scale` times finer.
    """

    scale: tuple[int, int]
    shape: tuple[int, int]
    steps: Integers


@compiled
def spread(rows: Rows, at: Array, faces: Faces) -> Rows:
    """Rows over points at lattice coordinates (q, 2) as rows over the nodes of faces."""
    shape, steps = faces.shape, faces.steps
    pointer, index, weight = rows
    width, columns = steps.shape[0], shape[1]
    base, values = _functions_at(index, at, faces)
    offset, room = _offsets(faces), width * index.size
    nodes, load = empty_integers(room), empty_numbers(room)
    ends, slot = integers(pointer.size, 0), integers(shape[0] * columns, -1)
    on_face, filled = numbers(width, 0.0), 0
    for row in range(pointer.size - 1):
        first = filled
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
        ends[row + 1] = filled
    return ends, nodes[:filled].copy(), load[:filled].copy()


@called
def _offsets(faces: Faces) -> Integers:
    """Numbers (a,) of a face's nodes less that of its first."""
    result = integers(faces.steps.shape[0], 0)
    for a in range(result.size):
        result[a] = faces.steps[a, 0] * faces.shape[1] + faces.steps[a, 1]
    return result


@called
def _functions_at(points: Integers, at: Array, faces: Faces) -> tuple[Integers, Array]:
    """First node (q,) of the face that each of some points lies on, -1 of the others, and the face's
    functions (q, a) there.
    """
    scale, shape, steps = faces.scale, faces.shape, faces.steps
    size, columns = steps[0, 0], shape[1]
    for a in range(steps.shape[0]):
        size = max(size, steps[a, 0])
    base, values = integers(at.shape[0], -1), empty_table(at.shape[0], steps.shape[0])
    value, slope = empty_table(2, size + 1), empty_table(2, size + 1)
    corner = integers(2, 0)
    for point in points:
        if base[point] < 0:
            locate(at[point, 0] / scale[0], at[point, 1] / scale[1], shape, size, corner, value, slope)
            base[point] = corner[0] * columns + corner[1]
            for a in range(steps.shape[0]):
                values[point, a] = value[0, steps[a, 0]] * value[1, steps[a, 1]]
    return base, values


@compiled
def composed(rows: Rows, inner: Rows, columns: int) -> Rows:
    """Rows over what are themselves rows over columns, as rows over the columns."""
    pointer, index, weight = rows
    first, column, factor = inner
    room = 0
    for i in index:
        room += first[i + 1] - first[i]
    nodes, load = empty_integers(room), empty_numbers(room)
    ends, slot = integers(pointer.size, 0), integers(columns, -1)
    filled = 0
    for row in range(pointer.size - 1):
        begin = filled
        for k in range(pointer[row], pointer[row + 1]):
            for m in range(first[index[k]], first[index[k] + 1]):
                at_column = slot[column[m]]
                if at_column < begin:
                    at_column = slot[column[m]] = filled
                    nodes[filled], load[filled] = column[m], 0.0
                    filled += 1
                load[at_column] += weight[k] * factor[m]
        ends[row + 1] = filled
    return ends, nodes[:filled].copy(), load[:filled].copy()


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

    def interpolated(self) -> Rows:
        """Displacements of the refined nodes as sums of those of the nodes before refinement: shared."""
        return _interpolated(self)

    def loads(self, rows: Rows, at: Array, refined: bool = True) -> NodalLoads:
        """Nodal loads of unit forces, spread by `rows` over points at refined coordinates (q, 2)."""
        faces = self.faces(refined)
        return NodalLoads(spread(rows, at, faces), faces.shape[0] * faces.shape[1])


@lru_cache(maxsize=8)
def _interpolated(lattice: Lattice) -> Rows:
    refined = np.argwhere(np.ones(lattice.shape)) / lattice.factors
    matrix = interpolation(refined, lattice.coarse, lattice.linear)
    matrix.eliminate_zeros()
    return matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data
