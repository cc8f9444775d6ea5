"""Life of rolling bearings: public numbers, printed tables of ISO 281, limits and duty cycles."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees
from rolling_bearings import P1, P2, P3, TAPERED, public_cases

from facegear.bearings.elements import BallBearing, RollerBearing
from facegear.bearings.equilibrium import find_equilibrium
from facegear.bearings.equivalent_load import LARGE_ANGLES, equivalent_load
from facegear.bearings.life import (
    Lubrication,
    basic_life,
    edge_factors,
    life_factor,
    life_together,
    load_rating,
    rate_duty,
    reference_life,
    reference_load,
    sum_damage,
)
from facegear.bearings.response import element_loads
from facegear.errors import InvalidInput

CASES = public_cases()
RADIAL = np.array([1.0, 0.0, 0.0, 0.0, 0.0])


@against(
    "external source",
    "ISO 281, table of the factors f_c of ball bearings",
    capability="bearing_life",
    module="facegear.bearings.life",
)
@pytest.mark.parametrize(
    ("gamma", "factor"), [(0.05, 46.7), (0.10, 55.5), (0.14, 58.8), (0.20, 59.9), (0.30, 56.0), (0.40, 48.4)]
)
def test_factors_of_ball_bearings_are_those_of_the_printed_table(gamma, factor):
    """ISO 281, table 2; the last two as a public program prints them."""
    bearing = BallBearing(2, 10e-3, 10e-3 / gamma)
    size = 1.3 * 2 ** (2 / 3) * 10**1.8
    agrees("factor f_c", load_rating(bearing) / size, factor, absolute=0.0501)


@against(
    "external source",
    "ISO 281, table of the factors f_c of roller bearings",
    capability="bearing_life",
    module="facegear.bearings.life",
)
@pytest.mark.parametrize(("gamma", "factor"), [(0.05, 74.1), (0.10, 84.2), (0.14, 87.7), (0.20, 88.7)])
def test_factors_of_roller_bearings_are_those_of_the_printed_table(gamma, factor):
    bearing = RollerBearing(2, 10e-3, 10e-3 / gamma, effective_length=10e-3)
    size = 1.1 * 10 ** (7 / 9) * 2**0.75 * 10 ** (29 / 27)
    agrees("factor f_c", load_rating(bearing) / size, factor, absolute=0.0501)


@against(
    "second implementation",
    "public bearings: a program of its own",
    capability="bearing_life",
    module="facegear.bearings.life",
)
def test_load_ratings_of_public_bearings_have_their_printed_digits():
    ratings = [load_rating(bearing) for bearing in (P1, P2, P3)]
    agrees("load ratings, N", ratings, [35098.28, 31087.36, 70003.07], absolute=5.01e-3)


def test_balls_above_an_inch_grow_in_rating_more_slowly_without_a_jump():
    small, large = (load_rating(BallBearing(8, ball, 0.15)) for ball in (25.399e-3, 25.401e-3))
    assert large == pytest.approx(small, rel=2e-4)


@against(
    "second implementation",
    "public bearings: a program of its own",
    capability="bearing_life",
    module="facegear.bearings.life",
)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_reference_lives_of_public_loads_have_their_printed_digits(case):
    state = find_equilibrium(case.bearing, case.load)
    life = reference_life(case.bearing, state.loads)[0]
    agrees("reference life L10r, million turns", life, case.life, relative=4e-6)


@against(
    "analytic",
    "basic life of ISO 281",
    capability="bearing_life",
    module="facegear.bearings.life",
)
def test_reference_life_of_many_balls_without_clearance_is_the_basic_life():
    """Rounding of the standards' factors remains: 0.407 and 0.389 for 0.40681 and 0.38954."""
    bearing = replace(P1, elements=200, pitch_diameter=1.4, clearance=0.0)
    force = 0.01 * load_rating(bearing)
    reference = reference_life(bearing, find_equilibrium(bearing, force * RADIAL).loads)[0]
    agrees("L10r over L10", reference / basic_life(bearing, np.array(force)), 1.0, absolute=2e-3)


