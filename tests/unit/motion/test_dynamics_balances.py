"""Balances that the motion of any machine keeps: phase volume, energy, angular momentum, mean forces."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lumped_machines import drive_rows, make_layout, make_machine
from random_machines import FINE, frequency, kicked, machines, speeds
from recorded_motion import Trajectory, record
from references import against, agrees

from facegear.harmonics import Harmonics
from facegear.machine.flank_errors import error_series, mirror_series
from facegear.machine.kinematics import KINEMATICS, PRINTED_KINEMATICS
from facegear.machine.layout import Role
from facegear.machine.linear_model import flank_jacobian, mass_diagonal
from facegear.machine.machine import OpenFlanks
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.integrator.system import System
from facegear.motion.plan import Settings
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import Model, build_model, simulate


def contacts(machine):
    """k and e of each contact of the system: meshes as printed, flanks where meshes are geometric."""
    if machine.layout.kinematics.flanks_apart:
        both = *machine.mesh_stiffness, *map(mirror_series, machine.mesh_stiffness)
        phases = np.tile(machine.phases, 2)
        return [own.shift(lag) for own, lag in zip(both, phases, strict=True)], error_series(machine)
    stiffness = [machine.stiffness.shift(float(phase)) for phase in machine.phases]
    return stiffness, [machine.error.shift(float(phase)) for phase in machine.error_phases]


def pressed(system, deflection, state):
    """Deflection beyond the edge of the flank in contact, 0 where none is."""
    low, upper = system.lower[: system.contacts], system.upper[: system.contacts]
    lower = np.where(np.isfinite(low), low, 0.0)
    edge = np.where(state > 0, upper, lower)
    return np.where(state == 0, 0.0, deflection - edge)


def state_of(system, deflection):
    """1 beyond the upper edge, -1 below the lower one, else 0."""
    lower, upper = system.lower[: system.contacts], system.upper[: system.contacts]
    return np.where(deflection > upper, 1, np.where(deflection < lower, -1, 0))


def acting_damping(system, state):
    return system.mesh_damping[: system.contacts] * (1.0 if system.damping_when_open else np.abs(state))


def contact_forces(system, stiffness, beyond, rate, state):
    """Spring and damper of each contact together, cut at zero where it only pushes."""
    force = stiffness * beyond + acting_damping(system, state) * rate
    return np.where(system.push_only & (force * state < 0.0), 0.0, force)


def rings(model, coordinates):
    """x, y (K, R, 2) of the pinions whose bearings have play, and the bearing's force there."""
    system = model.system
    rows = system.mesh_jacobian[system.contacts :].reshape(-1, 3, system.size)[:, :2]
    place = np.einsum("rcn,kn->krc", rows, coordinates)
    distance = np.hypot(place[..., 0], place[..., 1])
    beyond = np.maximum(distance - system.ring_clearance, 0.0)
    along = place / np.maximum(distance, 1e-300)[..., None]
    return place, along, beyond


def ring_dissipation(model, coordinates, velocity):
    """Power (K,) that the damping of bearings with play takes."""
    system = model.system
    place, along, beyond = rings(model, coordinates)
    rows = system.mesh_jacobian[system.contacts :].reshape(-1, 3, system.size)[:, :2]
    speed = np.einsum("rcn,kn->krc", rows, velocity)
    radial = (along * speed).sum(axis=-1)
    tangential = (speed**2).sum(axis=-1) - radial**2
    share = beyond / np.maximum(np.hypot(place[..., 0], place[..., 1]), 1e-300)
    power = system.ring_lag * system.ring_stiffness * (radial**2 * (beyond > 0.0) + share * tangential)
    return power.sum(axis=1)


def weak_dampers_that_only_push():
    """Flanks part so soon after their force is zero that rounding once kept the motion from going on."""
    layout = make_layout((("input", Role.INPUT, 0.0),), pinion_bearing=1e7, gear_bearing=1e8)
    return make_machine(
        layout,
        torque=50.0,
        tail_share=0.0,
        backlash=72.4e-6,
        error=45e-6,
        stiffness=Harmonics(4.1e8 * np.array([0.0, 0.0, 0.02]), 4.1e8 * np.array([1.0, 0.0, 0.0])),
        mesh_damping=1e-5,
        mass_damping=0.0,
        open_flanks=OpenFlanks.PUSH_ONLY,
    )


