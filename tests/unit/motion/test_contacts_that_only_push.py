"""Dampers that act in contact only: how far they pull, and contacts that are cut before they do."""

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from oscillators import one_degree
from recorded_motion import record
from references import against, agrees
from scipy.integrate import solve_ivp

from facegear.machine.kinematics import KINEMATICS
from facegear.machine.machine import OpenFlanks
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import build_model, simulate, steady_state

SPEED, DAMPING, SLOW = 0.7, 0.4, 0.02
FINE = Settings(tolerance=1e-14)
STARTS = ((0.5, 0.4), (-1.3, 0.2), (1.4, -0.6))


def oscillator(push_only, damping=DAMPING):
    """x'' + .02 x' + F = .1 + .6 cos .7 t, backlash of +-1, k = 1 + .3 cos .7 t and a damper in contact."""
    return one_degree(
        SLOW,
        stiffness=((0.0, 0.0), (1.0, 0.3)),
        load=((0.0, 0.0), (0.1, 0.6)),
        contact_damping=damping,
        push_only=push_only,
    )


def by_pieces(start, end, push_only):
    """Run by SciPy's DOP853, stopped and started again at each of its own events; the largest pull."""

    def push(t, z):
        side = np.sign(z[0])
        return side * ((1.0 + 0.3 * np.cos(SPEED * t)) * (z[0] - side) + DAMPING * z[1])

    def edge(t, z):
        return abs(z[0]) - 1.0

    def slope(acts):
        def right(t, z):
            force = np.sign(z[0]) * push(t, z) if acts else 0.0
            return [z[1], 0.1 + 0.6 * np.cos(SPEED * t) - SLOW * z[1] - force]

        return right

    events = (edge, push) if push_only else (edge,)
    for event in events:
        event.terminal = True
    now, state, pull, kinds = 0.0, np.array(start), 0.0, set()
    while now < end:
        ahead = state + 1e-9 * np.array(slope(False)(now, state))
        acts = edge(now, ahead) > 0.0 and (not push_only or push(now + 1e-9, ahead) > 0.0)
        run = solve_ivp(slope(acts), (now, now + 1e-9), state, "DOP853", rtol=1e-13, atol=1e-14)
        run = solve_ivp(
            slope(acts), (now + 1e-9, end), run.y[:, -1], "DOP853", events=events, rtol=1e-13, atol=1e-14
        )
        now, state = run.t[-1], run.y[:, -1]
        kinds |= {number for number, times in enumerate(run.t_events) if times.size}
        if acts:
            pull = max(pull, *(-push(t, z) for t, z in zip(run.t, run.y.T, strict=True)))
    return state, pull, kinds


