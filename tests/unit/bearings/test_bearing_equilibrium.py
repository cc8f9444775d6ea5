"""Equilibrium of one rolling bearing: public numbers, a second solver, and hard cases."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from references import against, agrees
from rolling_bearings import ALL, P1, P2, P3, TAPERED, public_cases
from scipy.optimize import linprog, minimize

from facegear.bearings.elements import BallBearing, RollerBearing
from facegear.bearings.equilibrium import find_equilibrium
from facegear.bearings.response import element_loads, respond
from facegear.errors import InvalidInput, NotConverged

CASES = public_cases()
ARMS = np.array([1.0, 1.0, 1.0, 0.03, 0.03])
"""Arm, m, at which moments are compared with forces."""
directions = st.tuples(*[st.floats(-1.0, 1.0)] * 5).map(np.array)
sizes = st.floats(-2.0, 4.3).map(lambda exponent: 10.0**exponent)
clearances = st.sampled_from([0.0, 1e-6, 15e-6, 120e-6, -10e-6])


def assert_balanced(state, load):
    """Forces are known to the rounding of the lengths that cancel, at most 0.5 mm, times the stiffness."""
    size = max(np.abs(load / ARMS).max(), np.abs(state.force / ARMS).max())
    stiffness = np.abs(state.stiffness / np.outer(ARMS, ARMS)).max()
    thrown = state.bearing.elements * state.bearing.stiffness_at(state.bearing.springs.centrifugal)
    rounding = 64.0 * 2.3e-16 * 6e-4 * max(stiffness, thrown)
    assert np.abs((state.force - load) / ARMS).max() <= 2e-12 * size + rounding + 1e-15


@against(
    "second implementation",
    "public bearings: a program of its own",
    capability="bearing_life",
    module="facegear.bearings.equilibrium",
)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_public_loads_move_bearings_by_their_printed_digits(case):
    state = find_equilibrium(case.bearing, case.load)
    agrees("motion, um, urad", state.motion * 1e6, case.motion * 1e6, absolute=5.01e-5)
    agrees("load of the hardest element, N", state.hardest_load, case.hardest, absolute=5.01e-4)
    assert state.loaded_elements == case.count
    agrees("loaded zone, degrees", np.degrees(state.zone), np.degrees(case.zone), absolute=0.1)


@against(
    "second implementation",
    "public bearings: a program of its own",
    capability="bearing_life",
    module="facegear.bearings.response",
)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_public_stiffness_has_its_printed_digits_and_nothing_else(case):
    stiffness = find_equilibrium(case.bearing, case.load).stiffness
    printed = case.digits > 0.0
    assert (np.abs(stiffness[~printed]) <= 1e-9 * np.abs(stiffness).max()).all()
    agrees(
        "stiffness over half of its last printed digit",
        stiffness[printed] / case.digits[printed],
        case.stiffness[printed] / case.digits[printed],
        absolute=1.01,
    )


@against(
    "second implementation",
    "public bearings: a program of its own",
    capability="bearing_life",
    module="facegear.bearings.equilibrium",
)
def test_hardest_contacts_of_public_loads_have_their_printed_pressure_and_angle():
    state = find_equilibrium(CASES[0].bearing, CASES[0].load)
    agrees("largest pressures, MPa", np.array(state.pressures) / 1e6, [2466.39, 2087.92], absolute=5.01e-3)
    assert state.static_safety == pytest.approx((4200.0 / 2466.39) ** 3, rel=1e-5)
    hard = find_equilibrium(P2, CASES[7].load)
    hardest = hard.loads.element_inner[0].argmax()
    angle = np.degrees(hard.loads.inner_angle[0, hardest])
    agrees("contact angle of the hardest ball, degrees", angle, 22.2522, absolute=5.01e-5)
    rollers = find_equilibrium(P3, CASES[10].load)
    line_load = rollers.loads.inner.max() * P3.slices / 11.2
    agrees("load of the hardest slice, N/mm", line_load, 492.263, absolute=5.01e-4)


@against(
    "third-party program",
    "commercial program, quoted by the repository minzhun/ISO16281",
    capability="bearing_life",
    module="facegear.bearings.equilibrium",
)
def test_a_commercial_program_moves_a_radially_loaded_bearing_by_as_much():
    """Numbers that a public repository quotes (minzhun/ISO16281); it has 1.48 in place of 1.48096."""
    bearing = BallBearing(7, 11.5e-3, 43.5e-3, groove_ratio_outer=0.53, young=210e9)
    radial, axial = np.zeros(5), np.zeros(5)
    radial[0], axial[2] = 1000.0, 1000.0
    across, along = find_equilibrium(bearing, radial).motion[0], find_equilibrium(bearing, axial).motion[2]
    agrees("radial motion under 1000 N, um", across * 1e6, 15.1101, relative=1e-4)
    agrees("axial motion under 1000 N, um", along * 1e6, 133.538, relative=1e-4)
    loose = replace(bearing, clearance=10e-6)
    across = find_equilibrium(loose, radial).motion[0]
    agrees("radial motion with clearance, um", across * 1e6, 21.223, relative=1e-4)
    # The program measures axially from the middle of the axial clearance.
    beyond = find_equilibrium(loose, axial).motion[2] * 1e6
    agrees("axial motion with clearance, um", beyond, 149.1717, relative=1e-4)


@against(
    "analytic",
    "Stribeck's number: integrals of the load over the zone",
    capability="bearing_life",
    module="facegear.bearings.equilibrium",
)
@pytest.mark.parametrize(
    ("bearing", "count", "factor"),
    [
        (replace(P1, clearance=0.0), 10, 4.3791),
        (replace(P1, elements=20, pitch_diameter=140e-3, clearance=0.0), 20, 4.3692),
        (replace(P3, elements=10, clearance=0.0, has_profile=False), 10, 4.0880),
        (BallBearing(1000, 1e-4, 60e-3), 1000, 4.37010),
        (RollerBearing(1000, 1e-4, 60e-3, effective_length=1e-4, slices=2, has_profile=False), 1000, 4.08499),
    ],
)
def test_the_hardest_element_carries_stribecks_share(bearing, count, factor):
    """Without clearance, one element below the load."""
    load = np.array([10.0 if count == 1000 else 3000.0, 0.0, 0.0, 0.0, 0.0])
    state = find_equilibrium(bearing, load)
    # Contact angles change by the load, which the closed forms of balls leave out.
    share = state.hardest_load * count / load[0]
    agrees("hardest element's load over the mean of all", share, factor, relative=1e-4)


@settings(deadline=None)
@given(st.sampled_from(["P1", "P3", "thrown P1", "thrown P3"]), directions, sizes, clearances)
def test_bearings_that_take_every_load_find_a_balance(name, direction, size, clearance):
    bearing = replace(ALL[name], clearance=clearance)
    load = size * direction * ARMS * [1.0, 1.0, "P1" in name, 0.2, 0.2]
    # Loads of less than a rounding are none.
    assume(not load.any() or np.abs(load).max() > 1e-3 * size)
    assert_balanced(find_equilibrium(bearing, load), load)


def test_a_light_load_beside_a_small_centrifugal_force_finds_its_balance():
    """A load of 3 mN, and 7 mN on each ball: positions of balls are known to their rounding alone."""
    bearing = replace(P1, clearance=1e-4, first_element=4.317079066407471, speed=12.136970140093961)
    load = np.array([-1.39342501e-03, 2.37099782e-03, 0.0, 4.71582980e-05, -3.89728390e-05])
    state = find_equilibrium(bearing, load)
    assert np.abs((state.force - load) / ARMS).max() < 1e-9 * np.abs(load).max()


@pytest.mark.parametrize(
    ("bearing", "load"),
    [
        (replace(P3, clearance=1e-4, first_element=3.8), [0.035687, 0.066624, 0.0, 3.52e-4, -3.34e-4]),
        (replace(P3, clearance=1e-6, first_element=3.2), [-5.0e-5, 1.597e-3, 0.0, 0.0, -7.89e-6]),
        (replace(TAPERED, clearance=0.0, first_element=1.57), [0.0, 1.394e-3, 2.972e-3, 0.0, -4.13e-6]),
    ],
)
def test_slow_rollers_that_one_slice_holds_have_a_tangent(bearing, load):
    """Both contacts are stiff along the same line there, so that no matrix of theirs has an inverse."""
    slow = replace(bearing, speed=0.2)
    state = find_equilibrium(slow, np.array(load))
    assert np.abs((state.force - load) / ARMS).max() < 1e-6 * np.abs(load).max()


@settings(deadline=None)
@given(directions, sizes, st.sampled_from([0.0, 10e-6]))
def test_a_tapered_bearing_holds_a_load_exactly_where_its_normals_can(direction, size, clearance):
    """A load is held if it is a sum of pushes of the slices (Farkas); near the border nothing is asked."""
    bearing = replace(TAPERED, clearance=clearance)
    load = size * (direction + [0.0, 0.0, 0.4, 0.0, 0.0]) * ARMS * [1.0, 1.0, 1.0, 0.5, 0.5]
    assume(np.abs(load).max() > 1e-3 * size)
    rollers = bearing.springs
    cosine, sine = rollers.cosine, rollers.sine
    ends = []
    for x in (rollers.positions[0], rollers.positions[-1]):
        lever = rollers.normal_axial * rollers.radius - x
        radial, axial = (
            rollers.normal_radial * np.ones(cosine.size),
            rollers.normal_axial * np.ones(cosine.size),
        )
        ends.append(np.array([radial * cosine, radial * sine, axial, lever * sine, -lever * cosine]))
    pushes = np.concatenate(ends, axis=1) / ARMS[:, None]
    count = pushes.shape[1]

    def lacks(target):
        """Smallest sum of forces that pushes leave unbalanced, over the load."""
        both = np.concatenate([pushes, np.eye(5), -np.eye(5)], axis=1)
        cost = np.concatenate([np.zeros(count), np.ones(10)])
        return linprog(cost, A_eq=both, b_eq=target).fun / np.abs(target).max()

    lacking = lacks(load / ARMS)
    if lacking > 1e-3:
        with pytest.raises(NotConverged, match="nothing holds them"):
            find_equilibrium(bearing, load)
    elif lacks(load / ARMS - 2e-3 * np.abs(load / ARMS).max() * pushes.sum(axis=1)) < 1e-9:
        assert_balanced(find_equilibrium(bearing, load), load)


@against(
    "third-party program",
    "SciPy: minimum of the energy",
    capability="bearing_life",
    module="facegear.bearings.equilibrium",
)
@pytest.mark.parametrize("name", ["P1", "P2", "P3", "tapered"])
def test_scipys_minimum_of_the_energy_is_the_same_motion(name):
    bearing = replace(ALL[name], clearance=5e-6)
    load = np.array([2500.0, -900.0, 0.0 if name == "P3" else 3000.0, 12.0, -7.0])
    scale = 1e-5 / ARMS

    def energy(scaled):
        answer = respond(bearing, (scaled * scale)[None])
        return answer.energy[0] - load @ (scaled * scale), (answer.force[0] - load) * scale

    found = minimize(energy, np.ones(5), jac=True, method="BFGS", options={"gtol": 1e-11, "maxiter": 2000})
    motion = find_equilibrium(bearing, load).motion
    counts = np.array([True, True, name != "P3", True, True])
    differences = (found.x * scale - motion) * ARMS * 1e6
    agrees("motion at the rings less SciPy's, um", differences[counts], 0.0, absolute=1e-3)


@settings(deadline=None)
@given(st.sampled_from(["P1", "P3"]), directions, sizes, st.floats(-3.0, 3.0))
def test_turning_load_and_cage_together_turns_the_motion(name, direction, size, angle):
    bearing = ALL[name]
    load = size * direction * ARMS * [1.0, 1.0, name == "P1", 0.2, 0.2]
    assume(np.hypot(*load[:2]) > 0.1 * size)
    turn = np.eye(5)
    turn[:2, :2] = turn[3:, 3:] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    here = find_equilibrium(bearing, load)
    there = find_equilibrium(replace(bearing, first_element=bearing.first_element + angle), turn @ load)
    assert there.hardest_load == pytest.approx(here.hardest_load, rel=1e-6)
    assert np.linalg.norm(there.motion[:2]) == pytest.approx(np.linalg.norm(here.motion[:2]), abs=1e-9)


@pytest.mark.parametrize("bearing", [P1, P2, P3, TAPERED, replace(P1, clearance=100e-6)])
def test_a_bearing_without_load_stays_where_it_is(bearing):
    state = find_equilibrium(bearing, np.zeros(5))
    assert not state.motion.any() and state.hardest_load == 0.0 and state.zone == 0.0
    assert state.static_safety == np.inf
    assert state.contact_angles == (bearing.contact_angle, bearing.contact_angle)


@pytest.mark.parametrize("bearing", [P1, P3])
def test_a_bearing_pressed_in_without_load_is_stiff_in_its_middle(bearing):
    state = find_equilibrium(replace(bearing, clearance=-10e-6), np.zeros(5))
    assert np.abs(state.motion).max() < 1e-12
    assert state.loaded_elements == bearing.elements and state.zone == pytest.approx(2 * np.pi)
    assert np.allclose(state.loads.element_inner, state.hardest_load)


def test_thrust_that_turns_round_passes_the_clearance_and_comes_out_mirrored():
    loose = replace(P1, clearance=40e-6)
    thrusts = np.array([2000.0, 200.0, 1e-3, 0.0, -1e-3, -200.0, -2000.0])
    motions, start = [], None
    for thrust in thrusts:
        state = find_equilibrium(loose, np.array([0.0, 0.0, thrust, 0.0, 0.0]), start)
        start = state.motion
        motions.append(state.motion[2])
    # A ball rolls up the grooves by half of the axial clearance before it is pressed.
    free = np.sqrt(loose.groove_distance**2 - loose.springs.rest_radial**2)
    assert motions[0] > motions[1] > motions[2] >= free - 1e-12
    assert np.allclose(np.array(motions[:3]), -np.array(motions[:3:-1]), rtol=0, atol=1e-11)
    # Nothing moves the loose ring, so that it stays where its balls let go.
    assert motions[3] == pytest.approx(free, abs=1e-8)


def test_a_preload_that_vanishes_leaves_the_stiffness_of_the_loaded_side():
    """Interference that falls through zero: the load zone shrinks, and the stiffness without jumps."""
    load = np.array([4000.0, 0.0, 0.0, 0.0, 0.0])
    clearances = np.linspace(-8e-6, 8e-6, 17)
    states = [find_equilibrium(replace(P3, clearance=clearance), load) for clearance in clearances]
    zones = np.array([state.zone for state in states])
    stiffness = np.array([state.stiffness[0, 0] for state in states])
    assert (np.diff(zones) <= 1e-9).all() and zones[0] > 1.3 * zones[-1]
    assert (np.abs(np.diff(stiffness)) < 0.12 * stiffness[0]).all() and stiffness[-1] < stiffness[0]


def test_a_clearance_that_the_load_does_not_cross_leaves_the_motion_across_open():
    """One ball carries: across it nothing holds the ring, and along the shaft its rolling alone."""
    state = find_equilibrium(replace(P1, clearance=200e-6), np.array([50.0, 0.0, 0.0, 0.0, 0.0]))
    assert state.loaded_elements == 1
    assert state.motion[1] == 0.0 and abs(state.stiffness[1, 1]) < 1e-9 * state.stiffness[0, 0]
    assert 0.0 < state.stiffness[2, 2] < 0.05 * state.stiffness[0, 0]


def test_loads_that_nothing_holds_are_refused_in_one_line():
    thrust = np.array([100.0, 0.0, 500.0, 0.0, 0.0])
    with pytest.raises(InvalidInput, match=r"thrust of a cylindrical roller bearing = 500\.0: must be 0 N"):
        find_equilibrium(P3, thrust)
    with pytest.raises(NotConverged, match="nothing holds them"):
        find_equilibrium(TAPERED, -thrust)
    for wrong in (np.array([0.0, 0.0, -500.0, 0.0, 0.0]), np.array([1000.0, 0.0, 0.0, 0.0, 0.0])):
        with pytest.raises((InvalidInput, NotConverged), match=r"thrust of an angular contact|nothing holds"):
            find_equilibrium(P2, wrong)


def test_the_search_ends_at_the_same_motion_from_any_start():
    chance = np.random.default_rng(4)
    load = CASES[7].load
    for _ in range(5):
        state = find_equilibrium(P2, load, chance.uniform(-1.0, 1.0, 5) * 2e-4)
        assert np.abs(state.motion - CASES[7].motion).max() < 5.1e-11


def test_centrifugal_force_moves_the_angles_of_inner_and_outer_contacts_apart():
    load = np.array([0.0, 0.0, 2000.0, 0.0, 0.0])
    slow, fast = (find_equilibrium(replace(P2, speed=speed), load) for speed in (0.0, 1500.0))
    assert slow.loads.inner_angle[0, 0] == pytest.approx(slow.loads.outer_angle[0, 0])
    assert fast.loads.inner_angle[0, 0] > slow.loads.inner_angle[0, 0] > fast.loads.outer_angle[0, 0]
    outer = fast.loads.outer[0, :, 0] * np.cos(fast.loads.outer_angle[0])
    inner = fast.loads.inner[0, :, 0] * np.cos(fast.loads.inner_angle[0])
    assert np.allclose(outer - inner, replace(P2, speed=1500.0).springs.centrifugal, rtol=1e-8)


def test_element_loads_of_an_equilibrium_balance_the_load():
    case = CASES[9]
    loads = element_loads(P3, find_equilibrium(P3, case.load).motion[None]).element_inner[0]
    balance = [loads @ np.cos(P3.angles), loads @ np.sin(P3.angles)]
    assert np.allclose(balance, case.load[:2], rtol=1e-12)