@pytest.mark.parametrize(("life", "load"), [(0.9925, 1.0025)])
def test_reference_life_of_ten_balls_is_that_of_the_notes(life, load):
    bearing = replace(P1, clearance=0.0)
    force = 0.01 * load_rating(bearing)
    state = find_equilibrium(bearing, force * RADIAL)
    reference = reference_life(bearing, state.loads)
    assert reference[0] / basic_life(bearing, force) == pytest.approx(life, abs=2e-4)
    assert reference_load(bearing, reference)[0] / force == pytest.approx(load, abs=1e-4)


@pytest.mark.parametrize(
    ("part", "share"), [(0.05, 0.692), (0.1, 0.687), (0.2, 0.703), (0.3, 0.723), (0.5, 0.773), (1.0, 0.920)]
)
def test_reference_load_of_rollers_over_the_radial_load_is_that_of_the_notes(part, share):
    bearing = replace(P3, clearance=0.0)
    force = part * load_rating(bearing)
    reference = reference_life(bearing, find_equilibrium(bearing, force * RADIAL).loads)
    assert reference_load(bearing, reference)[0] / force == pytest.approx(share, abs=5.01e-4)


@pytest.mark.parametrize(
    ("slices", "life"), [(11, 163.0), (21, 390.0), (31, 517.0), (41, 567.0), (81, 602.0), (161, 603.0)]
)
def test_life_of_tilted_rollers_depends_on_slices_as_in_the_notes(slices, life):
    bearing = replace(P3, slices=slices)
    assert reference_life(bearing, find_equilibrium(bearing, CASES[10].load).loads)[0] == pytest.approx(
        life, abs=0.51
    )


def test_edge_factors_are_one_in_the_middle_and_rise_to_both_edges_alike():
    factors = edge_factors(41)
    assert factors[20] == 1.0 and np.allclose(factors, factors[::-1], rtol=1e-14)
    assert (np.diff(factors[20:]) > 0.0).all()


@against(
    "third-party program",
    "commercial program, quoted by the repository minzhun/ISO16281",
    capability="bearing_life",
    module="facegear.bearings.life",
)
def test_a_commercial_programs_lives_of_a_ball_bearing():
    """Quoted by a public repository (minzhun/ISO16281), with its C of 23 400 N; its 1.48 makes 2e-4."""
    bearing = BallBearing(7, 11.5e-3, 43.5e-3, groove_ratio_outer=0.53, young=210e9)
    radial = reference_life(bearing, find_equilibrium(bearing, 1000.0 * RADIAL).loads, 23_400.0)[0]
    thrust = np.array([0.0, 0.0, 1000.0, 0.0, 0.0])
    axial = reference_life(bearing, find_equilibrium(bearing, thrust).loads, 23_400.0)[0]
    agrees("life under 1000 N across, million turns", radial, 13163.0, relative=1e-4)
    agrees("life under 1000 N along, million turns", axial, 2222.73, relative=1e-4)


def test_the_ring_that_stands_still_is_worn_on_one_side():
    """The turning ring's mean is the smaller one; under pure thrust it does not matter which ring turns."""
    radial = find_equilibrium(P1, 5000.0 * RADIAL).loads
    thrust = find_equilibrium(P1, np.array([0.0, 0.0, 5000.0, 0.0, 0.0])).loads
    assert reference_life(P1, radial, outer_turns=True)[0] < reference_life(P1, radial)[0]
    assert reference_life(P1, thrust, outer_turns=True)[0] == pytest.approx(reference_life(P1, thrust)[0])


def test_lives_fall_with_the_exponents_of_their_standard():
    for bearing, exponent in ((P1, 3.0), (P3, 10 / 3)):
        lives = basic_life(bearing, np.array([1000.0, 2000.0]))
        assert lives[0] / lives[1] == pytest.approx(2.0**exponent)


