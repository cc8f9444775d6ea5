"""Energy, force and stiffness of rolling bearings: public numbers, derivatives, a second program."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from rolling_bearings import ALL, P1, P2, P3, TAPERED, SlowBearing, public_cases

from facegear.bearings.elements import BallBearing, RollerBearing
from facegear.bearings.response import element_loads, largest_pressures, load_zone, respond
from facegear.errors import InvalidInput, NotConverged

CASES = public_cases()
SCALE = np.array([1.0, 1.0, 1.0, 0.03, 0.03])
"""Arm, m, at which moments and tilts are compared with forces and shifts."""
motions = st.tuples(*[st.floats(-1.0, 1.0)] * 5).map(
    lambda values: np.array(values) * [80e-6, 80e-6, 60e-6, 2e-3, 2e-3]
)
bearings = st.sampled_from(sorted(ALL))


def relative_error(computed, expected, scale=1.0):
    size = np.abs(expected * scale).max()
    return np.abs((computed - expected) * scale).max() / size


def test_hertzian_constants_of_the_public_bearings_have_their_printed_digits():
    inner, outer = P1.contacts
    assert np.allclose([inner.axis_ratio, outer.axis_ratio], [9.188766, 7.347835], rtol=0, atol=5e-7)
    constants = np.array([P1.springs.stiffness, inner.stiffness, outer.stiffness]) / 10**4.5
    assert np.allclose(constants, [370528.4, 1021540.4, 1075648.3], rtol=0, atol=0.05)
    assert np.allclose([one.axis_ratio for one in P2.contacts], [8.994243, 5.879903], rtol=0, atol=5e-7)
    assert P2.springs.stiffness / 10**4.5 == pytest.approx(335260.5, abs=0.05)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_public_motions_carry_their_loads(case):
    """Motions are printed to 5e-11 m and rad, which times the stiffness is the error of the force."""
    force = respond(case.bearing, case.motion[None]).force[0]
    allowed = np.abs(case.stiffness) @ np.full(5, 5e-11) * 1.01 + 1e-9
    assert (np.abs(force - case.load) <= allowed).all()


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_loaded_elements_and_zone_at_public_motions(case):
    """Printed zones are counted in tenths of a degree."""
    loads = element_loads(case.bearing, case.motion[None])
    assert loads.is_loaded.sum() == case.count
    assert load_zone(case.bearing, case.motion) == pytest.approx(case.zone, abs=np.radians(0.1))


def test_the_zone_of_a_radial_load_is_that_of_its_closed_form():
    for bearing, middle in ((P1, 0.0), (replace(P3, slices=2001), 0.0)):
        x = 35e-6
        expected = 2.0 * np.arccos((0.5 * bearing.clearance + middle) / x)
        assert load_zone(bearing, np.array([x, 0.0, 0.0, 0.0, 0.0])) == pytest.approx(expected, abs=1e-6)


@settings(deadline=None)
@given(bearings, motions)
def test_force_is_the_gradient_of_the_energy_and_stiffness_that_of_the_force(name, motion):
    """Central differences of the fourth order; elements that only just touch are left out."""
    bearing = ALL[name]
    loads = element_loads(bearing, motion[None]).element_inner[0]
    assume(loads.max() > 1.0)
    step = 1e-9
    moves = np.concatenate([factor * step * np.eye(5) / SCALE[:, None] for factor in (-2, -1, 1, 2)])
    nearby = element_loads(bearing, motion + np.concatenate([np.zeros((1, 5)), 20.0 * moves]))
    for touching in (nearby.inner > 0.0, nearby.outer > 0.0):
        assume((touching == touching[0]).all())
    here, around = respond(bearing, motion[None]), respond(bearing, motion + moves)
    weights = np.array([1.0, -8.0, 8.0, -1.0]) / (12.0 * step)
    slope = np.einsum("k,ki->i", weights, around.energy.reshape(4, 5)) * SCALE
    force, stiffness = here.force[0], here.stiffness[0]
    assert np.allclose(slope / SCALE, force / SCALE, rtol=0, atol=1e-7 * np.abs(force / SCALE).max())
    turned = np.einsum("k,kij->ij", weights, around.force.reshape(4, 5, 5)) * SCALE[:, None]
    scaled = stiffness / np.outer(SCALE, SCALE)
    assert np.allclose(turned / np.outer(SCALE, SCALE), scaled, rtol=0, atol=2e-6 * np.abs(scaled).max())


@settings(deadline=None)
@given(bearings, motions)
def test_stiffness_is_symmetric_and_never_negative(name, motion):
    stiffness = respond(ALL[name], motion[None]).stiffness[0] / np.outer(SCALE, SCALE)
    largest = np.abs(stiffness).max()
    assert np.abs(stiffness - stiffness.T).max() <= 1e-14 * largest
    assert np.linalg.eigvalsh(stiffness).min() >= -1e-12 * largest


@settings(deadline=None)
@given(st.sampled_from(["P1", "P2", "P3", "tapered", "mirrored"]), motions)
def test_a_second_program_gives_the_same_energy_and_force(name, motion):
    slow, fast = SlowBearing(ALL[name]), respond(ALL[name], motion[None])
    in_mm = motion * [1e3, 1e3, 1e3, 1.0, 1.0]
    energy = slow.energy(in_mm)
    assert fast.energy[0] == pytest.approx(1e-3 * energy, rel=1e-10, abs=1e-16)
    force = slow.force(in_mm) / [1, 1, 1, 1e3, 1e3]
    size = np.abs(force / SCALE).max()
    assert np.abs((fast.force[0] - force) / SCALE).max() <= 1e-10 * size + 1e-9


@pytest.mark.parametrize("name", ["thrown P1", "thrown P2", "thrown P3", "thrown tapered"])
def test_a_second_program_gives_the_same_energy_under_centrifugal_force(name):
    slow, chance = SlowBearing(ALL[name]), np.random.default_rng(5)
    drawn = chance.uniform(-1.0, 1.0, (6, 5)) * [60e-6, 60e-6, 30e-6, 1e-3, 1e-3]
    fast = respond(ALL[name], drawn).energy
    energies = [1e-3 * slow.energy(motion * [1e3, 1e3, 1e3, 1.0, 1.0]) for motion in drawn]
    assert np.allclose(fast, energies, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("name", ["P1", "P2", "P3", "tapered"])
def test_centrifugal_force_vanishes_with_the_square_of_the_speed(name):
    motion = np.array([[40e-6, 10e-6, 15e-6, 5e-4, -4e-4]])
    at_rest = respond(ALL[name], motion)
    errors = [
        relative_error(respond(replace(ALL[name], speed=speed), motion).force, at_rest.force)
        for speed in (2.0, 1.0)
    ]
    assert errors[0] < 1e-3
    assert errors[1] <= 0.3 * errors[0] + 1e-12


@pytest.mark.parametrize("bearing", [replace(P1, speed=1500.0), replace(P3, speed=1500.0)])
def test_an_element_that_leaves_the_inner_ring_presses_the_outer_one_by_its_force_alone(bearing):
    loads = element_loads(bearing, np.zeros((1, 5)))
    assert (loads.inner == 0.0).all()
    assert np.allclose(loads.outer.sum(axis=-1), bearing.springs.centrifugal, rtol=1e-12)
    response = respond(bearing, np.zeros((1, 5)))
    assert not response.force.any() and abs(response.energy[0]) < 1e-12


@settings(deadline=None)
@given(bearings, motions, st.floats(-4.0, 4.0))
def test_turning_motion_and_cage_together_turns_the_force(name, motion, angle):
    bearing = ALL[name]
    turned = replace(bearing, first_element=bearing.first_element + angle)
    turn = np.eye(5)
    cosine, sine = np.cos(angle), np.sin(angle)
    turn[:2, :2] = turn[3:, 3:] = [[cosine, -sine], [sine, cosine]]
    here, there = respond(bearing, motion[None]), respond(turned, (turn @ motion)[None])
    size = np.abs(here.force[0] / SCALE).max() + 1.0
    assert np.abs((there.force[0] - turn @ here.force[0]) / SCALE).max() <= 1e-9 * size
    assert there.energy[0] == pytest.approx(here.energy[0], rel=1e-9, abs=1e-13)


@settings(deadline=None)
@given(bearings, motions)
def test_mirroring_z_mirrors_thrust(name, motion):
    """In the mirror z and tilts change sign."""
    mirror = np.array([1.0, 1.0, -1.0, -1.0, -1.0])
    bearing = ALL[name]
    seen = replace(bearing, direction=-bearing.direction)
    here, there = respond(bearing, motion[None]), respond(seen, (mirror * motion)[None])
    size = np.abs(here.force[0] / SCALE).max() + 1.0
    assert np.abs((there.force[0] - mirror * here.force[0]) / SCALE).max() <= 1e-10 * size


def test_ball_bearing_without_clearance_is_an_angular_contact_bearing_without_angle():
    plain = replace(P1, clearance=0.0)
    motion = np.array([[20e-6, 5e-6, 60e-6, 3e-4, 1e-3]])
    near = respond(replace(plain, contact_angle=1e-9), motion).force
    assert relative_error(near, respond(plain, motion).force) < 1e-6


def test_pressures_below_the_hardest_ball_have_their_printed_digits():
    case = CASES[0]
    pressures = largest_pressures(P1, element_loads(P1, case.motion[None]))[0] / 1e6
    # The motion is printed to 1.2e-6 of itself, and the pressure goes with its square root.
    assert np.allclose(pressures, [2466.39, 2087.92], rtol=3e-6)
    angle = element_loads(P2, CASES[7].motion[None])
    hardest = angle.element_inner[0].argmax()
    assert np.degrees(angle.inner_angle[0, hardest]) == pytest.approx(22.2522, abs=5e-4)
    slices = element_loads(P3, CASES[10].motion[None]).inner[0]
    assert slices.max() * P3.slices / 11.2 == pytest.approx(492.263, rel=1e-5)


def test_pure_thrust_has_the_stiffness_of_closed_form():
    """Leaving out the part across the contact is the usual error of a stiffness made by hand."""
    motion = np.array([[0.0, 0.0, 21e-6, 0.0, 0.0]])
    springs, loads = P2.springs, element_loads(P2, motion)
    load, angle = loads.inner[0, 0, 0], loads.inner_angle[0, 0]
    length = np.hypot(springs.rest_radial, springs.rest_axial + 21e-6)
    along = 1.5 * springs.stiffness ** (2 / 3) * load ** (1 / 3)
    across = load / length
    normal, tangent = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    lever = np.array([springs.height, -springs.arm])
    blocks = along * np.outer(normal, normal) + across * np.outer(tangent, tangent)
    half = P2.elements / 2
    stiffness = respond(P2, motion).stiffness[0]
    assert stiffness[0, 0] == pytest.approx(half * blocks[0, 0], rel=1e-12)
    assert stiffness[2, 2] == pytest.approx(2 * half * blocks[1, 1], rel=1e-12)
    assert stiffness[4, 4] == pytest.approx(half * lever @ blocks @ lever, rel=1e-12)
    assert stiffness[0, 4] == pytest.approx(half * blocks[0] @ lever, rel=1e-12)


@pytest.mark.parametrize("ratio", [0.3, 1.5])
def test_many_tapered_rollers_carry_the_integrals_of_sjovall(ratio):
    """Rings that do not tilt carry forces by the extent of the load zone."""
    count, exponent = 1000, 10 / 9
    bearing = RollerBearing(
        *(count, 1e-4, 62e-3), contact_angle=0.25, effective_length=1e-4, slices=2, has_profile=False
    )
    x = 20e-6
    z = x * (2 * ratio - 1) / np.tan(0.25)
    force = respond(bearing, np.array([[x, 0.0, z, 0.0, 0.0]])).force[0]
    largest = element_loads(bearing, np.array([[x, 0.0, z, 0.0, 0.0]])).element_inner.max()
    angle = np.linspace(-np.pi, np.pi, 2_000_001)[:-1]
    shares = np.maximum(1 - (1 - np.cos(angle)) / (2 * ratio), 0.0) ** exponent
    radial, axial = np.mean(shares * np.cos(angle)), np.mean(shares)
    assert force[0] == pytest.approx(count * largest * np.cos(0.25) * radial, rel=5e-6)
    assert force[2] == pytest.approx(count * largest * np.sin(0.25) * axial, rel=5e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"elements": 1}, "number of rolling elements = 1"),
        ({"elements": 30}, "pitch diameter of a bearing"),
        ({"contact_angle": 1.6}, "contact angle"),
        ({"direction": 0}, "direction of a bearing's thrust"),
        ({"element_diameter": 0.0}, "element diameter"),
        ({"clearance": 1.1e-3}, "clearance of a ball bearing"),
        ({"groove_ratio_inner": 0.5}, "groove ratio inner"),
    ],
)
def test_a_bearing_that_cannot_be_is_refused_in_one_line(change, message):
    with pytest.raises(InvalidInput, match=message):
        replace(P1, **change)


@pytest.mark.parametrize(
    ("change", "message"), [({"effective_length": 0.0}, "effective length"), ({"slices": 1}, "slices")]
)
def test_rollers_that_cannot_be_are_refused_in_one_line(change, message):
    with pytest.raises(InvalidInput, match=message):
        replace(TAPERED, **change)


@pytest.mark.parametrize("bearing", [P1, P2, P3, TAPERED])
def test_a_motion_that_is_no_number_gives_none(bearing):
    motion = np.full((1, 5), np.nan)
    assert np.isnan(respond(bearing, motion).force).all()
    with pytest.raises(NotConverged, match="rolling elements"):
        respond(replace(bearing, speed=100.0), motion)


def test_many_motions_are_answered_as_one_by_one():
    chance = np.random.default_rng(1)
    drawn = chance.uniform(-1.0, 1.0, (20, 5)) * 5e-5
    for bearing in (P1, P3, BallBearing(9, 8e-3, 40e-3, speed=2000.0)):
        together = respond(bearing, drawn)
        for number, motion in enumerate(drawn):
            alone = respond(bearing, motion[None])
            assert np.array_equal(together.force[number], alone.force[0])
            assert np.array_equal(together.stiffness[number], alone.stiffness[0])
