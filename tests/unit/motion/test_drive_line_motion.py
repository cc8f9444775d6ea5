"""The motion of a machine with shafts that bend and masses behind torsional springs, against closed forms."""

import numpy as np
import pytest
from drive_lines import driven, on_bearings
from lumped_machines import make_layout
from references import against, agrees
from scipy.interpolate import CubicSpline

from facegear.harmonics import Harmonics, stacked_values
from facegear.machine.drive_line import TurningMass
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.machine import OpenFlanks
from facegear.motion.bearing_forces import bearing_history, bearing_table, shaft_bearing_history
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import Motion, Settings
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.motion.track import track
from facegear.rigid_body import carry_motion

PLACES = (("one", Role.INPUT, 0.0), ("two", Role.INPUT, 40.25))
SPEED, K, ERROR = 6100.0, 4.1e8, 2e-6
TURNING, MESHING = SPEED * np.pi / 30.0, 23 * SPEED * np.pi / 30.0
CHAINS = {
    0: (TurningMass("shaft", 6e5, 0.002, 0.02), TurningMass("engine", 2.5e4, 0.08, 0.01)),
    2: (TurningMass("rotor", 5e6, 3.0, 0.005),),
}


@pytest.fixture(scope="module")
def running():
    """Machine, model and its steady response to the first harmonic of an error."""
    machine = driven(
        on_bearings(1.5e8, 2.5e8),
        masses=CHAINS,
        layout=make_layout(PLACES, (Side.UPPER,), kinematics=GEOMETRIC),
        stiffness=Harmonics(np.zeros(1), np.array([K])),
        error=ERROR,
        open_flanks=OpenFlanks.CONTACT_ONLY,
    )
    model = build_model(machine)
    settings = Settings(tolerance=1e-11, periodic_residual=1e-12, samples=256)
    return machine, model, simulate(model, SPEED, settings)


def full(machine):
    """Damping and stiffness (n, n) with both drive flanks always closed."""
    linear, rows = machine.linear, machine.linear.rows[:2]
    closed = rows.T @ rows
    damping = linear.damping + TURNING * linear.spin.gyroscopic + machine.damping.mesh * closed
    return damping, linear.stiffness + K * closed


def harmonic(machine):
    """Complex displacements (n,) of the first harmonic in full matrices."""
    rows, c = machine.linear.rows[:2], machine.damping.mesh
    damping, spring = full(machine)
    dynamic = -(MESHING**2) * machine.linear.mass + 1j * MESHING * damping + spring
    error = ERROR * np.exp(-2j * np.pi * machine.phases)
    return np.linalg.solve(dynamic, rows.T @ ((K + 1j * MESHING * c) * error))


@against(
    "analytic",
    "linear response in full matrices",
    capability="dynamics_response",
    module="facegear.machine.drive_line",
)
def test_transmission_error_shakes_tilting_pinions_and_engines_as_the_closed_form_says(running):
    machine, model, response = running
    assert (response.motion, response.period) == (Motion.PERIODIC, 1)
    moving = response.coordinates @ model.reduction.basis.T
    moving -= moving.mean(axis=0)
    exact = np.real(harmonic(machine) * np.exp(2j * np.pi * response.phases[:, None]))
    line, size = machine.drive_line, np.abs(exact).max()
    for pinion in line.tilting:
        own = line.motions(pinion)
        agrees("motion of a pinion, m and rad", moving[:, own], exact[:, own], absolute=1e-8 * size)
    for spring in line.springs():
        ends = [spring.first, spring.second]
        twist, expected = np.diff(moving[:, ends]), np.diff(exact[:, ends])
        agrees("twist of a torsional spring, rad", twist, expected, absolute=1e-8 * np.abs(expected).max())