@against(
    "analytic",
    "Liouville's formula",
    capability="dynamics_response branches",
    module="facegear.motion.integrator.integrator",
)
@settings(max_examples=12, deadline=None)
@given(machine=machines(), speed=st.floats(8000, 20_000))
@example(machine=weak_dampers_that_only_push(), speed=8000.0)
def test_liouville_across_contact_switches(machine, speed):
    model = build_model(machine)
    integrator = Integrator(model.system, frequency(model, speed), 1e-14, 20)
    matrix, run = monodromy(integrator, integrator.by_phase(kicked(model)), 1)
    sign, volume = np.linalg.slogdet(matrix)
    assert sign > 0
    # The determinant is known to the rounding of its smallest factor.
    accuracy = 1e-13 * np.linalg.cond(matrix)
    agrees("logarithm of the volume of disturbances", volume, run.divergence, absolute=1e-9 + accuracy)


@against(
    "analytic",
    "balance of energy",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@settings(max_examples=12, deadline=None)
@given(machine=machines(), speed=speeds)
def test_energy_audit_over_a_period(machine, speed):
    model = build_model(machine)
    system: System = model.system
    omega = frequency(model, speed)
    run = record(system, omega, kicked(model), 2, FINE)
    phases, weights = run.quadrature(16)
    times = weights / omega
    step = np.searchsorted(run.starts, phases, side="right") - 1
    ahead = (phases - run.starts[step])[:, None]
    powers = ahead ** np.arange(run.coordinates.shape[1])
    rates = np.arange(1, run.coordinates.shape[1]) * ahead ** np.arange(run.coordinates.shape[1] - 1)
    velocity = omega * np.einsum("kp,kpn->kn", rates, run.coordinates[step][:, 1:])
    flanks = slice(0, system.contacts)
    deflection = np.einsum("kp,kpm->km", powers, run.deflections[step][..., flanks])
    rate = omega * np.einsum("kp,kpm->km", rates, run.deflections[step][:, 1:, flanks])
    cycles = phases / TAU
    springs, errors = contacts(machine)
    stiffness = np.stack([series(cycles) for series in springs], axis=1)
    slope = np.stack([derivative(series, cycles, omega) for series in springs], axis=1)
    error_rate = np.stack([derivative(series, cycles, omega) for series in errors], axis=1)
    state = run.states[step][:, flanks]
    beyond = pressed(system, deflection, state)
    force = contact_forces(system, stiffness, beyond, rate, state)
    damper = force - stiffness * beyond
    place = np.einsum("kp,kpn->kn", powers, run.coordinates[step])
    # d/dt of kinetic + bearing + mesh energy: torques in, damping out, k'(t) stores, e'(t) pushes.
    power = velocity @ model.reduction.load - velocity**2 @ system.damping - (damper * rate).sum(axis=1)
    power -= ring_dissipation(model, place, velocity)
    power += (0.5 * slope * beyond**2).sum(axis=1) - (force * error_rate).sum(axis=1)

    def energy(at):
        y = np.stack([run.at(np.array([at + shift]))[0][0] for shift in (0.0,)])[0]
        k = np.clip(np.searchsorted(run.starts, at, side="right") - 1, 0, run.starts.size - 1)
        ahead_at = at - run.starts[k]
        order = np.arange(1, run.coordinates.shape[1])
        v = omega * (order * ahead_at ** (order - 1)) @ run.coordinates[k][1:]
        d = run.at(np.array([at]))[1][0, flanks]
        gap = pressed(system, d, state_of(system, d))
        now = np.array([float(series(at / TAU)) for series in springs])
        in_rings = 0.5 * system.ring_stiffness @ rings(model, y[None])[2][0] ** 2
        return 0.5 * v @ v + 0.5 * system.omega_squared @ y**2 + 0.5 * now @ gap**2 + in_rings

    ends = run.starts[-1] + run.lengths[-1]
    change = energy(ends) - energy(0.0)
    exchanged = np.abs(power) @ times + abs(energy(0.0))
    agrees("work less the change of energy, J", times @ power, change, absolute=1e-8 * exchanged)


def derivative(series: Harmonics, cycles: np.ndarray, omega: float) -> np.ndarray:
    order = np.arange(series.order + 1)
    return omega * Harmonics(np.r_[0.0, (-order * series.cosine)[1:]], order * series.sine)(cycles)


@against(
    "analytic",
    "angular momentum of every body",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
@settings(max_examples=12, deadline=None)
@given(machine=machines(), speed=speeds)
def test_torques_less_mesh_forces_change_the_spin_of_every_body(machine, speed):
    """I dw + lambda I dtheta = torque T - lever * (impulse of the mesh forces), body by body."""
    model = build_model(machine)
    system, layout = model.system, machine.layout
    omega = frequency(model, speed)
    run = record(system, omega, kicked(model), 2, FINE)
    force, times = mesh_forces(model, run, omega)
    ends = []
    for step, ahead in ((0, 0.0), (-1, run.lengths[-1])):
        order = np.arange(run.coordinates.shape[1])
        displacement = ahead**order @ run.coordinates[step]
        slope = (order[1:] * ahead ** order[:-1]) @ run.coordinates[step][1:]
        ends.append((model.reduction.basis @ displacement, omega * (model.reduction.basis @ slope)))
    (angle, spin), (later_angle, later_spin) = ((q[layout.spins], v[layout.spins]) for q, v in ends)
    inertia = mass_diagonal(layout)[layout.spins]
    gained = inertia * (later_spin - spin + machine.damping.mass * (later_angle - angle))
    directions = flank_jacobian(layout) if layout.kinematics.flanks_apart else drive_rows(layout)
    impulses = directions[:, layout.spins] * (times @ force)[:, None]
    given_ = machine.torques * times.sum()
    size = np.abs(given_).max() + np.abs(impulses).max() + np.abs(inertia * spin).max()
    agrees(
        "change of angular momentum over the base radius, N s",
        gained,
        given_ - impulses.sum(axis=0),
        relative=1e-7,
        absolute=1e-9 * size,
    )


def mesh_forces(model: Model, run: Trajectory, omega: float) -> tuple[np.ndarray, np.ndarray]:
    """Elastic and damping force of every mesh (K, meshes) at quadrature points, with their weights in s."""
    machine, system = model.machine, model.system
    phases, weights = run.quadrature(16)
    step = np.searchsorted(run.starts, phases, side="right") - 1
    ahead = (phases - run.starts[step])[:, None]
    order = np.arange(run.deflections.shape[1])
    flanks = slice(0, system.contacts)
    deflection = np.einsum("kp,kpm->km", ahead**order, run.deflections[step][..., flanks])
    slope = np.einsum("kp,kpm->km", order[1:] * ahead ** order[:-1], run.deflections[step][:, 1:, flanks])
    state = run.states[step][:, flanks]
    beyond = pressed(system, deflection, state)
    stiffness = np.stack([series(phases / TAU) for series in contacts(machine)[0]], axis=1)
    return contact_forces(system, stiffness, beyond, omega * slope, state), weights / omega


@against(
    "analytic",
    "balance of mean torques",
    capability="dynamics_response",
    module="facegear.motion.steady_state.simulate",
)
@pytest.mark.parametrize("kinematics", KINEMATICS.values(), ids=KINEMATICS)
def test_mean_mesh_forces_balance_the_torques_of_a_periodic_motion(kinematics):
    for torque, speed in ((800.0, 4500.0), (1500.0, 9000.0), (1500.0, 12_000.0)):
        error = 50e-6 if kinematics is PRINTED_KINEMATICS else 5e-6
        machine = make_machine(make_layout(kinematics=kinematics), torque=torque, error=error)
        settings_ = Settings(tolerance=1e-12, periodic_residual=1e-9)
        model = build_model(machine)
        response = simulate(model, speed, settings_)
        assert response.period > 0
        run = record(model.system, response.frequency, response.state, response.period, settings_)
        phases, weights = run.quadrature()
        deflections = run.at(phases)[1]
        gap = pressed(model.system, deflections, state_of(model.system, deflections))
        stiffness = np.stack([series(phases / TAU) for series in contacts(machine)[0]], axis=1)
        damping = acting_damping(model.system, state_of(model.system, deflections))
        mean = weights @ (stiffness * gap) / weights.sum()
        # Open and closed alike the damper's mean is nought; in contact only, the two flanks share it.
        assert np.ptp(damping) == 0.0
        layout = machine.layout
        directions = flank_jacobian(layout) if layout.kinematics.flanks_apart else drive_rows(layout)
        carried = (mean @ directions)[3:20:4]
        agrees(
            "mean torque of a pinion, N m",
            carried,
            machine.torques[:5],
            relative=1e-7,
            absolute=1e-7 * torque,
        )
