"""Motion on tables of forces: free and forced, with contact kept and lost, against exact answers.

The exact answers are those of the formulas that the tables are made from: closed forms by quadrature to 12
digits, forced orbits by Taylor series of high order, confirmed by DOP853 with located events.
"""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import power_table, two_pairs
from oscillators import one_degree

from facegear.dynamics.branches.continuation import ContinuationSettings, branch_at
from facegear.dynamics.branches.family import Family
from facegear.dynamics.branches.period_map import PeriodMap
from facegear.dynamics.branches.points import at_parameter
from facegear.dynamics.branches.special import Kind
from facegear.dynamics.integrator.integrator import Integrator
from facegear.dynamics.motion import State
from facegear.dynamics.steady_state.orbits import monodromy
from facegear.mesh_law.load_dependent import load_dependent_law


def oscillator(table, damping=0.0, amplitude=0.0, mean=1.0, lower=-np.inf, upper=0.0):
    """x'' + 2 z x' + F(phase, x) = mean + Fa cos W t."""
    load = ((0.0, 0.0), (mean, amplitude))
    system = one_degree(2.0 * damping, load=load, lower=lower, upper=upper)
    return replace(system, law=load_dependent_law([table]))


def closing_error(table, start, period, least):
    """How far a free motion from rest at `start` is from there after a period, or its lowest point is off."""
    integrator = Integrator(oscillator(table), 2.0 * np.pi / period, 1e-14)
    state = np.array([[start], [0.0]])
    run = integrator.run(state, 1, batches=1)
    return max(np.abs(run.state - state).max(), abs(run.sums.lowest[0] - least))


@pytest.mark.parametrize(
    ("start", "period", "least"),
    [
        (1.5, 5.1936418419845, 0.45296577331444),
        (1.60460120203, 5.229541362450, 0.32387905595),
        (2.0, 5.6280728407732, -0.26274169979695),  # leaves contact
    ],
)
def test_free_motions_converge_to_the_closed_form_with_the_fourth_power_of_the_number_of_levels(
    start, period, least
):
    errors = np.array([closing_error(power_table(n), start, period, least) for n in (100, 200, 400, 800)])
    assert errors[-1] < 2e-10
    assert (errors[:-1] > 6.0 * errors[1:]).all()
    assert errors[0] > 500.0 * errors[-1]


def test_a_body_between_two_flanks_swings_with_the_period_of_the_closed_form():
    """Law x^1.5 on both sides of a gap of +-0.3, speed 0.8 in it."""
    system = oscillator(power_table(800), mean=0.0, lower=-0.3, upper=0.3)
    state = np.array([[0.0], [0.8 * 8.2298730550201 / (2.0 * np.pi)]])
    run = Integrator(system, 2.0 * np.pi / 8.2298730550201, 1e-14).run(state, 1, batches=1)
    np.testing.assert_allclose(run.state, state, rtol=0, atol=1e-9)
    assert run.sums.highest[0] == pytest.approx(0.3 + 0.91461010385465, abs=1e-9)
    assert run.sums.lowest[0] == pytest.approx(-0.3 - 0.91461010385465, abs=1e-9)
    open_share = 4.0 * 0.3 / 0.8 / 8.2298730550201
    assert run.fractions[:, 0] == pytest.approx([open_share, *2 * [0.5 - 0.5 * open_share]], abs=1e-9)


def test_the_motion_keeps_its_order_where_it_passes_levels_of_the_table():
    """Levels that were not located would leave jumps in the motion's fourth derivative inside the steps."""
    system, state = oscillator(power_table(12, 0.2, 0.05)), np.array([[2.0], [0.0]])
    exact = Integrator(system, 1.1, 1e-15).run(state, 2).state
    rows = []
    for tolerance in 10.0 ** -np.arange(6.0, 11.0):
        run = Integrator(system, 1.1, tolerance, 9).run(state, 2)
        rows.append((tolerance, np.abs(run.state - exact).max()))
    tolerances, errors = np.array(rows).T
    assert (errors < 50.0 * tolerances).all()


def period_map(table, damping, amplitude=0.0, tolerance=1e-12, mean=1.0):
    system = oscillator(table, damping, amplitude, mean)
    return PeriodMap(Family("W", lambda speed: (system, speed)), 1, tolerance)


def orbit(flow_, speed, place, rate):
    u = float(np.log(speed))
    return at_parameter(flow_, flow_.weighted(State(np.array([place]), np.array([rate])), u), u)


def off(flow_, found, place, rate):
    state = flow_.state(found.z, found.u)
    return max(abs(state.displacement[0] - place), abs(state.velocity[0] - rate))


