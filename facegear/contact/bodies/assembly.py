"""Stiffness of linear elastic bodies: scikit-fem's elements, contracted to element matrices in batches.

scikit-fem's form assembly gives the same matrix to rounding and is the reference in the tests; for the
27-node element it is many times slower, which would make it the longest part of a compliance job.
"""

import numpy as np
import scipy.sparse as sp
from skfem import MeshHex2

from facegear.arrays import Array, Integers
from facegear.contact.bodies.cellwise import Part
from facegear.contact.bodies.element_matrices import isoparametric_stiffness
from facegear.contact.bodies.elements import mesh_of
from facegear.contact.options import Element
from facegear.geometry.design import Material


def elements_of(
    mesh: MeshHex2,
    elements: Integers,
    cell: Integers,
    moved: sp.csr_matrix,
    material: Material,
    element: Element = "hex27",
) -> Part:
    """Stiffness, N/m, of the elements (m,) of a mesh, in cells (m,).

    moved (3 q, n): displacements of the mesh's q nodes by the unknowns; dof 3 k + i is the displacement of
    node k along axis i. `element` other than hex27 puts linear elements on the same nodes.
    """
    finer = mesh_of(mesh, element)
    copies, whole = finer.nelements // mesh.nelements, mesh.nelements
    elements = (elements + whole * np.arange(copies)[:, None]).ravel()
    nodes = finer.dofs.element_dofs[:, elements].T.astype(np.int64)

    def matrices(members: Integers) -> Array:
        return isoparametric_stiffness(finer.doflocs.T[nodes[members]], element, material)

    rows = (3 * nodes[:, None, :] + np.arange(3)[:, None]).reshape(len(nodes), -1)
    return Part(matrices, rows, moved, np.tile(cell, copies))
