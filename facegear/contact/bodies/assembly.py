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

from facegear.arrays import Array, Integers
from facegear.contact.bodies.element_matrices import element_stiffness
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
