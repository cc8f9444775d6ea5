"""Exact properties of the lumped model over random machines."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine

from facegear.dynamics.integrator.compiled import TAU
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.integrator.system import System
from facegear.dynamics.integrator.trajectory import Trajectory, record
from facegear.dynamics.motion import Settings, State
from facegear.dynamics.steady_state.orbits import monodromy
from facegear.dynamics.steady_state.simulate import Model, build_model, simulate, static_start
from facegear.harmonics.series import Harmonics
from facegear.transmission.flanks import error_series, stiffness_series
from facegear.transmission.flanks import mirrored as backwards
from facegear.transmission.imperfections import perfect
from facegear.transmission.layout import Body, MeshKinematics, Role, Side, Tilt
from facegear.transmission.machine import OpenFlanks, mesh_frequency
from facegear.transmission.matrices import flank_directions, mass_diagonal, mesh_directions

FINE = Settings(tolerance=1e-14)


@st.composite
def machines(draw, **fixed):
    """One to six pinions at half-pitch places between one or two face gears.

    Geometric ones may tilt, have play in their bearings and errors in every mesh.
    """
    count = draw(st.integers(1, 6))
    places = []
    for i in range(count):
        role = Role.INPUT if i == 0 else draw(st.sampled_from(list(Role)))
        places.append((f"p{i}", role, draw(st.integers(0, 285)) / 2.0))
    sides = draw(st.sampled_from([(Side.LOWER, Side.UPPER), (Side.UPPER,)]))
    kinematics = fixed.pop("kinematics", None) or draw(st.sampled_from(list(MeshKinematics)))
    bearings = draw(st.floats(1e7, 1e9)), draw(st.floats(1e8, 1e10))
    layout = make_layout(tuple(places), sides, *bearings, kinematics)
    swing = draw(st.floats(0.0, 0.25))
    options = {
        "torque": draw(st.floats(50, 2000)),
        # Smaller shares may be refused: `test_next_to_no_torque_against_a_ring_...` of the statics.
        "tail_share": draw(st.one_of(st.just(0.0), st.floats(1e-6, 0.3))),
        "backlash": draw(st.floats(2e-5, 2e-4)),
        "error": draw(st.floats(0, 8e-5)),
        "stiffness": Harmonics(4.1e8 * np.array([0, swing, 0.02]), 4.1e8 * np.array([1.0, 0.5 * swing, 0.0])),
        "mesh_damping": draw(st.floats(0, 5000)),
        "mass_damping": draw(st.floats(0, 2000)),
        "open_flanks": draw(st.sampled_from(list(OpenFlanks))),
    }
    symmetric = fixed.pop("symmetric", False)
    if kinematics is MeshKinematics.PRINTED:
        return make_machine(layout, **(options | fixed))
    if draw(st.booleans()):
        tilt = Tilt(0.3, draw(st.floats(1e6, 1e8)))
        gears = tuple(replace(gear, body=replace(gear.body, tilt=tilt)) for gear in layout.gears)
        layout = replace(layout, gears=gears)
    error = np.zeros(len(layout.meshes)) if symmetric else np.array([draw(ERRORS) for _ in layout.meshes])
    play = draw(st.sampled_from([0.0, 1e-5, 5e-5]))
    flaws = replace(perfect(layout), error=error, clearance=np.full(count, play))
    return make_machine(layout, **(options | fixed), imperfections=flaws)


ERRORS = st.floats(-2e-5, 2e-5)


def contacts(machine):
    """k and e of each contact of the system: meshes as printed, flanks where meshes are geometric."""
    if machine.layout.is_geometric:
        return stiffness_series(machine), error_series(machine)
    stiffness = [machine.stiffness.shifted(float(phase)) for phase in machine.phases]
    return stiffness, [machine.error.shifted(float(phase)) for phase in machine.error_phases]


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
    beyond = np.maximum(distance - system.ring_play, 0.0)
    along = place / np.maximum(distance, 1e-300)[..., None]
    return place, along, beyond


def ring_dissipation(model, coordinates, velocity):
    """Power (K,) that the damping of bearings with play takes."""
    system = model.system
    place, along, beyond = rings(model, coordinates)
    rows = system.mesh_jacobian[system.contacts :].reshape(-1, 3, system.size)[:, :2]
    speed = np.einsum("rcn,kn->krc", rows, velocity)
    radial = (along * speed).sum(axis=-1)
    turning = (speed**2).sum(axis=-1) - radial**2
    share = beyond / np.maximum(np.hypot(place[..., 0], place[..., 1]), 1e-300)
    power = system.ring_lag * system.ring_stiffness * (radial**2 * (beyond > 0.0) + share * turning)
    return power.sum(axis=1)


speeds = st.floats(3000, 20_000)


def frequency(model: Model, speed: float) -> float:
    return TAU * mesh_frequency(model.machine.layout, speed)


def kicked(model: Model, seed: int = 0) -> State:
    """Static equilibrium with a random velocity that opens contacts within a period."""
    start = static_start(model)
    kick = np.random.default_rng(seed).normal(size=start.velocity.size)
    reach = np.abs(model.reduced.mesh_jacobian).max()
    return replace(start, velocity=0.5 * model.system.scale / reach * kick * 2e3)


@settings(max_examples=12, deadline=None)
@given(machine=machines(), speed=speeds, factor=st.floats(0.01, 100))
def test_scaling_torques_backlash_and_error_scales_the_motion(machine, speed, factor):
    model = build_model(machine)
    start = kicked(model)
    scaled = replace(
        machine,
        torques=factor * machine.torques,
        half_backlash=factor * machine.half_backlash,
        error=machine.error.scaled(factor),
        imperfections=replace(
            machine.imperfections,
            error=factor * machine.imperfections.error,
            clearance=factor * machine.imperfections.clearance,
        ),
    )
    bigger = replace(build_model(scaled).system, scale=factor * model.system.scale)
    first = record(model.system, frequency(model, speed), start, 2, FINE)
    second = record(
        bigger, frequency(model, speed), State(factor * start.displacement, factor * start.velocity), 2, FINE
    )
    phases = np.linspace(0.0, 2 * TAU, 50)
    one, two = first.at(phases)[1], second.at(phases)[1]
    np.testing.assert_allclose(two / factor, one, atol=1e-9 * model.system.scale)


@settings(max_examples=12, deadline=None)
@given(machine=machines(kinematics=MeshKinematics.PRINTED), speed=speeds)
def test_negated_torques_and_error_negate_the_motion(machine, speed):
    model = build_model(machine)
    start = kicked(model)
    mirrored = build_model(replace(machine, torques=-machine.torques, error=machine.error.scaled(-1.0)))
    first = record(model.system, frequency(model, speed), start, 2, FINE)
    second = record(
        mirrored.system, frequency(model, speed), State(-start.displacement, -start.velocity), 2, FINE
    )
    phases = np.linspace(0.0, 2 * TAU, 50)
    np.testing.assert_allclose(second.at(phases)[1], -first.at(phases)[1], atol=1e-9 * model.system.scale)


def standing_on_an_edge():
    """A gear without load at rest where its flank just touches, from where only the jerk moves it."""
    layout = make_layout((("p0", Role.INPUT, 0.0),), kinematics=MeshKinematics.GEOMETRIC)
    layout = replace(
        layout,
        pinions=(replace(layout.pinions[0], body=Body(1.199, 0.002, (1e7, 1e7, 0.0))),),
        gears=tuple(replace(gear, body=Body(7.795, 0.54, (1e8,) * 3)) for gear in layout.gears),
    )
    flaws = replace(perfect(layout), clearance=np.array([1e-5]))
    swing = Harmonics(np.array([0.0, 0.0, 8.2e6]), np.array([4.1e8, 0.0, 0.0]))
    options = {"error": 0.0, "stiffness": swing, "mesh_damping": 0.0, "mass_damping": 0.0}
    return make_machine(layout, 50.0, 0.0, backlash=1.14732774e-4, imperfections=flaws, **options)


def resting_on_rings():
    """Idle pinions that stand on the rims of their play until a flank touches one, without mesh damping.

    What such a touch moves grows with the cube of time. Rounding once decided whether the ring was pressed in
    the first 1e-4 rad, which impacts magnified to 2e-9 of the length scale.
    """
    roles = (Role.INPUT, Role.TAIL, Role.IDLER, Role.INPUT, Role.TAIL, Role.IDLER)
    pitches = (117.0, 128.0, 88.5, 84.5, 62.0, 117.0)
    places = tuple((f"p{i}", *place) for i, place in enumerate(zip(roles, pitches, strict=True)))
    layout = make_layout(places, (Side.UPPER,), 1e7, 6329249313.423762, MeshKinematics.GEOMETRIC)
    tilting = tuple(replace(gear, body=replace(gear.body, tilt=Tilt(0.3, 1e7))) for gear in layout.gears)
    layout = replace(layout, gears=tilting)
    swing = Harmonics(
        np.array([0.0, 87174057.83775103, 8200000.0]), np.array([4.1e8, 43587028.918875515, 0.0])
    )
    options = {"stiffness": swing, "mesh_damping": 0.0, "mass_damping": 468.78866131223623}
    options |= {"open_flanks": OpenFlanks.CONTACT_ONLY, "backlash": 6.103515625e-05}
    flaws = replace(perfect(layout), clearance=np.full(6, 1e-5))
    error = 3.0399327968901198e-05
    return make_machine(layout, 1996.3598187060481, 0.0, error=error, imperfections=flaws, **options)


def mirrored_start(model: Model, mirrored: Model) -> State:
    """The mirror image of static equilibrium; bodies that float freely have no other way to match."""
    layout = model.machine.layout
    place = model.reduced.basis @ static_start(model).displacement
    bodies = 4 * len(layout.bodies)
    place[0:bodies:4] *= -1.0
    place[layout.spins] *= -1.0
    place[bodies + 1 :: 2] *= -1.0
    start = mirrored.reduced.basis.T @ (mass_diagonal(layout) * place)
    return State(start, np.zeros_like(start))


@settings(max_examples=12, deadline=None)
@given(machine=machines(kinematics=MeshKinematics.GEOMETRIC, symmetric=True), speed=speeds)
@example(machine=standing_on_an_edge(), speed=3000.0)
@example(machine=resting_on_rings(), speed=6836.269395264446)
def test_in_a_mirror_drive_and_back_flanks_change_places(machine, speed):
    """Angles, torques and the waveforms' direction mirrored; at half pitches the teeth stand as before."""
    model = build_model(machine)
    layout = machine.layout
    turned = tuple(replace(pinion, pitches=-pinion.pitches) for pinion in layout.pinions)
    mirrored = build_model(
        replace(
            machine,
            layout=replace(layout, pinions=turned),
            torques=-machine.torques,
            stiffness=backwards(machine.stiffness),
            error=backwards(machine.error),
        )
    )
    run = record(model.system, frequency(model, speed), static_start(model), 3, FINE)
    other = record(mirrored.system, frequency(mirrored, speed), mirrored_start(model, mirrored), 3, FINE)
    phases = np.linspace(0.0, 3 * TAU, 50)
    flanks = slice(0, model.system.contacts)
    drive, back = np.split(run.at(phases)[1][:, flanks], 2, axis=1)
    swapped = np.concatenate([back, drive], axis=1)
    np.testing.assert_allclose(other.at(phases)[1][:, flanks], swapped, atol=1e-9 * model.system.scale)


