"""Every static result against the balance of all forces and moments, with bearings that couple x and y."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import drive_rows, make_layout, make_machine
from references import against, agrees

from facegear.errors import NotConverged
from facegear.harmonics import Harmonics
from facegear.machine.flanks import flank_edges
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC, KINEMATICS, PRINTED_KINEMATICS
from facegear.machine.layout import Layout, Role, Side
from facegear.machine.linear_model import bearing_matrix, flank_jacobian
from facegear.machine.statics import (
    balance,
    bearing_loads,
    mean_equilibrium,
    static_bearing_forces,
    static_equilibrium,
)

K = 4.1e8
FLAT = Harmonics(np.zeros(1), np.array([K]))
COUPLING = st.floats(-0.9, 0.9)


@st.composite
def coupled_machines(draw, kinematics, **options):
    """The paper's layout with bearings of every body that differ along x and y and couple them."""
    layout = make_layout(kinematics=kinematics)

    def coupled(body, stiffness):
        x, y = (stiffness * draw(st.floats(0.3, 3.0)) for _ in range(2))
        across = draw(COUPLING) * np.sqrt(x * y)
        return replace(body, bearing=(x, y, stiffness), bearing_xy=across)

    layout = replace(
        layout,
        pinions=tuple(replace(one, body=coupled(one.body, 6.5e7)) for one in layout.pinions),
        gears=tuple(replace(one, body=coupled(one.body, 8.7e8)) for one in layout.gears),
    )
    tail = draw(st.floats(0.0, 0.3))
    given_ = {"stiffness": FLAT, "error": 0.0, **options}
    return make_machine(layout, draw(st.floats(100.0, 2000.0)), tail, **given_)


def external_forces(layout: Layout, on_bearings, torques):
    """Sum (3,) of what bearings take, in the gears' frame, and its moment about their axis less the torques'.

    on_bearings (bodies, 3), N. A pinion's x is tangential, its y along the gears' axis.
    """
    pinions = len(layout.pinions)
    along = np.stack([np.cos(layout.angles), np.sin(layout.angles)], axis=1)
    tangential, axial = on_bearings[:pinions, 0], on_bearings[:pinions, 1]
    sideways = tangential @ along + on_bearings[pinions:, :2].sum(axis=0)
    moment = tangential.sum() * layout.mesh_radius
    turning = sum(gear.sign * torque for gear, torque in zip(layout.gears, torques[pinions:], strict=True))
    return np.append(sideways, axial.sum() + on_bearings[pinions:, 2].sum()), moment - turning


@against(
    "analytic",
    "balance of forces and moments of the gearbox",
    capability="hunting",
    module="facegear.machine.statics",
)
@settings(max_examples=10, deadline=None)
@given(coupled_machines(GEOMETRIC))
def test_what_the_bearings_of_a_gearbox_take_balances_its_torques_however_they_couple_x_and_y(machine):
    layout = machine.layout
    size = np.abs(machine.torques[:5]).max() / layout.pinion_arm
    forces, moment = external_forces(layout, static_bearing_forces(machine), machine.torques)
    agrees("sum of all forces, N", forces, 0.0, relative=1e-7, absolute=1e-9 * size)
    agrees("sum of all moments, N m", moment, 0.0, absolute=1e-9 * size * layout.mesh_radius)


@against(
    "analytic",
    "balance of forces and moments of the gearbox",
    capability="hunting",
    module="facegear.machine.statics",
)
@settings(max_examples=10, deadline=None)
@given(coupled_machines(GEOMETRIC), st.integers(0, 2**31))
def test_external_forces_on_any_bodies_end_in_the_bearings(machine, seed):
    layout = machine.layout
    forces = 2000.0 * np.random.default_rng(seed).normal(size=(7, 3))
    forces[:5, 2] = 0.0
    pushed = static_bearing_forces(replace(machine, forces=forces))
    taken, moment = external_forces(layout, pushed, machine.torques)
    brought, turning = external_forces(layout, forces, 0.0 * machine.torques)
    agrees("sum of the bearing forces, N", taken, brought, relative=1e-7, absolute=1e-6)
    agrees("moment of the bearing forces, N m", moment, turning, absolute=1e-6)
    assert np.abs(pushed - static_bearing_forces(machine)).max() > 100.0