def test_equivalent_loads_of_pure_radial_loads_are_the_loads():
    force = np.array([[300.0, -400.0, 0.0, 1.0, 2.0]])
    for bearing in (P1, P2, P3, TAPERED):
        assert equivalent_load(bearing, force)[0] == pytest.approx(500.0)


@pytest.mark.parametrize(("degrees", "radial", "thrust", "limit"), LARGE_ANGLES)
def test_thrust_beyond_e_counts_by_the_printed_factors(degrees, limit, radial, thrust):
    bearing = replace(P2, contact_angle=np.radians(degrees))
    loads = np.array([[1000.0, 0.0, part * limit * 1000.0, 0.0, 0.0] for part in (0.99, 1.01, 3.0)])
    expected = [1000.0, *(1000.0 * (radial + thrust * part * limit) for part in (1.01, 3.0))]
    assert np.allclose(equivalent_load(bearing, loads), expected)


def test_equivalent_loads_do_not_jump_where_thrust_begins_to_count():
    """X + Y e is 1, as far as the two printed digits go."""
    for bearing in (P1, P2, TAPERED):
        radial = 2000.0
        thrusts = np.linspace(0.0, 4000.0, 4001)
        loads = np.stack([np.full(4001, radial), *(np.zeros(4001),), thrusts, *np.zeros((2, 4001))], axis=-1)
        assert np.abs(np.diff(equivalent_load(bearing, loads))).max() < 0.012 * radial


@pytest.mark.parametrize(
    ("degrees", "relative", "expected"),
    [
        (0.0, 1.03, 0.56 + 3.0 * 1.55),
        (10.0, 0.345, 0.46 + 3.0 * 1.71),
        (15.0, 0.345, 0.44 + 3.0 * 1.40),
        (15.0, 9.0, 0.44 + 3.0 * 1.00),
        (12.5, 0.345, 0.45 + 3.0 * 1.555),
        (17.5, 0.345, 0.435 + 3.0 * 1.20),
        (20.0, 0.345, 0.43 + 3.0 * 1.00),
    ],
)
def test_small_contact_angles_have_factors_that_depend_on_the_thrust(degrees, relative, expected):
    """They had no equivalent load. Values between rows and angles are those of linear interpolation."""
    bearing = replace(P2, contact_angle=np.radians(degrees))
    thrust = relative * bearing.elements * (1e3 * bearing.element_diameter) ** 2
    load = thrust / 3.0 * np.array([1.0, 0.0, 3.0, 0.0, 0.0])
    assert equivalent_load(bearing, load) == pytest.approx(expected * thrust / 3.0, rel=1e-12)


def test_bearings_beyond_the_tables_have_no_equivalent_load_under_thrust():
    bearing = replace(P2, contact_angle=np.radians(46.0))
    assert np.isnan(equivalent_load(bearing, np.array([1000.0, 0.0, 3000.0, 0.0, 0.0])))


@pytest.mark.parametrize("bearing", [P1, P3])
def test_the_life_factor_rises_with_film_and_cleanness_to_fifty(bearing):
    def factor(contamination=0.5, viscosity=1.0, limit=2000.0, load=5000.0):
        return float(life_factor(bearing, np.array(load), Lubrication(contamination, viscosity, limit)))

    assert factor(contamination=0.2) < factor() < factor(contamination=0.9)
    assert factor(viscosity=0.2) < factor(viscosity=0.5) < factor() < factor(viscosity=3.0)
    assert factor(viscosity=9.0) == factor(viscosity=4.0)
    assert factor(load=1e15) == pytest.approx(0.1, rel=0.01)
    assert factor(contamination=1.0, viscosity=4.0, load=100.0) == 50.0
    # Branches of the formula meet at their ends.
    for end in (0.4, 1.0):
        assert factor(viscosity=end - 1e-9) == pytest.approx(factor(viscosity=end), rel=2e-3)


