"""Known displacement fields of an elastic body: the error of each kind of element falls with its order.

The field is the gradient of a harmonic function: u = grad phi, div u = 0, and no body force whatever the
elastic constants. It is not a polynomial, so no element holds it exactly. Boundary nodes are given the field;
the nodes inside follow from the stiffness alone. The body is bent, so that its elements are curved.
"""

from dataclasses import replace

import numpy as np
import pytest
from contact_bodies import block, stiffness
from references import against, agrees
from scipy.sparse.linalg import spsolve

from facegear.contact.bodies.elements import ElasticBody
from facegear.contact.bodies.layer import tied_system
from facegear.contact.bodies.substructure import condense
from facegear.contact.options import Refinement

RATE_Y, RATE_Z = 1.3, 0.8
RATE_X = np.hypot(RATE_Y, RATE_Z)


def field(points):
    """Gradient (n, 3) of exp(a x) cos(b y) cos(c z), a^2 = b^2 + c^2."""
    x, y, z = points.T
    growth = np.exp(RATE_X * x)
    return np.stack(
        [
            RATE_X * growth * np.cos(RATE_Y * y) * np.cos(RATE_Z * z),
            -RATE_Y * growth * np.sin(RATE_Y * y) * np.cos(RATE_Z * z),
            -RATE_Z * growth * np.cos(RATE_Y * y) * np.sin(RATE_Z * z),
        ],
        axis=1,
    )


def bent(points):
    x, y, z = points.T
    return np.stack([x + 0.1 * y * z, y * (1 + 0.2 * x), z + 0.1 * x**2], axis=1)


def body(cells, part=False, held=lambda points: np.zeros(points.shape, dtype=bool)) -> ElasticBody:
    """A bent cube of `cells` hexahedra a side; `part`: only the middle third of its top may touch."""
    ends = np.linspace(0.0, 1.0, cells + 1)
    cube = block(ends, ends, ends, mapping=bent, held=held)
    if not part:
        return cube
    rows = slice(2 * (cells // 3), 4 * (cells // 3) + 1)
    return replace(cube, flank=cube.flank[rows, rows], normals=cube.normals[rows, rows])


def error_inside(cells, refinement, element="hex27", part=False):
    """RMS error of the nodes inside, relative to the largest displacement."""
    system = tied_system(body(cells, part), refinement, element)
    matrix, exact = stiffness(system.parts), field(system.points)
    inside = np.repeat(inner(system.points), 3)
    known = exact.ravel()
    solved = spsolve(matrix[inside][:, inside].tocsc(), -matrix[inside][:, ~inside] @ known[~inside])
    return np.sqrt(np.mean((solved - known[inside]) ** 2)) / np.abs(known).max()


def inner(points):
    """Mask of the points (n,) inside the bent cube, by Newton's method back to the straight cube."""
    straight = points.copy()
    for _ in range(30):
        straight += points - bent(straight)
    return ((straight > 1e-9) & (straight < 1 - 1e-9)).all(axis=1)


@against(
    "manufactured",
    "gradient of a harmonic function on a bent cube",
    capability="compliance",
    module="facegear.contact.bodies.layer",
)
@pytest.mark.parametrize(("element", "order"), [("hex27", 3), ("hex8", 2), ("tet4", 2)])
def test_displacements_converge_with_the_order_of_the_element(element, order):
    errors = [error_inside(count, Refinement(), element) for count in (3, 6)]
    measured = np.log2(errors[0] / errors[1])
    agrees(f"order of the displacements, {element}", measured, order, absolute=0.2, at_least=True)


@against(
    "manufactured",
    "gradient of a harmonic function on a bent cube",
    capability="compliance",
    module="facegear.contact.bodies.layer",
)
@pytest.mark.parametrize("cuts", [Refinement(2, 1, 1), Refinement(2, 2, 2, 1.5)])
def test_a_refined_layer_tied_to_coarse_elements_keeps_their_order(cuts):
    errors = [error_inside(cells, cuts, part=True) for cells in (3, 6)]
    measured = np.log2(errors[0] / errors[1])
    agrees("order of the displacements with a tied layer", measured, 3, absolute=0.2, at_least=True)


@against(
    "third-party program",
    "scipy.sparse.linalg.spsolve on the whole body",
    capability="compliance",
    module="facegear.contact.bodies.substructure",
)
def test_a_condensed_body_moves_as_the_whole_one_under_the_same_loads():
    cube = body(3, part=True, held=lambda points: np.repeat(points[:, 1:2] < 1e-9, 3, axis=1))
    system = tied_system(cube, Refinement(2, 1, 1))
    loads = np.random.default_rng(0).uniform(0.5, 1.5, system.spread.shape[0])
    force = np.zeros((len(system.points), 3))
    force[system.loaded_nodes] = (system.spread.T @ loads)[:, None] * system.loaded_normals
    loose = ~system.is_held.ravel()
    moved = np.zeros(loose.size)
    matrix = stiffness(system.parts)
    moved[loose] = spsolve(matrix[loose][:, loose].tocsc(), force.ravel()[loose])
    normal = (moved.reshape(-1, 3)[system.loaded_nodes] * system.loaded_normals).sum(axis=1)
    computed = condense(system).flank @ loads
    agrees("displacement of a loaded node, m", computed, system.spread @ normal, relative=1e-10)
