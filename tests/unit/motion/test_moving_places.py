"""Meshes whose place in the mesh cycle moves with their pinions: energy, tangents, symmetry, answers."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from floating_machines import KINDS, make_floating_machine
from force_tables import power_table
from scipy.integrate import solve_ivp
from scipy_motions import kicked

import facegear
from facegear.errors import FacegearError, InvalidInput
from facegear.exchange.fmu import write_fmu
from facegear.machine.layout import DOF_PER_BODY
from facegear.machine.machine import FlankTables, mesh_frequency
from facegear.machine.statics import mean_equilibrium
from facegear.meshing.linear import LinearLaw, Piecewise
from facegear.meshing.moving_law import moving_law
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.requests import run_many
from facegear.motion.steady_state.mesh_samples import mesh_response
from facegear.motion.steady_state.simulate import build_model, simulate

OMEGA = TAU * 2100.0
TABLES = 2 * (FlankTables(*(power_table(9, depth, 2e-6, 4e-4, 2.4e10) for depth in (0.2, 0.1))),)


@cache
def model_of(name, tables=False, moving=True):
    machine = make_floating_machine(KINDS[name], moving)
    return build_model(replace(machine, tables=TABLES) if tables else machine)


@pytest.mark.parametrize("tables", [False, True])
def test_force_and_reaction_are_the_derivatives_of_one_energy(tables):
    law = model_of("helical", tables).system.law
    rng = np.random.default_rng(7)
    cycles, phase_shifts = rng.random(40), 0.5 * rng.normal(size=(40, law.contacts))
    beyond = 3e-5 * rng.random((40, law.contacts)) + 1e-7

    def energy(amount, place):
        return law.energy(cycles, beyond + amount, phase_shifts + place, (0, 0))

    by_amount = (energy(1e-9, 0.0) - energy(-1e-9, 0.0)) / 2e-9
    by_place = (energy(0.0, 1e-6) - energy(0.0, -1e-6)) / 2e-6
    force, reaction = (law.energy(cycles, beyond, phase_shifts, orders) for orders in ((1, 0), (0, 1)))
    np.testing.assert_allclose(force, by_amount, rtol=0.0, atol=1e-6 * np.abs(force).max())
    np.testing.assert_allclose(reaction, by_place, rtol=0.0, atol=1e-6 * np.abs(reaction).max())
    still = law.energy(cycles, beyond, np.zeros_like(phase_shifts), (1, 0))
    np.testing.assert_allclose(still, law.force(cycles, beyond), rtol=1e-11)


def test_a_helical_pinion_one_axial_pitch_outwards_meshes_as_one_that_has_turned_by_a_tooth():
    machine = make_floating_machine(KINDS["helical"], True)
    layout, rows = machine.layout, machine.linear.rows
    outwards, turned = np.zeros((2, machine.linear.size))
    outwards[2] = layout.base_pitch / layout.flank_frames[1][0].normal[2]
    turned[3] = TAU / layout.pinion_teeth
    np.testing.assert_allclose(rows @ outwards, rows @ turned, rtol=0.0, atol=1e-15)
    # Both carry the meshes of that pinion on by a mesh period; a turn is in part one of all bodies as well.
    apart = machine.phase_rows @ (outwards - turned)
    np.testing.assert_allclose(apart, apart[0], rtol=1e-12)
    others = machine.phase_rows[[1, 3, 5, 7]] @ outwards
    np.testing.assert_allclose(machine.phase_rows[[0, 2, 4, 6]] @ outwards - others, TAU, rtol=1e-12)


@pytest.mark.parametrize("name", KINDS)
def test_places_change_the_motion_and_no_place_leaves_it_as_it_was(name):
    moving, even = model_of(name), model_of(name, moving=False)
    ends = []
    for model in (moving, even):
        mapped = model.reduction.basis.T @ moving.machine.linear.mass @ even.reduction.basis
        start = kicked(even, 0.05)
        state = np.array([mapped @ start.displacement, mapped @ start.velocity / OMEGA])
        ends.append(model.reduction.basis @ Integrator(model.system, OMEGA, 1e-12).run(state, 1).state[0])
    assert np.abs(ends[0] - ends[1]).max() > 1e-5 * np.abs(ends[1]).max()
    system = replace(moving.system, phase_shifts=np.zeros_like(moving.system.phase_shifts))
    start = Integrator(system, OMEGA).by_phase(kicked(moving, 0.05))
    still = [
        Integrator(each, OMEGA, 1e-12).run(start, 1).state
        for each in (system, replace(system, law=system.law.steady, phase_shifts=None))
    ]
    np.testing.assert_allclose(still[0], still[1], rtol=0.0, atol=1e-9 * np.abs(still[1]).max())


def right_side(model):
    """The reduced equations once more, by the energy of the law."""
    system = model.system
    rows, phase_shifts = system.mesh_jacobian, system.phase_shifts

    def right(t, z):
        y, v = np.split(z, 2)
        cycles = np.array([t * OMEGA / TAU])
        orders = np.arange(system.error.shape[2])
        sine, cosine = np.sin(TAU * cycles * orders), np.cos(TAU * cycles * orders)
        errors, rates = (
            (system.error[:, 0] @ sine + system.error[:, 1] @ cosine)[system.error_kind],
            (system.error[:, 0] @ (orders * cosine) - system.error[:, 1] @ (orders * sine))[
                system.error_kind
            ],
        )
        over = rows @ y - errors - system.upper
        pressed, at = np.maximum(over, 0.0)[None], (phase_shifts @ y)[None]
        force, reaction = (system.law.energy(cycles, pressed, at, orders)[0] for orders in ((1, 0), (0, 1)))
        force = force + system.mesh_damping * (over > 0.0) * (rows @ v - OMEGA * rates)
        velocity = system.damping * v
        if system.coupling is not None:
            velocity = velocity + OMEGA * system.coupling.velocity_terms(OMEGA) @ v
            velocity = velocity + OMEGA**2 * system.coupling.displacement_terms(OMEGA) @ y
        own = system.load[:, 1, 0] - velocity - system.omega_squared * y
        return np.concatenate([v, own - rows.T @ force - phase_shifts.T @ reaction])

    return right


def test_forces_that_follow_load_and_place_move_as_scipy_says():
    model = model_of("helical", tables=True)
    start = kicked(model, 0.03)
    integrator = Integrator(model.system, OMEGA, 1e-13)
    found = integrator.by_time(integrator.run(integrator.by_phase(start), 1).state)
    exact = solve_ivp(
        right_side(model),
        (0.0, TAU / OMEGA),
        np.concatenate([start.displacement, start.velocity]),
        "DOP853",
        rtol=1e-12,
        atol=1e-16,
        max_step=1e-6,
    ).y[:, -1]
    for mine, other in zip((found.displacement, found.velocity), np.split(exact, 2), strict=True):
        assert np.abs(mine - other).max() < 1e-6 * np.abs(other).max()


@pytest.mark.parametrize("tables", [False, True])
@pytest.mark.parametrize("name", KINDS)
def test_a_disturbance_is_the_difference_of_two_motions(name, tables):
    model = model_of(name, tables)
    integrator = Integrator(model.system, OMEGA, 1e-13)
    start = integrator.by_phase(kicked(model, 0.02))
    direction = integrator.scale * np.sin(1.0 + np.arange(start.size)).reshape(start.shape)
    step = 1e-5
    off = [integrator.run(start + sign * step * direction, 1, fine=True).state for sign in (1.0, -1.0)]
    found = integrator.run(start, 1, direction[None]).tangents[0]
    expected = (off[0] - off[1]) / (2.0 * step)
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()
    # Without the slopes by the place it would not be.
    even = replace(model.system, phase_shifts=0.0 * model.system.phase_shifts)
    other = Integrator(even, OMEGA, 1e-13).run(start, 1, direction[None]).tangents[0]
    assert np.abs(other - expected).max() > 1e-4 * np.abs(expected).max()


def test_machines_side_by_side_move_as_each_does_alone():
    model = model_of("all", tables=True)
    integrators, starts, alone = [], [], []
    for speed in (0.9, 1.0, 1.1):
        integrator = Integrator(model.system, speed * OMEGA, 1e-12)
        start = integrator.by_phase(kicked(model, 0.02))
        integrators.append(integrator)
        starts.append(start)
        alone.append(integrator.run(start, 2).state)
    for result, state in zip(run_many(integrators, starts, 2, fewest=1), alone, strict=True):
        np.testing.assert_allclose(result.state, state, rtol=0.0, atol=1e-9 * np.abs(state).max())


def test_steady_states_have_forces_by_place_and_balance_the_torques():
    model = model_of("helical")
    speed = 7000.0
    response = simulate(model, speed)
    assert response.period > 0
    _, forces = mesh_response(model.system, response.coordinates, response.per_period)
    np.testing.assert_allclose(response.forces, forces, rtol=1e-12)
    torque = forces.mean(axis=0) * model.machine.layout.pinion_arm
    # The reaction along the place takes a part of second order in the compression.
    assert torque[[0, 2]].sum() == pytest.approx(800.0, rel=5e-3)
    even = replace(model.system, law=model.system.law.steady, phase_shifts=None)
    _, at_even_places = mesh_response(even, response.coordinates, response.per_period)
    assert np.abs(forces - at_even_places).max() > 1e-4 * np.abs(forces).max()


def test_sizes_of_shift_and_reaction_are_those_of_the_page():
    model = model_of("helical")
    system, machine = model.system, model.machine
    even, response = (simulate(each, 5040.0) for each in (model_of("helical", moving=False), model))
    moved = response.coordinates
    shifts = moved @ system.phase_shifts.T
    assert 0.002 < np.abs(shifts).max() / TAU < 0.01
    over = np.maximum(moved @ system.mesh_jacobian.T - system.upper, 0.0)
    cycles = np.arange(len(moved)) / response.per_period
    force, reaction = (system.law.energy(cycles, over, shifts, orders) for orders in ((1, 0), (0, 1)))
    axial = np.abs(force @ machine.linear.rows[:8, 2]).max()
    assert 1e-3 < np.abs(reaction @ machine.phase_rows[:, 2]).max() / axial < 3e-3
    changed = np.abs(response.forces.std(axis=0) / even.forces.std(axis=0) - 1.0)
    assert 0.02 < changed.max() < 0.05


def test_a_pinion_that_its_mean_load_floats_carries_its_meshes_on_by_that_float():
    """Motions count from the place without load, so that no other shift of the law belongs to it."""
    model = model_of("helical")
    machine = model.machine
    moved = (simulate(model, 5040.0).coordinates @ model.system.phase_shifts.T).mean(axis=0)
    at_rest = mean_equilibrium(machine).displacements[0]
    place = machine.phase_rows @ at_rest
    # Stiffness that varies gives way by 3 % more in the mean than its mean does.
    np.testing.assert_allclose(moved, place, rtol=0.0, atol=0.04 * np.abs(place).max())
    floated = at_rest * np.isin(np.arange(at_rest.size), [2, 6])
    assert np.abs(machine.phase_rows @ floated).max() > 0.1 * np.abs(place).max()


def test_a_config_asks_for_moving_places_and_refuses_what_they_cannot_have(tmp_path):
    pair = {"tooth_pair.helix_angle_deg": 15.0, "transmission.pinion.bearing_stiffness_n_per_m.z": 2e8}
    moving = {
        "transmission.mesh_kinematics": "geometric",
        "transmission.pinion.base_radius_mm": None,
        "transmission.face_gear.mesh_radius_mm": None,
        "transmission.mesh_place": "moving",
    }
    base = facegear.load("config/harmonics_only.yaml")
    gearbox = base.with_values({**pair, **moving})
    even = base.with_values({**pair, **moving, "transmission.mesh_place": "even"})
    tables = [each.response().table() for each in (gearbox, even)]
    assert all(table["periodic"].all() for table in tables)
    forces = [table.loc[table["quantity"].str.contains("force"), "value"].to_numpy() for table in tables]
    changed = np.abs(forces[0] - forces[1]).max() / np.abs(forces[1]).max()
    assert 1e-6 < changed < 0.2
    with pytest.raises(FacegearError, match=r"mesh_place = \"moving\": must be even where mesh_k"):
        base.with_values({"transmission.mesh_place": "moving"})
    with pytest.raises(
        FacegearError, match=r"mesh_place = .*even, where lubrication\.friction\.effect is exc"
    ):
        facegear.load("config/friction.yaml").with_values(
            {"transmission.mesh_place": "moving", "lubrication.friction.effect": "excitation"}
        )
    machine = make_floating_machine(KINDS["helical"], True)
    with pytest.raises(InvalidInput, match="even, where an FMU is written"):
        write_fmu(tmp_path / "machine.fmu", machine, 7000.0)
    assert not list(tmp_path.iterdir())


def test_laws_that_jump_in_the_mesh_cycle_have_no_moving_places():
    piece = Piecewise(np.array([0.0, 0.4, 1.0]), np.array([[1e7], [0.0]]))
    law = LinearLaw(np.full((1, 2, 1), 4e8), np.zeros(2, dtype=int), (piece,))
    with pytest.raises(InvalidInput, match="fixed, where the stiffness jumps"):
        moving_law(law, 4)


def test_places_follow_turn_and_float_of_the_own_pinion_alone():
    machine = make_floating_machine(KINDS["tapered"], True)
    rows = machine.phase_rows
    still = np.delete(np.arange(machine.linear.size), [2, 3, 6, 7, 11, 15])
    assert not rows[:, still].any()
    assert not rows[::2, DOF_PER_BODY + 2].any() and rows[1::2, DOF_PER_BODY + 2].all()
    assert mesh_frequency(machine.layout, 60.0) == machine.layout.pinion_teeth
