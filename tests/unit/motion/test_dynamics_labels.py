"""A label survives longer watching, and an orbit is the one that the run itself comes to."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from lumped_machines import make_layout, make_machine
from recorded_motion import record
from references import against, agrees

from facegear.build.config import resolved_values
from facegear.build.load import load_config
from facegear.build.machine import MachineInputs
from facegear.harmonics import Harmonics
from facegear.machine.kinematics import GEOMETRIC
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Look, Motion, Settings
from facegear.motion.requests import alone
from facegear.motion.steady_state import second_look, watch
from facegear.motion.steady_state.orbits import change
from facegear.motion.steady_state.periodicity import KnownOrbit, known_orbit, often_seems_to_close
from facegear.motion.steady_state.second_look import CHANCE, chance_of_never_closing, other_starts
from facegear.motion.steady_state.settle import count_unsteady_periods, settle
from facegear.motion.steady_state.simulate import build_model, simulate, steady_state
from facegear.motion.sweeps.sweep_tables import response_summary
from facegear.schema.motion import SECOND_LOOKS
from validation.dynamics.oscillators import (
    Oscillator,
    closed_form_run,
    end_of,
    judge,
    plain_runs,
    random_oscillators,
)

TRANSIENT = Oscillator(0.01, 0.179493529, 1.178660661, 0.996169122, 0.0, 0.0)
LOW_DAMPING = Oscillator(0.002, 0.1, 0.05, 0.75, -1.6, 0.1)


@pytest.mark.parametrize("refine", [True, False])
def test_a_chaotic_transient_is_waited_for(refine):
    found = steady_state(TRANSIENT.system, TRANSIENT.speed, Settings(refine=refine), TRANSIENT.start)
    assert found.label == "period-1"
    assert found.moments.ac_rms[0] == pytest.approx(1.27, abs=0.01)


@pytest.mark.parametrize("refine", [True, False])
def test_at_low_damping_the_orbit_is_the_one_that_the_run_comes_to(refine):
    """Newton's method once took this run to the upper orbit, and without it called it period-3."""
    settings = Settings(refine=refine)
    found = steady_state(LOW_DAMPING.system, LOW_DAMPING.speed, settings, LOW_DAMPING.start)
    alone = closed_form_run(LOW_DAMPING, 3000)[-1]
    assert found.label == "period-1"
    np.testing.assert_allclose([found.state.displacement[0], found.state.velocity[0]], alone, atol=1e-5)
    assert found.moments.minimum[0] > 1.0, "the lower orbit keeps contact"


@pytest.mark.parametrize("number", [230, 248])
def test_a_spiral_that_turns_by_parts_of_a_period_is_period_1_without_refinement(number):
    """Turning by a half and by a sixth a period, they were once called period-2 and period-6."""
    oscillator = list(random_oscillators(number + 1))[number]
    found = steady_state(oscillator.system, oscillator.speed, Settings(refine=False), oscillator.start)
    assert found.label == "period-1"


