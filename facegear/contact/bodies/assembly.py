"""Stiffness of linear elastic bodies: scikit-fem's bases, contracted to element matrices in batches.

scikit-fem's form assembly gives the same matrix to rounding and is the reference in the tests; for the
27-node element it is about ten times slower, which would make it the longest part of a compliance job.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.sparse as sp
from skfem import Basis, MeshHex2
from skfem.assembly import Dofs

from facegear.arrays import Array, Integers
from facegear.contact.bodies.cellwise import Part
from facegear.contact.bodies.element_matrices import element_stiffness
from facegear.contact.bodies.elements import KINDS, mesh_of
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
    kind, degree = KINDS[element]
    mapping = finer.mapping()
    mapping.invDF = _last_kept(mapping.invDF)
    shared = {"mapping": mapping, "dofs": Dofs(finer, kind()), "disable_doflocs": True}

    def matrices(members: Integers) -> Array:
        basis = Basis(finer, kind(), intorder=degree, elements=elements[members], **shared)
        return element_stiffness(basis, material)

    rows = (3 * nodes[:, :, None] + np.arange(3)).reshape(len(nodes), -1)
    return Part(matrices, rows, moved, np.tile(cell, copies))


def _last_kept(function: Callable[..., Array]) -> Callable[..., Array]:
    """A function of a mapping that keeps its last result: a basis asks for it with each of its functions."""
    asked: tuple[Any, ...] = ()
    result = np.zeros(0)

    def kept(*given: Any) -> Array:
        nonlocal asked, result
        if len(given) != len(asked) or any(a is not b for a, b in zip(given, asked, strict=True)):
            asked, result = given, function(*given)
        return result

    return kept
