"""A machine with two coordinates more, gyroscopic terms and full matrices, in statics and modes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from rocking_bodies import InOtherCoordinates, Rocking, whirl

from facegear.errors import NotConverged
from facegear.machine import statics
from facegear.machine.block_statics import static_blocks
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC, KINEMATICS
from facegear.machine.layout import Role, Side
from facegear.machine.loaded_modes import loaded_modes
from facegear.machine.modes import name_modes
from facegear.machine.statics import equilibria, mean_equilibrium, static_bearing_forces, static_equilibrium

BODY, J, STIFFNESS, POLAR = "one", 0.003, 5e4, 0.005
PLACES = ((BODY, Role.INPUT, 0.0), ("two", Role.TAIL, 40.25))
BOTH_KINEMATICS = pytest.mark.parametrize("kinematics", KINEMATICS.values(), ids=KINEMATICS)


def machine_with(bodies, kinematics=GEOMETRIC, **more):
    layout = make_layout(PLACES, (Side.UPPER,), kinematics=kinematics)
    return replace(make_machine(layout, tail_share=0.3, **more), bodies=bodies)


def levers(machine, size=0.02):
    """Rows of the flanks by the tilts, of the first pinion's flanks alone."""
    rows = np.zeros((len(machine.linear.rows), 2))
    rows[:: len(PLACES)] = size, -0.4 * size
    return rows


@BOTH_KINEMATICS
@pytest.mark.parametrize("speed_rpm", [0.0, 1200.0, 30000.0, -30000.0])
def test_a_turning_body_whirls_at_the_roots_of_its_quadratic_equation(kinematics, speed_rpm):
    machine = machine_with(Rocking(BODY, J, STIFFNESS, POLAR), kinematics)
    found = loaded_modes(machine, speed_rpm).frequencies
    rest = loaded_modes(replace(machine, bodies=None)).frequencies
    own = whirl(J, STIFFNESS, POLAR, speed_rpm * np.pi / 30.0) / (2.0 * np.pi)
    np.testing.assert_allclose(found, np.sort([*rest, *own]), rtol=1e-9, atol=1e-6 * rest[-1])


def test_forward_whirl_turns_as_the_body_does_and_backward_whirl_against_it():
    machine = machine_with(Rocking(BODY, J, STIFFNESS, POLAR))
    modes = loaded_modes(machine, 20000.0)
    slow, fast = whirl(J, STIFFNESS, POLAR, 20000.0 * np.pi / 30.0) / (2.0 * np.pi)
    for frequency, turn in ((slow, -1.0), (fast, 1.0)):
        shape = modes.shapes[:, np.abs(modes.frequencies - frequency).argmin()]
        assert np.abs(shape[:-2]).max() < 1e-9 * np.abs(shape).max()
        assert shape[-1] / shape[-2] == pytest.approx(-1j * turn, abs=1e-9)


def test_a_mass_on_a_spring_seen_from_turning_axes_has_sum_and_difference_frequencies():
    own, speed = np.sqrt(STIFFNESS / J), 900.0
    machine = machine_with(Rocking(BODY, J, STIFFNESS, 2.0 * J, softening=J))
    found = 2.0 * np.pi * loaded_modes(machine, speed * 30.0 / np.pi).frequencies
    for frequency in (own - speed, own + speed):
        assert np.abs(found - frequency).min() < 1e-9 * frequency


def test_modes_of_a_body_that_turning_has_made_unstable_are_refused():
    machine = machine_with(Rocking(BODY, J, STIFFNESS, softening=J))
    beyond = 1.01 * np.sqrt(STIFFNESS / J) * 30.0 / np.pi
    with pytest.raises(NotConverged, match="not positive"):
        loaded_modes(machine, beyond)


def test_modes_of_a_body_that_its_stiffness_drives_away_are_refused_at_rest_too():
    with pytest.raises(NotConverged, match="not positive"):
        loaded_modes(machine_with(Rocking(BODY, J, -STIFFNESS)))


