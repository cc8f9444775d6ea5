"""Hard machines: each is held against the full, unreduced equations run by SciPy, and must name its
motion.
"""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import drive_rows, make_layout, make_machine
from oscillators import one_degree
from recorded_motion import record
from references import against, agrees
from scipy.integrate import solve_ivp

from facegear.harmonics import Harmonics
from facegear.machine.layout import Role, Side
from facegear.machine.linear_model import bearing_diagonal, mass_diagonal
from facegear.machine.machine import mesh_frequency
from facegear.machine.torques import balanced_torques
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Motion, Settings, State
from facegear.motion.steady_state.simulate import build_model, simulate, static_start, steady_state
from facegear.motion.steady_state.statistics import moments

FINE = Settings(tolerance=1e-13)
TWENTY = Harmonics(np.r_[0.0, 3e7 / np.arange(1, 21) ** 1.5], np.r_[4.1e8, -2e7 / np.arange(1, 21) ** 1.5])


def one_engine_out():
    machine = make_machine()
    on_pinions = machine.torques[:5].copy()
    on_pinions[3] = 0.0
    return replace(machine, torques=balanced_torques(machine.layout, on_pinions))


def ring(count):
    places = tuple((f"p{i}", Role.INPUT if i % 3 == 0 else Role.IDLER, 11.5 * i) for i in range(count))
    return make_layout(places)


CASES = {
    "no backlash": (make_machine(backlash=0.0), 7500.0),
    "backlash of 2 mm": (make_machine(backlash=2e-3), 7500.0),
    "no mesh damping": (make_machine(mesh_damping=0.0), 7500.0),
    "no mass damping": (make_machine(mass_damping=0.0), 7500.0),
    "stiff bearings": (make_machine(make_layout(pinion_bearing=6.5e11, gear_bearing=8.7e13)), 7500.0),
    "soft bearings": (make_machine(make_layout(pinion_bearing=6.5e5, gear_bearing=8.7e7)), 7500.0),
    "50 rpm": (make_machine(), 50.0),
    "40 000 rpm": (make_machine(), 40_000.0),
    "rattle without torque": (make_machine(torque=0.0), 7500.0),
    "torque reversed": (make_machine(torque=-800.0), 7500.0),
    "one engine out": (one_engine_out(), 7500.0),
    "neither error nor backlash": (make_machine(error=0.0, backlash=0.0), 7500.0),
    "12 pinions": (make_machine(ring(12)), 7500.0),
    "one pinion": (make_machine(ring(1)), 7500.0),
    "20 harmonics": (make_machine(stiffness=TWENTY), 7500.0),
}


SLOW = {"50 rpm", "stiff bearings"}


def full_run(machine, speed, start, end):
    """Mesh deflections after a time of the full M q'' + C q' + K q = F - NF, equations (14) to (22)."""
    layout = machine.layout
    mass, bearing, directions = mass_diagonal(layout), bearing_diagonal(layout), drive_rows(layout)
    damping = machine.damping.mass * mass + machine.damping.bearing * bearing
    applied = np.zeros(mass.size)
    applied[3::4] = machine.torques
    omega = TAU * mesh_frequency(layout, speed)
    order_k, order_e = np.arange(machine.stiffness.order + 1), np.arange(machine.error.order + 1)
    shift_k, shift_e = TAU * machine.phases, TAU * machine.error_phases
    b = machine.half_backlash

    def rates(t, state):
        q, v = np.split(state, 2)
        angle = np.outer(omega * t - shift_k, order_k)
        k = np.sin(angle) @ machine.stiffness.sine + np.cos(angle) @ machine.stiffness.cosine
        angle = np.outer(omega * t - shift_e, order_e)
        e = np.sin(angle) @ machine.error.sine + np.cos(angle) @ machine.error.cosine
        e_rate = omega * (
            np.cos(angle) @ (order_e * machine.error.sine) - np.sin(angle) @ (order_e * machine.error.cosine)
        )
        d = directions @ q - e
        force = k * (np.maximum(d - b, 0.0) + np.minimum(d + b, 0.0))
        force += machine.damping.mesh * (directions @ v - e_rate)
        return np.concatenate([v, (applied - damping * v - bearing * q - directions.T @ force) / mass])

    # Contact switches limit any solver without events: many small steps instead.
    solution = solve_ivp(rates, (0.0, end), start, "DOP853", rtol=1e-11, atol=1e-13, max_step=end / 1000)
    assert solution.success
    angle = np.outer(omega * end - shift_e, order_e)
    error = np.sin(angle) @ machine.error.sine + np.cos(angle) @ machine.error.cosine
    return directions @ solution.y[: mass.size, -1] - error


