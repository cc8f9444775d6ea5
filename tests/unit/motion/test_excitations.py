"""Periodic torques on bodies: motion and linear response, and what is refused."""

import pickle
from dataclasses import replace

import gear_bodies
import numpy as np
import pytest
from drive_lines import driven, on_bearings
from idler_machines import make_idlers
from lumped_machines import make_layout
from recorded_motion import record
from references import against, agrees
from scipy_motions import gap_to_scipy, kicked

import facegear
from facegear.door.outputs import machine_of
from facegear.errors import ConfigError, ConfigErrors
from facegear.harmonics import Harmonics
from facegear.machine.disturbances import Excitation, rigid_rotation, without_rigid_rotation
from facegear.machine.drive_line import TurningMass
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.machine import OpenFlanks
from facegear.machine.shaft_orders import loaded_machine
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Motion, Settings
from facegear.motion.steady_state.simulate import build_model, simulate

PLACES = (("one", Role.INPUT, 0.0), ("two", Role.INPUT, 40.25))
SPEED, K = 6100.0, 4.1e8
CHAINS = {
    0: (TurningMass("shaft", 6e5, 0.002, 0.02), TurningMass("engine", 2.5e4, 0.08, 0.01)),
    2: (TurningMass("rotor", 5e6, 3.0, 0.005),),
}
SETTINGS = Settings(tolerance=1e-11, periodic_residual=1e-12, samples=256)


def make_excited(*excitations, shaft=True, masses=CHAINS):
    """Build a machine with constant stiffness and without transmission error that these torques shake."""
    machine = driven(
        on_bearings(1.5e8, 2.5e8) if shaft else None,
        masses=masses,
        layout=make_layout(PLACES, (Side.UPPER,), kinematics=GEOMETRIC),
        stiffness=Harmonics(np.zeros(1), np.array([K])),
        error=0.0,
        open_flanks=OpenFlanks.CONTACT_ONLY,
        mass_damping=0.0,
    )
    return replace(machine, excitations=excitations)


@against(
    "analytic",
    "harmonic response in full matrices",
    capability="dynamics_response",
    module="facegear.machine.disturbances",
)
@pytest.mark.parametrize(
    "excitation",
    [
        Excitation(0, 23.0, 23, 600.0, 0.4),
        Excitation(2, 286.0, 143, 9000.0),
        Excitation(1, 69.0, 23, 2000.0, -2.0),
    ],
)
def test_a_periodic_torque_shakes_the_machine_as_its_linear_response_says(excitation):
    machine = make_excited(excitation)
    model, loaded = build_model(machine), loaded_machine(machine)
    response = simulate(model, SPEED, SETTINGS)
    assert (response.motion, response.period) == (Motion.PERIODIC, 1)
    motion = loaded.excited_motion(machine, excitation, SPEED)
    turns = np.exp(2j * np.pi * excitation.mesh_harmonic * response.phases[:, None])
    moving = response.coordinates @ model.reduction.basis.T
    moving = moving - moving.mean(axis=0)
    rows = machine.linear.rows[:2]
    exact = np.real((rows @ motion) * turns)
    agrees("deflection of a mesh, m", moving @ rows.T, exact, absolute=1e-8 * np.abs(exact).max())
    for spring in machine.drive_line.springs():
        ends = [spring.first, spring.second]
        exact = np.real(np.diff(motion[ends]) * turns)
        twist = np.diff(moving[:, ends])
        agrees("twist of a torsional spring, rad", twist, exact, absolute=1e-8 * np.abs(exact).max())


@against(
    "third-party program",
    "SciPy's DOP853 with the torque written plainly",
    capability="dynamics_response",
    module="facegear.motion.steady_state.simulate",
)
def test_a_torque_that_parts_flanks_moves_them_as_scipy_says():
    excitation = Excitation(1, 46.0, 23, 2500.0, 0.3)
    machine = make_excited(excitation, shaft=False, masses={})
    model, omega = build_model(machine), TAU * 23 * SPEED / 60.0
    push = model.reduction.basis.T @ machine.straining_torque(1)

    def acting(cycles, y, v, pressed):
        return 2500.0 * np.cos(2.0 * TAU * cycles[0] + 0.3) * push

    start = kicked(model, 0.3)
    run = record(model.system, omega, start, 2, Settings(tolerance=1e-13))
    assert (run.states == 0).any() and (run.states == 1).any()
    phases = np.linspace(0.0, 2.0 * TAU, 21)
    gap = gap_to_scipy(model, omega, acting, start, run, phases, 1e-10)
    agrees("largest difference of the motion, m", gap, 0.0, absolute=2e-6 * model.system.scale)