@against(
    "analytic",
    "springs of both flanks and of the bearing in closed form",
    capability="hunting",
    module="facegear.machine.statics",
)
def test_a_pinion_set_too_deep_presses_both_flanks_as_the_closed_form_says():
    """Bearing k_b and both flanks along the gear's axis, held gear: k_b (d - u) = 2 k u sin^2 a."""
    layout = make_layout((("a", Role.INPUT, 0.0),), (Side.UPPER,), 6.5e7, 1e19, GEOMETRIC)
    deep = 20e-6
    flaws = replace(perfect(layout), position=np.array([[0.0, deep]]))
    machine = make_machine(layout, 0.001, 0.0, 0.0, 0.0, FLAT, imperfections=flaws)
    given_way = deep * 6.5e7 / (6.5e7 + 2.0 * K * np.sin(layout.pressure_angle) ** 2)
    exact = K * given_way * np.sin(layout.pressure_angle)
    found = mean_equilibrium(machine)
    agrees("flank force, N", found.flank_forces[0], 2 * [exact], relative=1e-4)
    assert found.residual[0] < 1e-12


@against(
    "second implementation",
    "dense linear solution with NumPy",
    capability="load_sharing_reference",
    module="facegear.machine.statics",
)
@settings(max_examples=10, deadline=None)
@given(coupled_machines(PRINTED_KINEMATICS, backlash=0.0))
def test_printed_statics_with_coupled_bearings_are_the_linear_solution(machine):
    directions = drive_rows(machine.layout)
    applied = np.zeros(28)
    applied[3::4] = machine.torques
    stiffness = bearing_matrix(machine.layout) + K * directions.T @ directions
    linear = K * directions @ np.linalg.lstsq(stiffness, applied, rcond=1e-14)[0]
    found = static_equilibrium(machine).forces
    agrees("mesh force, N", found, linear, relative=1e-7, absolute=1e-8 * np.abs(linear).max())


def test_a_coupled_bearing_of_the_lower_gear_carries_in_statics_what_it_carries_in_motion():
    """The bearing pulled along x by a part of the idlers' forces gives way along y, too."""
    layout = make_layout(kinematics=GEOMETRIC)
    lower, upper = layout.gears
    body = replace(lower.body, bearing=(2e8, 2e8, 8.7e9), bearing_xy=1.6e8)
    machine = make_machine(replace(layout, gears=(replace(lower, body=body), upper)), tail_share=0.1)
    moved = mean_equilibrium(machine).displacements[0, 20:22]
    np.testing.assert_allclose(
        static_bearing_forces(machine)[5, :2], np.array([[2e8, 1.6e8], [1.6e8, 2e8]]) @ moved, rtol=1e-9
    )
    forces, _ = external_forces(machine.layout, static_bearing_forces(machine), machine.torques)
    np.testing.assert_allclose(forces, 0.0, atol=1e-6)


@pytest.mark.parametrize("kinematics", KINEMATICS.values(), ids=KINEMATICS)
def test_a_static_result_whose_forces_do_not_balance_is_refused(kinematics):
    machine = make_machine(make_layout(kinematics=kinematics), stiffness=FLAT, error=0.0)
    found = static_equilibrium(machine)
    if kinematics is GEOMETRIC:
        forces = mean_equilibrium(machine).flank_forces
        gaps = (flank_edges(machine))[None]
    else:
        forces, gaps = found.forces[None], machine.half_backlash[None]
    stiffness = np.full_like(gaps, K)
    right = balance(machine.linear, found.displacements[None], forces, stiffness, gaps)
    right.require(1e-10, ["at rest"])
    wrong = balance(machine.linear, 1.000001 * found.displacements[None], forces, stiffness, gaps)
    with pytest.raises(NotConverged, match="at rest: forces and moments out of balance"):
        wrong.require(1e-10, ["at rest"])


def test_the_balance_counts_every_degree_of_freedom():
    """A force that one bearing takes and no contact gives is left over, whatever the body and direction."""
    layout = make_layout(kinematics=GEOMETRIC)
    machine = make_machine(layout, stiffness=FLAT, error=0.0, imperfections=perfect(layout))
    found = mean_equilibrium(machine)
    held = np.flatnonzero(np.diag(bearing_matrix(layout)))
    moved = found.displacements + 1e-9 * np.eye(layout.dof)[held]
    forces = np.tile(found.flank_forces, (held.size, 1))
    gaps = np.tile(flank_edges(machine), (held.size, 1))
    checked = balance(machine.linear, moved, forces, np.full_like(gaps, K), gaps)
    largest = abs(machine.torques[6]) / layout.gear_arm
    expected = 1e-9 * np.diag(bearing_matrix(layout))[held] / largest
    np.testing.assert_allclose(checked.residual, expected, rtol=1e-6)
    np.testing.assert_allclose(
        bearing_loads(machine.linear, found.displacements) + found.flank_forces @ flank_jacobian(layout),
        [np.where(np.arange(28) % 4 == 3, np.repeat(machine.torques, 4), 0.0)],
        atol=1e-8,
    )
