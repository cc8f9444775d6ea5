"""Balance of motion on a casing: its own damping, work and dissipation, forces on bodies, feet."""

import numpy as np
import pytest
import scipy.linalg
from references import against, agrees

from facegear.casing.reduction import own_modes
from facegear.harmonics import Harmonics, stack_series, stacked_values
from facegear.machine.casing_coordinates import casing_motion
from facegear.machine.flank_errors import error_series
from facegear.machine.machine import Damping, OpenFlanks, mesh_frequency
from facegear.machine.statics import mean_equilibrium
from facegear.motion.bearing_forces import bearing_history
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model, simulate, static_start
from tests.helpers.public_casing import mount_public
from tests.helpers.seated_machines import STIFFNESS, make_small_layout, make_small_machine, place_on

SPEED = 2500.0
RATIO = 0.03
MESH, BEARING = 500.0, 1e-6
"""Damping of meshes, N s/m, and bearings, s."""
ERROR = Harmonics(np.array([0.0, 1e-6, 0.0]), np.array([0.0, 2e-6, -5e-7]))
TIGHT = Settings(tolerance=1e-13)


def make_model(modes):
    """The small machine on the public casing, whose flanks all stay closed on one side: it is linear."""
    damping = Damping(MESH, 0.0, BEARING, OpenFlanks.CONTACT_ONLY)
    casing = place_on(mount_public(modes, damping_ratio=RATIO))
    return build_model(make_small_machine(casing=casing, error=ERROR, damping=damping))


@pytest.fixture(scope="module", params=[30, 0])
def model(request):
    return make_model(request.param)


@pytest.fixture(scope="module")
def steady(model):
    return simulate(model, SPEED, TIGHT)


def over_period(samples, order):
    """Derivative by time of samples over one mesh period."""
    assert len(samples) % 2 == 0
    omega = 2.0 * np.pi * mesh_frequency(make_small_layout(), SPEED)
    lines = np.fft.rfft(samples, axis=0)
    factors = (1j * omega * np.arange(len(lines))) ** order
    factors[-1] = 0.0
    return np.fft.irfft(lines * factors.reshape(-1, *(1,) * (samples.ndim - 1)), len(samples), axis=0)


def flank_motion(model, response):
    """Displacements (K, n) of all coordinates, motions (K, 2 meshes) of the flanks and their errors, m."""
    linear, machine = model.machine.linear, model.machine
    displacements = response.coordinates[: response.per_period] @ model.reduction.basis.T
    cycles = np.arange(response.per_period) / response.per_period
    errors = stacked_values(stack_series(error_series(machine)), cycles)
    return displacements, displacements @ linear.rows.T, errors


def body_damping(machine, linear, rates):
    """Power (K,) that bearings turn into heat: motions of bodies against their seats."""
    casing, first = machine.casing, machine.lumped_model.size
    seats = casing_motion(linear, rates) @ casing.relative_motions(linear.labels[:first], None).T
    strains = rates[:, :first] - seats
    return BEARING * np.einsum("ki,ij,kj->k", strains, machine.lumped_model.stiffness, strains)


@pytest.mark.parametrize("modes", [30, 0])
def test_each_mode_of_the_casing_alone_decays_by_its_ratio(modes):
    mounted = mount_public(modes, damping_ratio=RATIO)
    inverse = np.linalg.inv(mounted.mass)
    size = mounted.size
    matrix = np.block(
        [[np.zeros((size, size)), np.eye(size)], [-inverse @ mounted.stiffness, -inverse @ mounted.damping]]
    )
    values = np.linalg.eigvals(matrix)
    np.testing.assert_allclose(-values.real / np.abs(values), RATIO, rtol=1e-8)
    expected = 2.0 * np.pi * own_modes(mounted.stiffness, mounted.mass)[0]
    np.testing.assert_allclose(np.sort(np.abs(values))[::2], expected, rtol=1e-8)


def test_a_casing_set_free_turns_its_energy_into_heat():
    """The integral of the power of its damping, by a matrix exponential, is what its energy loses."""
    mounted = mount_public(0, damping_ratio=RATIO)
    size, time = mounted.size, 2e-3
    stiffness, mass, damping = mounted.stiffness, mounted.mass, mounted.damping
    shapes = own_modes(stiffness, mass)[1]
    stiffness, damping = shapes.T @ stiffness @ shapes, shapes.T @ damping @ shapes
    matrix = np.block([[np.zeros((size, size)), np.eye(size)], [-stiffness, -damping]])
    heat = scipy.linalg.block_diag(np.zeros((size, size)), damping)
    # Van Loan 1978: the integral of e^(A' t) H e^(A t).
    both = np.block([[-matrix.T, heat], [np.zeros_like(matrix), matrix]])
    scale = np.r_[np.sqrt(np.diagonal(stiffness)), np.ones(size)]
    both = np.r_[1.0 / scale, scale][:, None] * both * np.r_[scale, 1.0 / scale]
    whole = scipy.linalg.expm(time * both)
    flow = whole[2 * size :, 2 * size :]
    lost = flow.T @ whole[: 2 * size, 2 * size :]
    start = scale * np.r_[np.full(size, 1e-5), np.zeros(size)]
    end = flow @ start
    assert end @ end < 0.5 * (start @ start)
    np.testing.assert_allclose(start @ lost @ start, 0.5 * (start @ start - end @ end), rtol=1e-8)


