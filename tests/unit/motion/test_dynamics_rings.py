"""Bearings with play in the dynamics: the exact ring, against SciPy, statics and Liouville's theorem."""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from recorded_motion import record
from references import against, agrees
from scipy_motions import gap_to_scipy, kicked

from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.sharing.hunting import hunting_cycle

ONE = (("engine", Role.INPUT, 0.0),)
TWO = (("engine", Role.INPUT, 0.0), ("idler", Role.IDLER, 35.5))


def machine_with(clearance, places=TWO, sides=tuple(Side), torque=900.0, **options):
    layout = make_layout(places, sides, kinematics=GEOMETRIC)
    errors = options.pop("errors", {})
    flaws = replace(perfect(layout), bearing_clearance=np.full(len(places), clearance), **errors)
    return make_machine(layout, torque, 0.0, error=8e-6, imperfections=flaws, **options)


def pulling_rings(system):
    """Forces of the bearings with clearance, written out once more."""
    rows = system.mesh_jacobian[system.contacts :].reshape(-1, 3, system.size)

    def acting(cycles, y, v, pressed):
        pull = np.zeros(system.size)
        for row, spring, clearance in zip(rows, system.ring_stiffness, system.ring_clearance, strict=True):
            q, q_rate = row[:2] @ y, row[:2] @ v
            r = np.hypot(*q)
            if r > clearance:
                jacobian = (1.0 - clearance / r) * np.eye(2) + clearance / r**3 * np.outer(q, q)
                force = spring * ((1.0 - clearance / r) * q + system.ring_lag * jacobian @ q_rate)
                pull -= row[:2].T @ force
        return pull

    return acting


@against(
    "third-party program",
    "scipy.integrate.solve_ivp",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("clearance", [3e-6, 40e-6])
def test_a_bearing_with_clearance_moves_as_scipy_says_through_touching_and_leaving(clearance):
    model = build_model(machine_with(clearance, ONE, torque=20.0, backlash=20e-6))
    omega = TAU * 1500.0
    start = kicked(model, 0.15)
    run = record(model.system, omega, start, 2, Settings(tolerance=1e-13))
    rim = run.states[:, model.system.contacts + 2 :: 3]
    assert (rim == 0).any() and (rim == 1).any()
    phases = np.linspace(0.0, 2.0 * TAU, 21)
    gap = gap_to_scipy(model, omega, pulling_rings(model.system), start, run, phases, 1e-11)
    agrees("largest difference of the motion, m", gap, 0.0, absolute=2e-6 * model.system.scale)


@against(
    "analytic",
    "Liouville's formula",
    capability="dynamics_response branches",
    module="facegear.motion.integrator.integrator",
)
def test_liouville_holds_while_bearings_touch_and_leave_their_rings():
    model = build_model(machine_with(40e-6, ONE, torque=20.0, backlash=20e-6))
    omega = TAU * 1500.0
    integrator = Integrator(model.system, omega, 1e-14, 20)
    start, n = kicked(model, 0.15), integrator.size
    state = integrator.by_phase(start)
    matrix, run = monodromy(integrator, state, 1)
    rim = run.fractions[1, model.system.contacts + 2 :: 3]
    assert ((rim > 0.0) & (rim < 1.0)).any()
    sign, volume = np.linalg.slogdet(matrix)
    assert sign > 0
    agrees("logarithm of the determinant", volume, run.divergence, absolute=1e-8)
    # The matrix itself, against differences of neighbouring runs.
    for column in range(0, 2 * n, 5):
        moved = []
        for sign in (-1.0, 1.0):
            change = np.zeros((2, n))
            change[divmod(column, n)] = sign * 1e-9
            near = State(state[0] + change[0], (state[1] + change[1]) * omega)
            run = record(model.system, omega, near, 1, Settings(tolerance=1e-14))
            moved.append(run.at(np.array([TAU]))[0][0])
        slope_ = (moved[1] - moved[0]) / 2e-9
        np.testing.assert_allclose(matrix[:n, column], slope_, atol=2e-4 * np.abs(matrix).max())


def test_without_clearance_the_ring_is_the_bearing():
    tiny, none = (
        simulate(machine_with(clearance), 2500.0, Settings(tolerance=1e-10)) for clearance in (1e-13, 0.0)
    )
    assert tiny.label == none.label == "period-1"
    np.testing.assert_allclose(tiny.forces, none.forces, atol=1e-6 * np.abs(none.forces).max())


def test_slow_running_with_clearance_is_the_quasi_static_machine():
    errors = {"position": 1e-6 * np.array([[30.0, 10.0], [-20.0, 5.0]])}
    machine = machine_with(25e-6, torque=250.0, errors=errors)
    still = hunting_cycle(machine, 32).at_rest.forces
    gaps = []
    for speed in (160.0, 40.0):
        settings = Settings(samples=32, dwell=2, settle=2, window=1, refine=False)
        response = simulate(machine, speed, settings)
        moving = response.forces[: response.per_period : response.per_period // 32]
        gaps.append(np.abs(moving - still).max() / np.abs(still).max())
    assert gaps[1] < 2e-3 and gaps[1] < 0.5 * gaps[0]
