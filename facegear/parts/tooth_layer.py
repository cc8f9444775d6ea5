"""The layer that stands for the teeth of a face gear that bends, fitted to one sector of its ring.

Stiffness round the axis and in shear of the layer that stands for the teeth, from their own energies. Two
waves of one order bend and twist a rim. The layer of Fourier elements on a rim of the same thickness gets the
two numbers with which it stores as much energy in both as the real teeth do. What fills the layer is its
volume of teeth.

Elastic energy of real teeth on a rim round which waves travel: one tooth with its rim by finite elements. In
a wave of n nodal diameters every tooth moves as its neighbour does, turned by a pitch and later by the phase
n times the pitch, so that one sector is the whole ring. On the back of the rim the motion along the axis is
given, all other motions are free.
"""

from dataclasses import replace
from math import pi

import numpy as np
import scipy.sparse as sp
from scipy.optimize import root
from scipy.sparse.linalg import splu
from skfem import Basis, ElementHex2, MeshHex2

from facegear.arrays import Array, Integers
from facegear.contact.bodies.elements import element_stiffness
from facegear.errors import NotConverged
from facegear.parts.body_mesh import BodyMesh
from facegear.parts.elements import elements_of
from facegear.parts.matrices import elastic_stiffness
from facegear.parts.section import GAUSS, Layer, Section, rectangle
from facegear.teeth.design import Material, PairDesign
from facegear.teeth.face_gear_fillet import root_height
from facegear.teeth.mesh_quality import hex_mesh
from facegear.teeth.mesh_sizes import MeshSizes
from facegear.teeth.tooth_mesh import FeTooth, gear_tooth

SAME_HEIGHT = 1e-9
"""Difference of two heights, m, up to which they are equal: rounding of coordinates of 0.1 m."""


