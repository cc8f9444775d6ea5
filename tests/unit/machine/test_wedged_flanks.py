"""Wedged meshes of gears that bend: both flanks press on one rim, which gives way to either."""

from dataclasses import replace

import gear_bodies
import numpy as np
import pytest
import scipy.linalg
from force_tables import linear_table
from gear_bodies import gearbox
from lumped_machines import make_layout, make_machine
from references import against, agrees
from test_elastic_gears_at_rest import below

from facegear.harmonics import Harmonics
from facegear.machine import elastic_gears
from facegear.machine.elastic_gears import ElasticGears
from facegear.machine.flank_errors import constant_errors
from facegear.machine.flanks import flank_law
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role
from facegear.machine.loaded_contacts import loaded_contacts
from facegear.machine.loaded_modes import loaded_modes, machine_in_motion, pressed_springs
from facegear.machine.machine import FlankTables
from facegear.machine.shaft_orders import LoadedMachine, TurnOrders, loaded_machine
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium
from facegear.machine.torques import balanced_torques
from facegear.machine.turning_modes import machine_at_speeds
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.parts.gear_body import influence

pytestmark = pytest.mark.xdist_group("reference_body")  # solved once a process
K, SPEED = 4.1e8, 5000.0
SWUNG = Harmonics(K * np.array([0, 0.25, -0.08]), K * np.array([1.0, 0.1, 0.05]))


def pressed_into_mesh(body):
    """The paper's gearbox with three pinions 0.4 mm off their places, so that three meshes are wedged."""
    machine = gearbox(body)
    flaws = perfect(machine.layout)
    position = flaws.position.copy()
    position[:, 1] = [4e-4, 4e-4, -4e-4, 0.0, 0.0]
    return replace(machine, imperfections=replace(flaws, position=position))


TWO = ("one", Role.INPUT, 0.0), ("two", Role.INPUT, 41.5)


def wedged_pinions(seed, stiffness=SWUNG, places=TWO):
    """Pinions between two gears that bend, which forces along their axis press on them: all are wedged.

    Modes are random. What they leave out is as soft as the teeth, along the axis other than round it.
    """
    random = np.random.default_rng(seed)
    layout = make_layout(places, kinematics=GEOMETRIC)
    heavy = replace(layout.gears[0].body, mass=31.0, inertia=1.3, bearing=(8.7e9, 8.7e9, 1e7))
    gears = tuple(replace(gear, body=heavy) for gear in layout.gears)
    layout = replace(layout, gears=gears)
    bodies = {}
    for gear in range(2):
        body = gear_bodies.small_body(seed + gear)
        mesh = body.mesh.copy()
        mesh[1, 0] = mesh[0, 1] = 0.0  # modes without diameters go along the axis or round it
        body = replace(body, frequency=40.0 * body.frequency, mesh=mesh)
        left_out = np.zeros((5, 3, 3))
        left_out[4] = np.diag([*random.uniform(5e-10, 4e-9, 2), 0.0])
        bodies[gear] = replace(body, static=body.modal + left_out)
    elastic = ElasticGears(layout, bodies)
    machine = make_machine(layout, backlash=1e-6, error=0.0, stiffness=stiffness)
    count, ratio = len(places), layout.gear_radius / layout.pinion_radius
    torques = balanced_torques(layout, np.full(count, 300.0), -150.0 * count * ratio)
    forces = np.zeros((count + 2, 3))
    forces[count:, 2] = [gear.sign * -1e5 * count for gear in layout.gears]
    return replace(machine, torques=torques, forces=forces, bodies=elastic, softening=elastic.softening())


def states(machine):
    return [state.value for state in loaded_contacts(machine).flank_states()]


def springs_with_bodies_between(machine, cycles):
    """Flank stiffness (2 meshes, 2 meshes) of teeth on springs of the body, which are condensed away.

    Every flank stands on a massless point of its own. Springs of the body, from the sum over the orders that
    the modes leave out, join the points of a mesh. Averaged over the cycles (K,).
    """
    layout, meshes = machine.layout, len(machine.layout.meshes)
    angle = layout.pressure_angle
    law = flank_law(replace(machine, softening=None))
    teeth = law.slope(cycles, np.ones((cycles.size, 2 * meshes)))
    whole = np.zeros((2 * meshes, 2 * meshes))
    for mesh, (_, gear) in enumerate(layout.meshes):
        body = machine.bodies.bodies[gear]
        sides = [gear_bodies.flank_direction(angle, back) for back in (False, True)]
        rim = np.linalg.inv([[influence(body.residual, 0.0, a, b) for b in sides] for a in sides])
        both = [mesh, mesh + meshes]
        for row in teeth[:, both]:
            tooth = np.diag(row)
            condensed = tooth - tooth @ np.linalg.solve(tooth + rim, tooth)
            whole[np.ix_(both, both)] += condensed / cycles.size
    return whole


