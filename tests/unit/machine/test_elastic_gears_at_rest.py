"""Face gears that bend, at rest: what every mesh transmits, and where flanks stand.

Sources of the numbers: whole orders of Fourier elements in a script of its own, which shares no module with
facegear.
"""

from dataclasses import replace

import gear_bodies
import numpy as np
import pytest
from force_tables import linear_table
from gear_bodies import ANGLE, gearbox, mesh_forces
from references import against, agrees

from facegear.machine.loaded_contacts import loaded_contacts
from facegear.machine.machine import FlankTables
from facegear.machine.static_gears import at_rest
from facegear.machine.statics import mean_equilibrium
from facegear.parts.gear_body import influence
from facegear.parts.reduced_body import ReducedBody
from facegear.pipeline.stages.gear_bodies import _left_out

pytestmark = pytest.mark.xdist_group("reference_body")  # solved once a process


@against(
    "second implementation",
    "statics with the influence of whole Fourier finite elements",
    capability="hunting modal",
    module="facegear.machine.elastic_gears",
)
def test_left_and_right_idler_differ_on_gears_that_bend_by_as_much_as_another_program_has_it():
    rigid, flexible = gearbox(), at_rest(gearbox(gear_bodies.reference_modes()))
    agrees("mesh force on rigid gears, N", mesh_forces(rigid), gear_bodies.RIGID, absolute=0.1)
    agrees("mesh force on gears that bend, N", mesh_forces(flexible), gear_bodies.FLEXIBLE, absolute=0.6)


def test_static_answers_do_not_depend_on_how_many_modes_are_kept_for_motion():
    """Two sets of modes besides none at all; what the whole machine of modes gives moves by 9 N."""
    whole, forces = gear_bodies.reference_modes(), []
    for max_frequency in (1e3, 4e3, 1e5):
        body = below(whole, max_frequency)
        forces.append(mesh_forces(at_rest(gearbox(body))))
    assert forces[0] == pytest.approx(forces[2], rel=1e-6)
    assert forces[1] == pytest.approx(forces[2], rel=1e-6)
    moving = [mesh_forces(gearbox(below(whole, max_frequency))) for max_frequency in (4e3, 1e5)]
    assert np.abs(moving[0] - moving[1]).max() > 5.0


def test_summary_says_how_far_what_motion_leaves_out_moves_forces_at_rest():
    machine = gearbox(gear_bodies.reference_modes())
    off = np.abs(mesh_forces(machine) - mesh_forces(at_rest(machine))).max()
    assert 1.0 < off < 10.0 and f"by up to {off:.3g} N of 23647 N" in _left_out(machine)


def below(body: ReducedBody, max_frequency) -> ReducedBody:
    """The body with its modes below a frequency, Hz."""
    kept = body.frequency < max_frequency
    return replace(
        body,
        order=body.order[kept],
        frequency=body.frequency[kept],
        coriolis=body.coriolis[np.ix_(kept, kept)],
        stiffening=body.stiffening[np.ix_(kept, kept)],
        mesh=body.mesh[:, kept],
        hub=body.hub[:, kept],
        hub_spin=body.hub_spin[kept],
        round=body.round[kept],
        slope=body.slope[kept],
    )


def test_law_that_depends_on_the_load_acts_behind_a_body_as_the_stiffness_that_it_is_the_same_as():
    """Forces are in proportion to the amount, at rest and with the modes of motion."""
    table = linear_table(4, 1e-3, 4.1e8)
    constant = gearbox(gear_bodies.reference_modes())
    lawful = replace(constant, tables=(FlankTables(table, table),) * 2)
    for standing in (lambda machine: machine, at_rest):
        expected = mean_equilibrium(standing(constant)).forces[0]
        assert mean_equilibrium(standing(lawful)).forces[0] == pytest.approx(expected, rel=1e-9)
    pressed = loaded_contacts(lawful)
    closed = pressed.flanks > 0.0
    assert pressed.stiffness[closed] == pytest.approx(np.tile(constant.mean_stiffness, 2)[closed], rel=1e-9)


def test_flanks_at_rest_stand_where_teeth_and_the_influence_of_all_flanks_let_them():
    """Held against the sum over the orders that stage gear_bodies writes, for both gears and both flanks."""
    machine = at_rest(gearbox(body := gear_bodies.reference_modes(), backlash=20e-6))
    layout, linear = machine.layout, machine.linear
    settled = mean_equilibrium(machine)
    forces, hubs = settled.flank_forces[0], settled.displacements[0, : layout.dof]
    flanks = [gear_bodies.flank_direction(ANGLE, back) for back in (False, True)]
    given = linear.rows[:, : layout.dof] @ hubs
    for gear, own in enumerate(layout.gears):
        numbers = np.flatnonzero([g == gear for _, g in layout.meshes] * 2)
        for f in numbers:
            for g in numbers:
                angles = [layout.angles[layout.meshes[k % 10][0]] for k in (f, g)]
                directions = [flanks[k // 10] for k in (f, g)]
                angle = own.sign * (angles[0] - angles[1])
                given[f] -= influence(body.static, angle, *directions) * forces[g]
    pressed = forces > 0.0
    assert pressed.sum() >= 10
    assert given[pressed] - forces[pressed] / 4.1e8 == pytest.approx(10e-6, abs=1e-12)
    assert (given[~pressed] <= 10e-6).all()


def test_machine_at_rest_needs_two_coordinates_for_each_mesh_of_a_gear_and_gives_the_same_answers():
    """The body has no more compliance than its modes."""
    body = gear_bodies.reference_modes()
    machine = gearbox(replace(body, static=body.modal))
    condensed = at_rest(machine)
    assert machine.linear.size > 100 and condensed.linear.size == 28 + 2 * 10
    whole, few = mesh_forces(machine), mesh_forces(condensed)
    assert few == pytest.approx(whole, abs=1e-9 * np.abs(whole).max())
    assert at_rest(gearbox()).linear.size == 28


def test_bodies_ten_thousand_times_stiffer_come_to_the_rigid_machine_in_proportion():
    rigid, away = mesh_forces(gearbox()), []
    body = gear_bodies.reference_modes()
    for stiffer in (1e4, 1e3):
        stiff = replace(body, frequency=body.frequency * np.sqrt(stiffer), static=body.static / stiffer)
        away.append(mesh_forces(at_rest(gearbox(stiff))) - rigid)
    assert np.abs(away[0]).max() < 1e-4 * np.abs(rigid).max()
    assert away[1] == pytest.approx(10.0 * away[0], rel=1e-2, abs=1e-2)