@against(
    "analytic",
    "eigenvalues of the full matrices",
    capability="dynamics_response",
    module="facegear.machine.drive_line",
)
def test_multipliers_with_tilts_and_torsional_springs_are_those_of_the_full_matrices(running):
    machine, _, response = running
    damping, spring = full(machine)
    inverse, n = np.linalg.inv(machine.linear.mass), machine.linear.size
    system = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ spring, -inverse @ damping]])
    exact = np.exp(np.linalg.eigvals(system) * 2.0 * np.pi / MESHING)
    nearest = exact[np.abs(response.multipliers[:, None] - exact).argmin(axis=1)]
    agrees("multipliers", response.multipliers, nearest, absolute=1e-9)


def test_bearings_of_a_shaft_carry_what_springs_and_dampers_of_its_pinion_do(running):
    machine, model, response = running
    forces = bearing_history(model, response)
    loads = shaft_bearing_history(model, response, forces)
    line, linear = machine.drive_line, machine.linear
    complex_force = (1.0 + 1j * MESHING * linear.bearing_damping) * (linear.stiffness @ harmonic(machine))
    exact = np.real(complex_force * np.exp(2j * np.pi * response.phases[:, None]))
    loads = loads - loads.mean(axis=0)
    for pinion in line.tilting:
        own = exact[:, line.motions(pinion)]
        at_pinion = sum(
            loads[:, 2 * pinion + number] @ carry_motion(position - 0.05)
            for number, position in enumerate((0.0, 0.12))
        )
        np.testing.assert_allclose(at_pinion, own, atol=1e-6 * np.abs(exact).max())


def test_the_table_of_bearing_forces_names_each_bearing_of_a_shaft(running):
    _, model, response = running
    table = bearing_table(model, response)
    assert table["body"].drop_duplicates().to_list() == [
        *("one", "two", "upper face gear"),
        *("one bearing A", "one bearing B", "two bearing A", "two bearing B"),
    ]
    across = table[table["direction"] == "y"].set_index("body")
    for column in ("static_n", "mean_n"):
        both = across.loc["one bearing A", column] + across.loc["one bearing B", column]
        assert both == pytest.approx(across.loc["one", column], rel=1e-9)


@against(
    "analytic",
    "balance of power",
    capability="dynamics_response",
    module="facegear.machine.drive_line",
)
def test_shafts_springs_masses_and_meshes_take_no_more_power_than_is_brought_in():
    machine = driven(
        on_bearings(1.5e8, 2.5e8),
        masses=CHAINS,
        layout=make_layout(PLACES, (Side.UPPER,), kinematics=GEOMETRIC),
        stiffness=Harmonics(np.zeros(1), np.array([K])),
        error=8e-6,
        torque=1500.0,
        open_flanks=OpenFlanks.CONTACT_ONLY,
    )
    model = build_model(machine)
    found = simulate(model, 2500.0, Settings(tolerance=1e-10, samples=1024))
    assert found.motion is Motion.PERIODIC and found.periods == 1
    system, each = model.system, np.eye(model.system.size)
    rate = track(found).along(0.0 * each, each).T
    error = stacked_values(system.error, found.phases)[:, system.error_kind]
    closed = found.coordinates @ system.mesh_jacobian.T - error - system.upper
    touches = (closed > 0.0).all(axis=0)
    assert ((closed < 0.0).all(axis=0) | touches).all()
    time = np.append(found.phases, 1.0) * TAU / found.frequency
    error_rate = CubicSpline(time, np.vstack([error, error[:1]]), bc_type="periodic")(time[:-1], 1)
    flank_rate = rate @ system.mesh_jacobian.T
    force = (K * closed + machine.damping.mesh * (flank_rate - error_rate)) * touches
    by_meshes = (force * flank_rate).sum(axis=1).mean()
    moving = rate @ model.reduction.basis.T
    by_rest = np.einsum("ki,ij,kj->k", moving, machine.linear.damping, moving).mean()
    in_springs = sum(
        spring.damping * (np.diff(moving[:, [spring.first, spring.second]]) ** 2).mean()
        for spring in machine.drive_line.springs()
    )
    assert in_springs > 1e-6 * abs(by_meshes)
    size = abs(by_meshes)
    agrees("power of meshes, shafts and springs, W", by_meshes + by_rest, 0.0, absolute=1e-5 * size)