def test_a_torque_that_turns_all_bodies_alike_strains_nothing():
    """Torques in proportion to the inertia that they turn move all bodies together."""
    machine = make_excited()
    linear, at = machine.linear, machine.torque_coordinates
    rotation = rigid_rotation(machine.layout, linear, machine.drive_line)
    assert linear.rows @ rotation == pytest.approx(np.zeros(4), abs=1e-15)
    assert np.abs(linear.stiffness @ rotation).max() < 1e-9 * np.abs(linear.stiffness).max()
    for body in range(3):
        strain = machine.straining_torque(body)
        assert rotation @ strain == pytest.approx(0.0, abs=1e-12)
        assert strain[at[body]] > 0.0
    whole = linear.momentum(rotation)
    assert without_rigid_rotation(whole, linear, rotation) == pytest.approx(0.0 * whole, abs=1e-12)


def make_shaken(order, body="idler 1"):
    """Build idlers between two gears, one of them with a periodic torque."""
    shaken = [{"body": body, "order": order, "torque_n_m": 5.0}]
    return make_idlers(3).with_values({"transmission.excitations": shaken})


def test_an_order_that_does_not_repeat_with_the_mesh_is_refused_in_motion_alone():
    gearbox = make_shaken(5)
    assert len(gearbox.shaft_orders().excited())
    with pytest.raises(ConfigError, match=r"transmission\.excitations = 5.*a multiple of 23"):
        gearbox.response()


def test_a_gears_order_counts_its_own_turns():
    assert machine_of(make_shaken(240, "lower")).excitations[0].mesh_harmonic == 2


def test_a_body_that_is_not_there_is_refused_with_the_names_that_are():
    with pytest.raises(
        ConfigErrors, match=r"excitations\[0\]\.body.*idler 1, idler 2, idler 3, lower, upper"
    ):
        make_shaken(23, "propeller")


def test_printed_kinematics_take_no_excitation():
    config = facegear.load("config/paper.yaml", None)
    shaken = [{"body": "upper", "order": 143, "torque_n_m": 5.0}]
    with pytest.raises(ConfigErrors, match="excitations"):
        config.with_values({"transmission.excitations": shaken})


def test_an_fmu_refuses_an_order_that_its_motion_cannot_have(tmp_path):
    with pytest.raises(ConfigError, match=r"transmission\.excitations = 5.*a multiple of 23"):
        make_shaken(5).export(tmp_path / "machine.fmu")
    assert not list(tmp_path.iterdir())


def test_values_and_a_pickled_machine_keep_their_excitations():
    gearbox = make_shaken(23)
    copies = facegear.load(gearbox.values, None), pickle.loads(pickle.dumps(gearbox))
    for copy in copies:
        assert copy.config.transmission.excitations == gearbox.config.transmission.excitations
        assert machine_of(copy).excitations == machine_of(gearbox).excitations


def test_a_rexs_file_says_that_it_lost_the_excitations(tmp_path):
    path = make_shaken(23).export(tmp_path / "machine.rexs")
    assert "excitations" in path.read_text(encoding="utf-8").split("Lost")[1].split("-->")[0]


SHAKEN = [{"body": "right input", "order": 23, "torque_n_m": 20.0, "phase_deg": 40.0}]
COMBINED = {
    "load-dependent law": {"mesh_stiffness.mesh_law": "load_dependent"},
    "constant load": {"mesh_stiffness.mesh_law": "constant_load"},
    "push only": {"transmission.damping.open_flanks": "push_only"},
    "mesh deflection": {"transmission.damping.open_flanks": "mesh_deflection"},
    "pose": {"transmission.operating_pose": "static"},
    "tilt": {"transmission.face_gear.tilt": {"stiffness_n_m_per_rad": 1e8, "inertia_kg_m2": 0.3}},
}
"""Changes of a config that may stand beside a periodic torque."""


def assert_shaken_as_linear(calm, shaken, speed):
    """Compare what excitations add to the motion of the mesh that moves most with its linear response."""
    meshes = len(shaken.layout.meshes)
    linear = loaded_machine(shaken).excited_motion(shaken, shaken.excitations[0], speed)
    expected = np.abs(shaken.linear.rows[:meshes] @ linear).max()
    moved = []
    for model in (build_model(calm), build_model(shaken)):
        answer = simulate(model, speed)
        assert (answer.motion, answer.period) == (Motion.PERIODIC, 1)
        moved.append(model.displacements(answer) @ model.machine.linear.rows[:meshes].T)
    change = moved[1] - moved[0]
    found = np.abs(change - change.mean(axis=0)).max()
    assert found == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize("name", list(COMBINED))
def test_a_periodic_torque_shakes_each_kind_of_machine_as_its_linear_response(name):
    """Stiffness that varies with phase and load makes the motion differ a little."""
    calm = facegear.example().with_values(COMBINED[name])
    shaken = calm.with_values({"transmission.excitations": SHAKEN})
    assert_shaken_as_linear(machine_of(calm), machine_of(shaken), calm.values["dynamics"]["speed_rpm"])


def test_a_periodic_torque_shakes_gears_that_bend_as_their_linear_response():
    calm = gear_bodies.gearbox(gear_bodies.small_body(1), open_flanks=OpenFlanks.CONTACT_ONLY)
    shaken = replace(calm, excitations=(Excitation(2, 23.0, 23, 20.0, 0.7),))
    assert_shaken_as_linear(calm, shaken, SPEED)
