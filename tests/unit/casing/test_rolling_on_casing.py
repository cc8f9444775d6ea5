"""The small machine with its input on rolling bearings, on fixed seats and on the public casing."""

from dataclasses import replace

import numpy as np
import pytest
from references import against, agrees

from facegear.bearings.life import reference_life
from facegear.bearings.response import element_loads
from facegear.bearings.shaft import RollingShaft, Support, find_shaft_equilibrium
from facegear.harmonics import Harmonics
from facegear.machine.casing import Casing
from facegear.machine.casing_tables import foot_table
from facegear.machine.drive_line import DriveLine
from facegear.machine.layout import Body
from facegear.machine.loaded_modes import MOTION_LIMIT, loaded_modes
from facegear.machine.machine import Damping, OpenFlanks
from facegear.machine.mean_load import at_mean_load
from facegear.machine.rolling_seats import rolling_seat
from facegear.machine.shaft_tables import ring_strains, shaft_bearing_loads
from facegear.machine.statics import bearing_forces, equilibria, mean_equilibrium
from facegear.motion.bearing_forces import bearing_history, shaft_bearing_history
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.parts.shafts import Elasticity, Segment
from tests.helpers.public_casing import mount_public
from tests.helpers.rolling_bearings import P1, P3
from tests.helpers.seated_machines import make_small_layout, make_small_machine, place_on

SEGMENTS = (Segment(0.04, 0.05, 0.02), Segment(0.05, 0.06, 0.02), Segment(0.04, 0.05, 0.02))
SHAFT = RollingShaft(
    SEGMENTS,
    Elasticity(206e9, 0.3),
    (Support(0.01, P1, np.zeros(5)), Support(0.12, P3, np.zeros(5))),
    0.06,
)
FORCES = {
    "fixed": (10_424.510, 4612.010, 5812.501, 26_354.754),
    "casing": (11_687.282, 5158.265, 6529.017, 25_091.982),
}
BEARINGS = {
    "fixed": ((-7858.977, -3663.779, 0.0), (-6578.727, -3068.632, 0.0)),
    "casing": ((-6614.261, -3083.612, 0.0), (-5534.523, -2581.460, 0.0)),
}
MODES = {
    "fixed": (0, 621.301, 1266.245, 1452.879, 1452.879, 1520.109, 1556.023),
    "casing": (0, 566.256, 748.764, 790.878, 808.616, 845.897, 885.903),
}
LIVES = {"fixed": (61.8026, 3957.77), "casing": (102.872, 6769.38)}


def make_machine(seat, names=("p0", "p0"), factor=1.0, modes=0, shaft=SHAFT):
    layout = make_small_layout()
    state = find_shaft_equilibrium(shaft, np.array([-14e3, -7e3, 0.0, 0.0, 0.0]))
    body = Body(1.2, 6e-4, (3e8, 3e8, 1e8))
    layout = replace(layout, pinions=(replace(layout.pinions[0], body=body), *layout.pinions[1:]))
    line = DriveLine(layout, {0: rolling_seat(shaft, state, None)}, {})
    casing = None
    if seat == "casing":
        simple = place_on(mount_public(modes, factor), layout)
        along = layout.mesh_radius + np.array([each.position for each in shaft.supports]) - shaft.pinion
        seats = {**simple.bearing_seats, 0: names}
        casing = Casing(layout, simple.mounted, seats, {}, {0: along})
    return at_mean_load(make_small_machine(layout, casing, drive_line=line))


@pytest.fixture(scope="module")
def machines():
    return {seat: make_machine(seat) for seat in FORCES}


