"""The public casing of the reference page: its numbers, printed with their digits, and what must follow."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from references import against, agrees

from facegear.casing.reduction import reduce_casing
from facegear.casing.whole import require_free, require_mass
from facegear.machine.casing_response import ORDERS, sensor_accelerations
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.machine import Damping, OpenFlanks
from facegear.machine.shaft_orders import loaded_machine
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


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing",
    module="facegear.casing.whole",
)
def test_the_file_is_a_free_casing_of_the_printed_mass():
    casing = read_public_casing()
    require_free(casing)
    require_mass(casing, None)
    agrees("mass of the casing, kg", float(casing.total_mass), 16.2864, relative=2e-6)
    assert casing.rigid_force() < 1e-12


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing",
    module="facegear.casing.reduction",
)
def test_guyan_stiffness_and_mass_of_the_seats():
    casing = read_public_casing()
    seats, base = make_interfaces(casing)
    guyan = reduce_casing(casing, [*seats, base], 0)
    stiffness = np.diagonal(guyan.stiffness)
    of_seat = (1.031075e9, 2.345465e9, 1.796709e9, 1.407386e7, 3.791393e6, 2.664190e6)
    agrees("stiffness of the input's seat, N/m, N m/rad", stiffness[:6], of_seat, relative=4e-7)
    of_gear = (1.865385e9, 1.600037e9, 3.648251e8, 1.874373e6, 1.694110e6, 1.459062e7)
    agrees("stiffness of the upper gear's seat, N/m, N m/rad", stiffness[24:30], of_gear, relative=4e-7)
    mass = (0.9563484, 2.156295, 1.676904, 2.939117e-3, 9.930635e-4, 1.238979e-3)
    agrees("mass at the input's seat, kg, kg m2", np.diagonal(guyan.mass)[:6], mass, relative=4e-7)


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing",
    module="facegear.casing.reduction",
)
@pytest.mark.parametrize(
    ("modes", "printed"),
    [(0, (2507.7, 3293.5, 3780.9, 4065.8)), (30, (2419.7, 3230.3, 3516.7, 3753.2))],
)
def test_modes_of_the_free_casing(modes, printed):
    casing = read_public_casing()
    seats, base = make_interfaces(casing)
    reduced = reduce_casing(casing, [*seats, base], modes)
    squared = scipy.linalg.eigvalsh(reduced.stiffness, reduced.mass)
    agrees("modes of the free casing, Hz", np.sqrt(squared[6:10]) / (2.0 * np.pi), printed, absolute=0.06)


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing",
    module="facegear.casing.reduction",
)
def test_modes_with_seats_and_base_held():
    frequencies = mount_public(30).frequencies[:6]
    printed = (3700.0624, 4396.8355, 4932.3602, 5257.1523, 6923.8316, 7178.7664)
    agrees("modes with seats and base held, Hz", frequencies, printed, relative=1e-8)


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing_loads",
    module="facegear.machine.statics",
)
def test_mesh_forces_on_fixed_seats():
    forces = np.abs(mean_equilibrium(make_small_machine()).forces[0])
    printed = (8695.780, 3617.369, 5078.411, 28_083.484, 3617.369, 5078.411)
    agrees("mesh forces on fixed seats, N", forces, printed, absolute=6e-4)


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing_loads",
    module="facegear.machine.casing",
)
def test_mesh_forces_on_the_casing(seated):
    forces = np.abs(mean_equilibrium(seated[30]).forces[0])
    agrees("mesh forces on the casing, N", forces, FORCES, absolute=6e-4)


def test_statics_do_not_depend_on_modes(seated):
    with_modes, guyan = (mean_equilibrium(seated[modes]).displacements[0] for modes in (30, 0))
    size = guyan.size
    np.testing.assert_allclose(with_modes[:size], guyan, rtol=1e-11, atol=1e-16)
    assert not with_modes[size:].any()


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing_loads",
    module="facegear.machine.casing",
)
def test_motion_of_the_upper_gears_seat(seated):
    machine = seated[30]
    moved = mean_equilibrium(machine).displacements[0, machine.lumped_model.size :][24:30]
    printed = (-2.87293, 23.20273, 49.34759, 634.88362, -340.07469, -25.06502)
    agrees("motion of the upper gear's seat, um, urad", 1e6 * moved, printed, absolute=6e-6)


@against(
    "analytic",
    "balance of torques",
    capability="casing_loads",
    module="facegear.machine.casing",
)
def test_the_base_carries_exactly_the_applied_torques(seated):
    # The input's torque acts against its axis, which is X; the output's load against Z.
    machine = seated[30]
    casing = mean_equilibrium(machine).displacements[0, machine.lumped_model.size :]
    on_base = machine.casing.mounted.foot_loads @ casing
    agrees("forces and moments on the base, N, N m", on_base, [0, 0, 0, -1000, 0, -3000], absolute=1e-6)


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing_loads",
    module="facegear.machine.loaded_modes",
)
@pytest.mark.parametrize("modes", [30, 0])
def test_modes_of_the_machine_on_the_casing(seated, modes):
    frequencies = loaded_modes(seated[modes]).frequencies[:13]
    agrees("modes of the machine on the casing, Hz", frequencies, MODES[modes], absolute=6e-5)


@against(
    "second implementation",
    "public casing: a program of its own for 20-node bricks",
    capability="casing_response",
    module="facegear.machine.casing_response",
)
@pytest.mark.parametrize(("modes", "frequency"), list(ACCELERATIONS))
def test_acceleration_at_the_corner(seated, modes, frequency):
    """The printed loss factor of 0.02 is, at one frequency, viscous damping of 0.02 over it."""
    loss = 0.02 / (2.0 * np.pi * frequency)
    mounted = seated[modes].casing.mounted
    casing = replace(seated[modes].casing, mounted=replace(mounted, damping=loss * mounted.stiffness))
    damping = Damping(loss * STIFFNESS, 0.0, loss, OpenFlanks.CONTACT_ONLY)
    machine = replace(seated[modes], casing=casing, damping=damping)
    errors, forces = np.zeros((2, ORDERS, 2 * len(machine.layout.meshes)), complex)
    forces[0, 0] = STIFFNESS * 1e-6
    speed = 60.0 * frequency / machine.layout.pinion_teeth
    computed = sensor_accelerations(machine, loaded_machine(machine), (errors, forces), speed)[0]
    agrees(
        f"acceleration at the corner, {frequency} Hz, {modes} modes, m/s2",
        np.abs(computed),
        ACCELERATIONS[modes, frequency],
        relative=5e-6,
    )


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
