"""The public casing of the reference page: its numbers, printed with their digits, and what must follow."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from facegear.casing.reduction import reduce_casing
from facegear.casing.whole import require_free, require_mass
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.statics import mean_equilibrium
from tests.helpers.public_casing import make_interfaces, mount_public, read_public_casing
from tests.helpers.seated_machines import STIFFNESS, make_small_layout, make_small_machine, place_on

FORCES = (10_639.410, 4439.803, 6199.608, 26_139.854, 4439.803, 6199.608)
MODES = {
    30: (0, 747.9217, 790.7245, 808.2577, 845.3924, 885.0385, 1035.2859, 1256.1222)
    + (1324.3329, 1339.5229, 1384.9366, 1706.0249, 1757.1428),
    0: (0, 748.0124, 790.8616, 808.4073, 845.5324, 885.1971, 1035.7028, 1257.5369)
    + (1325.4661, 1340.0509, 1385.0045, 1723.3726, 1769.6424),
}
ACCELERATIONS = {
    (30, 1000): (1.544245, 10.342352, 3.852386),
    (0, 1000): (1.471571, 10.015326, 3.687399),
    (30, 1600): (4.266346, 19.067027, 5.096109),
    (0, 1600): (3.413955, 17.222895, 3.932260),
}


@pytest.fixture(scope="module")
def seated():
    return {modes: make_small_machine(casing=place_on(mount_public(modes))) for modes in (30, 0)}


def test_the_file_is_a_free_casing_of_the_printed_mass():
    casing = read_public_casing()
    require_free(casing)
    require_mass(casing, None)
    assert casing.total_mass == pytest.approx(16.2864, rel=2e-6)
    assert casing.rigid_force() < 1e-12


def test_guyan_stiffness_and_mass_of_the_seats():
    casing = read_public_casing()
    seats, base = make_interfaces(casing)
    guyan = reduce_casing(casing, [*seats, base], 0)
    stiffness = np.diagonal(guyan.stiffness)
    of_seat = (1.031075e9, 2.345465e9, 1.796709e9, 1.407386e7, 3.791393e6, 2.664190e6)
    np.testing.assert_allclose(stiffness[:6], of_seat, rtol=4e-7)
    of_gear = (1.865385e9, 1.600037e9, 3.648251e8, 1.874373e6, 1.694110e6, 1.459062e7)
    np.testing.assert_allclose(stiffness[24:30], of_gear, rtol=4e-7)
    mass = (0.9563484, 2.156295, 1.676904, 2.939117e-3, 9.930635e-4, 1.238979e-3)
    np.testing.assert_allclose(np.diagonal(guyan.mass)[:6], mass, rtol=4e-7)


@pytest.mark.parametrize(
    ("modes", "printed"),
    [(0, (2507.7, 3293.5, 3780.9, 4065.8)), (30, (2419.7, 3230.3, 3516.7, 3753.2))],
)
def test_modes_of_the_free_casing(modes, printed):
    casing = read_public_casing()
    seats, base = make_interfaces(casing)
    reduced = reduce_casing(casing, [*seats, base], modes)
    squared = scipy.linalg.eigvalsh(reduced.stiffness, reduced.mass)
    np.testing.assert_allclose(np.sqrt(squared[6:10]) / (2.0 * np.pi), printed, atol=0.06)


def test_modes_with_seats_and_base_held():
    frequencies = mount_public(30).frequencies[:6]
    printed = (3700.0624, 4396.8355, 4932.3602, 5257.1523, 6923.8316, 7178.7664)
    np.testing.assert_allclose(frequencies, printed, rtol=1e-8)


def test_mesh_forces_on_fixed_seats():
    forces = np.abs(mean_equilibrium(make_small_machine()).forces[0])
    printed = (8695.780, 3617.369, 5078.411, 28_083.484, 3617.369, 5078.411)
    np.testing.assert_allclose(forces, printed, atol=6e-4)


def test_mesh_forces_on_the_casing(seated):
    np.testing.assert_allclose(np.abs(mean_equilibrium(seated[30]).forces[0]), FORCES, atol=6e-4)


def test_statics_do_not_depend_on_modes(seated):
    with_modes, guyan = (mean_equilibrium(seated[modes]).displacements[0] for modes in (30, 0))
    size = guyan.size
    np.testing.assert_allclose(with_modes[:size], guyan, rtol=1e-11, atol=1e-16)
    assert not with_modes[size:].any()


def test_motion_of_the_upper_gears_seat(seated):
    machine = seated[30]
    moved = mean_equilibrium(machine).displacements[0, machine.lumped_model.size :][24:30]
    printed = (-2.87293, 23.20273, 49.34759, 634.88362, -340.07469, -25.06502)
    np.testing.assert_allclose(1e6 * moved, printed, atol=6e-6)


def test_the_base_carries_exactly_the_applied_torques(seated):
    # The input's torque acts against its axis, which is X; the output's load against Z.
    machine = seated[30]
    casing = mean_equilibrium(machine).displacements[0, machine.lumped_model.size :]
    on_base = machine.casing.mounted.foot_loads @ casing
    np.testing.assert_allclose(on_base, [0, 0, 0, -1000, 0, -3000], atol=1e-6)


@pytest.mark.parametrize("modes", [30, 0])
def test_modes_of_the_machine_on_the_casing(seated, modes):
    frequencies = loaded_modes(seated[modes]).frequencies[:13]
    np.testing.assert_allclose(frequencies, MODES[modes], atol=6e-5)


@pytest.mark.parametrize(("modes", "frequency"), list(ACCELERATIONS))
def test_acceleration_at_the_corner(seated, modes, frequency):
    machine = seated[modes]
    linear, omega = machine.linear, 2.0 * np.pi * frequency
    carrying = mean_equilibrium(machine).flank_forces[0] > 0.0
    rows = linear.rows[carrying]
    stiffness = (1.0 + 0.02j) * (linear.stiffness + STIFFNESS * rows.T @ rows)
    force = STIFFNESS * 1e-6 * linear.rows[0]
    motion = np.linalg.solve(stiffness - omega**2 * linear.mass, force)
    moved = machine.casing.mounted.sensors @ motion[machine.lumped_model.size :]
    printed = ACCELERATIONS[modes, frequency]
    np.testing.assert_allclose(omega**2 * np.abs(moved), printed, rtol=5e-6)


@pytest.mark.parametrize(("factor", "moved"), [(1e2, 1.2e-3), (1e4, 1.2e-5), (1e6, 1.2e-7)])
def test_a_stiff_casing_moves_forces_in_proportion(factor, moved):
    fixed = mean_equilibrium(make_small_machine()).forces
    on_stiff = mean_equilibrium(make_small_machine(casing=place_on(mount_public(0, factor)))).forces
    assert np.abs(on_stiff - fixed).max() / np.abs(fixed).max() == pytest.approx(moved, rel=0.02)


def test_compiled_and_dense_statics_agree(seated, monkeypatch):
    compiled = mean_equilibrium(seated[30])
    monkeypatch.setattr("facegear.machine.statics.static_blocks", lambda machine: None)
    dense = mean_equilibrium(seated[30])
    np.testing.assert_allclose(dense.forces, compiled.forces, rtol=1e-9)
    np.testing.assert_allclose(dense.displacements, compiled.displacements, atol=1e-13)


def test_a_casing_turned_with_its_machine_changes_nothing(seated):
    layout = make_small_layout(turned=7.3)
    mounted = mount_public(30, turned=layout.angles[0])
    turned = make_small_machine(layout, place_on(mounted, layout))
    first, second = (mean_equilibrium(machine) for machine in (seated[30], turned))
    np.testing.assert_allclose(second.forces, first.forces, rtol=1e-11)
    np.testing.assert_allclose(
        loaded_modes(turned).frequencies[1:], loaded_modes(seated[30]).frequencies[1:], rtol=1e-9
    )


def test_a_machine_without_casing_is_the_one_of_before():
    machine = make_small_machine()
    assert machine.linear.size == machine.lumped_model.size
    assert replace(machine, casing=None).linear.labels == machine.layout.dof_names
