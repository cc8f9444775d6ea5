"""The gear body whose numbers other programs gave, simple bodies with closed forms, each solved once, and the
paper's gearbox on them.
"""

from dataclasses import replace
from functools import cache
from math import pi

import numpy as np
from lumped_machines import make_layout, make_machine

from facegear.harmonics import Harmonics
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.statics import mean_equilibrium
from facegear.parts.body_mesh import body_mesh
from facegear.parts.gear_body import SolvedBody, reduced_body, solve_body
from facegear.parts.matrices import BodyMatrices, body_matrices
from facegear.parts.reduced_body import ReducedBody, RimForces
from facegear.parts.section import Section, rectangle
from facegear.parts.wheel import Hub, Patch, Rim, Web, wheel
from facegear.teeth.design import Material

STEEL = Material(206e9, 0.3)
TEETH = 143
PATCH = Patch(height=16.6875e-3, half_width=2 * 2 * pi / TEETH)
HUB, RIM = Hub(0.120, 0.140, -0.050, 0.0), Rim(0.250, 0.275, -0.012, 0.012)
WEB = Web(0.018, 0.012, -0.006, 25 / 110)
ANGLE = np.radians(25)
RIGID = [-7511.2, -6367.7, 10123.2, 10123.2, -6367.7, 5200.7, 6367.7, 23854.4, 23854.4, 6367.7]
FLEXIBLE = [-7791, -6308, 10331, 10564, -6796, 5481, 6308, 23647, 23413, 6796]
"""Mesh forces of `gearbox`, N, on rigid gears and on two of `reference_body`, as another program has them."""


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
    return int(np.argmin(np.hypot(*(body.elements.shape_points - np.array([[r], [height]])))))


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
        mesh=np.concatenate([random.uniform(0.1, 0.3, (2, 8)), np.zeros((1, 8))]),
        hub=np.where(order < 2, random.uniform(0.1, 1.0, (2, 8)), 0.0),
        hub_spin=np.where(order == 0, 0.3, 0.0),
        round=turning,
        static=np.zeros((5, 3, 3)),
        damping_ratio=np.array(0.02),
    )
    mesh = body.mesh.copy()
    mesh[2] = random.uniform(-0.2, 0.2, 8) * (1.0 - turning)
    body = replace(body, mesh=mesh)
    residual = np.zeros((5, 3, 3))
    residual[4] = np.diag([2e-10, 3e-10, 1e-10])
    return replace(body, static=body.modal + residual)


def flank_direction(angle: float, back: bool = False) -> np.ndarray:
    """Axial, tangential and radial part of a unit force of spur teeth on the upper gear."""
    return np.array([-np.sin(angle), -np.cos(angle) if back else np.cos(angle), 0.0])


def spur_forces(sign: float = 1.0) -> RimForces:
    """Unit forces of both flanks of spur teeth on the rim of the upper or the lower gear."""
    mirror = np.array([1.0, sign, 1.0])
    return RimForces(
        np.stack([flank_direction(ANGLE, back) * mirror for back in (False, True)]),
        np.zeros(2),
        np.full(2, 0.268),
    )


def gearbox(body=None, **changes):
    """The paper's layout at 1328 N m, 2b = 100 um, k = 4.1e8 N/m, both gears with the same body."""
    layout = make_layout(kinematics=GEOMETRIC)
    gears = tuple(replace(gear, body=replace(gear.body, mass=31.0, inertia=1.3)) for gear in layout.gears)
    layout = replace(layout, gears=gears)
    constant = Harmonics(np.zeros(1), np.array([4.1e8]))
    machine = make_machine(layout, torque=1328, tail_share=0.034, error=0.0, stiffness=constant, **changes)
    if body is None:
        return machine
    elastic = ElasticGears(layout, {0: body, 1: body})
    return replace(machine, bodies=elastic, softening=elastic.softening())


def mesh_forces(machine):
    """Force of each mesh under the mean torques, N."""
    return mean_equilibrium(machine).forces[0]