def test_an_unstable_orbit_on_a_table_has_place_and_multipliers_of_the_power_law():
    """Damping .02, load 1 + .1 cos W t, W 1.1; contact is lost."""
    flow_ = period_map(power_table(1000), 0.02, 0.1)
    found = orbit(flow_, 1.1, 1.79379722656, 0.68475098448)
    assert off(flow_, found, 1.79379722656, 0.68475098448) < 1e-9
    np.testing.assert_allclose(np.sort(found.multipliers.real), [0.51611544, 1.54179196], rtol=0, atol=2e-8)
    assert found.multipliers.prod().real == pytest.approx(np.exp(-0.04 * 2 * np.pi / 1.1), rel=1e-9)


def test_branches_on_a_table_fold_where_the_power_law_does():
    """Damping .02, load 1 + .1 cos W t: the upper fold keeps contact, the lower one has lost it."""
    flow_ = period_map(power_table(300), 0.02, 0.1, 1e-11)
    branch = branch_at(flow_, np.array([1.2, 0.0]), 1.0, ContinuationSettings(0.8, 1.2))
    folds = sorted(special.point.value for special in branch.of(Kind.FOLD))
    assert folds == pytest.approx([0.81612741138, 1.13889845103], abs=1e-6)


def test_a_parametric_table_doubles_its_period_where_the_power_law_does():
    """Damping .03, depth .25, no other load."""
    for speed in (2.28318159363, 2.60138748211):
        found = orbit(period_map(power_table(300, 0.25), 0.03), speed, 1.0, 0.0)
        assert found.multipliers.real.min() == pytest.approx(-1.0, abs=1e-6)


@pytest.mark.parametrize(
    ("exponent", "speed", "place", "rate", "multiplier", "errors"),
    [
        (1.5, 0.8, 0.225049594966, -0.024427649766, -0.32846400 + 0.71856790j, (1e-6, 1e-4)),
        (1.5, 1.3, 0.779768783813, -0.030364658620, -0.49906886 + 0.70654013j, (2e-6, 4e-4)),
        (1.0, 0.8, -0.45595237096, -0.17884962094, 2.23132244, (1e-5, 4e-4)),
    ],
)
def test_two_pairs_that_take_over_from_each_other_are_met_as_well_as_their_corners_are_resolved(
    exponent, speed, place, rate, multiplier, errors
):
    """Their kinks move through the levels with the phase, so that convergence is slow: what a table of 192
    levels and 48 orders was measured to reach, and that a coarser one is far worse.
    """
    found = []
    for levels, orders in ((12, 12), (192, 48)):
        flow_ = period_map(two_pairs(levels, orders, exponent), 0.03, tolerance=1e-11, mean=0.3)
        point = orbit(flow_, speed, place, rate)
        found.append((off(flow_, point, place, rate), np.abs(point.multipliers - multiplier).min()))
    assert (np.array(found[1]) < errors).all()
    assert (np.array(found[0]) > 10.0 * np.array(found[1])).all()


def test_tangents_of_a_table_are_differences_of_its_motions():
    """Liouville's theorem alone is blind to the slopes."""
    integrator = Integrator(oscillator(power_table(8, 0.3, 0.1), 0.02, 0.1), 1.1, 1e-14)
    start = np.array([[2.2], [0.1]])
    matrix, run = monodromy(integrator, start, 1)
    assert 0.0 < run.fractions[0, 0] < 1.0
    assert np.linalg.det(matrix) == pytest.approx(np.exp(run.divergence), rel=1e-11)
    for column in range(2):
        shift = np.zeros((2, 1))
        shift[column] = 1e-5
        ends = [integrator.run(start + sign * shift, 1, fine=True).state for sign in (1.0, -1.0)]
        np.testing.assert_allclose(matrix[:, column], (ends[0] - ends[1]).ravel() / 2e-5, atol=1e-7)


def test_a_free_motion_keeps_its_energy_through_all_levels():
    """The force of a table at a fixed phase has a potential: its cubics, integrated."""
    table = power_table(12, first=0.05)
    law = load_dependent_law([table])
    integrator = Integrator(oscillator(table), 1.0, 1e-14)

    def energy(state):
        x, w = np.linspace(0.0, max(state[0, 0], 0.0), 200_001), 1.0
        force = law.force(np.zeros(x.size), x[:, None])[:, 0]
        return 0.5 * (w * state[1, 0]) ** 2 + np.trapezoid(force, x) - state[0, 0]

    run = integrator.run(np.array([[2.5], [0.0]]), 5)
    energies = [energy(state[:, None] if state.ndim == 1 else state) for state in run.ends]
    assert energies == pytest.approx([energy(np.array([[2.5], [0.0]]))] * 5, abs=1e-9)
