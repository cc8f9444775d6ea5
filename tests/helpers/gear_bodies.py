"""The gear body whose numbers other programs gave, and simple bodies with closed forms; each solved once."""

from dataclasses import replace
from functools import cache
from math import pi

import numpy as np

from facegear.gear_body.body import SolvedBody, solve_body
from facegear.gear_body.matrices import BodyMatrices, body_matrices
from facegear.gear_body.mesh import body_mesh
from facegear.gear_body.patch import Patch
from facegear.gear_body.reduced import ReducedBody
from facegear.gear_body.reduction import reduced_body
from facegear.gear_body.section import Hub, Rim, Section, Web, rectangle, wheel
from facegear.geometry.design import Material

STEEL = Material(206e9, 0.3)
TEETH = 143
PATCH = Patch(height=16.6875e-3, half_width=2 * 2 * pi / TEETH)
HUB, RIM = Hub(0.120, 0.140, -0.050, 0.0), Rim(0.250, 0.275, -0.012, 0.012)
WEB = Web(0.018, 0.012, -0.006, 25 / 110)


def section(held: bool = True, layer=None) -> Section:
    """Hub, conical web of 18 to 12 mm and ring of the tables below, bore held or free."""
    corners = wheel(HUB, WEB, RIM)
    bore = np.isclose(corners[:, 0], HUB.bore_radius) & np.isclose(
        np.roll(corners[:, 0], -1), HUB.bore_radius
    )
    return Section(corners, tuple((bore & held).tolist()), (0.250, 0.275), STEEL, 7850.0, layer)


@cache
def reference_body() -> SolvedBody:
    """The section with its modes below 10 kHz of 0 to 12 nodal diameters."""
    return solve_body(section(), 10_000.0, 12, TEETH)


@cache
def reference_modes() -> ReducedBody:
    """Its modes alone, as a machine takes them."""
    return reduced_body(reference_body(), PATCH, 0.002)


@cache
def reference_matrices() -> BodyMatrices:
    """Its matrices."""
    return body_matrices(section(), body_mesh(section()))


def rectangular(inner: float, outer: float, thickness: float, material: Material, held: bool, across: int):
    """Matrices of a disc or ring of density 1 kg/m3 with its bore held or free."""
    corners = rectangle(inner, outer, -0.5 * thickness, 0.5 * thickness)
    edges = (False, False, False, held)
    shape = Section(corners, edges, (0.5 * (inner + outer), outer), material, 1.0)
    return body_matrices(shape, body_mesh(shape, across))


def at(body: BodyMatrices, r: float, height: float) -> int:
    """Number of the scalar shape that stands at a place."""
    return int(np.argmin(np.hypot(*(body.elements.places - np.array([[r], [height]])))))


def small_body(seed=0) -> ReducedBody:
    """Two modes of 0 to 3 nodal diameters with matrices that no symmetry simplifies."""
    random = np.random.default_rng(seed)
    order = np.repeat(np.arange(4), 2)
    same = order[:, None] == order
    coriolis, stiffening = (np.where(same, 0.5 * (a + a.T), 0.0) for a in random.uniform(-1, 1, (2, 8, 8)))
    turning = np.array([0.0, 1.0, 0, 0, 0, 0, 0, 0])
    coriolis[0, 0] = coriolis[1, 1] = stiffening[0, 1] = stiffening[1, 0] = 0.0
    body = ReducedBody(
        order=order,
        frequency=random.uniform(20, 60, 8),
        coriolis=coriolis,
        stiffening=stiffening,
        mesh=random.uniform(0.1, 0.3, (2, 8)),
        hub=np.where(order < 2, random.uniform(0.1, 1.0, (2, 8)), 0.0),
        hub_spin=np.where(order == 0, 0.3, 0.0),
        round=turning,
        static=np.zeros((5, 2, 2)),
        damping_ratio=np.array(0.02),
    )
    residual = np.zeros((5, 2, 2))
    residual[4] = np.diag([2e-10, 3e-10])
    return replace(body, static=body.modal + residual)
