"""Friction as a disturbance of the motion: forces on the bodies, SciPy, energy, the static loss."""

from dataclasses import replace

import numpy as np
import pytest
from free_machines import rigid_rotation
from lumped_machines import make_layout, make_machine
from recorded_motion import record
from references import against, agrees
from scipy_motions import gap_to_scipy, kicked

from facegear.harmonics import stacked_values
from facegear.machine.disturbances import PARTS, MeshFriction, friction_rows
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import FaceGear, Role, Side, Tilt
from facegear.machine.linear_model import bearing_matrix, flank_jacobian, mass_diagonal
from facegear.machine.machine import OpenFlanks, mesh_frequency
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Settings
from facegear.motion.steady_state.orbits import monodromy
from facegear.motion.steady_state.simulate import build_model, simulate

TWO = (("engine", Role.INPUT, 0.0), ("idler", Role.IDLER, 35.5))


def layout_with_axial_bearings():
    """Two pinions held along their axes, two gears of which one rocks."""
    shape = make_layout(TWO, kinematics=GEOMETRIC)
    held = [replace(one, body=replace(one.body, bearing=(6.5e7, 6.5e7, 3e7))) for one in shape.pinions]
    lower, upper = shape.gears
    rocking = FaceGear(Side.UPPER, replace(upper.body, tilt=Tilt(0.3, 5e7)))
    return replace(shape, pinions=tuple(held), gears=(lower, rocking))


def rubbing_machine(size=0.05, layout=None, **options):
    """A machine whose meshes rub by made-up series of a few harmonics, each with its own."""
    layout = layout or layout_with_axial_bearings()
    random = np.random.default_rng(11)
    ratios = size * random.normal(size=(len(layout.meshes), len(PARTS), 2, 4))
    ratios[:, :, 0, 0] = 0.0
    ratios[:, 3:, 1, 0] = -size
    options = {"torque": 500.0, "tail_share": 0.0, "error": 8e-6, **options}
    return replace(make_machine(layout, **options), friction=MeshFriction(ratios))


def test_a_force_along_the_normal_acts_on_the_bodies_as_the_force_of_the_mesh_does():
    machine = rubbing_machine()
    layout = machine.layout
    cosine, sine = np.cos(layout.pressure_angle), np.sin(layout.pressure_angle)
    for at_output in (True, False):
        rows = friction_rows(layout, machine.linear, None, at_output)
        drive = np.einsum("p,mpd->md", [-cosine, 0.0, -sine, -1.0, 1.0], rows)
        back = np.einsum("p,mpd->md", [cosine, 0.0, -sine, 1.0, -1.0], rows)
        np.testing.assert_allclose(
            np.concatenate([drive, back]), -flank_jacobian(layout), atol=1e-15 * layout.gear_arm
        )


def test_friction_never_turns_the_machine_as_a_whole():
    machine = rubbing_machine()
    layout = machine.layout
    rows, turn = friction_rows(layout, machine.linear, None), rigid_rotation(layout)
    np.testing.assert_allclose(rows @ turn, 0.0, atol=1e-13)
    # What the output gives way by is what the moments take.
    np.testing.assert_allclose(
        friction_rows(layout, machine.linear, None, at_output=False) @ turn,
        np.tile([0.0, 0.0, 0.0, 1.0, 1.0], (4, 1)),
        atol=1e-13,
    )


def test_the_back_flank_rubs_as_the_mirror_image_that_turns_the_other_way():
    both = rubbing_machine().friction.flank_ratios(np.zeros(8))
    cycles = np.array([0.13, 0.4, 0.77])
    for part, sign in enumerate((1.0, -1.0, -1.0, 1.0, 1.0)):
        here, mirrored = (
            stacked_values(both[half, part], at)
            for half, at in ((slice(4, 8), cycles), (slice(0, 4), -cycles))
        )
        np.testing.assert_allclose(here, sign * mirrored, atol=1e-15)