def damped_exponents(linear, springs, damping, speed):
    """Exponents of the quadratic eigenproblem, 1/s, by the generalised pencil."""
    turning, rows, size = speed * np.pi / 30.0, linear.rows, linear.size
    stiff = linear.stiffness + turning * linear.spin.circulatory + turning**2 * linear.spin.centrifugal
    stiff = stiff + rows.T @ springs @ rows
    slow = linear.damping + turning * linear.spin.gyroscopic + damping * rows.T @ rows
    none, one = np.zeros((size, size)), np.eye(size)
    left = np.block([[none, one], [-stiff, -slow]])
    return scipy.linalg.eigvals(left, scipy.linalg.block_diag(one, linear.mass))


def vibrations(linear, springs, damping, speed):
    """Angular frequencies of the damped vibrations, rad/s."""
    roots = damped_exponents(linear, springs, damping, speed)
    return np.sort(roots.imag[roots.imag > 1.0])


@against(
    "analytic",
    "teeth and rims as springs between massless points, condensed at every place of the mesh cycle",
    capability="gear_waves modal shaft_orders",
    module="facegear.machine.loaded_contacts",
)
@pytest.mark.parametrize("seed", [0, 3, 7])
def test_wedged_machine_vibrates_as_one_with_springs_of_its_bodies_between_the_flanks(seed):
    machine = wedged_pinions(seed)
    assert set(states(machine)) == {"closed"}
    linear, springs = pressed_springs(machine)
    expected = springs_with_bodies_between(machine, np.arange(512) / 512)
    agrees("stiffness of the flanks over k", springs / K, expected / K, absolute=1e-9)
    assert np.abs(np.diag(expected, 4)).min() > 0.02 * K
    (modes,) = machine_at_speeds(machine, [SPEED])
    computed = vibrations(linear, expected, 0.5 * machine.damping.mesh, SPEED) / (2 * np.pi)
    agrees("damped frequencies, Hz", modes.frequencies, computed, relative=1e-7)
    uncoupled = replace(machine, softening=machine.softening * np.eye(2))
    (apart,) = machine_at_speeds(uncoupled, [SPEED])
    assert np.abs(apart.frequencies / modes.frequencies - 1.0).max() > 0.01


def test_waves_of_a_wedged_machine_come_to_those_with_all_modes_as_more_of_them_are_kept():
    """Nothing is left out of the body with all its modes below 10 kHz."""
    whole = gear_bodies.reference_modes()
    whole = replace(whole, static=whole.modal)
    exact = pressed_into_mesh(whole)
    assert [m for m in range(10) if states(exact)[m] == states(exact)[m + 10] == "closed"] == [2, 5, 6]
    limit = loaded_modes(exact).frequencies
    stiffest = int(np.argmin(np.abs(limit - 1714.3)))
    errors, dropped = [], []
    for last in (3e3, 4e3, 5e3):
        machine = pressed_into_mesh(below(whole, last))
        uncoupled = replace(machine, softening=machine.softening * np.eye(2))
        found = [loaded_modes(each).frequencies[stiffest] for each in (machine, uncoupled)]
        errors.append(abs(found[0] / limit[stiffest] - 1.0))
        dropped.append(abs(found[1] / limit[stiffest] - 1.0))
    assert errors[0] < 3e-3 and errors[1] < 1e-3 and errors[2] < 6e-4
    assert (np.array(dropped) > 2.0 * np.array(errors)).all()


def test_law_that_depends_on_the_load_couples_wedged_flanks_as_the_stiffness_that_it_is_the_same_as():
    constant = wedged_pinions(0, Harmonics(np.zeros(1), np.array([K])))
    table = linear_table(4, 2e-3, K)
    lawful = replace(constant, tables=(FlankTables(table, table),) * 2)
    expected, found = pressed_springs(constant)[1], pressed_springs(lawful)[1]
    assert np.abs(np.diag(expected, 4)).min() > 0.02 * K
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-7 * K)


