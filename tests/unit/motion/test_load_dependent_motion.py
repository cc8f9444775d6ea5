"""Motion on tables of forces: free and forced, with contact kept and lost, against exact answers.

The exact answers are those of the formulas that the tables are made from: closed forms by quadrature to 12
digits, forced orbits by Taylor series of high order, confirmed by DOP853 with located events.
"""

from dataclasses import replace

import numpy as np
import pytest
from force_tables import power_table, two_pairs
from law_oscillators import closing_error, law_period_map, orbit, oscillator
from references import against, agrees
from scipy.integrate import simpson
from scipy.interpolate import CubicHermiteSpline
from whole_branches import branch_at

from facegear.meshing.load_dependent import load_dependent_law
from facegear.motion.branches.continuation import ContinuationSettings
from facegear.motion.branches.family import Family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.special import Kind
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.steady_state.orbits import monodromy


@against(
    "analytic",
    "period of an oscillator with a power law",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
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
    errors = np.array([closing_error(power_table_law(n), start, period, least) for n in (100, 200, 400, 800)])
    agrees("distance from the start after a period", errors[-1], 0.0, absolute=2e-10)
    assert (errors[:-1] > 6.0 * errors[1:]).all()
    assert errors[0] > 500.0 * errors[-1]


@against(
    "analytic",
    "period of an oscillator between two flanks",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_a_body_between_two_flanks_swings_with_the_period_of_the_closed_form():
    """Law x^1.5 on both sides of a gap of +-0.3, speed 0.8 in it."""
    system = oscillator(power_table_law(800), mean=0.0, lower=-0.3, upper=0.3)
    state = np.array([[0.0], [0.8 * 8.2298730550201 / (2.0 * np.pi)]])
    run = Integrator(system, 2.0 * np.pi / 8.2298730550201, 1e-14).run(state, 1, batches=1)
    agrees("distance from the start after a period", run.state, state, absolute=1e-9)
    agrees("largest displacement", run.sums.maximum[0], 0.3 + 0.91461010385465, absolute=1e-9)
    agrees("smallest displacement", run.sums.minimum[0], -0.3 - 0.91461010385465, absolute=1e-9)
    open_fraction = 4.0 * 0.3 / 0.8 / 8.2298730550201
    agrees(
        "fractions of the time on the flanks",
        run.fractions[:, 0],
        [open_fraction, *2 * [0.5 - 0.5 * open_fraction]],
        absolute=1e-9,
    )


def test_the_motion_keeps_its_order_where_it_passes_levels_of_the_table():
    """Levels that were not located would leave jumps in the motion's fourth derivative inside the steps."""
    system, state = oscillator(power_table_law(12, 0.2, 0.05)), np.array([[2.0], [0.0]])
    exact = Integrator(system, 1.1, 1e-15).run(state, 2).state
    rows = []
    for tolerance in 10.0 ** -np.arange(6.0, 11.0):
        run = Integrator(system, 1.1, tolerance, 9).run(state, 2)
        rows.append((tolerance, np.abs(run.state - exact).max()))
    tolerances, errors = np.array(rows).T
    assert (errors < 50.0 * tolerances).all()


def power_table_law(*args, **kwargs):
    return load_dependent_law([power_table(*args, **kwargs)])


def two_pairs_law(*args):
    return load_dependent_law([two_pairs(*args)])


def off(period_map, found, place, rate):
    state = period_map.state(found.z, found.u)
    return max(abs(state.displacement[0] - place), abs(state.velocity[0] - rate))


@against(
    "second implementation",
    "power law of force: Taylor series of high order",
    capability="branches",
    module="facegear.motion.branches.points",
)
def test_an_unstable_orbit_on_a_table_has_place_and_multipliers_of_the_power_law():
    """Damping .02, load 1 + .1 cos W t, W 1.1; contact is lost."""
    period_map = law_period_map(power_table_law(1000), 0.02, 0.1)
    found = orbit(period_map, 1.1, 1.79379722656, 0.68475098448)
    agrees(
        "distance from the orbit", off(period_map, found, 1.79379722656, 0.68475098448), 0.0, absolute=1e-9
    )
    agrees(
        "multipliers of the unstable orbit",
        np.sort(found.multipliers.real),
        [0.51611544, 1.54179196],
        absolute=2e-8,
    )
    agrees(
        "product of the multipliers",
        found.multipliers.prod().real,
        np.exp(-0.04 * 2 * np.pi / 1.1),
        relative=1e-9,
    )


@against(
    "second implementation",
    "power law of force: Taylor series of high order",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_branches_on_a_table_fold_where_the_power_law_does():
    """Damping .02, load 1 + .1 cos W t: the upper fold keeps contact, the lower one has lost it."""
    period_map = law_period_map(power_table_law(300), 0.02, 0.1, 1e-11)
    branch = branch_at(period_map, np.array([1.2, 0.0]), 1.0, ContinuationSettings(0.8, 1.2))
    folds = sorted(special.point.value for special in branch.of(Kind.FOLD))
    agrees("speed of a fold", folds, [0.81612741138, 1.13889845103], absolute=1e-6)


def test_a_parametric_table_doubles_its_period_where_the_power_law_does():
    """Damping .03, depth .25, no other load."""
    for speed in (2.28318159363, 2.60138748211):
        found = orbit(law_period_map(power_table_law(300, 0.25), 0.03), speed, 1.0, 0.0)
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
        period_map = law_period_map(two_pairs_law(levels, orders, exponent), 0.03, tolerance=1e-11, mean=0.3)
        point = orbit(period_map, speed, place, rate)
        found.append((off(period_map, point, place, rate), np.abs(point.multipliers - multiplier).min()))
    assert (np.array(found[1]) < errors).all()
    assert (np.array(found[0]) > 10.0 * np.array(found[1])).all()


@against(
    "second implementation",
    "central differences of the motion; Liouville's formula",
    capability="branches",
    module="facegear.motion.integrator.integrator",
)
def test_tangents_of_a_table_are_differences_of_its_motions():
    """Liouville's theorem alone is blind to the slopes."""
    integrator = Integrator(oscillator(power_table_law(8, 0.3, 0.1), 0.02, 0.1), 1.1, 1e-14)
    start = np.array([[2.2], [0.1]])
    matrix, run = monodromy(integrator, start, 1)
    assert 0.0 < run.fractions[0, 0] < 1.0
    agrees("determinant of the tangents", np.linalg.det(matrix), np.exp(run.divergence), relative=1e-11)
    for column in range(2):
        shift = np.zeros((2, 1))
        shift[column] = 1e-5
        ends = [integrator.run(start + sign * shift, 1, fine=True).state for sign in (1.0, -1.0)]
        agrees(
            "column of the tangents",
            matrix[:, column],
            (ends[0] - ends[1]).ravel() / 2e-5,
            relative=1e-7,
            absolute=1e-7,
        )


def potential_of(table):
    """Integral of the mean force over the deflection."""
    forces, slopes = table.forces[:, 1, 0], table.slopes[:, 1, 0]
    return CubicHermiteSpline(table.levels, forces, slopes).antiderivative()


@against(
    "analytic",
    "conservation of energy",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_a_free_motion_keeps_its_energy_through_all_levels():
    """The force of a table at a fixed phase has a potential: its cubics, integrated."""
    potential = potential_of(power_table(12, first=0.05))
    integrator = Integrator(oscillator(power_table_law(12, first=0.05)), 1.0, 1e-14)
    start = np.array([[2.5], [0.0]])
    ends = np.concatenate([start[None], integrator.run(start, 5).ends])[..., 0]
    energies = 0.5 * ends[:, 1] ** 2 + potential(np.maximum(ends[:, 0], 0.0)) - ends[:, 0]
    agrees("energy", energies, energies[0], absolute=1e-12)


def test_the_work_of_the_moving_phase_closes_the_balance_of_energy():
    """Kinetic energy and potential change by the work of the load and by that of the phase: the derivative of
    the potential by the phase at a fixed place. Contact is lost; nothing damps.
    """
    depth, speed, periods, table = 0.2, 1.1, 3, power_table(12, first=0.05)
    integrator = Integrator(oscillator(power_table_law(12, depth, 0.05), 0.0, 0.1), speed, 1e-14)
    start = np.array([[2.2], [0.1]])
    run = integrator.run(start, periods, samples=4000)
    place = np.append(run.samples[:, 0], run.state[0, 0])
    phases = 2.0 * np.pi * np.arange(place.size) / 4000
    assert place.min() < 0.0
    assert place.max() < table.levels[-1]
    potential = potential_of(table)(np.maximum(place, 0.0))
    load = (1.0 + 0.1 * np.cos(phases)) * place
    of_load = load[-1] - load[0] + simpson(0.1 * np.sin(phases) * place, x=phases)
    of_phase = simpson(-depth * np.sin(phases) * potential, x=phases)
    energies = 0.5 * (speed * np.array([start[1, 0], run.state[1, 0]])) ** 2 + 1.2 * potential[[0, -1]]
    assert energies[1] - energies[0] == pytest.approx(of_load + of_phase, abs=1e-10)
    assert abs(of_phase) > 1e-2


@pytest.mark.parametrize("load", [0.3, 0.55, 1.0])
def test_a_slow_motion_follows_the_transmission_error_under_its_load_the_nearer_the_slower(load):
    """The rest is the damper's, which is proportional to the speed."""
    law = power_table_law(200, 0.2, 1e-3)
    resting = (load / (1.0 + 0.2 * np.cos(2.0 * np.pi * np.arange(64) / 64))) ** (2.0 / 3.0)
    errors = []
    for speed in (0.02, 0.01):
        period_map = law_period_map(law, 0.02, mean=load)
        point = orbit(period_map, speed, resting[0], 0.0)
        integrator = Integrator(oscillator(law, 0.02, mean=load), speed, 1e-12)
        state = integrator.by_phase(period_map.state(point.z, point.u))
        moved = integrator.run(state, 1, samples=64).samples[:, 0]
        errors.append(np.abs(moved - resting).max())
    assert errors[0] < 3e-4
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.2)


def test_a_small_vibration_of_one_pair_has_the_frequency_of_the_local_stiffness():
    """A pair's law about 550 N m: 5.2856e8 N/m on the average, and a frequency 14.2 % above that."""
    mass, force, average, local = 1.145274157, 550.0 / 0.0390845, 5.28555e8, 3904.3
    exponent = local**2 * mass * (2.0 * np.pi) ** 2 / average
    size = force / (force / average) ** exponent / mass
    law = power_table_law(400, first=1e-7, last=1e-4, size=size, exponent=exponent)
    system = replace(oscillator(law, mean=force / mass), scale=1e-5)
    frequency = 4.0 * 2.0 * np.pi * local
    matrix, _ = monodromy(Integrator(system, frequency, 1e-14), np.array([[force / average], [0.0]]), 1)
    angle = np.abs(np.angle(np.linalg.eigvals(matrix))).max()
    assert 4.0 * local * angle / (2.0 * np.pi) == pytest.approx(local, rel=1e-6)


def test_rattle_without_a_mean_load_meets_both_flanks_alike():
    """A mirror image of itself half a period later; each flank in contact for the same time."""
    system = oscillator(power_table_law(100, first=1e-4), 0.05, 1.0, 0.0, -0.3, 0.3)
    period_map = PeriodMap(Family("W", lambda speed: (system, speed)), 1, 1e-12)
    point = orbit(period_map, 0.8, 1.5, 0.0)
    integrator = Integrator(system, 0.8, 1e-12)
    run = integrator.run(integrator.by_phase(period_map.state(point.z, point.u)), 1, samples=64)
    place = run.samples[:, 0]
    assert place.max() > 0.4
    np.testing.assert_allclose(place[32:], -place[:32], rtol=0, atol=1e-9)
    assert run.fractions[1, 0] == pytest.approx(run.fractions[2, 0], abs=1e-9)
    assert 0.0 < run.fractions[0, 0] < 1.0


@pytest.mark.parametrize("amplitude", [0.02, 0.08])
def test_within_a_tenth_of_the_load_the_motion_is_that_of_the_local_stiffness_but_for_its_curvature(
    amplitude,
):
    """The curvature of the law over the motion bounds what a constant local stiffness misses."""
    speed, damping, local = 0.3, 0.02, 1.5
    law = power_table_law(300, first=1e-3)
    period_map = law_period_map(law, damping, amplitude)
    point = orbit(period_map, speed, 1.0, 0.0)
    integrator = Integrator(oscillator(law, damping, amplitude), speed, 1e-12)
    state = integrator.by_phase(period_map.state(point.z, point.u))
    moved = integrator.run(state, 1, samples=128).samples[:, 0]
    phases = 2.0 * np.pi * np.arange(128) / 128
    response = amplitude / (local - speed**2 + 2j * damping * speed)
    linear = 1.0 + (response * np.exp(1j * phases)).real
    assert np.abs(moved - 1.0).max() < 0.1 / local
    curvature = np.abs(1.5 * np.sqrt(moved) / local - 1.0).max()
    missed = np.abs(moved - linear).max() / np.abs(response)
    assert missed < curvature * local / (local - speed**2)
    assert missed > 0.1 * curvature
