"""Shafts on rolling bearings: public numbers, balance, springs as bearings, and hard cases."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rolling_bearings import P1, P2, P3, TAPERED
from scipy.optimize import root

from facegear.bearings.life import reference_life
from facegear.bearings.response import element_loads, respond
from facegear.bearings.shaft import RollingShaft, Support, find_shaft_equilibrium, follow_pinion
from facegear.errors import NotConverged
from facegear.parts.shafts import Bearing, Elasticity, Segment, Shaft, condense_shaft
from facegear.rigid_body import carry_motion

STEEL = Elasticity(206e9, 0.3)
REST = np.zeros(5)
THRUST = np.array([0.0, 0.0, 1.0, 0.0, 0.0])
STEPPED = (Segment(0.04, 0.05, 0.02), Segment(0.05, 0.06, 0.02), Segment(0.04, 0.05, 0.02))
S1 = RollingShaft(STEPPED, STEEL, (Support(0.01, P1, REST), Support(0.12, P3, REST)), 0.06)
LOAD_1 = np.array([6000.0, -2500.0, 1200.0, 0.0, 20.0])


def make_pair(preload=8e-6):
    """S2 of the notes, an O arrangement: each inner ring is pushed to the other by half of the preload."""
    ball = replace(P2, first_element=0.0)
    supports = (
        Support(0.015, ball, 0.5 * preload * THRUST),
        Support(0.095, replace(ball, direction=-1), -0.5 * preload * THRUST),
    )
    segments = (Segment(0.03, 0.04), Segment(0.06, 0.045), Segment(0.07, 0.04))
    return RollingShaft(segments, STEEL, supports, 0.145)


LOAD_2 = np.array([1500.0, 800.0, -900.0, 0.0, 0.0])


def assert_balanced(shaft, state, load):
    carried = sum(
        carry_motion(support.position - shaft.pinion).T @ force
        for support, force in zip(shaft.supports, state.forces, strict=True)
    )
    assert np.allclose(carried, load, rtol=0, atol=1e-9 * np.abs(load).max() + 1e-8)


def test_a_shaft_on_a_ball_and_a_roller_bearing_has_its_public_numbers():
    state = find_shaft_equilibrium(S1, LOAD_1)
    expected = [21.33796, -8.76716, 132.94188, 33.84699, 100.89522]
    assert np.allclose(1e6 * state.pinion, expected, rtol=0, atol=5.01e-6)
    first, second = state.forces * [1, 1, 1, 1e3, 1e3]
    assert np.allclose(first, [2863.977, -1262.920, 1200.0, -11133.8, -25111.9], rtol=0, atol=0.0501)
    assert np.allclose(second, [3136.023, -1237.080, 0.0, 55.0, 149.4], rtol=0, atol=0.0501)
    tangent = 1e-6 / np.diag(state.compliance)[:2]
    assert np.allclose(tangent, [348.437, 299.142], rtol=0, atol=5.01e-4)
    lives = [
        reference_life(b, element_loads(b, q[None]))[0] for b, q in zip((P1, P3), state.rings, strict=True)
    ]
    assert np.allclose(lives, [1352.74, 42121.2], rtol=4e-6)


def test_a_preloaded_pair_of_angular_contact_bearings_has_its_public_numbers():
    shaft = make_pair()
    state = find_shaft_equilibrium(shaft, LOAD_2)
    expected = [29.27539, 15.56167, 3.96176, -145.51924, 273.47672]
    assert np.allclose(1e6 * state.pinion, expected, rtol=0, atol=5.01e-6)
    assert np.allclose(state.forces[0, :3], [-288.739, -153.988, 1134.188], rtol=0, atol=5.01e-4)
    assert np.allclose(state.forces[1, :3], [1788.739, 953.988, -2034.188], rtol=0, atol=5.01e-4)
    tangent = 1e-6 / np.diag(state.compliance)[:2]
    assert np.allclose(tangent, [50.7399, 52.6600], rtol=0, atol=5.01e-5)
    pairs = zip((support.bearing for support in shaft.supports), state.rings, strict=True)
    lives = [reference_life(bearing, element_loads(bearing, ring[None]))[0] for bearing, ring in pairs]
    assert np.allclose(lives, [139083.0, 3673.49], rtol=4e-6)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_bearings_that_are_matrices_give_the_condensed_shaft(seed):
    chance = np.random.default_rng(seed)
    matrices = []
    for _ in range(3):
        root = chance.normal(size=(5, 5)) * np.array([1e4, 1e4, 1e4, 1e2, 1e2])
        matrices.append(root.T @ root)
    at = np.sort(chance.uniform(0.0, 0.13, 3))
    load = chance.normal(size=5) * [1e3, 1e3, 1e3, 1e1, 1e1]
    shaft = RollingShaft(
        STEPPED, STEEL, tuple(Support(x, matrix, REST) for x, matrix in zip(at, matrices, strict=True)), 0.06
    )
    springs = tuple(Bearing(x, matrix) for x, matrix in zip(at, matrices, strict=True))
    condensed = condense_shaft(Shaft(STEPPED, STEEL, springs, 0.06))
    state = find_shaft_equilibrium(shaft, load)
    assert np.allclose(state.pinion, condensed.compliance @ load, rtol=1e-8, atol=1e-14)
    assert np.allclose(state.forces, condensed.bearing_loads(load), rtol=1e-7, atol=1e-6)
    assert np.allclose(
        state.compliance, condensed.compliance, rtol=1e-7, atol=1e-9 * condensed.compliance.max()
    )


def test_the_tangent_is_the_derivative_of_loads_on_pinion_and_seats():
    shaft, seats = make_pair(), np.zeros((2, 5))
    state = find_shaft_equilibrium(shaft, LOAD_2)
    step = 1e-8
    for number in range(5):
        moved = seats.copy()
        moved[1, number] = step
        plus = find_shaft_equilibrium(shaft, LOAD_2, moved)
        moved[1, number] = -step
        minus = find_shaft_equilibrium(shaft, LOAD_2, moved)
        column = state.stiffness[:, 10 + number]
        # The load stays: the pinion moves so that K_pp dq + K_ps ds = 0.
        motion = np.linalg.solve(state.stiffness[:5, :5], -column[:5])
        assert np.allclose((plus.pinion - minus.pinion) / (2 * step), motion, rtol=1e-5, atol=1e-5)
        forces = column[5:] + state.stiffness[5:, :5] @ motion
        measured = -(plus.forces - minus.forces).ravel() / (2 * step)
        assert np.allclose(measured, forces, rtol=1e-5, atol=1e-5 * np.abs(forces).max())


def test_seats_that_move_as_one_body_carry_the_shaft_along():
    shaft = make_pair()
    rigid = np.array([3e-6, -5e-6, 2e-6, 1e-5, -2e-5])
    seats = np.array([carry_motion(support.position - shaft.pinion) @ rigid for support in shaft.supports])
    rest, moved = (find_shaft_equilibrium(shaft, LOAD_2, given) for given in (np.zeros((2, 5)), seats))
    assert np.allclose(moved.pinion - rest.pinion, rigid, rtol=0, atol=1e-12)
    assert np.allclose(moved.forces, rest.forces, rtol=1e-7, atol=1e-5)


@settings(deadline=None)
@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(0.0, 4.0))
def test_every_load_on_a_preloaded_pair_is_in_balance(x, y, z, exponent):
    shaft, load = make_pair(), np.array([x, y, z, 0.0, 0.0]) * 10.0**exponent
    assert_balanced(shaft, find_shaft_equilibrium(shaft, load), load)


def test_thrust_that_grows_takes_the_preload_of_one_bearing_and_spares_the_other():
    shaft = make_pair()
    states = [find_shaft_equilibrium(shaft, thrust * THRUST) for thrust in (0.0, 500.0, 20_000.0)]
    left, right = np.array([state.forces[:, 2] for state in states]).T
    assert left[0] == pytest.approx(-right[0], rel=1e-9) and left[0] > 0.0
    assert right[1] < 0.0 and right[2] == 0.0 and left[2] == pytest.approx(20_000.0)


def test_a_pair_without_preload_and_load_is_loose_and_is_found_nevertheless():
    """Endplay: inner rings stand apart, so that thrust first crosses the gap."""
    shaft = make_pair(preload=-30e-6)
    rest = find_shaft_equilibrium(shaft, np.zeros(5))
    assert not rest.forces.any() and not rest.pinion.any()
    pushed = find_shaft_equilibrium(shaft, 300.0 * THRUST)
    assert pushed.pinion[2] > 15e-6
    assert_balanced(shaft, pushed, 300.0 * THRUST)


def test_bearings_beside_each_other_and_beside_the_pinion_are_no_special_case():
    ball = replace(P2, first_element=0.0)
    twins = (Support(0.06, ball, 2e-6 * THRUST), Support(0.06, replace(ball, direction=-1), -2e-6 * THRUST))
    shaft = RollingShaft(STEPPED, STEEL, (*twins, Support(0.12, P3, REST)), 0.06)
    state = find_shaft_equilibrium(shaft, LOAD_1)
    assert_balanced(shaft, state, LOAD_1)


@pytest.mark.parametrize("pair", [(P3, P3), (TAPERED, P3)])
def test_a_shaft_that_no_bearing_holds_along_its_axis_is_refused(pair):
    supports = tuple(Support(x, bearing, REST) for x, bearing in zip((0.01, 0.12), pair, strict=True))
    shaft = RollingShaft(STEPPED, STEEL, supports, 0.06)
    with pytest.raises(NotConverged, match="nothing holds them"):
        find_shaft_equilibrium(shaft, np.array([2000.0, 0.0, -500.0, 0.0, 0.0]))


def test_a_softer_shaft_tilts_its_rings_more_and_carries_the_same():
    soft = replace(S1, material=Elasticity(2e9, 0.3))
    stiff = find_shaft_equilibrium(S1, LOAD_1)
    state = find_shaft_equilibrium(soft, LOAD_1)
    assert_balanced(soft, state, LOAD_1)
    assert np.abs(state.rings[:, 3:]).max() > np.abs(stiff.rings[:, 3:]).max()


def make_random_shaft(seed):
    """A shaft of three segments on two to four bearings of any kind."""
    chance = np.random.default_rng(seed)
    segments = tuple(
        Segment(*pair)
        for pair in zip(chance.uniform(0.02, 0.08, 3), chance.uniform(0.03, 0.06, 3), strict=True)
    )
    length = sum(segment.length for segment in segments)
    kinds = [
        P1,
        P2,
        replace(P2, direction=-1),
        P3,
        TAPERED,
        replace(TAPERED, direction=-1),
        replace(P1, speed=800.0),
    ]
    chosen = [P1, *chance.choice(np.array(kinds, object), chance.integers(1, 4))]
    supports = [
        Support(at, replace(bearing, first_element=turn), chance.uniform(-3e-6, 3e-6) * THRUST)
        for at, bearing, turn in zip(
            chance.uniform(0.0, length, len(chosen)),
            chosen,
            chance.uniform(0.0, 6.0, len(chosen)),
            strict=True,
        )
    ]
    return RollingShaft(segments, STEEL, tuple(supports), float(chance.uniform(0.0, length))), chance


@pytest.mark.parametrize("seed", range(12))
def test_scipy_finds_the_same_balance_of_random_shafts(seed):
    """Motions of all rings are unknowns of their own there, and the shaft a stiffness."""
    shaft, chance = make_random_shaft(seed)
    load = chance.normal(size=5) * [2e3, 2e3, 5e2, 20.0, 20.0]
    state = find_shaft_equilibrium(shaft, load)
    assert_balanced(shaft, state, load)
    count, bends = len(shaft.supports), shaft.bending.shape[1]
    scale = np.concatenate([[1e-5] * 3, [1e-4] * 2, 1e-5 / shaft.bend_arms])

    def out_of_balance(scaled):
        coordinates = scaled * scale
        rings = shaft.rigid @ coordinates[:5] + shaft.bending @ coordinates[5:]
        rings = rings.reshape(count, 5) + [support.offset for support in shaft.supports]
        forces = np.concatenate(
            [
                respond(one.bearing, ring[None]).force[0]
                for one, ring in zip(shaft.supports, rings, strict=True)
            ]
        )
        bent = coordinates[5:] + shaft.bending.T @ forces
        return np.concatenate([shaft.rigid.T @ forces - load, bent]) * scale

    found = root(
        out_of_balance,
        np.concatenate([state.pinion, state.bend]) / scale + 1e-3 * chance.normal(size=5 + bends),
        tol=1e-14,
    )
    assert np.abs((found.x * scale)[:5] - state.pinion).max() < 1e-9


@pytest.mark.parametrize("seed", range(8))
def test_a_held_pinion_feels_the_gradient_of_the_energy_and_its_tangent(seed):
    shaft, chance = make_random_shaft(seed)
    balance = find_shaft_equilibrium(shaft, chance.normal(size=5) * [3e3, 3e3, 5e2, 20.0, 20.0])
    count = len(shaft.supports)
    seats = chance.uniform(-1.0, 1.0, (count, 5)) * 1e-7
    here = follow_pinion(shaft, balance.pinion, seats)
    assert np.allclose(
        follow_pinion(shaft, balance.pinion, seats, here.bend + 1e-3).loads, here.loads, rtol=1e-8, atol=1e-6
    )
    step = 1e-9
    for number in range(5 * (1 + count)):
        states = []
        for sign in (1.0, -1.0):
            moved = np.concatenate([balance.pinion, seats.ravel()])
            moved[number] += sign * step
            states.append(follow_pinion(shaft, moved[:5], moved[5:].reshape(count, 5), here.bend))
        slope = (states[0].energy - states[1].energy) / (2 * step)
        assert slope == pytest.approx(
            here.loads.ravel()[number], rel=1e-5, abs=1e-3 * (1.0 + np.abs(here.loads).max() * 1e-3)
        )
        column = (states[0].loads - states[1].loads).ravel() / (2 * step)
        largest = np.abs(here.stiffness[:, number]).max()
        assert np.allclose(column, here.stiffness[:, number], rtol=0, atol=2e-3 * largest)


def test_an_equilibrium_is_the_held_pinion_that_feels_its_load():
    state = find_shaft_equilibrium(S1, LOAD_1)
    held = follow_pinion(S1, state.pinion, np.zeros((2, 5)))
    assert np.allclose(held.pinion_load, LOAD_1, rtol=0, atol=1e-6)
    assert np.allclose(held.stiffness, state.stiffness, rtol=1e-6)
    assert held.energy == pytest.approx(state.energy, rel=1e-9)