@against(
    "third-party program",
    "SciPy's DOP853 with located events",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("start", STARTS)
def test_a_contact_that_only_pushes_moves_as_scipy_says_through_cutting_parting_and_meeting(start):
    state, pull, kinds = by_pieces(start, 3 * TAU / SPEED, push_only=True)
    assert kinds == {0, 1} and pull < 1e-9
    run = record(oscillator(True), SPEED, State(*(np.array([value]) for value in start)), 3, FINE)
    agrees("displacement after three periods", run.at(np.array([3 * TAU]))[0][0, 0], state[0], absolute=1e-8)


@pytest.mark.parametrize("damping", 10.0 ** -np.arange(5.0, 17.0))
def test_flanks_part_with_a_damper_however_weak_as_they_do_without(damping):
    """Its cut and the edge lie so close together that rounding moves the zero of the force between them."""
    start = np.array([[1.4], [-0.6 / SPEED]])
    damped, undamped = (Integrator(oscillator(True, of), SPEED, 1e-14).run(start, 3) for of in (damping, 0.0))
    assert damped.steps < 2 * undamped.steps
    np.testing.assert_allclose(damped.state, undamped.state, rtol=0, atol=100.0 * damping + 1e-11)


@against(
    "third-party program",
    "SciPy's DOP853 with located events",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_the_largest_pull_of_a_damper_is_what_scipy_meets():
    settings = Settings(tolerance=1e-10, periodic_residual=1e-9)
    start = State(np.array([1.4]), np.array([-0.6]))
    cut = simulate_system(oscillator(True), settings, start)
    assert cut.averages.pull[0] < 1e-12
    found = simulate_system(oscillator(False), settings, start)
    assert found.period > 0
    first = (found.state.displacement[0], found.state.velocity[0])
    _, pull, _ = by_pieces(first, found.period * TAU / SPEED, push_only=False)
    assert pull > 0.05
    agrees("largest pull", found.averages.pull[0], pull, relative=1e-6)


def simulate_system(system, settings, start):
    return steady_state(system, SPEED, settings, start)


@pytest.mark.parametrize("start", STARTS)
def test_disturbances_pass_the_cut_unchanged_and_shear_where_flanks_meet(start):
    """The matrix of three periods against differences of runs, its determinant against Liouville."""
    system = oscillator(True)
    state = np.array([[start[0]], [start[1] / SPEED]])
    matrix, result = monodromy(Integrator(system, SPEED, 1e-14, 20), state, 3)
    assert np.log(np.linalg.det(matrix)) == pytest.approx(result.divergence, abs=1e-9)
    for column in range(2):
        ends = []
        for sign in (-1.0, 1.0):
            near = state[:, 0].copy()
            near[column] += sign * 1e-6
            run = record(system, SPEED, State(near[:1], near[1:] * SPEED), 3, FINE)
            ends.append(run.at(np.array([3 * TAU]))[0][0, 0])
        assert (ends[1] - ends[0]) / 2e-6 == pytest.approx(matrix[0, column], rel=1e-5, abs=1e-7)


def machine_of(open_flanks, kinematics):
    layout = make_layout(kinematics=kinematics)
    return make_machine(layout, 800.0, 0.05, error=25e-6, mesh_damping=3000.0, open_flanks=open_flanks)


def contact_forces(model, response, periods=2):
    """Spring and damper together of every flank (K, meshes or flanks) where it overlaps, N, dense."""
    system, omega = model.system, response.frequency
    run = record(system, omega, response.state, periods, Settings(tolerance=1e-12))
    step = np.arange(run.starts.size)
    forces = []
    for share in np.linspace(0.0, 1.0, 9):
        ahead = (share * run.lengths)[:, None] ** np.arange(run.deflections.shape[1])
        slope = np.arange(1, run.deflections.shape[1]) * ahead[:, :-1]
        d = np.einsum("sp,spm->sm", ahead, run.deflections)[:, : system.contacts]
        rate = omega * np.einsum("sp,spm->sm", slope, run.deflections[:, 1:])[:, : system.contacts]
        cycles = (run.starts + share * run.lengths) / TAU
        side = run.states[step][:, : system.contacts]
        lower = np.where(np.isfinite(system.lower), system.lower, 0.0)[: system.contacts]
        beyond = d - np.where(side > 0, system.upper[: system.contacts], lower)
        push = system.law.force(cycles, beyond) + system.mesh_damping[: system.contacts] * rate
        forces.append(side * push)
    return np.concatenate(forces)


@pytest.mark.parametrize("kinematics", KINEMATICS.values(), ids=KINEMATICS)
def test_a_machine_says_how_far_its_dampers_pull_and_never_pulls_where_it_may_only_push(kinematics):
    speed = 9000.0
    settings = Settings(settle=256, window=128)
    pulling = build_model(machine_of(OpenFlanks.CONTACT_ONLY, kinematics))
    response = simulate(pulling, speed, settings)
    largest = -contact_forces(pulling, response, max(response.period, 128)).min()
    assert largest > 100.0
    if response.period:
        assert response.averages.pull.max() == pytest.approx(largest, rel=1e-3)
    else:
        assert 0.5 * largest < response.averages.pull.max() < 2.0 * largest
    pushing = build_model(machine_of(OpenFlanks.PUSH_ONLY, kinematics))
    response = simulate(pushing, speed, settings)
    assert response.averages.pull.max() < 1e-8 * np.abs(response.forces).max()
    assert response.fractions[0].max() > 0.0
    cut = contact_forces(pushing, response, 16)
    assert (cut < 0.0).any()  # where they would pull, they do not: the motion is that of SciPy, above
