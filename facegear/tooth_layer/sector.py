"""Elastic energy of real teeth on a rim round which waves travel: one tooth with its rim by finite elements.

In a wave of n nodal diameters every tooth moves as its neighbour does, turned by a pitch and later by the
phase n times the pitch, so that one sector is the whole ring. On the back of the rim the motion along the
axis is given, all other motions are free.
"""

from dataclasses import replace
from math import pi

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu
from skfem import Basis, ElementHex2, MeshHex2

from facegear.arrays import Array, Integers
from facegear.contact.bodies.element_matrices import element_stiffness
from facegear.geometry.design import Material, PairDesign
from facegear.mesh.hexahedra import hex_mesh
from facegear.mesh.sizes import MeshSizes
from facegear.mesh.tooth import FeTooth, gear_tooth

SIZES = (0.5, 1.6, 0.9)
"""Profile, width and thickness of the elements in modules."""
ELEMENTS_AT_ONCE = 64
DEGREE = 5


def tooth_energies(
    design: PairDesign, material: Material, rim: float, order: int, sizes: tuple[float, ...] = SIZES
) -> Array:
    """Twice the elastic energy (2,), J, of the whole ring of teeth in waves of `order` nodal diameters.

    The back of a rim `rim` (m) thick rises along the axis by 1 m at the crest, then by 1 m for each metre
    from the middle of the teeth outwards.
    """
    design = replace(design, face_gear=replace(design.face_gear, rim_thickness=rim))
    tooth = gear_tooth(design, MeshSizes(*(size * design.module for size in sizes)))
    mesh, numbers = hex_mesh(tooth.nodes, tooth.hexes)
    stiffness = assembled(mesh, material)
    kept, joined = cyclic(tooth, numbers, order)
    places = np.empty_like(tooth.nodes)
    places[numbers] = tooth.nodes
    back = np.flatnonzero(np.isin(kept, numbers[np.unique(tooth.faces["rim_back"])]))
    at_back = places[kept[back]]
    middle = 0.5 * (design.face_gear.inner_radius + design.face_gear.outer_radius)
    rising = np.stack([np.ones(back.size), np.hypot(at_back[:, 0], at_back[:, 1]) - middle], axis=1)
    wave = np.exp(-1j * order * azimuth(tooth, at_back))[:, None] * rising
    matrix = (joined.conj().T @ stiffness @ joined).tocsr()
    return 0.5 * tooth.teeth * energies(matrix, 3 * back + 2, wave)


def assembled(mesh: MeshHex2, material: Material) -> sp.csr_matrix:
    """Stiffness (3n, 3n), N/m; dof 3 k + i is the displacement of the node k of the mesh along axis i."""
    size, parts = 3 * mesh.dofs.N, []
    for elements in np.array_split(np.arange(mesh.nelements), 1 + mesh.nelements // ELEMENTS_AT_ONCE):
        basis = Basis(mesh, ElementHex2(), intorder=DEGREE, elements=elements)
        blocks = element_stiffness(basis, material)
        nodes = mesh.dofs.element_dofs[:, elements].T
        dofs = (3 * nodes[:, :, None] + np.arange(3)).reshape(elements.size, -1)
        row, column = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        parts.append(sp.coo_matrix((blocks.ravel(), (row.ravel(), column.ravel())), (size, size)).tocsr())
    return sum(parts[1:], start=parts[0])


def azimuth(tooth: FeTooth, points: Array) -> Array:
    """Angle (rad) of points in the sense in which tooth j stands at j pitches, 0 in the middle of tooth 0."""
    turned = tooth.rotated(np.array([0.0, 1.0, 0.0]), 0.5 * pi)
    return np.arctan2(points @ turned, points[:, 1])


def cyclic(tooth: FeTooth, numbers: Integers, order: int) -> tuple[Integers, sp.csr_matrix]:
    """The m nodes of a sector that are not on its right cut, and the motion (3n, 3m) of all nodes by theirs.

    numbers: of each node of the tooth in the mesh. Those on the right cut move as those on the left do,
    turned by a pitch, and by the phase of a wave exp(-i n angle).
    """
    left, right = numbers[tooth.cut_left], numbers[tooth.cut_right]
    turn = tooth.rotated(np.eye(3), tooth.pitch).T
    own = np.ones(numbers.size, bool)
    own[right] = False
    kept, column = np.flatnonzero(own), np.cumsum(own) - 1
    free = sp.csr_matrix((np.ones(kept.size), (kept, column[kept])), (own.size, kept.size))
    cut = sp.csr_matrix((np.ones(left.size), (right, column[left])), (own.size, kept.size))
    phase = np.exp(-1j * order * tooth.pitch)
    return kept, (sp.kron(free, np.eye(3)) + phase * sp.kron(cut, turn)).tocsr()


def energies(stiffness: sp.csr_matrix, fixed: Integers, values: Array) -> Array:
    """Twice the energy (k,) of motions that take the values (f, k) at the dofs `fixed` and rest elsewhere."""
    free = np.setdiff1d(np.arange(stiffness.shape[0]), fixed)
    factor = splu(
        stiffness[free][:, free].tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    moved = np.zeros((stiffness.shape[0], values.shape[1]), values.dtype)
    moved[fixed] = values
    moved[free] = -factor.solve(stiffness[free][:, fixed] @ values)
    return np.asarray((moved.conj() * (stiffness @ moved)).sum(axis=0).real)