@against(
    "second implementation",
    "public machine on rolling bearings and casing: a program of its own",
    capability="casing_loads",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize("seat", list(FORCES))
def test_published_mesh_forces(machines, seat):
    forces = np.abs(mean_equilibrium(machines[seat]).forces[0])
    agrees(f"mesh forces on seats: {seat}, N", forces[:4], FORCES[seat], absolute=2e-3)


@against(
    "second implementation",
    "public machine on rolling bearings and casing: a program of its own",
    capability="bearing_life",
    module="facegear.bearings.life",
)
@pytest.mark.parametrize("seat", list(FORCES))
def test_published_loads_and_lives_of_the_bearings(machines, seat):
    shaft = mean_equilibrium(machines[seat]).shafts[0]
    agrees(
        f"loads of the bearings on seats: {seat}, N", shaft.forces[0, :, :3], BEARINGS[seat], absolute=2e-3
    )
    lives = [
        reference_life(bearing, element_loads(bearing, motion[None]))[0]
        for bearing, motion in zip((P1, P3), shaft.rings[0], strict=True)
    ]
    agrees(f"L10r on seats: {seat}, million turns", lives, LIVES[seat], relative=5e-6)


@against(
    "second implementation",
    "public machine on rolling bearings and casing: a program of its own",
    capability="casing_loads",
    module="facegear.machine.loaded_modes",
)
@pytest.mark.parametrize("seat", list(FORCES))
def test_published_tangent_modes(machines, seat):
    frequencies = loaded_modes(machines[seat]).frequencies[:7]
    agrees(f"modes on seats: {seat}, Hz", frequencies, MODES[seat], absolute=2e-3)


def test_the_base_carries_the_torques(machines):
    machine = machines["casing"]
    motion = mean_equilibrium(machine).displacements[0]
    on_base = machine.casing.mounted.foot_loads @ motion[-machine.casing.size :]
    np.testing.assert_allclose(on_base, [0, 0, 0, -1000, 0, -3000], atol=1e-5)


def test_tangents_stand_at_the_equilibrium_itself(machines):
    """At the mean load the linear model has the balance of the rolling bearings."""
    machine = machines["casing"]
    at = mean_equilibrium(machine)
    linear = machine.linear
    left_over = at.displacements[0] @ linear.stiffness + at.flank_forces[0] @ linear.rows - linear.loads
    np.testing.assert_allclose(left_over / linear.lengths, 0.0, atol=1e-4)


def test_a_stiff_casing_is_the_machine_on_fixed_seats():
    fixed = mean_equilibrium(make_machine("fixed")).forces
    stiff = mean_equilibrium(make_machine("casing", factor=1e6)).forces
    np.testing.assert_allclose(stiff, fixed, rtol=1e-5)


def test_one_bearing_on_the_casing_and_one_on_the_ground():
    machine = make_machine("casing", names=("p0", ""))
    assert equilibria(machine, np.linspace(0.0, 1.0, 3)).residual.max() < 1e-10
    feet = foot_table(machine, mean_equilibrium(machine)).set_index("foot")
    assert np.abs(feet.loc["ground"].astype(float)).max() > 1000.0
    np.testing.assert_allclose(feet.loc["out of balance"].astype(float), 0.0, atol=1e-5)


@pytest.mark.parametrize("names", [("p0", "p0"), ("p0", ""), ("p0", "p1")])
def test_a_motion_at_rest_on_the_casing_loads_both_bearings_as_statics_do(names):
    machine = make_machine("casing", names=names)
    model = build_model(replace(machine, damping=Damping(2000.0, 300.0, 2e-6, OpenFlanks.CONTACT_ONLY)))
    response = simulate(model, 2000.0)
    history = bearing_history(model, response)
    at_rest = mean_equilibrium(machine)
    of_bodies = bearing_forces(machine, at_rest)
    np.testing.assert_allclose(history - of_bodies, 0.0, atol=1e-6 * np.abs(of_bodies).max())
    on_bearings, expected = shaft_bearing_history(model, response, history), at_rest.shafts[0].forces
    np.testing.assert_allclose(on_bearings - expected, 0.0, atol=1e-6 * np.abs(expected).max())


def test_few_motions_of_the_casing_answer_as_all_do_below_rolling_bearings(monkeypatch):
    error = Harmonics(np.array([0.0, 1e-6, 0.0]), np.array([0.0, 2e-6, -5e-7]))
    damping = Damping(500.0, 0.0, 2e-6, OpenFlanks.CONTACT_ONLY)
    machine, amplitudes, sizes = (
        replace(make_machine("casing", modes=30), error=error, damping=damping),
        [],
        [],
    )
    is_loaded = mean_equilibrium(machine).flank_forces[0] > 0.0
    for limit in (MOTION_LIMIT, 1e6):
        monkeypatch.setattr("facegear.machine.loaded_modes.MOTION_LIMIT", limit)
        model = build_model(machine)
        motion = simulate(model, 3000.0).coordinates @ model.reduction.basis.T
        amplitudes.append(np.ptp(motion @ model.machine.linear.rows[is_loaded].T, axis=0))
        sizes.append(model.system.size)
    assert sizes[0] < 35 < 70 < sizes[1]
    np.testing.assert_allclose(amplitudes[0], amplitudes[1], atol=0.01 * amplitudes[1].max())


def test_motion_of_rolling_bearings_on_the_casing_settles(machines):
    model = build_model(
        replace(machines["casing"], damping=Damping(2000.0, 0.0, 2e-6, OpenFlanks.CONTACT_ONLY))
    )
    response = simulate(model, 2000.0)
    moved = response.coordinates @ model.reduction.basis.T @ model.machine.linear.rows.T
    at_rest = mean_equilibrium(machines["casing"])
    expected = at_rest.displacements @ machines["casing"].linear.rows.T
    np.testing.assert_allclose(moved.mean(axis=0), expected[0], atol=1e-7)


@pytest.mark.parametrize("names", [("p0", "p0", "p0"), ("p0", "", "p1")])
def test_seats_strain_a_shaft_on_three_rolling_bearings(names):
    """Loads by tangents, after a small change of the torque, are those of a new equilibrium."""
    third = Support(0.065, P3, np.zeros(5))
    shaft = replace(SHAFT, supports=(*SHAFT.supports, third))
    machine = make_machine("casing", names=names, shaft=shaft)
    changes = []
    for torques in (machine.torques, 1.001 * machine.torques):
        loaded = replace(machine, torques=torques)
        at_rest = mean_equilibrium(loaded)
        forces, strains = bearing_forces(loaded, at_rest), ring_strains(loaded, at_rest.displacements)
        tangent = shaft_bearing_loads(machine.drive_line, forces, strains=strains)
        changes.append((tangent[0], at_rest.shafts[0].forces[0]))
    (tangent, exact), (later_tangent, later_exact) = changes
    np.testing.assert_allclose(tangent, exact, atol=1e-6)
    largest = np.abs(later_exact - exact).max()
    np.testing.assert_allclose(later_tangent - tangent, later_exact - exact, atol=5e-3 * largest)