@settings(max_examples=12, deadline=None)
@given(machine=machines(), speed=st.floats(8000, 20_000))
def test_liouville_across_contact_switches(machine, speed):
    model = build_model(machine)
    integrator = Integrator(model.system, frequency(model, speed), 1e-14, 20)
    matrix, run = monodromy(integrator, integrator.by_phase(kicked(model)), 1)
    sign, volume = np.linalg.slogdet(matrix)
    assert sign > 0
    # The determinant is known to the rounding of its smallest factor.
    accuracy = 1e-13 * np.linalg.cond(matrix)
    assert abs(volume - run.divergence) < 1e-9 + accuracy


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
    power = velocity @ model.reduced.load - velocity**2 @ system.damping - (damper * rate).sum(axis=1)
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
    assert abs(times @ power - change) < 1e-8 * exchanged


def derivative(series: Harmonics, cycles: np.ndarray, omega: float) -> np.ndarray:
    order = np.arange(series.order + 1)
    return omega * Harmonics(np.r_[0.0, (-order * series.b)[1:]], order * series.a)(cycles)


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
        ends.append((model.reduced.basis @ displacement, omega * (model.reduced.basis @ slope)))
    (angle, spin), (later_angle, later_spin) = ((q[layout.spins], v[layout.spins]) for q, v in ends)
    inertia = mass_diagonal(layout)[layout.spins]
    gained = inertia * (later_spin - spin + machine.damping.mass * (later_angle - angle))
    directions = flank_directions(layout) if layout.is_geometric else mesh_directions(layout)
    impulses = directions[:, layout.spins] * (times @ force)[:, None]
    given_ = machine.torques * times.sum()
    size = np.abs(given_).max() + np.abs(impulses).max() + np.abs(inertia * spin).max()
    np.testing.assert_allclose(gained, given_ - impulses.sum(axis=0), atol=1e-9 * size)


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