def test_the_life_factor_by_hand():
    """ISO 281, equation (33): kappa 2, e_C C_u / P = 0.1."""
    lubrication = Lubrication(0.5, 2.0, 1000.0, reliability=99.0)
    film = 2.5671 - 1.9987 / 2.0**0.071739
    expected = 0.1 * (1.0 - film**0.83 * 0.1 ** (1 / 3)) ** -9.3
    assert life_factor(P1, np.array(5000.0), lubrication) == pytest.approx(0.25 * expected)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((0.0, 1.0, 100.0), "contamination factor"),
        ((1.5, 1.0, 100.0), "contamination factor"),
        ((0.5, 0.05, 100.0), "viscosity ratio"),
        ((0.5, 1.0, 0.0), "fatigue load limit"),
        ((0.5, 1.0, 100.0, 92.0), "reliability of bearings"),
    ],
)
def test_conditions_that_the_standard_does_not_know_are_refused(values, message):
    with pytest.raises(InvalidInput, match=message):
        Lubrication(*values)


def test_a_duty_cycle_sums_damage_and_an_unloaded_bin_does_none():
    loads = np.array([[5000.0, 0, 0, 0, 0], [2000.0, 0, 1000.0, 0, 0], [0.0, 0, 0, 0, 0]])
    motions = np.array([find_equilibrium(P1, load).motion for load in loads])
    turns, hours = np.array([60e3, 120e3, 60e3]), np.array([10.0, 30.0, 60.0])
    life = rate_duty(P1, loads, element_loads(P1, motions), turns, hours)
    assert life.basic[2] == life.reference[2] == np.inf
    for lives, total in ((life.basic, life.basic_hours), (life.reference, life.reference_hours)):
        single = 1e6 * lives / turns
        assert total == pytest.approx(100.0 / (10.0 / single[0] + 30.0 / single[1]))
    assert np.isnan(life.modified_reference).all() and np.isnan(life.modified_hours)
    lubricated = rate_duty(
        P1, loads, element_loads(P1, motions), turns, hours, lubrication=Lubrication(0.5, 2.0, 900.0)
    )
    assert (lubricated.modified_reference[:2] != life.reference[:2]).all() and lubricated.modified_hours > 0.0


def test_a_bin_that_is_repeated_or_cut_in_two_changes_nothing():
    lives, turns, hours = np.array([100.0, 30.0]), np.array([1e5, 2e5]), np.array([3.0, 1.0])
    whole = sum_damage(lives, turns, hours)
    assert sum_damage(np.repeat(lives, 2), np.repeat(turns, 2), np.repeat(hours / 2, 2)) == pytest.approx(
        whole
    )
    assert sum_damage(lives, turns, 7.0 * hours) == pytest.approx(whole)
    assert sum_damage(lives, -turns, hours) == pytest.approx(whole)


@given(st.lists(st.floats(1.0, 1e6), min_size=1, max_size=8))
def test_equal_bearings_together_live_by_the_closed_form(lives):
    for bearing, slope in ((P1, 10 / 9), (P3, 9 / 8)):
        expected = sum(life**-slope for life in lives) ** (-1 / slope)
        assert life_together([bearing] * len(lives), lives) == pytest.approx(expected, rel=1e-9)


@given(st.floats(1.0, 1e6), st.floats(1.0, 1e6))
def test_balls_and_rollers_together_live_shorter_than_either(first, second):
    together = life_together([P1, P3], [first, second])
    assert (together / first) ** (10 / 9) + (together / second) ** (9 / 8) == pytest.approx(1.0, rel=1e-9)
    assert together < min(first, second)


def test_bearings_without_load_do_not_count():
    assert life_together([P1, P3], [50.0, np.inf]) == pytest.approx(50.0)
    assert life_together([P1], [np.inf]) == np.inf
    assert np.isnan(life_together([P1], [np.nan]))
