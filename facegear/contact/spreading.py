"""The nodal loads that unit forces make which averages over points spread on elements' faces; compiled."""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from facegear.arrays import Array, Integers, Mask
from facegear.contact.averages import Rows
from facegear.contact.bodies import surface
from facegear.contact.bodies.surface import LINEAR_STEPS, QUADRATIC_STEPS, locate
from facegear.contact.options import Refinement
from facegear.machine_code import picked
from facegear.machine_code.compiler import compiler, for_callers
from facegear.machine_code.picked import empty_integers, empty_numbers, empty_table, integers, numbers

compiled = compiler(Path(surface.__file__), Path(picked.__file__))
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