@pytest.mark.parametrize("kinematics", MeshKinematics)
def test_mean_mesh_forces_balance_the_torques_of_a_periodic_motion(kinematics):
    for torque, speed in ((800.0, 4500.0), (1500.0, 9000.0), (1500.0, 12_000.0)):
        error = 50e-6 if kinematics is MeshKinematics.PRINTED else 5e-6
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
        directions = flank_directions(layout) if layout.is_geometric else mesh_directions(layout)
        carried = (mean @ directions)[3:20:4]
        np.testing.assert_allclose(carried, machine.torques[:5], atol=1e-7 * torque)


@settings(max_examples=8, deadline=None)
@given(
    torque=st.floats(100, 2000),
    speed=speeds,
    backlash=st.floats(0, 2e-4),
    kinematics=st.sampled_from(list(MeshKinematics)),
)
def test_left_and_right_move_alike_where_the_machine_is_symmetric(torque, speed, backlash, kinematics):
    model = build_model(make_machine(make_layout(kinematics=kinematics), torque=torque, backlash=backlash))
    run = record(model.system, frequency(model, speed), static_start(model), 3, FINE)
    deflections = run.at(np.linspace(0.0, 3 * TAU, 200))[1]
    for right, left in ((1, 4), (2, 3), (6, 9), (7, 8)):
        np.testing.assert_allclose(
            deflections[:, right], deflections[:, left], atol=1e-9 * model.system.scale
        )