@against(
    "analytic",
    "oscillator with backlash in closed pieces",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_closed_form_pieces_and_taylor_steps_agree_before_chaos_parts_them():
    oscillators = list(random_oscillators(6))
    starts = [oscillator.start for oscillator in oscillators]
    runs = plain_runs(oscillators, starts, 8, 1e-13)
    for oscillator, ours in zip(oscillators, runs, strict=True):
        agrees(
            "motion over eight periods", ours, closed_form_run(oscillator, 8), relative=1e-7, absolute=1e-7
        )


def test_labels_of_random_oscillators_hold_for_20_000_further_periods():
    rows = judge(list(random_oscillators(8)), Settings())
    assert all(row["agrees"] or row["label"] == Motion.NOT_SETTLED for row in rows)
    assert sum(row["label"] == Motion.NOT_SETTLED for row in rows) == 0
    assert all(row["refinement_agrees"] for row in rows)
    assert all(row["reached"] or row["sensitive"] for row in rows)
    assert all(row["reached_closed_form"] or row["sensitive"] for row in rows)


@pytest.mark.parametrize(
    ("start", "label"), [((-0.8931, -0.3998), "period-3"), ((1.3661, 0.4104), "period-5")]
)
def test_the_chaos_of_one_oscillator_of_the_suite_is_a_transient_between_two_stable_orbits(start, label):
    """Number 211, chaotic for 400 to 45 000 periods, in whatever steps, comes to one or the other."""
    oscillator = list(random_oscillators(212))[211]
    oscillator = replace(oscillator, displacement=start[0], velocity=start[1])
    found = steady_state(oscillator.system, oscillator.speed, Settings(), oscillator.start)
    alone = closed_form_run(oscillator, 1500)
    assert found.label == end_of(alone).label == label
    assert abs(found.multipliers[0]) < 0.95
    distances = np.abs(alone[-5:] - [found.state.displacement[0], found.state.velocity[0]]).max(axis=1)
    assert distances.min() < 1e-6


def test_a_run_that_still_moves_is_no_period_to_the_suite():
    decaying = np.cumsum(np.full((4000, 2), 1e-4), axis=0)
    assert end_of(decaying).label == "irregular"


@pytest.mark.parametrize("speed", [400.0, 4000.0])
def test_averages_and_extremes_do_not_depend_on_how_densely_the_motion_is_sampled(speed):
    """Against 4096 samples and the recorded polynomials; 32 samples a period once missed 1.6 % at 547 rpm."""
    model = build_model(make_machine(torque=2000.0))
    coarse, fine = (
        simulate(model, speed, Settings(tolerance=1e-6, settle=256, window=16, samples=samples))
        for samples in (16, 4096)
    )
    assert coarse.motion is Motion.PERIODIC and coarse.label == fine.label
    np.testing.assert_allclose(coarse.moments.ac_rms, fine.deflections.std(axis=0), rtol=1e-6)
    np.testing.assert_allclose(coarse.moments.mean, fine.deflections.mean(axis=0), rtol=1e-6)
    np.testing.assert_allclose(coarse.mean_forces[0], fine.forces.mean(axis=0), rtol=1e-5, atol=1e-2)
    run = record(model.system, coarse.frequency, coarse.state, coarse.period, Settings(tolerance=1e-6))
    for mesh in range(3):
        extremes = coarse.moments.minimum[mesh], coarse.moments.maximum[mesh]
        np.testing.assert_allclose(extremes, run.extremes(mesh), atol=2e-6 * model.system.scale)


@pytest.mark.parametrize("speed", [400.0, 15000.0])
def test_averages_and_extremes_of_meshes_with_two_flanks_come_from_polynomials_too(speed):
    model = build_model(make_machine(make_layout(kinematics=GEOMETRIC), torque=100.0))
    fine = simulate(model, speed, Settings(tolerance=1e-6, settle=256, window=16, samples=4096))
    moments = fine.moments
    rtol = 1e-6 if fine.motion is Motion.PERIODIC else 1e-3
    least = rtol * moments.ac_rms.max()
    np.testing.assert_allclose(moments.mean, fine.deflections.mean(axis=0), rtol=rtol, atol=least)
    np.testing.assert_allclose(moments.ac_rms, fine.deflections.std(axis=0), rtol=rtol)
    np.testing.assert_allclose(moments.minimum, fine.deflections.min(axis=0), atol=1e-5 * model.system.scale)
    np.testing.assert_allclose(moments.maximum, fine.deflections.max(axis=0), atol=1e-5 * model.system.scale)
    assert (moments.maximum >= fine.deflections.max(axis=0) - 1e-9 * model.system.scale).all()
    np.testing.assert_allclose(fine.mean_forces[0], fine.forces.mean(axis=0), rtol=1e-4, atol=1e-2)
    # The magnitude of what two wedged flanks transmit has a corner inside a step.
    np.testing.assert_allclose(fine.mean_forces[1], np.abs(fine.forces).mean(axis=0), rtol=2e-3)


def paper_machine():
    """The machine of config/paper.yaml: its torques, error and stiffness (to 1e4 N/m)."""
    sines = [0.0, 2.934e7, -4.22e6, -1.91e6, 4.8e5, 2.9e5, -4e5, -1.6e5, 9e4]
    cosines = [4.1e8, 4.93e6, 5.14e6, -4.8e5, -1.39e6, 1.7e5, 4e4, -2.8e5, -2e4]
    machine = make_machine(
        torque=1327.6, tail_share=0.034, stiffness=Harmonics(np.array(sines), np.array(cosines))
    )
    error = Harmonics(np.array([0.0, -2.26761004e-5]), np.array([0.0, -1.05258953e-5]))
    return replace(machine, error=error, error_lags=np.zeros(len(machine.layout.meshes)))


@pytest.mark.parametrize("refine", [True, False])
def test_steps_that_alternate_do_not_make_a_motion_of_twice_its_period(refine):
    """At 200 rpm some 170 steps a period at 1e-4, chosen by the motion itself, once made this period-2."""
    model = build_model(paper_machine())
    coarse = Settings(tolerance=1e-4, periodic_residual=1e-5, settle=128, samples=32, refine=refine)
    found = simulate(model, 200.0, coarse)
    exact = simulate(model, 200.0, Settings(tolerance=1e-10, periodic_residual=1e-9))
    assert found.label == exact.label == "period-1"
    largest = exact.moments.ac_rms.max()
    np.testing.assert_allclose(found.moments.ac_rms, exact.moments.ac_rms, atol=1e-3 * largest)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_a_free_body_that_the_steps_push_on_and_on_is_no_torus(tolerance):
    hasty = Settings(tolerance=tolerance, settle=256, window=160, periodic_residual=1e-5, samples=32)
    found = simulate(make_machine(torque=900.0), 175.0, replace(hasty, extensions=1))
    assert found.fractions[0].max() == pytest.approx(1.0)
    assert found.label == "period-1"


def test_a_short_window_does_not_take_a_torus_for_chaos():
    """Over 50 periods the exponent of this machine's torus once was 0.076 with an interval of 0.030."""
    stiffness = Harmonics(
        np.array([0.0, 3.0997e7, -3.841e6, -3.383e6]), np.array([4.32232e8, 3.2811e7, 1.0362e7, -5.75e5])
    )
    example = Path(__file__).parents[3] / "examples" / "machines" / "unequal_inputs.yaml"
    model = build_model(MachineInputs.of_config(resolved_values(load_config(example)), stiffness).build())
    settings = Settings(tolerance=1e-6, settle=100, window=50)
    assert simulate(model, 5000.0, settings).motion is Motion.QUASI_PERIODIC


@pytest.mark.parametrize("number", [31, 118])
def test_starts_that_differ_by_rounding_are_never_given_two_classes_of_motion(number):
    """Watched for 256 periods, these were chaotic from one start and period-1 from the next."""
    oscillator = list(random_oscillators(number + 1))[number]
    hasty = Settings(tolerance=1e-6, periodic_residual=1e-6, settle=256, window=160, extensions=1)
    settings = replace(hasty, second_looks=SECOND_LOOKS)
    found = []
    for k in range(40):
        start = replace(oscillator, displacement=oscillator.displacement + 1e-12 * k)
        found.append(steady_state(start.system, start.speed, settings, start.start))
        if k > 3 and found[-1].looks is not None:
            break
    assert len({each.label for each in found} - {Motion.NOT_SETTLED.value}) < 2
    doubted = [each for each in found if each.looks is not None]
    assert doubted and all(each.motion is Motion.NOT_SETTLED for each in doubted)
    assert all(first != second for first, second in (each.looks for each in doubted))
    assert all(" from one start and " in response_summary(each) for each in doubted)


@pytest.mark.parametrize("aside", [0.0, 1e-12, -1e-12])
def test_a_run_longer_than_the_states_that_are_kept_of_it_is_looked_at_again(aside):
    """It wanders for 400 of 876 periods, and comes to periods 1, 3, 5 and 7 from starts 1e-12 aside."""
    oscillator = list(random_oscillators(276))[275]
    start = replace(oscillator, displacement=oscillator.displacement + aside)
    found = steady_state(start.system, start.speed, Settings(second_looks=SECOND_LOOKS), start.start)
    assert found.motion is Motion.NOT_SETTLED
    assert found.looks is not None and found.looks[0] != found.looks[1]


@pytest.mark.parametrize("looks", [3, 12])
def test_a_run_that_wanders_gets_as_many_looks_as_asked_for(monkeypatch, looks):
    """Seven were the most for a run that wanders, whatever was asked for."""
    oscillator, starts = list(random_oscillators(343))[342], []
    integrator = Integrator(oscillator.system, oscillator.speed)
    first = settle(integrator, integrator.by_phase(oscillator.start), Settings())
    assert count_unsteady_periods(integrator, first, first.period) > 0

    def settle_again(integrator, start, settings, known_orbit):
        starts.append(start)
        return first
        yield

    monkeypatch.setattr(second_look, "settling", settle_again)
    settings = Settings(second_looks=looks)
    run = alone(watch.watch(watch.FirstWatch(integrator, settings, first.state, first, None)))
    run = replace(run, settling_result=first, motion=Motion.PERIODIC)
    plan = second_look.find_disagreement(integrator, first.state, settings, run)
    assert alone(plan) is None
    assert len(starts) == looks


@pytest.mark.parametrize("aside", [0.0, 1e-12, 2e-12, 3e-12])
def test_an_irregular_class_is_withdrawn_where_other_starts_leave_it_open(aside):
    """Chaotic from three starts of four and not settled from the fourth, they were taken for one class."""
    oscillator = list(random_oscillators(202))[201]
    start = replace(oscillator, displacement=oscillator.displacement + aside)
    found = steady_state(start.system, start.speed, Settings(second_looks=12), start.start)
    assert found.motion is Motion.NOT_SETTLED
    if found.looks is not None:
        assert found.looks == (Look(0, Motion.CHAOTIC), Look(0, Motion.NOT_SETTLED))
        assert "chaotic from one start and not settled from another" in response_summary(found)


def test_an_irregular_motion_that_never_seems_to_close_is_looked_at_once(monkeypatch):
    oscillator, runs = list(random_oscillators(29))[28], []
    classify_run = watch.classify_run
    for module in (watch, second_look):
        monkeypatch.setattr(
            module, "classify_run", lambda *arguments: runs.append(arguments) or classify_run(*arguments)
        )
    found = steady_state(oscillator.system, oscillator.speed, Settings(second_looks=12), oscillator.start)
    assert found.motion is Motion.CHAOTIC and len(runs) == 2


def look_once_at(monkeypatch, motion, other_motion):
    """Return what one look at oscillator 28 finds if the first run is of a class and the look of another."""
    oscillator = list(random_oscillators(29))[28]
    integrator, settings = (
        Integrator(oscillator.system, oscillator.speed),
        Settings(second_looks=SECOND_LOOKS),
    )
    start = integrator.by_phase(oscillator.start)
    run = alone(watch.watch(alone(watch.begin(integrator, start, settings))))

    def classify_look(integrator, look, settings):
        return other_motion, run.exponent
        yield

    monkeypatch.setattr(second_look, "classify_run", classify_look)
    return alone(second_look.find_disagreement(integrator, start, settings, replace(run, motion=motion)))


@pytest.mark.parametrize("motion", [Motion.CHAOTIC, Motion.QUASI_PERIODIC])
def test_a_look_that_stays_open_does_not_withdraw_an_irregular_class(monkeypatch, motion):
    """Watched for less long than the first run, it did; long runs confirmed the class nine times of ten."""
    assert look_once_at(monkeypatch, motion, Motion.NOT_SETTLED) is None


def test_a_look_of_another_irregular_class_withdraws_the_first(monkeypatch):
    """Chaos and a torus were one class, because neither has a period."""
    look, found = look_once_at(monkeypatch, Motion.CHAOTIC, Motion.QUASI_PERIODIC)
    assert look.period == 0 and found == Look(0, Motion.QUASI_PERIODIC)


@pytest.mark.parametrize(("number", "often"), [(201, True), (28, False)])
def test_a_small_attractor_often_seems_to_close(number, often):
    """Number 201 comes within 0.02 of one of its 64 last states almost anywhere, number 28 nowhere."""
    oscillator = list(random_oscillators(number + 1))[number]
    integrator = Integrator(oscillator.system, oscillator.speed)
    ends = integrator.run(integrator.by_phase(oscillator.start), 512).ends[128:]
    assert often_seems_to_close(integrator, ends, Settings()) is often


@pytest.mark.parametrize("aperiodic_until", [0, 300])
def test_a_long_run_is_unsteady_for_as_long_as_it_was_near_no_periodic_motion(aperiodic_until):
    """Every run longer than its record was unsteady; beside a branch point motions lost their class."""
    oscillator = next(random_oscillators(1))
    integrator = Integrator(oscillator.system, oscillator.speed)
    run = settle(integrator, integrator.by_phase(oscillator.start), Settings(settle=64, dwell=16))
    run = replace(run, ends=run.ends[-17:], periods_run=5000, aperiodic_until=aperiodic_until)
    assert count_unsteady_periods(integrator, run, run.period) == aperiodic_until


@pytest.mark.parametrize(
    ("look", "text"),
    [
        (Look(3, Motion.PERIODIC), "period-3"),
        (Look(3), "period-3"),
        (Look(0, Motion.QUASI_PERIODIC), "quasi-periodic"),
        (Look(0), "irregular"),
    ],
)
def test_a_look_is_named_by_its_period_or_class(look, text):
    assert str(look) == text


def test_a_motion_that_every_start_is_drawn_to_needs_no_second_look():
    oscillator = next(random_oscillators(1))
    once, again = (
        steady_state(oscillator.system, oscillator.speed, Settings(second_looks=looks), oscillator.start)
        for looks in (0, SECOND_LOOKS)
    )
    assert once.label == again.label == "period-1" and again.looks is None
    assert once.periods_run == again.periods_run


def test_looks_end_when_a_motion_that_never_closes_is_rarer_than_stated():
    """Lifetimes of a chaotic transient are exponential: the stated chance is a bound 19 times of 20."""
    random = np.random.default_rng(1)
    patience = 512
    for runs, mean in ((2, 40.0), (4, 150.0), (8, 400.0)):
        wandered = random.exponential(mean, size=(2000, runs)).sum(axis=1)
        stated = np.array([chance_of_never_closing(runs, total, patience) for total in wandered])
        too_small = (stated < np.exp(-patience / mean)).mean()
        assert too_small == pytest.approx(CHANCE, abs=0.02)


def test_another_start_lies_where_the_run_itself_has_moved_so_that_symmetry_is_kept():
    """A direction of its own breaks the symmetry: mirrored meshes then switch one after the other."""
    oscillator = next(random_oscillators(1))
    integrator = Integrator(oscillator.system, oscillator.speed)
    random = np.random.default_rng(0)
    moved = settle(integrator, integrator.by_phase(oscillator.start), Settings(settle=64, dwell=16))
    only_places = replace(moved, ends=random.normal(size=(20, 2, 1)) * [[[1.0], [0.0]]])
    start = np.array([[0.3], [0.1]])
    for _, other in zip(range(5), other_starts(integrator, start, 1e-3, only_places), strict=False):
        assert other[1, 0] == start[1, 0]
        assert change(integrator, start, other) == pytest.approx(1e-3)


def test_a_run_that_comes_near_a_known_stable_orbit_is_over_with_the_same_period():
    oscillator = next(random_oscillators(1))
    integrator = Integrator(oscillator.system, oscillator.speed)
    start, settings = integrator.by_phase(oscillator.start), Settings()
    first = settle(integrator, start, settings)
    states = integrator.run(first.state, first.period).ends
    again = settle(integrator, start, settings, known_orbit=KnownOrbit(first.orbit, states))
    assert first.orbit is not None and again.period == first.period
    assert again.periods_run <= first.periods_run
    assert change(integrator, again.state, states[-1]) < 1e-4


def test_a_run_is_over_once_a_known_orbit_of_several_periods_draws_it_in():
    """It went on until it was within the error of the steps, or Newton's method had found the orbit again."""
    *_, oscillator = random_oscillators(6)
    integrator = Integrator(oscillator.system, oscillator.speed)
    first = settle(integrator, integrator.by_phase(oscillator.start), Settings())
    known = known_orbit(integrator, first.orbit)
    assert first.period == 2 and known is not None
    aside = integrator.run(first.state, 1).state + 5e-3
    again = settle(integrator, aside, Settings(), known_orbit=known)
    assert again.is_known_orbit and again.period == 2
    assert again.periods_run == 16, "the first look"
    assert near(integrator, again.state, known.states) < 1e-9
    assert near(integrator, again.ends[-1], known.states) > 1e-6, "far beyond the error of the steps"


def near(integrator, state, states):
    """Distance of a state (2, n) from the nearest of some states."""
    return min(change(integrator, state, other) for other in states)
