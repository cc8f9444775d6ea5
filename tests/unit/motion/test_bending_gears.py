"""The motion of machines whose face gears bend and turn: disturbances, multipliers, power and reactions."""

from dataclasses import replace

import gear_bodies
import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from random_machines import kicked
from recorded_motion import record
from references import against, agrees

from facegear.harmonics import Harmonics
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.flank_errors import error_series
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Tilt
from facegear.machine.machine import OpenFlanks
from facegear.machine.torques import balanced_torques
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import build_model, simulate

PLACES = (("one", Role.INPUT, 0.0), ("two", Role.INPUT, 41.5))
SPEED, K = 6100.0, 4.1e8
TURNING, OMEGA = SPEED * np.pi / 30.0, 23 * SPEED * np.pi / 30.0


def machine(open_flanks=OpenFlanks.CONTACT_ONLY, error=2e-6, torque=800.0):
    """Two pinions between two gears that bend and share the load: modes of 0 to 3 nodal diameters between 0.8
    and 2.4 kHz. The hub of the upper one tilts on its bearings.
    """
    layout = make_layout(PLACES, kinematics=GEOMETRIC)
    held = [replace(gear.body, mass=31.0, inertia=1.3) for gear in layout.gears]
    held[1] = replace(held[1], tilt=Tilt(3.0, 5e7, 0.01))
    gears = tuple(replace(gear, body=body) for gear, body in zip(layout.gears, held, strict=True))
    layout = replace(layout, gears=gears)
    bodies = {}
    for gear in range(2):
        body = gear_bodies.small_body(gear + 1)
        body = replace(body, frequency=40.0 * body.frequency, static=body.static / 1600.0)
        placed = {"mass": 20.0, "moment": 0.3, "pitch_height": 0.02}
        bodies[gear] = replace(body, **{name: np.array(value) for name, value in placed.items()})
    elastic = ElasticGears(layout, bodies)
    rigid = make_machine(
        layout,
        torque=torque,
        tail_share=0.0,
        error=error,
        stiffness=Harmonics(np.zeros(1), np.array([K])),
        open_flanks=open_flanks,
    )
    ratio = layout.gear_radius / layout.pinion_radius
    torques = balanced_torques(layout, np.full(2, torque), -torque * ratio)
    return replace(rigid, torques=torques, bodies=elastic, softening=elastic.softening())


@against(
    "analytic",
    "Liouville's formula; central differences of the motion",
    capability="dynamics_response branches",
    module="facegear.motion.integrator.reduction",
)
def test_disturbances_of_gears_that_bend_are_differences_of_motions_and_keep_their_volume():
    """Contacts open and close; gyroscopic and circulatory terms take no part in the volume."""
    model = build_model(machine(torque=100.0))
    integrator = Integrator(model.system, OMEGA, 1e-14, 20)
    start, n = kicked(model), integrator.size
    state = integrator.by_phase(start)
    matrix, run = monodromy(integrator, state, 1)
    flanks = run.fractions[1, : model.system.contacts]
    assert ((flanks > 0.0) & (flanks < 1.0)).any()
    sign, volume = np.linalg.slogdet(matrix)
    assert sign > 0
    agrees("logarithm of the volume of disturbances", volume, run.divergence, absolute=1e-9)
    for column in range(0, 2 * n, 17):
        moved = []
        for step in (-1e-9, 1e-9):
            change = np.zeros(2 * n)
            change[column] = step
            near = State(state[0] + change[:n], (state[1] + change[n:]) * OMEGA)
            later = record(model.system, OMEGA, near, 1, Settings(tolerance=1e-14))
            moved.append(later.at(np.array([TAU]))[0][0])
        difference = (moved[1] - moved[0]) / 2e-9
        agrees(
            "disturbance of the coordinates over the largest",
            matrix[:n, column] / np.abs(matrix).max(),
            difference / np.abs(matrix).max(),
            absolute=2e-5,
        )