def rim_below(section: Section) -> float:
    """Compute the mean thickness along the axis of a section below its layer of teeth, at most the face
    width.

    A rim thicker than that is bent by its teeth no more than a solid one.

    Parameters
    ----------
    section : Section
        Section of the face gear.

    Returns
    -------
    float
        m.

    Raises
    ------
    ValueError
        For a section without a layer.
    """
    layer = section.layer
    if layer is None:
        raise ValueError("a section without teeth")
    width = layer.outer_radius - layer.inner_radius
    r = layer.inner_radius + 0.5 * width * (GAUSS[0] + 1.0)
    first, last = section.edges[:, 0], section.edges[:, 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        part = (r[:, None] - first[:, 0]) / (last[:, 0] - first[:, 0])
        height = first[:, 1] + part * (last[:, 1] - first[:, 1])
    top = layer.back + layer.rise(r)
    crossings = (part >= 0.0) & (part <= 1.0) & (height < top[:, None] - SAME_HEIGHT)
    back = np.where(crossings, height, -np.inf).max(axis=1)
    return float(min(0.5 * GAUSS[1] @ (top - back), width))


SIZES = (0.5, 1.6, 0.9)
"""Profile, width and thickness of the elements in modules."""
ELEMENTS_AT_ONCE = 64
"""Number of elements integrated together, which bounds memory; results do not depend on it."""
DEGREE = 5
"""Polynomial degree up to which integrals over elements are exact; products of quadratic shapes need 4."""


def tooth_energies(
    design: PairDesign, material: Material, rim: float, order: int, sizes: tuple[float, ...] = SIZES
) -> Array:
    """Compute twice the elastic energy of the whole ring of teeth and rim in two waves, by one cyclic
    sector.

    The back of the rim is flat; below a root that is a cone it is as thick on the mean as `rim`.

    At the back of the rim the motion along the axis is prescribed: in the first wave its amplitude is 1
    m, in the second 1 m for each metre from the middle of the teeth outwards.

    Parameters
    ----------
    design : PairDesign
        Pair of gears.
    material : Material
        Material of the face gear.
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
    ends = np.array([design.face_gear.inner_radius, design.face_gear.outer_radius])
    roots = root_height(design, ends)
    lowest = rim - float(roots.mean() - roots.min())
    design = replace(design, face_gear=replace(design.face_gear, rim_thickness=lowest))
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
    """Assemble the elastic stiffness of a mesh of 27-node hexahedra.

    Dof 3 k + i is the displacement of node k along axis i.

    Parameters
    ----------
    mesh : MeshHex2
        Mesh with n nodes.
    material : Material
        Material of the elements.

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
    """Compute u^H K u, twice the energy, of motions u with prescribed values at some dof and no force on
    all others.

    Parameters
    ----------
    stiffness : (n, n) sparse matrix
        N/m, real or Hermitian.
    fixed_dof : (f,) array of int
        Numbers of the dof.
    values : (f, k) array
        Displacements, real or complex, of k motions, m.

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


ORDER = 4
"""Nodal diameters of the waves; three to six give the same numbers to 1 %."""
ELEMENTS = (6, 4, 4)
"""Number of elements for the layer's energies: along the radius, through the rim and through the layer."""
FIT_TOLERANCE = 1e-8
"""Relative error up to which the layer's energies equal those of the teeth; far below the model's error."""


def fitted_teeth(section: Section, design: PairDesign) -> Section:
    """Return the section with the two fractions `hoop` and `shear` of its layer fitted to the real teeth.

    Both are solved for such that `layer_energies` equal `tooth_energies` in two waves of order ORDER on
    the section's mean rim.

    Parameters
    ----------
    section : Section
        Section of the face gear; returned as it is without a layer.
    design : PairDesign
        Pair of gears.

    Returns
    -------
    Section
        Section with fitted hoop and shear stiffness.

    Raises
    ------
    NotConverged
        Where no stiffness gives the energies of the teeth.
    """
    layer = section.layer
    if layer is None:
        return section
    rim = rim_below(section)
    target_energies = tooth_energies(design, section.material, rim, ORDER)

    def ratios(logarithms: Array) -> Array:
        """Return the logarithms (2,) of energies of layer over teeth, by the logarithms (2,) of `hoop`
        and `shear`.
        """
        hoop, shear = np.exp(logarithms)
        return np.log(layer_energies(replace(layer, hoop=hoop, shear=shear), section, rim) / target_energies)

    solution = root(ratios, np.log([layer.hoop, layer.shear]), tol=FIT_TOLERANCE)
    if np.abs(solution.fun).max() > 1e2 * FIT_TOLERANCE:
        off = f"energies of layer and teeth differ by {100 * np.abs(solution.fun).max():.2g} %"
        raise NotConverged("layer of teeth", f"rim {1e3 * rim:g} mm", off)
    hoop, shear = np.exp(solution.x).tolist()
    return replace(section, layer=replace(layer, hoop=hoop, shear=shear))


def layer_energies(layer: Layer, section: Section, rim: float) -> Array:
    """Compute twice the energy of a layer on a rim in the two waves of `tooth_energies`, of order ORDER.

    Layer and rim are taken as flat, and as thick as they are on the mean.

    Parameters
    ----------
    layer : Layer
        Layer of teeth.
    section : Section
        Section of the face gear, for its material.
    rim : float
        Thickness of the rim, m.

    Returns
    -------
    (2,) array
        J.
    """
    layer = replace(layer, slope=0.0)
    mesh = strip(layer, rim)
    corners = rectangle(layer.inner_radius, layer.outer_radius, layer.back - rim, layer.back)
    whole = replace(section, corners=corners, is_edge_held=(False,) * 4, layer=layer)
    elements = elements_of(mesh)
    stiffness = elastic_stiffness(whole, mesh, elements).at(ORDER)
    r, height = elements.shape_points
    back = np.flatnonzero(np.isclose(height, layer.back - rim, rtol=0.0, atol=1e-9))
    middle = 0.5 * (layer.inner_radius + layer.outer_radius)
    is_rising = np.stack([np.ones(back.size), r[back] - middle], axis=1)
    return energies(stiffness, 3 * back + 2, is_rising)


def strip(layer: Layer, rim: float) -> BodyMesh:
    """Return the mesh of a rectangular rim with the layer on it, with the numbers of elements in
    ELEMENTS.

    Parameters
    ----------
    layer : Layer
        Layer of teeth.
    rim : float
        Thickness of the rim, m.

    Returns
    -------
    BodyMesh
        Mesh, m.
    """
    across, below, above = ELEMENTS
    r = np.linspace(layer.inner_radius, layer.outer_radius, across + 1)
    heights = np.concatenate(
        [
            np.linspace(layer.back - rim, layer.back, below + 1),
            np.linspace(layer.back, layer.front, above + 1)[1:],
        ]
    )
    nodes = np.stack(np.meshgrid(r, heights), axis=-1).reshape(-1, 2)
    first = (np.arange(below + above)[:, None] * (across + 1) + np.arange(across)).ravel()
    quads = np.stack([first, first + 1, first + across + 2, first + across + 1], axis=1)
    return BodyMesh(nodes, quads, np.repeat([False, True], [below * across, above * across]))
