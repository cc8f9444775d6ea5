"""Machines whose meshes have tables of forces: statics, and modes about the load that each mesh carries."""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import power_table
from lumped_machines import make_layout, make_machine
from references import against, agrees

from facegear.machine.flanks import flank_edges, flank_law
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.layout import Role, Side
from facegear.machine.linear_model import bearing_matrix, flank_jacobian, mass_diagonal
from facegear.machine.loaded_contacts import loaded_contacts
from facegear.machine.loaded_modes import contact_table, loaded_modes, vibrating_machine
from facegear.machine.machine import FlankTables
from facegear.machine.statics import equilibria, mean_equilibrium, static_equilibrium
from facegear.meshing.force_table import ForceTable
from facegear.quantities import PAST_LAW
from facegear.sharing.quantities import quasi_static_quantities

C, N = 2.4e11, 1.5
TABLE = power_table(200, 0.2, 1e-7, 4e-4, C, N)
PINIONS = (("engine", Role.INPUT, 0.0), ("idler", Role.IDLER, 36.0), ("other", Role.INPUT, 70.0))


def made(pinions=PINIONS, sides=(Side.UPPER, Side.LOWER), torque=600.0, table=TABLE):
    layout = make_layout(pinions, sides, kinematics=GEOMETRIC)
    machine = make_machine(layout, torque, 0.0, error=0.0)
    return replace(machine, tables=len(sides) * (FlankTables(table, table),))


@against(
    "analytic",
    "inverse of the power law of the force",
    capability="load_sharing_reference",
    module="facegear.machine.statics",
)
@pytest.mark.parametrize("torque", [0.6, 60.0, 600.0, 3000.0])
def test_a_mesh_stands_where_its_table_has_the_force_at_every_phase(torque):
    machine = made(PINIONS[:1], (Side.UPPER,), torque)
    cycles = np.array([0.0, 0.21, 0.5, 0.9])
    found = equilibria(machine, cycles)
    force = torque / machine.layout.pinion_arm
    agrees("mesh force, N", found.forces[:, 0], force, relative=1e-10)
    amounts = (found.displacements @ flank_jacobian(machine.layout).T)[:, 0] - machine.half_backlash[0]
    factor = 1.0 + 0.2 * np.cos(2.0 * np.pi * cycles)
    agrees("deflection, m", amounts, (force / (factor * C)) ** (1.0 / N), relative=1e-6)


def test_a_negative_torque_presses_the_back_flank_by_its_own_table():
    softer = power_table(200, 0.2, 1e-7, 4e-4, 0.5 * C, N)
    machine = made(PINIONS[:1], (Side.UPPER,), -600.0)
    machine = replace(machine, tables=(FlankTables(TABLE, softer),))
    found = static_equilibrium(machine)
    amount = (flank_jacobian(machine.layout) @ found.displacements)[1] - machine.half_backlash[0]
    force = 600.0 / machine.layout.pinion_arm
    assert amount == pytest.approx((force / (0.5 * C)) ** (1.0 / N), rel=1e-6)


@against(
    "second implementation",
    "eigenvalues of a stiffness matrix of differences",
    capability="modal",
    module="facegear.machine.loaded_modes",
)
def test_frequencies_of_a_loaded_machine_are_those_of_differences_of_its_forces():
    """Each mesh has its own load; the stiffness matrix is taken from forces at displacements to either side
    of the equilibrium.
    """
    machine = made()
    layout = machine.layout
    place = mean_equilibrium(machine).displacements[0]
    directions, gaps = flank_jacobian(layout), flank_edges(machine)
    law = flank_law(machine).mean()

    def restoring(displacements):
        over = np.maximum(directions @ displacements - gaps, 0.0)
        return bearing_matrix(layout) @ displacements + directions.T @ law.force(np.zeros(1), over[None])[0]

    step = 1e-9
    columns = [
        (restoring(place + step * unit) - restoring(place - step * unit)) / (2.0 * step)
        for unit in np.eye(layout.dof)
    ]
    root = np.sqrt(mass_diagonal(layout))
    matrix = np.array(columns) / np.outer(root, root)
    exact = np.sqrt(np.maximum(np.linalg.eigvalsh(0.5 * (matrix + matrix.T)), 0.0)) / (2.0 * np.pi)
    found = loaded_modes(machine).frequencies
    elastic = found > 1.0
    agrees("natural frequency, Hz", np.sort(found)[-elastic.sum() :], exact[-elastic.sum() :], relative=1e-6)
    stiffness = loaded_contacts(machine).stiffness[: len(layout.meshes)]
    assert stiffness.max() > 1.2 * stiffness.min()


def test_a_pair_alone_swings_with_the_local_stiffness_of_its_load():
    """sqrt(n F / (x m)): with n = 1.5 22 % above what force over deflection gives."""
    machine = made(PINIONS[:1], (Side.UPPER,))
    force = 600.0 / machine.layout.pinion_arm
    local = loaded_contacts(machine).stiffness[0]
    assert local == pytest.approx(N * force / (force / C) ** (1.0 / N), rel=1e-5)


def test_factors_of_single_meshes_scale_the_whole_law():
    machine = made()
    errors = replace(machine.imperfections, stiffness=np.array([1.0, 0.7, 1.0, 1.0, 1.2, 1.0]))
    forces = [
        flank_law(one).force(np.array([0.3]), np.full((1, 12), 2e-5))[0]
        for one in (machine, replace(machine, imperfections=errors))
    ]
    np.testing.assert_allclose(forces[1], forces[0] * np.tile(errors.stiffness, 2), rtol=1e-12)


def test_a_table_of_one_torque_gives_the_deflection_and_the_slope_of_that_torque_back():
    """Hermite cubic from the first touch to its only level, straight beyond."""
    force = 600.0 / made(PINIONS[:1], (Side.UPPER,)).layout.pinion_arm
    mean, amount = np.array([[0.0], [1.0]]), 30e-6
    levels = np.array([0.0, amount])
    forces, slopes = np.array([0.0, force]), np.array([0.0, 1.3 * force / amount])
    table = ForceTable(levels, np.multiply.outer(forces, mean), np.multiply.outer(slopes, mean))
    machine = made(PINIONS[:1], (Side.UPPER,), table=table)
    found = static_equilibrium(machine)
    pressed = (flank_jacobian(machine.layout) @ found.displacements)[0] - machine.half_backlash[0]
    assert pressed == pytest.approx(amount, rel=1e-9)
    assert loaded_contacts(machine).stiffness[0] == pytest.approx(1.3 * force / amount, rel=1e-6)


def test_a_machine_of_a_series_says_for_how_much_of_the_time_it_is_past_its_table():
    last = power_table(200, 0.0, 1e-7, 3e-5, C, N)
    past = [
        quasi_static_quantities(made(PINIONS, torque=torque, table=last), 4)[0][PAST_LAW]
        for torque in (600.0, 6000.0)
    ]
    assert past == [0.0, 1.0]


def test_a_torque_beyond_the_table_is_reported_and_goes_on_straight():
    last = power_table(200, 0.0, 1e-7, 3e-5, C, N)
    below, beyond = (made(PINIONS[:1], (Side.UPPER,), torque, last) for torque in (600.0, 6000.0))
    assert not loaded_contacts(below).past_law.any()
    contacts = loaded_contacts(beyond)
    assert contacts.past_law.tolist() == [True, False]
    assert contacts.stiffness[0] == pytest.approx(N * C * 3e-5 ** (N - 1.0), rel=1e-9)
    found = vibrating_machine(beyond)
    assert contact_table(beyond, found, "local").iloc[0]["definition"] == "local, past the law's last level"