@settings(max_examples=12, deadline=None)
@given(machine=machines(kinematics=MeshKinematics.PRINTED, backlash=0.0, mass_damping=800.0), speed=speeds)
def test_without_backlash_the_response_is_hills(machine, speed):
    """Harmonic balance of the linear system with periodic k, solved to rounding in the frequency domain."""
    model = build_model(machine)
    system = model.system
    omega = frequency(model, speed)
    harmonics = 30
    size, orders = system.size, np.arange(-harmonics, harmonics + 1)
    matrix = np.zeros((orders.size * size, orders.size * size), dtype=complex)
    right = np.zeros(orders.size * size, dtype=complex)
    right[harmonics * size : (harmonics + 1) * size] = model.reduced.load
    mesh_jacobian = system.mesh_jacobian
    k = np.stack([fourier(machine.stiffness, p, harmonics) for p in machine.phases], axis=1)
    e = np.stack([fourier(machine.error, p, harmonics) for p in machine.error_phases], axis=1)
    for i, n in enumerate(orders):
        rows = slice(i * size, (i + 1) * size)
        s = 1j * n * omega
        matrix[rows, rows] += np.diag(s**2 + s * system.damping + system.omega_squared)
        matrix[rows, rows] += s * machine.damping.mesh * mesh_jacobian.T @ mesh_jacobian
        right[rows] += s * machine.damping.mesh * mesh_jacobian.T @ e[i]
        for j, other in enumerate(orders):
            if abs(n - other) <= harmonics:
                coupling = k[n - other + harmonics]
                matrix[rows, j * size : (j + 1) * size] += (mesh_jacobian.T * coupling) @ mesh_jacobian
                right[rows] += mesh_jacobian.T @ (coupling * e[j])
    solution = np.linalg.solve(matrix, right).reshape(orders.size, size)
    cycles = np.arange(64) / 64
    exact = (np.exp(2j * np.pi * np.outer(cycles, orders)) @ solution).real
    rate = (1j * omega * orders @ solution).real
    reach = np.abs(mesh_jacobian).max()
    close = 1e-9 * max(system.scale, np.abs(exact).max() * reach)
    # Started on it, the motion follows it for a period, whether it is stable or not.
    run = record(system, omega, State(exact[0], rate), 1, FINE)
    assert np.abs(run.at(TAU * cycles)[0] - exact).max() * reach < close
    settings_ = Settings(tolerance=1e-14, periodic_residual=1e-12)
    response = simulate(model, speed, settings_)
    if response.period == 1:
        assert np.abs(response.coordinates - exact).max() * reach < close
    else:  # only a parametric resonance keeps a motion with this damping from settling
        rest = np.zeros((2, system.size))
        matrix, _ = monodromy(Integrator(system, omega, 1e-14, 20), rest, 1)
        assert np.abs(np.linalg.eigvals(matrix)).max() > 0.97


def fourier(series: Harmonics, phase: float, harmonics: int) -> np.ndarray:
    """Complex coefficients of orders -harmonics .. harmonics of a shifted series."""
    shifted = series.shifted(phase)
    result = np.zeros(2 * harmonics + 1, dtype=complex)
    for j in range(shifted.order + 1):
        value = 0.5 * (shifted.b[j] - 1j * shifted.a[j])
        result[harmonics + j] += value
        result[harmonics - j] += value.conjugate()
    return result