@against(
    "analytic",
    "work of the meshes against the heat of bearings, casing and meshes",
    capability="casing_response",
    module="facegear.machine.casing_response",
)
def test_work_of_the_meshes_is_heat_of_bearings_casing_and_meshes(model, steady):
    machine, linear = model.machine, model.machine.linear
    displacements, motions, errors = flank_motion(model, steady)
    is_closed = mean_equilibrium(machine).flank_forces[0] > 0.0
    deflection = (motions - errors)[:, is_closed]
    gap = np.tile(machine.half_backlash, 2)[is_closed]
    assert (deflection > gap).all()
    rate = over_period(deflection, 1)
    force = STIFFNESS * (deflection - gap) + MESH * rate
    work = -(force * over_period(errors, 1)[:, is_closed]).sum(axis=1).mean()
    rates = over_period(displacements, 1)
    of_casing = casing_motion(linear, rates)
    in_casing = np.einsum("ki,ij,kj->k", of_casing, machine.casing.mounted.damping, of_casing).mean()
    in_bearings = body_damping(machine, linear, rates).mean()
    in_meshes = MESH * (rate**2).sum(axis=1).mean()
    assert in_casing > 0.05 * work > 0.0
    agrees("heat over work", (in_casing + in_bearings + in_meshes) / work, 1.0, absolute=1e-8)


def test_energy_of_a_machine_set_free_goes_where_damping_is(model):
    """Without errors, from a start aside: kinetic energy and that of all springs, and the heat of each
    step by Gauss's rule on its polynomial.
    """
    machine = make_small_machine(casing=model.machine.casing, damping=model.machine.damping)
    free = build_model(machine)
    linear, basis = free.machine.linear, free.reduction.basis
    frequency = 2.0 * np.pi * mesh_frequency(machine.layout, SPEED)
    integrator = Integrator(free.system, frequency, TIGHT.tolerance)
    start = integrator.by_phase(static_start(free))
    kick = 1e-3 * np.random.default_rng(1).uniform(-1.0, 1.0, start.shape[1])
    start[1] += kick / frequency * np.sqrt(np.abs(start[0]).max())
    periods = 3
    end, _, steps = integrator.steps(start, periods, 4000)
    is_closed = mean_equilibrium(free.machine).flank_forces[0] > 0.0
    rows = linear.rows[is_closed] @ basis
    gap = np.tile(machine.half_backlash, 2)[is_closed]

    def energy(state):
        over = rows @ state[0] - gap
        assert (over > 0.0).all()
        springs = 0.5 * (free.system.omega_squared * state[0]) @ state[0] + 0.5 * STIFFNESS * over @ over
        return 0.5 * frequency**2 * state[1] @ state[1] + springs - free.reduction.load @ state[0]

    nodes, weights = np.polynomial.legendre.leggauss(16)
    heat = 0.0
    for length, polynomial in zip(steps.lengths, steps.coordinates, strict=True):
        at = 0.5 * length * (1.0 + nodes)
        powers = np.arange(1, len(polynomial)) * at[:, None] ** np.arange(len(polynomial) - 1)
        rates = frequency * powers @ polynomial[1:]
        motion = rates @ basis.T
        of_casing = casing_motion(linear, motion)
        power = body_damping(free.machine, linear, motion) + MESH * ((rates @ rows.T) ** 2).sum(axis=1)
        power += np.einsum("ki,ij,kj->k", of_casing, machine.casing.mounted.damping, of_casing)
        heat += 0.5 * length / frequency * weights @ power
    lost = energy(start) - energy(end)
    assert lost > 0.2 * (energy(start) - energy(integrator.by_phase(static_start(free))))
    assert heat == pytest.approx(lost, rel=1e-8)


def test_bearings_carry_what_flanks_and_inertia_leave(monkeypatch):
    """Every pinion and gear on its own: forces of its flanks, its bearing, and its mass."""
    monkeypatch.setattr("facegear.machine.loaded_modes.MOTION_LIMIT", 1e6)
    model = make_model(0)
    steady = simulate(model, SPEED, TIGHT)
    machine, linear = model.machine, model.machine.linear
    displacements, motions, errors = flank_motion(model, steady)
    is_closed = mean_equilibrium(machine).flank_forces[0] > 0.0
    deflection = motions - errors
    force = STIFFNESS * (deflection - np.tile(machine.half_backlash, 2)) + MESH * over_period(deflection, 1)
    force = np.where(is_closed, force, 0.0)
    at = linear.translations
    inertia = machine.lumped_model.masses[at] * over_period(displacements, 2)[:, at]
    pressed = np.einsum("kf,fbd->kbd", force, machine.lumped_model.rows[:, at])
    carried = bearing_history(model, steady)[: steady.per_period]
    left_over = carried + inertia + pressed
    np.testing.assert_allclose(left_over, 0.0, atol=1e-6 * np.abs(carried).max())


def test_feet_carry_the_applied_torques_in_the_mean_of_a_motion(model, steady):
    mounted, linear = model.machine.casing.mounted, model.machine.linear
    displacements = flank_motion(model, steady)[0]
    motion = casing_motion(linear, displacements)
    loads = motion @ mounted.foot_loads.T
    assert np.ptp(loads, axis=0).max() > 1.0
    np.testing.assert_allclose(loads.mean(axis=0), [0, 0, 0, -1000, 0, -3000], atol=1e-5)
