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
    transformation: sp.csr_matrix,
    material: Material,
    element: Element = "hex27",
) -> Part:
    """Return the stiffness of some elements of a mesh as a part of a large matrix.

    Parameters
    ----------
    mesh : MeshHex2
        Mesh with q nodes.
    elements : (m,) array of int
        Numbers of the elements.
    cell : (m,) array of int
        Cell of each element.
    transformation : (3 q, n) sparse matrix
        Displacements of the mesh's nodes by the unknowns; dof 3 k + i is the displacement of node k along
        axis i.
    material : Material
        Of the elements.
    element : Element
        Other elements than hex27 are linear elements on the same nodes, for comparison.

    Returns
    -------
    Part
        Stiffness, N/m.
    """
    finer = mesh_of(mesh, element)
    copies, whole = finer.nelements // mesh.nelements, mesh.nelements
    elements = (elements + whole * np.arange(copies)[:, None]).ravel()
    nodes = finer.dofs.element_dofs[:, elements].T.astype(np.int64)

    def matrices(members: Integers) -> Array:
        return isoparametric_stiffness(finer.doflocs.T[nodes[members]], element, material)

    rows = (3 * nodes[:, None, :] + np.arange(3)[:, None]).reshape(len(nodes), -1)
    return Part(matrices, rows, transformation, np.tile(cell, copies))