def test_modes_of_bodies_that_lean_and_rock_have_unit_mass_and_name_the_tilt():
    machine = machine_with(Rocking(BODY, J, STIFFNESS, POLAR, leaning=5e5))
    modes, linear = loaded_modes(machine), machine.linear
    np.testing.assert_allclose(modes.shapes.T @ linear.mass @ modes.shapes, np.eye(linear.size), atol=1e-12)
    assert any("tilt" in name.symbols for name in name_modes(machine.layout, linear, modes))
    turning = loaded_modes(machine, 1e-3)
    np.testing.assert_allclose(turning.frequencies, modes.frequencies, rtol=1e-6, atol=1e-4)
    energies = np.einsum("im,ij,jm->m", turning.shapes.conj(), linear.mass, turning.shapes)
    np.testing.assert_allclose(energies[turning.frequencies > 0.0], 1.0, rtol=1e-6)


@BOTH_KINEMATICS
def test_moments_tilt_a_body_as_far_as_its_stiffness_says(kinematics):
    moments = np.array([30.0, -80.0])
    machine = machine_with(Rocking(BODY, J, STIFFNESS, moments=tuple(moments)), kinematics)
    found, plain = static_equilibrium(machine), static_equilibrium(replace(machine, bodies=None))
    np.testing.assert_allclose(found.displacements[-2:], moments / STIFFNESS, rtol=1e-9)
    np.testing.assert_allclose(found.forces, plain.forces, rtol=1e-9)
    np.testing.assert_allclose(
        static_bearing_forces(machine), static_bearing_forces(replace(machine, bodies=None)), atol=1e-5
    )


def test_flanks_tilt_a_body_by_their_forces_times_their_levers():
    machine = machine_with(None)
    rows = levers(machine)
    machine = replace(machine, bodies=Rocking(BODY, J, STIFFNESS, levers=rows))
    assert static_blocks(machine) is not None
    found = equilibria(machine, np.array([0.1, 0.7]))
    expected = -found.flank_forces @ rows / STIFFNESS
    np.testing.assert_allclose(found.displacements[:, -2:], expected, rtol=1e-9)


def test_a_shaft_that_couples_displacement_and_tilt_bends_by_its_whole_compliance():
    bodies, free = Rocking(BODY, J, STIFFNESS, leaning=1.2e6), machine_with(None)
    machine = replace(free, bodies=bodies)
    assert static_blocks(machine) is None
    found, linear = mean_equilibrium(machine), machine.linear
    at = [0, linear.size - 1]
    pushed = found.flank_forces[0] @ linear.rows[:, 0]
    compliance = np.linalg.inv(linear.stiffness[np.ix_(at, at)])
    np.testing.assert_allclose(found.displacements[0, at], -pushed * compliance[:, 0], rtol=1e-8)
    np.testing.assert_allclose(static_bearing_forces(machine), static_bearing_forces(free), atol=1e-4)


@pytest.mark.parametrize("clearance", [0.0, 20e-6])
def test_both_solvers_of_statics_agree(clearance, monkeypatch):
    layout = make_layout(kinematics=GEOMETRIC)
    machine = make_machine(
        layout, imperfections=replace(perfect(layout), bearing_clearance=np.full(5, clearance))
    )
    cycles = np.array([0.0, 0.4])
    by_blocks = equilibria(machine, cycles)
    monkeypatch.setattr(statics, "static_blocks", lambda machine: None)
    dense = equilibria(machine, cycles)
    largest = by_blocks.flank_forces.max()
    np.testing.assert_allclose(dense.flank_forces, by_blocks.flank_forces, atol=1e-9 * largest)


@settings(max_examples=15, deadline=None)
@given(st.lists(st.floats(-0.5, 0.5), min_size=8, max_size=8))
def test_modes_and_statics_do_not_depend_on_the_coordinates_of_a_body(mixing):
    plain = machine_with(None)
    bodies = Rocking(BODY, J, STIFFNESS, POLAR, moments=(20.0, 10.0), levers=levers(plain))
    one = replace(plain, bodies=bodies)
    # Tilts counted from a turned axis, and from the motion of the gear: masses are full then.
    transform = np.eye(one.linear.size)
    transform[-2:, -2:] += np.reshape(mixing[:4], (2, 2))
    transform[-2:, 8:10] = np.reshape(mixing[4:], (2, 2))
    other = replace(plain, bodies=InOtherCoordinates(bodies, transform))
    for speed in (0.0, 15000.0):
        np.testing.assert_allclose(
            loaded_modes(other, speed).frequencies, loaded_modes(one, speed).frequencies, rtol=1e-8, atol=1e-3
        )
    forces = [mean_equilibrium(machine).flank_forces[0] for machine in (one, other)]
    np.testing.assert_allclose(forces[1], forces[0], atol=1e-8 * forces[0].max())
