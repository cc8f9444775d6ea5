"""Symmetries of machines map each of their motions to another one."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from oscillators import backlash_oscillator, one_degree
from random_machines import FINE, frequency, machines, speeds
from recorded_motion import record

from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import KINEMATICS
from facegear.machine.layout import Role, Side
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.plan import State
from facegear.motion.steady_state.simulate import build_model
from facegear.motion.symmetries import mesh_images, symmetries

THREE = tuple((f"p{i}", Role.INPUT, i * 143.0 / 3.0) for i in range(3))
LEFT_AND_RIGHT = [0, 4, 3, 2, 1]


def make_start(size, seed=1):
    random = np.random.default_rng(seed)
    return State(1e-4 * random.normal(size=size), 0.3 * random.normal(size=size))


def assert_maps_motions(system, speed, symmetry, periods=2):
    """Run a motion and the image of the state that it passes at the symmetry's shift."""
    start = make_start(system.size)
    run = record(system, speed, start, periods + 1, FINE)
    phases = TAU * np.linspace(0.0, periods, 40)
    place, deflection = run.at(phases + TAU * symmetry.shift)
    step = 1e-5
    around = [run.at(np.array([TAU * symmetry.shift + sign * step]))[0][0] for sign in (1.0, -1.0)]
    velocity = (around[0] - around[1]) / (2.0 * step) * speed if symmetry.shift else start.velocity
    image = State(symmetry.matrix @ place[0], symmetry.matrix @ velocity)
    other = record(system, speed, image, periods, FINE)
    found = other.at(phases)[1][:, : system.contacts]
    expected = symmetry.signs * deflection[:, symmetry.contacts]
    np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(expected).max())


@pytest.mark.parametrize("kinematics", list(KINEMATICS.values()), ids=lambda kinematics: kinematics.name)
@pytest.mark.parametrize("clearance", [0.0, 1e-5])
def test_left_and_right_of_the_papers_machine_may_be_exchanged(kinematics, clearance):
    layout = make_layout(kinematics=kinematics)
    flaws = replace(perfect(layout), bearing_clearance=np.full(5, clearance))
    system = build_model(make_machine(layout, imperfections=flaws)).system
    (symmetry,) = symmetries(system)
    assert symmetry.shift == 0.0
    assert symmetry.meshes.tolist() == LEFT_AND_RIGHT + [5 + mesh for mesh in LEFT_AND_RIGHT]
    assert_maps_motions(system, TAU * 23 * 7000.0 / 60.0, symmetry)


def test_three_equal_pinions_follow_each_other_by_thirds_of_the_mesh_period():
    system = build_model(make_machine(make_layout(THREE, (Side.UPPER,)))).system
    by_shift = {round(3 * symmetry.shift): symmetry for symmetry in symmetries(system)}
    assert sorted(by_shift) == [1, 2]
    for symmetry in by_shift.values():
        assert_maps_motions(system, TAU * 23 * 7000.0 / 60.0, symmetry)


def test_without_mean_load_half_a_period_later_the_flanks_have_changed_places():
    (symmetry,) = symmetries(backlash_oscillator(0.5, mean=0.0, amplitude=2.0))
    assert (symmetry.shift, symmetry.signs.tolist()) == (0.5, [-1.0])
    assert symmetries(backlash_oscillator(0.5, mean=0.1, amplitude=2.0)) == ()


def test_stiffness_of_odd_orders_has_no_half_period_symmetry():
    load = ((0.0, 0.0), (0.0, 1.0))
    assert len(symmetries(one_degree(0.1, ((0.0,) * 3, (1.0, 0.0, 0.2)), load))) == 1
    assert symmetries(one_degree(0.1, ((0.0,) * 3, (1.0, 0.2, 0.0)), load)) == ()


@pytest.mark.parametrize(
    ("flaw", "alike"), [(0.0, True), (1e-12, True), (1e-3, False)], ids=["none", "rounding", "a thousandth"]
)
def test_a_real_imperfection_ends_the_symmetry_and_rounding_does_not(flaw, alike):
    layout = make_layout()
    heavier = replace(layout.pinions[1].body, mass=layout.pinions[1].body.mass * (1.0 + flaw))
    pinions = list(layout.pinions)
    pinions[1] = replace(pinions[1], body=heavier)
    system = build_model(make_machine(replace(layout, pinions=tuple(pinions)))).system
    assert (len(symmetries(system)) == 1) == alike
    assert len(mesh_images(system)) == 1 + alike


@settings(max_examples=12, deadline=None)
@given(machine=machines(), speed=speeds)
def test_what_is_called_a_symmetry_of_a_random_machine_maps_its_motions(machine, speed):
    model = build_model(machine)
    for symmetry in symmetries(model.system)[:2]:
        assert_maps_motions(model.system, frequency(model, speed), symmetry, periods=1)


@settings(max_examples=12, deadline=None)
@given(
    pitches=st.lists(st.integers(1, 142), min_size=1, max_size=2, unique=True),
    kinematics=st.sampled_from(list(KINEMATICS.values())),
)
def test_a_mirrored_pair_of_pinions_is_found_at_any_angle(pitches, kinematics):
    pairs = [
        (f"{side}{i}", Role.IDLER, sign * p / 2.0)
        for i, p in enumerate(pitches)
        for side, sign in (("r", 1), ("l", -1))
    ]
    places = (("input", Role.INPUT, 0.0), *pairs)
    system = build_model(make_machine(make_layout(places, (Side.UPPER,), kinematics=kinematics))).system
    exchanged = [0, *(mesh for i in range(len(pitches)) for mesh in (2 * i + 2, 2 * i + 1))]
    assert exchanged in [image.tolist() for image in mesh_images(system)]
