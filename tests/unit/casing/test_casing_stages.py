"""Stages of the casing: balance of the feet, load sharing side by side, marked modes, sensors over speed."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from references import against, agrees

from facegear.harmonics import Harmonics
from facegear.machine.casing_coordinates import casing_motion
from facegear.machine.casing_response import ORDERS, mesh_excitations, sensor_accelerations
from facegear.machine.casing_tables import frequency_table
from facegear.machine.loaded_modes import machine_in_motion
from facegear.machine.machine import Damping, OpenFlanks
from facegear.machine.modes import ModeClass, modes_of, name_modes
from facegear.machine.shaft_orders import loaded_machine
from facegear.machine.statics import equilibria, mean_equilibrium
from facegear.motion.steady_state.simulate import build_model, simulate
from facegear.pipeline.stages.casing import casing_loads, casing_response
from facegear.report.chapter_tables import casing_tables
from facegear.report.figures.casing import casing_figures, sensor_figures
from facegear.report.warnings import grouped_warnings
from tests.helpers.public_casing import mount_public
from tests.helpers.seated_machines import STIFFNESS, make_small_layout, make_small_machine, place_on

MACHINE_ALONE = {"mesh_stiffness": {"source": "harmonics"}, "transmission": {}}
"""Parts of a config that warnings read."""


@pytest.fixture(scope="module")
def machine():
    error = Harmonics(np.array([0.0, 1e-6, 0.0]), np.array([0.0, 2e-6, -5e-7]))
    damping = Damping(500.0, 0.0, 1e-6, OpenFlanks.CONTACT_ONLY)
    return make_small_machine(casing=place_on(mount_public(30)), error=error, damping=damping)


@pytest.fixture(scope="module")
def loads(machine):
    return casing_loads(machine, 500.0, 6000.0).content


def test_feet_and_applied_loads_are_in_balance(loads):
    feet = loads["feet"].set_index("foot")
    np.testing.assert_allclose(feet.loc["applied"].astype(float), [0, 0, 0, -1000, 0, -3000], atol=1e-9)
    np.testing.assert_allclose(feet.loc["out of balance"].astype(float), 0.0, atol=1e-6)


def test_forces_on_a_pinion_reach_the_feet():
    layout = make_small_layout()
    forces = np.zeros((5, 3))
    forces[1] = 300.0, -200.0, 0.0
    forces[4] = 50.0, 20.0, 10.0
    machine = make_small_machine(layout, place_on(mount_public(0)), forces=forces)
    feet = casing_loads(machine, 500.0, 6000.0).content["feet"].set_index("foot")
    np.testing.assert_allclose(feet.loc["out of balance"].astype(float), 0.0, atol=1e-6)
    # x of the pinion at 90 degrees is -X, its y is Z; x of the gear is Y, its y is -X.
    total = [-300.0 - 20.0, 50.0, -200.0 + 10.0]
    np.testing.assert_allclose(feet.loc["all feet"].astype(float)[:3], total, atol=1e-6)


def test_bearings_on_the_ground_stand_in_the_balance():
    layout, mounted = make_small_layout(), mount_public(0)
    casing = place_on(mounted)
    partly = replace(casing, bearing_seats={k: v for k, v in casing.bearing_seats.items() if k != 2})
    feet = casing_loads(make_small_machine(layout, partly), 500.0, 6000.0).content["feet"].set_index("foot")
    assert np.abs(feet.loc["ground"].astype(float)).max() > 1000.0
    np.testing.assert_allclose(feet.loc["out of balance"].astype(float), 0.0, atol=1e-6)


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing_loads",
    module="facegear.pipeline.stages.casing",
)
def test_load_sharing_stands_side_by_side(loads):
    sharing = loads["sharing"].set_index("mesh")
    row = sharing.loc["p0/lower"]
    agrees("mesh force on the casing, N", row["force_n"], 10_639.410, absolute=6e-4)
    agrees("mesh force on fixed seats, N", row["force_on_fixed_seats_n"], 8695.780, absolute=6e-4)
    agrees("change of the mesh force, %", row["change_percent"], 22.3514, absolute=1e-3)


def test_modes_of_the_casing_are_marked(loads, machine):
    modes = loads["modes"]
    assert not modes["is_casing_mode"][:11].any()
    assert modes["is_casing_mode"][11]
    assert modes["casing_energy_fraction"].between(0.0, 1.0 + 1e-12).all()
    linear = machine.linear
    rows = linear.rows[: len(machine.layout.meshes)]
    names = name_modes(machine.layout, linear, modes_of(linear, STIFFNESS * rows.T @ rows))
    assert names[-1].mode_class is ModeClass.CASING
    assert "casing" in names[-1].symbols


def test_mesh_excitations_are_the_errors_and_the_varying_force(machine):
    errors, forces = mesh_excitations(machine)
    loaded = mean_equilibrium(machine).flank_forces[0] > 0.0
    np.testing.assert_allclose(np.abs(errors[0, loaded]), np.hypot(1e-6, 2e-6), rtol=1e-12)
    np.testing.assert_allclose(np.abs(errors[1, loaded]), 5e-7, rtol=1e-12)
    assert not errors[2:].any()
    assert not forces.any()
    stiffness = Harmonics(np.zeros(2), np.array([STIFFNESS, 2e7]))
    _, forces = mesh_excitations(replace(machine, stiffness=stiffness))
    expected = mean_equilibrium(machine).flank_forces[0] * 2e7 / STIFFNESS
    np.testing.assert_allclose(np.abs(forces[0]), expected, rtol=1e-9, atol=1e-9)


@against(
    "second implementation",
    "equilibria over a mesh cycle, transformed",
    capability="casing_response",
    module="facegear.machine.casing_response",
)
def test_slow_meshes_move_the_sensors_as_statics_do(machine):
    """An answer without dynamics: the equilibria over a mesh cycle, transformed."""
    speed = 1e-3
    model, excitations = loaded_machine(machine), mesh_excitations(machine)
    slow = sensor_accelerations(machine, model, excitations, speed)
    omega = 2.0 * np.pi * machine.layout.pinion_teeth * speed / 60.0
    cycles = np.arange(32) / 32
    casing = equilibria(machine, cycles).displacements[:, machine.lumped_model.size :]
    moved = casing @ machine.casing.mounted.sensors.T
    amplitudes = 2.0 / 32 * np.fft.rfft(moved, axis=0)[1:3]
    orders = np.array([1.0, 2.0])[:, None]
    expected = -((orders * omega) ** 2) * amplitudes
    largest = np.abs(expected).max()
    agrees(
        "acceleration of the sensors over the largest", slow[:2] / largest, expected / largest, relative=1e-6
    )


def test_slow_motions_of_the_casing_rest_where_all_of_them_do(machine):
    """Gears tilt with their seats under the flanks, which the casing answers without any mode, too."""
    in_motion = machine_in_motion(machine)
    expected = mean_equilibrium(machine)
    for limit in (0.0, in_motion.casing.frequency_limit):
        slow = replace(in_motion, casing=replace(in_motion.casing, frequency_limit=limit))
        found = mean_equilibrium(slow)
        np.testing.assert_allclose(found.flank_forces, expected.flank_forces, atol=1e-6)
        moved = casing_motion(slow.linear, found.displacements)
        np.testing.assert_allclose(moved, casing_motion(machine.linear, expected.displacements), atol=1e-13)


@pytest.mark.parametrize(("limit", "error"), [(0.85, 1e-2), (1.0, 1e-2), (1.5, 2.5e-3), (2.0, 1e-3)])
def test_slow_modes_of_the_casing_converge_to_all(machine, limit, error, monkeypatch):
    amplitudes, speed = [], 3000.0
    for factor in (limit, 1e6):
        monkeypatch.setattr("facegear.machine.loaded_modes.MOTION_LIMIT", factor)
        model = build_model(machine)
        motion = simulate(model, speed).coordinates @ model.reduction.basis.T
        amplitudes.append(np.ptp(motion @ model.machine.linear.rows.T, axis=0))
    np.testing.assert_allclose(amplitudes[0], amplitudes[1], rtol=error)


def test_motion_on_a_casing_without_mass_has_fewer_coordinates(machine):
    massless = make_small_machine(casing=place_on(mount_public(0, with_mass=False)), damping=machine.damping)
    in_motion = machine_in_motion(massless)
    # Gears have inertia about their diameters, which stands on their seats.
    assert in_motion.linear.size <= massless.layout.dof + 4
    assert np.linalg.eigvalsh(in_motion.linear.mass)[0] > 0.0
    assert simulate(build_model(massless), 3000.0).label == "period-1"
    forces = [mean_equilibrium(one).forces for one in (massless, in_motion)]
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-9)


def test_the_sensor_table_holds_excited_orders_alone(machine):
    table = casing_response(machine, 500.0, 6000.0).content["sensors"]
    assert set(table["order"]) == {1, 2}
    assert set(table["sensor"]) == {"x", "y", "z"}
    assert len(table) % (2 * 3) == 0
    assert (table["acceleration_m_per_s2"] > 0.0).all()
    assert ORDERS >= 2


def test_modes_and_vibration_above_half_of_the_highest_held_mode_get_a_warning(loads, machine):
    own = frequency_table(machine.casing.mounted)
    highest = own.loc[own["held"] == "feet and seats", "frequency_hz"].max()
    beyond = int((loads["modes"]["frequency_hz"] > 0.5 * highest).sum())
    # 6000 rpm are 2000 Hz of the mesh: orders above the second lie beyond 5436 Hz
    sensors = casing_response(machine, 5999.0, 6000.0).content["sensors"]
    high = sensors["order"] * 2000.0 > 0.5 * highest
    assert (sensors["is_valid"] == ~high).all() and 0 < beyond < len(loads["modes"])
    tables = {"casing_modes": own, "casing_machine_modes": loads["modes"], "casing_sensors": sensors}
    lines = dict(grouped_warnings(MACHINE_ALONE, tables, None))["Casing"]
    assert lines[0].startswith(f"{beyond} of {len(loads['modes'])} modes of the machine lie above half of")
    assert f"{highest:.0f} Hz" in lines[0] and lines[0].endswith("raise transmission.casing.modes.")
    assert [line.split(" of ")[0] for line in lines[1:]] == [str(count) for count in [high.sum()] if count]
    few = {**tables, "casing_machine_modes": loads["modes"].head(3), "casing_sensors": sensors[~high]}
    assert grouped_warnings(MACHINE_ALONE, few, None) == []


def test_the_summary_counts_modes_above_half_of_the_highest_held_mode(machine):
    limit = machine.casing.mounted.valid_up_to
    assert f"above {limit:.0f} Hz, half of the highest mode" in casing_loads(machine, 500.0, 6000.0).summary


def test_the_report_shows_sharing_seats_feet_modes_and_sensors(loads, machine):
    """They were files and figures alone."""
    sensors = casing_response(machine, 500.0, 3000.0).content["sensors"]
    tables = {
        "casing_load_sharing": loads["sharing"],
        "casing_seat_motions": loads["seats"],
        "casing_feet": loads["feet"],
        "casing_machine_modes": loads["modes"],
        "casing_sensors": sensors,
    }
    shown = casing_tables(tables)
    assert [len(table.frame) for table in shown[:4]] == [len(tables[name]) for name in list(tables)[:4]]
    largest = shown[-1].frame.set_index(["sensor", "order"])["acceleration_m_per_s2"]
    expected = sensors.groupby(["sensor", "order"])["acceleration_m_per_s2"].max()
    assert np.allclose(largest.sort_index(), expected.sort_index())
    assert casing_tables({}) == []


def test_figures_draw_what_the_tables_hold(loads, machine):
    figures = casing_figures(loads["sharing"], loads["campbell"], loads["crossings"])
    assert len(figures) == 2
    empty = pd.DataFrame(columns=["order", "frequency_hz", "speed_rpm"])
    assert len(casing_figures(loads["sharing"], loads["campbell"], empty)) == 2
    (figure,) = sensor_figures(casing_response(machine, 500.0, 6000.0).content["sensors"])
    assert len(figure.panels) == 3