@against(
    "second implementation",
    "equilibria with the whole compliance between the flanks",
    capability="shaft_orders",
    module="facegear.machine.shaft_orders",
)
def test_errors_of_wedged_flanks_that_turn_slowly_change_forces_as_equilibria_do():
    """One pinion, so that no body carries two meshes, of which the compliance between would be left out."""
    wedged = wedged_pinions(0, Harmonics(np.zeros(1), np.array([K])), TWO[:1])
    moved = replace(perfect(wedged.layout), position=np.array([[0.0, 1e-5]]))
    flawed = replace(wedged, imperfections=moved)
    assert set(states(wedged)) == {"closed"}
    error = (constant_errors(flawed) - constant_errors(wedged))[None].astype(complex)
    orders = TurnOrders(["pinion"], np.array([1]), np.array([23]), error)
    found = loaded_machine(wedged).at_rest(orders).real[0]
    before, after = (mean_equilibrium(at_rest(each)).flank_forces[0] for each in (wedged, flawed))
    agrees("change of flank forces, N", found, after - before, absolute=1e-5 * np.abs(found).max())
    diagonal = np.diag(np.diagonal(loaded_machine(wedged).springs))
    apart = LoadedMachine(loaded_machine(wedged).linear, diagonal, np.zeros(4)).at_rest(orders).real[0]
    assert np.abs(apart - found).max() > 5e-3 * np.abs(found).max()


@against(
    "second implementation",
    "modes with the flanks coupled by a stiffness matrix of their own",
    capability="dynamics_response",
    module="facegear.machine.elastic_gears",
)
@pytest.mark.parametrize("seed", [0, 3, 7])
def test_attached_coordinates_couple_wedged_flanks_the_better_the_faster_they_are(seed, monkeypatch):
    machine = wedged_pinions(seed, Harmonics(np.zeros(1), np.array([K])))

    def off(other):
        """Relative change of the frequencies between 1 Hz and 2.5 kHz."""
        found = loaded_modes(other).frequencies[: expected.size]
        return np.abs(found[slow] / expected[slow] - 1.0).max()

    expected = loaded_modes(machine).frequencies
    slow = (expected > 1.0) & (expected < 2500.0)
    dropped = off(replace(machine, softening=machine.softening * np.eye(2)))
    errors = []
    for factor in (elastic_gears.ATTACHED_FREQUENCY, 3.0 * elastic_gears.ATTACHED_FREQUENCY):
        monkeypatch.setattr(elastic_gears, "ATTACHED_FREQUENCY", factor)
        moving = machine_in_motion(replace(machine, bodies=replace(machine.bodies)))
        assert moving.bodies.attached == (0, 1, 2, 3)
        errors.append(off(moving))
    assert errors[0] < 0.15 * dropped
    agrees("error at three times the frequency", errors[1], errors[0] / 9.0, relative=0.3)


def test_only_wedged_meshes_have_attached_coordinates():
    body = below(gear_bodies.reference_modes(), 4e3)
    wedged = machine_in_motion(pressed_into_mesh(body))
    assert wedged.bodies.attached == (2, 5, 6)
    assert wedged.linear.size == pressed_into_mesh(body).linear.size + 3
    for machine in (gearbox(body), gearbox()):
        assert machine_in_motion(machine) is machine


def test_motion_of_wedged_meshes_comes_to_that_with_all_modes():
    """The frequency that the coupling moves most; nothing is left out of the body with all its modes."""
    whole = gear_bodies.reference_modes()
    whole = replace(whole, static=whole.modal)
    exact = loaded_modes(pressed_into_mesh(whole)).frequencies
    stiffest = int(np.argmin(np.abs(exact - 1714.3)))
    machine = pressed_into_mesh(below(whole, 4e3))
    moving = loaded_modes(machine_in_motion(machine)).frequencies[stiffest]
    apart = loaded_modes(replace(machine, softening=machine.softening * np.eye(2))).frequencies[stiffest]
    assert abs(moving / exact[stiffest] - 1.0) < 1e-3 < abs(apart / exact[stiffest] - 1.0)


@against(
    "second implementation",
    "eigenvalues of the whole matrices, flanks coupled by a stiffness matrix of their own",
    capability="dynamics_response",
    module="facegear.motion.steady_state.simulate",
)
def test_multipliers_of_wedged_meshes_are_those_of_flanks_that_are_coupled():
    machine = wedged_pinions(0, Harmonics(np.zeros(1), np.array([K])))
    response = simulate(build_model(machine), SPEED)
    assert response.label == "period-1"
    period, errors = 60.0 / (23 * SPEED), []
    coupled = pressed_springs(machine)[1]
    for springs in (coupled, np.diag(np.diagonal(coupled))):
        roots = damped_exponents(machine.linear, springs, 0.5 * machine.damping.mesh, SPEED)
        slow = roots[(np.abs(roots) > 1.0) & (np.abs(roots) < 2.0 * np.pi * 2500.0)]
        nearest = np.abs(np.exp(slow * period)[:, None] - response.multipliers).min(axis=1)
        errors.append(nearest.max())
    agrees("distance of a multiplier", errors[0], 0.0, absolute=0.15 * errors[1])