@pytest.fixture(scope="module")
def running():
    """Machine, model and its steady response; flanks that are closed stay so."""
    bent = machine()
    model = build_model(bent)
    return (
        bent,
        model,
        simulate(model, SPEED, Settings(tolerance=1e-11, periodic_residual=1e-12, samples=256)),
    )


def whole_matrices(bent, closed):
    """Damping and stiffness (n, n) at speed with some flanks closed."""
    linear, spin, rows = bent.linear, bent.linear.spin, bent.linear.rows[closed]
    stiff = np.tile(bent.mean_stiffness, 2)[closed]
    damping = linear.damping + TURNING * spin.gyroscopic + bent.damping.mesh * rows.T @ rows
    spring = linear.stiffness + TURNING * spin.circulatory + TURNING**2 * spin.centrifugal
    return damping, spring + (stiff * rows.T) @ rows


@against(
    "analytic",
    "eigenvalues of the whole matrices",
    capability="dynamics_response",
    module="facegear.motion.steady_state.orbits",
)
def test_multipliers_of_gears_that_bend_are_those_of_the_whole_matrices(running):
    bent, _, response = running
    assert response.label == "period-1" and abs(response.liouville) < 1e-9
    forces = response.forces.mean(axis=0)
    closed = np.concatenate([forces > 0.0, forces < 0.0])
    damping, spring = whole_matrices(bent, closed)
    n = bent.linear.size
    inverse = np.linalg.inv(bent.linear.mass)
    system = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ spring, -inverse @ damping]])
    exact = np.exp(np.linalg.eigvals(system) * TAU / OMEGA)
    off = np.abs(response.multipliers[:, None] - exact).min(axis=1)
    agrees("multiplier", off, np.zeros(off.size), absolute=1e-9)


@against(
    "analytic",
    "balance of power, of forces and of torques over a period",
    capability="dynamics_response",
    module="facegear.motion.steady_state.simulate",
)
def test_steady_motion_of_gears_that_bend_balances_power_reactions_and_torques(running):
    """Power from the transmission error goes into flanks, bearings and steel.

    Rotating steel may take power from the rotation. Mean reactions of bearings and bodies hold the mean flank
    forces.
    """
    bent, model, response = running
    linear, w = bent.linear, OMEGA
    q = response.coordinates @ model.reduction.basis.T
    rate = derivative(q, w)
    flanks = q @ linear.rows.T
    forces = np.concatenate([np.maximum(response.forces, 0.0), np.maximum(-response.forces, 0.0)], axis=1)
    closed = forces.mean(axis=0) > 0.0
    errors = np.stack([series(response.phases) for series in error_series(bent)], axis=1)
    damper = bent.damping.mesh * closed * derivative(flanks - errors, w)
    brought = ((forces + damper) * derivative(errors, w)).sum(axis=1)
    steel = TURNING * np.einsum("ki,ij,kj->k", rate, linear.spin.circulatory, q)
    spent = np.einsum("ki,ij,kj->k", rate, linear.damping, rate) + steel
    spent += (damper * derivative(flanks - errors, w)).sum(axis=1)
    assert abs(steel.mean()) > 1e-4 * abs(brought.mean())
    agrees("power that the errors bring in, W", -brought.mean(), spent.mean(), relative=1e-6)
    spring = linear.stiffness + TURNING**2 * linear.spin.centrifugal + TURNING * linear.spin.circulatory
    left = q.mean(axis=0) @ spring.T + forces.mean(axis=0) @ linear.rows - linear.loads
    size = np.abs(forces).max()
    agrees("mean force out of balance", left / linear.lengths / size, np.zeros(left.size), absolute=1e-9)


def derivative(values, frequency):
    """Time derivatives (K, n) of periodic values (K, n), by their spectrum."""
    spectrum = np.fft.rfft(values, axis=0)
    order = np.arange(len(spectrum))[:, None]
    return np.fft.irfft(1j * order * frequency * spectrum, len(values), axis=0)
