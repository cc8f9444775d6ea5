"""The motion of a machine with two coordinates more and gyroscopic terms, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from rocking_bodies import InOtherCoordinates, Rocking

from facegear.harmonics import Harmonics
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.machine import OpenFlanks
from facegear.motion.bearing_forces import bearing_history
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Motion, Settings, State
from facegear.motion.steady_state.simulate import build_model, simulate, static_start

BODY, J, STIFFNESS, POLAR = "one", 0.003, 5e4, 0.005
PLACES = ((BODY, Role.INPUT, 0.0), ("two", Role.INPUT, 40.25))
SPEED, K, ERROR = 6100.0, 4.1e8, 2e-6
TURNING, MESHING = SPEED * np.pi / 30.0, 23 * SPEED * np.pi / 30.0
LEVERS = np.array([[0.02, -0.008], [0.0, 0.0], [0.015, 0.01], [0.0, 0.0]])


def machine_with(bodies):
    layout = make_layout(PLACES, (Side.UPPER,), kinematics=GEOMETRIC)
    constant = Harmonics(np.zeros(1), np.array([K]))
    options = {"stiffness": constant, "error": ERROR, "open_flanks": OpenFlanks.CONTACT_ONLY}
    return replace(make_machine(layout, **options), bodies=bodies)


ROTORS = {
    "gyroscopic": Rocking(BODY, J, STIFFNESS, POLAR, levers=LEVERS),
    "geared up, damped and softened": Rocking(
        BODY, J, STIFFNESS, POLAR, levers=LEVERS, turning_damping=0.8, softening=0.2 * J, ratio=0.7
    ),
    "on a shaft": Rocking(BODY, J, STIFFNESS, POLAR, levers=LEVERS, leaning=5e5),
}


@pytest.mark.parametrize("polar, damping, softening", [(POLAR, 0.0, 0.0), (POLAR, 2.0, 0.0), (2 * J, 0.5, J)])
def test_a_rotor_let_go_whirls_as_the_closed_form_says(polar, damping, softening):
    rotor = Rocking(BODY, J, STIFFNESS, polar, (1e-3, 0.0), turning_damping=damping, softening=softening)
    model = build_model(machine_with(rotor))
    basis, linear = model.reduction.basis, model.machine.linear
    moved, rates = np.zeros((2, linear.size))
    moved[-2:], rates[-2:] = (1e-4, -2e-4), (0.3, 0.1)
    start = static_start(model)
    start = State(start.displacement + basis.T @ linear.momentum(moved), basis.T @ linear.momentum(rates))
    integrator = Integrator(model.system, MESHING, 1e-11)
    ends = integrator.run(integrator.by_phase(start), 60).ends
    found = (ends[:, 0] @ basis.T)[:, -2:] @ [1.0, 1.0j]

    own = linear.mass_damping + linear.bearing_damping * STIFFNESS / J + damping / J
    spring = (STIFFNESS - 1j * TURNING * damping - TURNING**2 * softening) / J
    roots = np.roots([1.0, own - 1j * TURNING * polar / J, spring])
    standing = 1e-3 / J / spring
    resting = 1e-3 / STIFFNESS
    initial = [resting + 1e-4 - 2e-4j - standing, 0.3 + 0.1j]
    parts = np.linalg.solve([[1.0, 1.0], roots], initial)
    times = 2.0 * np.pi * np.arange(1, 61) / MESHING
    exact = standing + np.exp(np.outer(times, roots)) @ parts
    np.testing.assert_allclose(found, exact, atol=1e-9 * np.abs(exact).max())


def harmonic(machine):
    """Complex displacements (n,) of the first harmonic in full matrices, both drive flanks always closed."""
    linear, spin = machine.linear, machine.linear.spin
    rows, c = linear.rows[:2], machine.damping.mesh
    closed = rows.T @ rows
    damping = linear.damping + TURNING * spin.gyroscopic + c * closed
    spring = linear.stiffness + TURNING * spin.circulatory + TURNING**2 * spin.centrifugal + K * closed
    dynamic = -(MESHING**2) * linear.mass + 1j * MESHING * damping + spring
    error = ERROR * np.exp(-2j * np.pi * machine.phases)
    return np.linalg.solve(dynamic, rows.T @ ((K + 1j * MESHING * c) * error)), damping, spring


@pytest.fixture(scope="module", params=ROTORS)
def running(request):
    """Machine, model and its steady response."""
    machine = machine_with(ROTORS[request.param])
    model = build_model(machine)
    return (
        machine,
        model,
        simulate(model, SPEED, Settings(tolerance=1e-11, periodic_residual=1e-12, samples=256)),
    )


def test_transmission_error_shakes_a_turning_body_as_the_closed_form_says(running):
    machine, model, response = running
    assert (response.motion, response.period) == (Motion.PERIODIC, 1)
    moving = response.coordinates @ model.reduction.basis.T
    moving -= moving.mean(axis=0)
    exact, _, _ = harmonic(machine)
    exact = np.real(exact * np.exp(2j * np.pi * response.phases[:, None]))
    turns = machine.layout.spins
    moving[:, turns] -= moving[:, turns].mean(axis=1, keepdims=True)  # the rigid rotation is left out
    exact[:, turns] -= exact[:, turns].mean(axis=1, keepdims=True)
    tilts = slice(-2, None)
    np.testing.assert_allclose(moving[:, tilts], exact[:, tilts], atol=1e-8 * np.abs(exact[:, tilts]).max())
    deflections = (moving @ machine.linear.rows.T)[:, :2]
    expected = (exact @ machine.linear.rows.T)[:, :2]
    np.testing.assert_allclose(np.ptp(deflections, axis=0), np.ptp(expected, axis=0), rtol=1e-6)


def test_multipliers_of_a_turning_machine_are_those_of_its_full_matrices(running):
    machine, _, response = running
    linear = machine.linear
    _, damping, spring = harmonic(machine)
    inverse, n = np.linalg.inv(linear.mass), linear.size
    system = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ spring, -inverse @ damping]])
    exact = np.exp(np.linalg.eigvals(system) * 2.0 * np.pi / MESHING)
    off = np.abs(response.multipliers[:, None] - exact).min(axis=1)
    assert off.max() < 1e-9


def test_bearings_of_a_turning_machine_carry_their_springs_and_dampers(running):
    machine, model, response = running
    linear = machine.linear
    complex_force = (1.0 + 1j * MESHING * linear.bearing_damping) * (linear.stiffness @ harmonic(machine)[0])
    exact = np.real(complex_force * np.exp(2j * np.pi * response.phases[:, None]))[:, linear.translations]
    found = bearing_history(model, response)
    found = found - found.mean(axis=0)
    np.testing.assert_allclose(found, exact, atol=1e-6 * np.abs(exact).max())


def test_the_response_does_not_depend_on_the_coordinates_of_a_body():
    plain = machine_with(None)
    rotor = ROTORS["gyroscopic"]
    transform = np.eye(plain.linear.size + 2)
    transform[-2:, -2:] = [[0.9, 0.3], [-0.2, 1.1]]
    transform[-2:, 8:10] = [[0.2, -0.4], [0.5, 0.1]]
    settings = Settings(tolerance=1e-10, periodic_residual=1e-12)
    one, other = (
        simulate(machine_with(bodies), SPEED, settings)
        for bodies in (rotor, InOtherCoordinates(rotor, transform))
    )
    np.testing.assert_allclose(other.deflections, one.deflections, atol=1e-8 * np.abs(one.deflections).max())


def test_coordinates_that_nothing_couples_beside_the_meshes_take_the_short_way():
    assert build_model(machine_with(None)).system.coupling is None
    still = Rocking(BODY, J, STIFFNESS, levers=LEVERS)
    assert build_model(machine_with(still)).system.coupling is None
    assert build_model(machine_with(replace(still, polar=POLAR))).system.coupling is not None