@against(
    "third-party program",
    "scipy.integrate.solve_ivp on the full equations",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("name", CASES)
def test_short_run_agrees_with_the_full_equations(name):
    machine, speed = CASES[name]
    model = build_model(machine)
    start = static_start(model)
    kick = np.random.default_rng(1).normal(size=start.velocity.size)
    start = replace(start, velocity=0.02 * kick / np.abs(model.reduction.mesh_jacobian).max())
    omega = TAU * mesh_frequency(machine.layout, speed)
    end = min(TAU, omega * 3e-4)
    full = np.concatenate(
        [model.reduction.basis @ start.displacement, model.reduction.basis @ start.velocity]
    )
    expected = full_run(machine, speed, full, end / omega)
    run = record(model.system, omega, start, 1, FINE)
    found = run.at(np.array([end]))[1][0]
    agrees(
        "displacement, m",
        found,
        expected,
        relative=1e-7,
        absolute=2e-8 * max(model.system.scale, np.abs(expected).max()),
    )


@pytest.mark.parametrize("name", CASES)
def test_motion_is_named_and_its_rms_holds_at_a_tighter_tolerance(name):
    machine, speed = CASES[name]
    model = build_model(machine)
    few = {"settle": 64, "dwell": 16, "window": 16, "extensions": 0} if name in SLOW else {"settle": 256}
    settings = Settings(tolerance=1e-6, **few)
    response = simulate(model, speed, settings)
    assert np.isfinite(response.deflections).all()
    if response.motion is not Motion.PERIODIC:
        assert response.period == 0
        assert response.exponent is not None
        assert response.residual > settings.periodic_residual
        return
    assert response.residual <= settings.periodic_residual
    # The same orbit from its own state: another start may lie in another basin.
    again = simulate(model, speed, replace(settings, tolerance=1e-9), response.state)
    assert again.label == response.label
    first = moments(response.deflections, response.per_period, True)
    second = moments(again.deflections, again.per_period, True)
    np.testing.assert_allclose(first.ac_rms, second.ac_rms, atol=1e-5 * first.rms.max())


@against(
    "analytic",
    "linear oscillator that misses the edge by a millionth",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("miss", [1e-6, -1e-6])
def test_grazing_within_a_millionth_of_the_edge(miss):
    """Contact kept or lost by a millionth of the dead zone: closed form above, agreement with it below."""
    speed, damping, mean = 0.75, 0.05, 0.1
    gain = speed**2 / np.hypot(1 - speed**2, 2 * damping * speed)
    amplitude = (mean - miss) / gain
    system = one_degree(2 * damping, load=((0.0, 0.0), (mean, amplitude * speed**2)))
    fine = Settings(tolerance=1e-13, periodic_residual=1e-12)
    lag, swing = np.arctan2(2 * damping * speed, 1 - speed**2), mean - miss
    closed = State(np.array([1 + mean + swing * np.cos(lag)]), np.array([swing * speed * np.sin(lag)]))
    response = steady_state(system, speed, fine, closed)
    assert response.label == "period-1"
    least, most = record(system, speed, response.state, 1, fine).extremes(0)
    if miss > 0:
        agrees("smallest displacement", least, 1.0 + miss, absolute=1e-11)
        agrees("largest displacement", most, 1.0 + 2 * mean - miss, absolute=1e-11)
        assert response.fractions[0, 0] == 0.0
    else:
        assert 1.0 - 1.2e-6 < least < 1.0
        # A parabola that dips by 1e-6 below the edge with the curvature of the cosine.
        share = 2 * np.sqrt(2e-6 / mean) / (2 * np.pi)
        agrees("fraction of the time beyond the edge", response.fractions[0, 0], share, relative=0.02)


@against(
    "analytic",
    "scaling of the equation of motion",
    capability="dynamics_response",
    module="facegear.motion.steady_state.simulate",
)
def test_without_error_and_backlash_only_the_scale_depends_on_torque():
    for speed in (5000.0, 9000.0):
        small = simulate(make_machine(torque=200.0, error=0.0, backlash=0.0), speed)
        large = simulate(make_machine(torque=2000.0, error=0.0, backlash=0.0), speed)
        assert small.label == large.label
        agrees(
            "deflection of a mesh, m",
            10.0 * small.deflections,
            large.deflections,
            relative=1e-6,
            absolute=1e-12,
        )


def test_a_body_that_touches_nothing_is_periodic_with_a_neutral_multiplier():
    response = simulate(make_machine(torque=300.0), 2000.0)
    assert response.fractions[0].max() == pytest.approx(1.0)
    assert response.motion is Motion.PERIODIC
    assert abs(response.multipliers[0]) == pytest.approx(1.0, abs=1e-6)


def test_a_motion_given_too_little_time_is_not_called_periodic():
    machine = make_machine(torque=800.0)
    hasty = Settings(tolerance=1e-6, dwell=16, settle=16, window=16, extensions=0, refine=False)
    response = simulate(machine, 12_000.0, hasty)
    assert response.motion is not Motion.PERIODIC
    assert response.residual > hasty.periodic_residual


def test_one_face_gear_alone_runs_with_two_pinions():
    layout = make_layout((("one", Role.INPUT, 0.0), ("two", Role.INPUT, 45.0)), (Side.UPPER,))
    response = simulate(make_machine(layout, tail_share=0.0), 6000.0)
    assert response.deflections.shape[1] == 2
    assert response.forces.mean() > 0
