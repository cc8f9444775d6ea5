from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from lumped_machines import drive_rows, make_machine
from references import against, agrees

from facegear.errors import InvalidInput
from facegear.harmonics import Harmonics
from facegear.machine.dense_statics import Contacts, Line
from facegear.machine.imperfections import perfect
from facegear.machine.layout import Role, Side
from facegear.machine.machine import Machine
from facegear.machine.mesh_phases import PhaseConvention, mesh_phases
from facegear.machine.statics import static_equilibrium
from facegear.machine.torques import balanced_torques
from facegear.meshing.linear import linear_law


@against(
    "analytic",
    "balance of torques",
    capability="load_sharing_reference",
    module="facegear.machine.statics",
)
@settings(max_examples=30, deadline=None)
@given(
    torque=st.floats(-3000, 3000).filter(lambda t: t == 0.0 or abs(t) > 1e-6),
    share=st.floats(0, 0.5),
    backlash=st.floats(0, 1e-3),
    cycles=st.one_of(st.none(), st.floats(0, 1)),
)
@example(
    torque=1e-5, share=1e-5, backlash=1e-5, cycles=None
)  # next to nothing pushes the tail through its backlash
def test_static_mesh_forces_balance_the_torques_on_every_pinion(torque, share, backlash, cycles):
    machine = make_machine(torque=torque, tail_share=share, backlash=backlash)
    state = static_equilibrium(machine, cycles)
    layout = machine.layout
    lever = layout.pinion_radius * np.cos(layout.pressure_angle)
    on_pinions = state.forces.reshape(2, 5).sum(axis=0) * lever
    agrees(
        "torque of a pinion, N m",
        on_pinions,
        machine.torques[:5],
        relative=1e-7,
        absolute=1e-7 * max(abs(torque), 1.0),
    )


@against(
    "second implementation",
    "numpy.linalg.lstsq of the linear machine",
    capability="load_sharing_reference",
    module="facegear.machine.statics",
)
def test_without_backlash_statics_is_the_linear_solution(machine_of):
    from facegear.machine.linear_model import bearing_diagonal

    machine = machine_of(backlash=0.0)
    directions = drive_rows(machine.layout)
    stiffness = np.diag(bearing_diagonal(machine.layout)) + 4.1e8 * directions.T @ directions
    applied = np.zeros(28)
    applied[3::4] = machine.torques
    linear = directions @ np.linalg.lstsq(stiffness, applied, rcond=1e-14)[0] * 4.1e8
    agrees("mesh force, N", static_equilibrium(machine).forces, linear, relative=1e-7, absolute=1e-3)


def test_idlers_carry_load_on_the_opposite_flank_of_the_lower_gear(machine_of):
    forces = static_equilibrium(machine_of(backlash=0.0)).forces
    assert (forces[[0, 1, 4]] < 0).all()
    assert (forces[5:] > 0).all()


@against(
    "analytic",
    "mirror symmetry",
    capability="load_sharing_reference",
    module="facegear.machine.statics",
)
def test_left_and_right_carry_the_same_where_the_machine_is_symmetric(machine_of):
    forces = static_equilibrium(machine_of()).forces
    agrees("mesh force, N", forces[[1, 2, 6, 7]], forces[[4, 3, 9, 8]], relative=1e-9, absolute=1e-6)


def test_torques_out_of_balance_are_refused_with_the_excess(machine_of):
    machine = machine_of()
    torques = machine.torques.copy()
    torques[-1] *= 0.9
    with pytest.raises(InvalidInput, match=r"torques = .*must balance"):
        Machine(
            machine.layout, torques, machine.stiffness, machine.error, machine.half_backlash, machine.damping
        )


def test_a_single_face_gear_takes_the_sum_of_its_pinions(layout_of):
    layout = layout_of((("one", Role.INPUT, 0.0), ("two", Role.INPUT, 45.0)), (Side.UPPER,))
    torques = balanced_torques(layout, np.array([100.0, 50.0]))
    assert torques[-1] == pytest.approx(-150.0 * layout.gear_radius / layout.pinion_radius)


def test_phases_are_the_fractions_of_the_pitch_with_half_a_turn_for_the_lower_gear(layout_of):
    layout = layout_of()
    geometric = mesh_phases(layout, PhaseConvention.GEOMETRIC)
    np.testing.assert_allclose(geometric, [0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5])
    printed = mesh_phases(layout, PhaseConvention.AS_PRINTED)
    np.testing.assert_allclose(printed, [0.5, 0.5, 0.5, 0.5, 0.5, 0.0, 0.5, 0.5, 0.5, 0.5])


def test_phases_of_other_meshes_than_the_layouts_are_refused_before_a_kernel_reads_past_them(layout_of):
    machine = make_machine()
    with pytest.raises(InvalidInput, match="one for each of 10"):
        replace(machine, error_lags=np.zeros(4))
    with pytest.raises(InvalidInput, match="one for each of 10"):
        replace(machine, imperfections=perfect(layout_of((("one", Role.INPUT, 0.0),), (Side.UPPER,))))


NUMBERS = st.floats(-10.0, 10.0).filter(lambda x: x == 0.0 or abs(x) > 1e-3)


def dead_zones(stiffness, half_width):
    law = linear_law([Harmonics(np.zeros(1), np.array([k])) for k in stiffness])
    half = np.full(stiffness.size, half_width)
    return Contacts(law, np.zeros(stiffness.size), -half, half)


@given(
    meshes=st.lists(st.tuples(NUMBERS, NUMBERS, st.floats(0.1, 10.0)), min_size=1, max_size=10),
    rise=st.floats(1e-6, 10.0),
    constant=st.floats(-100.0, -0.1),
    half_width=st.floats(0.0, 5.0),
)
def test_the_line_search_of_the_statics_stops_where_the_slope_comes_to_zero(
    meshes, rise, constant, half_width
):
    deflections, rates, stiffness = np.array(meshes).T
    line = Line(constant, rise, deflections, rates, dead_zones(stiffness, half_width))
    best = line.minimum()
    before, at, after = line.slopes(best * np.array([1.0 - 1e-9, 1.0, 1.0 + 1e-9]))
    largest = abs(constant) + stiffness @ (np.abs(rates) * (np.abs(deflections) + np.abs(rates) * best))
    if line.slopes(np.zeros(1))[0] >= 0.0:
        assert best == 0.0
    else:
        assert before <= after
        assert abs(at) <= 1e-12 * (largest + rise * best)


@pytest.mark.filterwarnings("error")
def test_a_mesh_that_next_to_never_moves_leaves_the_line_search_to_the_others():
    line = Line(-1.0, 1.0, np.zeros(1), np.array([1e-320]), dead_zones(np.ones(1), 1e-4))
    assert line.minimum() == pytest.approx(1.0)


def test_no_line_is_searched_where_a_whole_step_presses_the_same_contacts(machine_of, monkeypatch):
    """A line was searched in each round, though without backlash the contacts change in the first alone."""
    solved, searched = [], []
    solve, minimum = np.linalg.solve, Line.minimum
    monkeypatch.setattr(np.linalg, "solve", lambda *given: solved.append(1) or solve(*given))
    monkeypatch.setattr(Line, "minimum", lambda line: searched.append(1) or minimum(line))
    static_equilibrium(machine_of(backlash=0.0))
    assert len(solved) > 4 > len(searched)
