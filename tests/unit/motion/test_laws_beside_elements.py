"""Every mesh law beside every element of a machine: the Taylor recurrence follows its own accelerations."""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import power_table
from lumped_machines import make_layout, make_machine
from random_machines import frequency
from references import against, agrees
from scipy.integrate import solve_ivp
from test_bending_gears import machine as build_bending_gears

from facegear.machine.disturbances import PARTS, MeshFriction
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.machine import FlankTables, OpenFlanks
from facegear.meshing.power import PowerLaw
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.steady_state.simulate import build_model, static_start

SPEED_RPM, STRETCH = 7500.0, 0.5
LAYOUT = make_layout(kinematics=GEOMETRIC)
FLANKS = FlankTables(*(power_table(9, depth, 2e-6, 4e-4, 2.4e10) for depth in (0.2, 0.1)))


def make_friction(machine):
    ratios = 0.05 * np.random.default_rng(11).normal(size=(len(machine.layout.meshes), len(PARTS), 2, 3))
    ratios[:, :, 0, 0] = 0.0
    return replace(machine, friction=MeshFriction(ratios))


def make_clearance(machine):
    pinions = len(machine.layout.pinions)
    errors = replace(perfect(machine.layout), bearing_clearance=np.full(pinions, 1e-5))
    return replace(machine, imperfections=errors)


def make_pushing(machine):
    damping = replace(machine.damping, mesh=12e3, open_flanks=OpenFlanks.PUSH_ONLY)
    return replace(machine, damping=damping)


LAWS = {
    "linear": lambda machine: machine,
    "load-dependent": lambda machine: replace(machine, tables=len(machine.layout.gears) * (FLANKS,)),
    "power": lambda machine: replace(
        machine,
        law=PowerLaw(
            size=2.4e10, depth=0.2, level=2e-6, contacts=2 * len(machine.layout.meshes), largest=4e-4
        ),
    ),
}
ELEMENTS = {
    "rigid bodies": lambda machine: machine,
    "bearing clearance": make_clearance,
    "friction": make_friction,
    "flanks that only push": make_pushing,
    "friction, clearance, flanks that only push": lambda machine: make_pushing(
        make_clearance(make_friction(machine))
    ),
    "gears that bend": None,
    "gears that bend, friction, clearance": None,
}


def make_combined(law, element):
    if not element.startswith("gears that bend"):
        return ELEMENTS[element](LAWS[law](make_machine(LAYOUT, torque=300.0)))
    machine = LAWS[law](build_bending_gears(torque=300.0))
    return make_clearance(make_friction(machine)) if "friction" in element else machine


def assert_follows_its_accelerations(machine):
    model = build_model(machine)
    integrator = Integrator(model.system, frequency(model, SPEED_RPM), 1e-11)
    kick = np.random.default_rng(5).normal(size=(2, model.system.size))
    kick *= 0.2 * model.system.scale / np.abs(model.reduction.mesh_jacobian).max()
    start = integrator.by_phase(static_start(model)) + kick

    def rates(phase, state):
        both = state.reshape(2, -1)
        return np.concatenate([both[1], integrator.accelerations(float(phase), both)])

    phases = np.arange(1, 9) / 8.0 * STRETCH
    exact = solve_ivp(
        rates,
        (0.0, STRETCH * TAU),
        start.ravel(),
        "DOP853",
        t_eval=TAU * phases,
        rtol=1e-10,
        atol=1e-10 * model.system.scale,
    ).y[: model.system.size]
    samples = integrator.run(start, 1, samples=16).samples
    moved = np.abs(samples[1:9].T - exact) * integrator.weights[:, None]
    agrees("coordinates, scaled", moved.max() / integrator.scale, 0.0, absolute=1e-5)


@against(
    "third-party program",
    "SciPy's DOP853 on the accelerations of the same machine",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("law", LAWS)
def test_a_law_moves_beside_an_element_as_its_accelerations_say(law, element):
    assert_follows_its_accelerations(make_combined(law, element))