def rubbed(model):
    """Friction of each flank on all bodies, written out once more."""
    machine = model.machine
    ratios = machine.friction.flank_ratios(np.tile(machine.phases, 2))
    rows = np.tile(friction_rows(machine.layout, machine.linear, None), (2, 1, 1)) @ model.reduction.basis

    def acting(cycles, y, v, pressed):
        at = stacked_values(ratios.reshape(-1, *ratios.shape[2:]), cycles).reshape(rows.shape[:2])
        return np.einsum("f,fp,fpn->n", pressed, at, rows)

    return acting


@against(
    "third-party program",
    "scipy.integrate.solve_ivp",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_rubbing_flanks_move_as_scipy_says_through_parting_and_both_flanks():
    model = build_model(rubbing_machine(torque=60.0, backlash=20e-6))
    omega = TAU * 6000.0
    start = kicked(model, 0.6)
    run = record(model.system, omega, start, 1, Settings(tolerance=1e-13))
    assert (run.states == 0).any() and (run.states[:, :4] == 1).any() and (run.states[:, 4:] == 1).any()
    phases = np.linspace(0.0, TAU, 11)
    gap = gap_to_scipy(model, omega, rubbed(model), start, run, phases, 1e-10)
    agrees("largest difference of the motion, m", gap, 0.0, absolute=2e-6 * model.system.scale)


@against(
    "second implementation",
    "central differences of the motion; Liouville's formula",
    capability="dynamics_response branches",
    module="facegear.motion.integrator.integrator",
)
@pytest.mark.parametrize("open_flanks", [OpenFlanks.CONTACT_ONLY, OpenFlanks.PUSH_ONLY])
def test_disturbances_of_rubbing_flanks_are_differences_and_keep_their_volume(open_flanks):
    model = build_model(rubbing_machine(torque=60.0, backlash=20e-6, open_flanks=open_flanks))
    omega = TAU * 2000.0
    integrator = Integrator(model.system, omega, 1e-14, 20)
    start, n = kicked(model, 0.3), integrator.size
    state = integrator.by_phase(start)
    matrix, run = monodromy(integrator, state, 1)
    assert ((run.fractions[0] > 0.0) & (run.fractions[0] < 1.0)).any()
    agrees(
        "logarithm of the determinant of the tangents",
        np.linalg.slogdet(matrix)[1],
        run.divergence,
        absolute=1e-7,
    )
    for column in range(0, 2 * n, 7):
        ends = []
        for sign in (-1.0, 1.0):
            change = np.zeros((2, n))
            change[divmod(column, n)] = sign * 1e-9
            ends.append(integrator.run(state + change, 1, fine=True).state[0])
        slope = (ends[1] - ends[0]) / 2e-9
        agrees(
            "column of the tangents",
            matrix[:n, column],
            slope,
            relative=1e-7,
            absolute=2e-4 * np.abs(matrix).max(),
        )


@against(
    "analytic",
    "balance of energy",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_power_in_less_power_out_less_friction_less_damping_is_the_change_of_energy():
    """The balance is that of the whole machine at even rotation, along a motion that parts and strikes back.

    The work of the even rotation on the varying stiffness and on the error counts as power in.
    """
    machine = rubbing_machine(torque=60.0, backlash=20e-6, open_flanks=OpenFlanks.CONTACT_ONLY)
    model = build_model(machine)
    layout, system, damping = machine.layout, model.system, machine.damping
    speed = 5000.0
    omega = TAU * mesh_frequency(layout, speed)
    turn = rigid_rotation(layout) * layout.pinion_arm * speed * TAU / 60.0
    run = record(system, omega, kicked(model, 0.3), 1, Settings(tolerance=1e-13))
    assert (run.states == 0).any() and (run.states[:, 4:] == 1).any()
    bearing, mass = bearing_matrix(layout), mass_diagonal(layout)
    jacobian, kept = flank_jacobian(layout), friction_rows(layout, machine.linear, None, False)
    output = layout.spins.start + 4 * (len(layout.bodies) - 1)
    errors = system.error[system.error_kind]

    def instants(phases, step, coordinates):
        """Displacements, their rates, cycles, overlaps and rates of overlap at phases of a step."""
        powers = (phases[:, None] - run.starts[step]) ** np.arange(coordinates.shape[0])
        slopes = np.arange(1, coordinates.shape[0])
        q = powers @ coordinates @ model.reduction.basis.T
        rate = omega * (powers[:, :-1] * slopes) @ coordinates[1:] @ model.reduction.basis.T
        cycles = phases / TAU
        orders = np.arange(errors.shape[2])
        e = stacked_values(errors, cycles)
        e_rate = omega * stacked_values(
            np.stack([-orders * errors[:, 1], orders * errors[:, 0]], axis=1), cycles
        )
        return q, rate, cycles, q @ jacobian.T - e - system.upper, rate @ jacobian.T - e_rate, e_rate

    def energy(q, rate, cycles, over):
        elastic = 0.5 * (system.law.stiffness(cycles) * np.maximum(over, 0.0) ** 2).sum(axis=1)
        return 0.5 * (rate**2) @ mass + 0.5 * np.einsum("kd,de,ke->k", q, bearing, q) + elastic

    nodes, weights = np.polynomial.legendre.leggauss(14)
    sums = dict.fromkeys(("power", "friction", "damping", "rotation"), 0.0)
    even, change = 0.0, 0.0
    ratios = machine.friction.flank_ratios(np.tile(machine.phases, 2))
    ratios = ratios.reshape(-1, *ratios.shape[2:])
    for step in range(run.starts.size):
        length = run.lengths[step]
        phases = run.starts[step] + 0.5 * length * (1.0 + nodes)
        _, rate, cycles, over, over_rate, e_rate = instants(phases, step, run.coordinates[step])
        touching = run.states[step] > 0
        over = np.where(touching, over, 0.0)
        force = system.law.stiffness(cycles) * over
        damper = damping.mesh * over_rate * touching
        on_each = force[:, :, None] * stacked_values(ratios, cycles).reshape(len(cycles), 8, len(PARTS))
        rubbing = np.einsum("kfp,fpd->kd", on_each, np.tile(kept, (2, 1, 1)))
        # The output's torque gives way by the moments that friction takes.
        torque = np.tile(machine.linear.loads, (len(cycles), 1))
        torque[:, output] -= layout.gear_arm * on_each[:, :, 3:].sum(axis=(1, 2))
        ahead = 1e-6
        stiffer = (system.law.stiffness(cycles + ahead) - system.law.stiffness(cycles - ahead)) / (
            2.0 * ahead
        )
        powers = {
            "power": (torque * (turn + rate)).sum(axis=1),
            "friction": -(rubbing * (turn + rate)).sum(axis=1),
            "damping": (rate**2) @ (damping.mass * mass)
            + damping.bearing * np.einsum("kd,de,ke->k", rate, bearing, rate)
            + (damper * over_rate).sum(axis=1),
            "rotation": -((force + damper) * e_rate).sum(axis=1)
            + 0.5 * (stiffer * over**2).sum(axis=1) * omega / TAU,
        }
        for name, values in powers.items():
            sums[name] += 0.5 * length / omega * weights @ values
        even += 0.5 * length / omega * weights @ -(rubbing @ turn)
        ends = instants(run.starts[step] + np.array([0.0, length]), step, run.coordinates[step])
        low, high = energy(*ends[:3], np.where(touching, ends[3], 0.0))
        change += high - low
    left_over = sums["power"] - sums["friction"] - sums["damping"] + sums["rotation"] - change
    assert abs(sums["friction"]) > 1e-2 * abs(change)
    agrees(
        "work left over, J", left_over, 0.0, absolute=1e-8 * (abs(sums["friction"]) + abs(sums["damping"]))
    )
    # Of the even rotation alone: what goes in and does not come out is what friction takes.
    assert even > 0.0


def test_without_friction_nothing_is_added_to_the_system():
    machine = rubbing_machine()
    plain = build_model(replace(machine, friction=None))
    assert plain.system.rubbing is None
    # Without any force of friction the motion of the larger system is that without it.
    none = build_model(replace(machine, friction=MeshFriction(0.0 * machine.friction.ratios)))
    forces = [simulate(one, 2500.0, Settings(tolerance=1e-11)).forces for one in (plain, none)]
    np.testing.assert_allclose(forces[1], forces[0], atol=1e-7 * forces[0].max())
