"""Stiffness of linear elastic bodies: scikit-fem's bases, contracted to element matrices in batches.

scikit-fem's form assembly gives the same matrix to rounding and is the reference in the tests; for the
27-node element it is about ten times slower, which would make it the longest part of a compliance job.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from skfem import Basis, Mesh, MeshHex2
from skfem.assembly import Dofs
from skfem.models.elasticity import lame_parameters

from facegear.arrays import Array, Integers
from facegear.contact.bodies.elements import KINDS, mesh_of
from facegear.contact.options import Element
from facegear.geometry.design import Material
from facegear.machine_code.compiler import compiler

compiled = compiler()

ELEMENTS_AT_ONCE = 512


@dataclass(frozen=True, eq=False)
class Part:
    """Elements (m,) of a mesh, and the node of the whole system that each of the mesh's nodes is, (n,)."""

    mesh: MeshHex2
    elements: Integers
    nodes: Integers


def element_stiffness(basis: Basis, material: Material) -> Array:
    """Stiffness (m, 3 a, 3 a) of a scalar basis' elements, each of their a functions taken for x, y and z.

    Dof 3 n + i is the displacement of local node n along axis i. Raises ValueError for an element that is
    turned inside out anywhere.
    """
    turned = np.sign(basis.mapping.detDF(basis.X, basis.tind))
    inverted = (turned != turned[:, :1]).any(axis=1)
    if inverted.any():
        raise ValueError(f"{np.count_nonzero(inverted)} elements are inverted")
    gradient = np.stack([function[0].grad for function in basis.basis])
    nodes, axes, elements, points = gradient.shape
    scaled = (gradient * np.sqrt(basis.dx)).transpose(2, 3, 0, 1).reshape(elements, points, nodes * axes)
    outer = (scaled.transpose(0, 2, 1) @ scaled).reshape(elements, nodes, axes, nodes, axes)
    lame, shear = lame_parameters(material.young_modulus, material.poisson_ratio)
    stiffness = lame * outer + shear * outer.transpose(0, 1, 4, 3, 2)
    trace = shear * np.einsum("maibi->mab", outer)
    for axis in range(axes):
        stiffness[:, :, axis, :, axis] += trace
    return stiffness.reshape(elements, nodes * axes, nodes * axes)


@compiled
def _scatter(elements: Integers, blocks: Array, indptr: Integers, indices: Integers, data: Array) -> None:
    nodes = elements.shape[1]
    for element in range(elements.shape[0]):
        for a in range(nodes):
            row = elements[element, a]
            first, last = indptr[row], indptr[row + 1]
            for b in range(nodes):
                slot = first + np.searchsorted(indices[first:last], elements[element, b])
                for i in range(3):
                    for j in range(3):
                        data[slot, i, j] += blocks[element, 3 * a + i, 3 * b + j]


def stiffness_matrix(
    parts: Sequence[Part], count: int, material: Material, element: Element = "hex27"
) -> sp.bsr_matrix:
    """Stiffness (3n, 3n) in N/m on `count` nodes; dof 3 k + i is the displacement of node k along axis i.

    `element` other than hex27 puts linear elements on the same nodes.
    """
    pieces = [_pieces(part, element) for part in parts]
    touched = np.concatenate([nodes for _, _, nodes in pieces])
    touches = sp.csr_matrix(
        (
            np.ones(touched.size, dtype=np.int32),
            (np.repeat(np.arange(len(touched)), touched.shape[1]), touched.ravel()),
        ),
        shape=(len(touched), count),
    )
    pattern = (touches.T @ touches).tocsr()
    pattern.sort_indices()
    data = np.zeros((pattern.nnz, 3, 3))
    for mesh, elements, nodes in pieces:
        kind, degree = KINDS[element]
        shared = {"mapping": mesh.mapping(), "dofs": Dofs(mesh, kind()), "disable_doflocs": True}
        for start in range(0, len(elements), ELEMENTS_AT_ONCE):
            batch = slice(start, start + ELEMENTS_AT_ONCE)
            basis = Basis(mesh, kind(), intorder=degree, elements=elements[batch], **shared)
            blocks = element_stiffness(basis, material)
            _scatter(nodes[batch], blocks, pattern.indptr, pattern.indices, data)
    return sp.bsr_matrix((data, pattern.indices, pattern.indptr), shape=(3 * count, 3 * count))


def _pieces(part: Part, element: Element) -> tuple[Mesh, Integers, Integers]:
    """Mesh and elements of the wanted kind, and the nodes (m, a) of the system that each element has."""
    mesh = mesh_of(part.mesh, element)
    copies, whole = mesh.nelements // part.mesh.nelements, part.mesh.nelements
    elements = (part.elements + whole * np.arange(copies)[:, None]).ravel()
    nodes = mesh.dofs.element_dofs[:, elements].T
    return mesh, elements, part.nodes[nodes]
