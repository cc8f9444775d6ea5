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
    """Compute twice the elastic energy of the whole ring of teeth in waves.

    The back of the rim rises along the axis by 1 m at the crest, then by 1 m for each metre from the
    middle of the teeth outwards.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    material : Material
        Of the face gear.
    rim : float
        Thickness of the rim, m.
    order : int
        Number of nodal diameters.
    sizes : tuple[float, ...]
        Profile, width and thickness of the elements, in modules.

    Returns
    -------
    (2,) array
        J.
    """
    design = replace(design, face_gear=replace(design.face_gear, rim_thickness=rim))
    tooth = gear_tooth(design, MeshSizes(*(size * design.module for size in sizes)))
    mesh, numbers = hex_mesh(tooth.nodes, tooth.hexes)
    stiffness = assemble_stiffness(mesh, material)
    kept_nodes, cyclic_map = cyclic(tooth, numbers, order)
    positions = np.empty_like(tooth.nodes)
    positions[numbers] = tooth.nodes
    back = np.flatnonzero(np.isin(kept_nodes, numbers[np.unique(tooth.faces["rim_back"])]))
    at_back = positions[kept_nodes[back]]
    middle = 0.5 * (design.face_gear.inner_radius + design.face_gear.outer_radius)
    is_rising = np.stack([np.ones(back.size), np.hypot(at_back[:, 0], at_back[:, 1]) - middle], axis=1)
    wave = np.exp(-1j * order * azimuth(tooth, at_back))[:, None] * is_rising
    matrix = (cyclic_map.conj().T @ stiffness @ cyclic_map).tocsr()
    return 0.5 * tooth.teeth * energies(matrix, 3 * back + 2, wave)


def assemble_stiffness(mesh: MeshHex2, material: Material) -> sp.csr_matrix:
    """Assemble the stiffness of a mesh.

    Dof 3 k + i is the displacement of node k along axis i.

    Parameters
    ----------
    mesh : MeshHex2
        Mesh with n nodes.
    material : Material
        Of the elements.

    Returns
    -------
    (3n, 3n) sparse matrix
        N/m.
    """
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
    """Compute the angle of points in the sense in which tooth j stands at j pitches, 0 in the middle of tooth
    0.

    Parameters
    ----------
    tooth : FeTooth
        Mesh of a tooth.
    points : (n, 3) array
        m.

    Returns
    -------
    (n,) array
        rad.
    """
    angle = tooth.rotated(np.array([0.0, 1.0, 0.0]), 0.5 * pi)
    return np.arctan2(points @ angle, points[:, 1])


def cyclic(tooth: FeTooth, numbers: Integers, order: int) -> tuple[Integers, sp.csr_matrix]:
    """Return the nodes of a sector that are not on its right cut, and the motion of all nodes by theirs.

    Nodes on the right cut move as those on the left do, turned by a pitch, and by the phase of a wave
    exp(-i n angle).

    Parameters
    ----------
    tooth : FeTooth
        Mesh of a tooth.
    numbers : (n,) array of int
        Number of each node of the tooth in the mesh.
    order : int
        Number n of nodal diameters.

    Returns
    -------
    tuple
        Nodes (m,), and sparse matrix (3n, 3m).
    """
    left, right = numbers[tooth.cut_left], numbers[tooth.cut_right]
    turn = tooth.rotated(np.eye(3), tooth.pitch).T
    is_master = np.ones(numbers.size, bool)
    is_master[right] = False
    masters, column = np.flatnonzero(is_master), np.cumsum(is_master) - 1
    free = sp.csr_matrix((np.ones(masters.size), (masters, column[masters])), (is_master.size, masters.size))
    cut = sp.csr_matrix((np.ones(left.size), (right, column[left])), (is_master.size, masters.size))
    phase = np.exp(-1j * order * tooth.pitch)
    return masters, (sp.kron(free, np.eye(3)) + phase * sp.kron(cut, turn)).tocsr()


def energies(stiffness: sp.csr_matrix, fixed_dof: Integers, values: Array) -> Array:
    """Compute twice the energy of motions with prescribed values at some dof, all others free.

    Parameters
    ----------
    stiffness : (n, n) sparse matrix
        N/m.
    fixed_dof : (f,) array of int
        Numbers of the dof.
    values : (f, k) array
        Displacements of k motions, m.

    Returns
    -------
    (k,) array
        J.
    """
    free = np.setdiff1d(np.arange(stiffness.shape[0]), fixed_dof)
    factor = splu(
        stiffness[free][:, free].tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    displacement = np.zeros((stiffness.shape[0], values.shape[1]), values.dtype)
    displacement[fixed_dof] = values
    displacement[free] = -factor.solve(stiffness[free][:, fixed_dof] @ values)
    return np.asarray((displacement.conj() * (stiffness @ displacement)).sum(axis=0).real)
