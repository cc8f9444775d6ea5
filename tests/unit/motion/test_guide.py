"""A run that the orbit of a like system leads comes to the motion that it would come to by itself."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as examples
from hypothesis import strategies as st
from lumped_machines import make_layout, make_machine
from oscillators import backlash_oscillator

from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.guide import RETURNS, drawn_in, guide_of, settle_by_guide
from facegear.motion.steady_state.orbits import ROUNDING, change
from facegear.motion.steady_state.simulate import build_model, simulate, static_start, steady_state

SPEED = 0.75
SYSTEM = backlash_oscillator(SPEED)
QUICK = Settings(tolerance=1e-10, periodic_residual=1e-9, longest_period=4)
BOTH = [
    steady_state(SYSTEM, SPEED, QUICK, State(np.array([place]), np.array([rate])))
    for place, rate in ((1.16, 0.01), (0.83, 0.16))
]
"""The two orbits of the oscillator with backlash at this speed."""


@given(st.sampled_from([0, 1]), st.floats(-2.0, 3.0), st.floats(-1.0, 1.0))
@examples(max_examples=15)
def test_of_two_orbits_a_run_comes_to_the_one_that_it_starts_towards_whichever_leads(leading, place, rate):
    start = State(np.array([place]), np.array([rate]))
    alone = steady_state(SYSTEM, SPEED, QUICK, start)
    led = steady_state(SYSTEM, SPEED, QUICK, start, guide_of(Integrator(SYSTEM, SPEED), BOTH[leading].orbit))
    assert led.label == alone.label == "period-1"
    assert led.state.displacement == pytest.approx(alone.state.displacement, abs=1e-8)
    assert led.state.velocity == pytest.approx(alone.state.velocity, abs=1e-8)


@pytest.mark.parametrize("change, followed", [(1.0, True), (1.01, True), (1.3, False), (1.6, False)])
def test_returns_that_do_not_follow_the_multipliers_of_the_guide_are_no_sign_of_its_orbit(change, followed):
    orbit = BOTH[0].orbit
    powers = (change * orbit.multipliers) ** np.arange(RETURNS + 1)[:, None]
    off = (powers * np.array([1e-3, 1e-3]) @ orbit.vectors.T).real
    assert drawn_in(off.reshape(-1, 2, 1), guide_of(Integrator(SYSTEM, SPEED), orbit)) == followed


def series_machine(shift):
    """A machine that stands in contact, its pinions, teeth and clearances moved by micrometres."""
    layout = make_layout(kinematics=GEOMETRIC)
    random = np.random.default_rng(5)
    pinions, meshes = len(layout.pinions), len(layout.meshes)
    flaws = replace(
        perfect(layout),
        bearing_clearance=20e-6 + shift * random.uniform(-8e-6, 8e-6, pinions),
        position=shift * random.uniform(-1e-5, 1e-5, (pinions, 2)),
        error=shift * random.uniform(-9e-6, 9e-6, meshes),
    )
    return make_machine(layout, error=2e-6, imperfections=flaws)


def test_a_machine_led_by_the_nominal_one_settles_on_its_own_orbit_within_a_quarter_of_the_periods():
    precise = Settings(tolerance=1e-8)
    nominal = simulate(series_machine(0.0), 3000.0, precise)
    guide = guide_of(Integrator(nominal.system, nominal.frequency), nominal.orbit)
    model = build_model(series_machine(1.0))
    alone, led = simulate(model, 3000.0, precise), simulate(model, 3000.0, precise, guide=guide)
    assert led.label == alone.label == "period-1"
    assert led.orbit is None and led.multipliers is None
    assert 4 * led.periods_run <= alone.periods_run
    moved = np.abs(alone.deflections - nominal.deflections).max()
    assert np.abs(led.deflections - alone.deflections).max() < 1e-6 * moved


def test_the_orbit_that_a_guide_leads_to_repeats_to_rounding_though_its_last_step_is_not_run():
    nominal = simulate(series_machine(0.0), 3000.0)
    guide = guide_of(Integrator(nominal.system, nominal.frequency), nominal.orbit)
    for shift in (0.3, 1.0):
        model = build_model(series_machine(shift))
        integrator = Integrator(model.system, nominal.frequency)
        settled = settle_by_guide(integrator, integrator.by_phase(static_start(model)), guide)
        end = integrator.run(settled.state, 1, fine=True).state
        assert settled.residual <= ROUNDING
        assert change(integrator, settled.state, end) <= 3.0 * ROUNDING


def test_scratch_space_is_shared_by_systems_of_the_same_sizes_alone_and_changes_no_motion():
    nominal, tight = build_model(series_machine(0.0)), make_machine(make_layout(kinematics=GEOMETRIC))
    first = Integrator(nominal.system, 2e3)
    moved = build_model(series_machine(1.0))
    alone, beside = Integrator(moved.system, 2e3), Integrator(moved.system, 2e3, like=first)
    start = alone.by_phase(static_start(moved))
    first.run(start, 3)
    assert beside.work is first.work and alone.work is not first.work
    assert np.array_equal(beside.run(start, 3).ends, alone.run(start, 3).ends)
    assert np.array_equal(beside.advance_period(start), alone.run(start, 1, fine=True).state)
    assert Integrator(moved.system, 2e3, order=7, like=first).work is not first.work
    assert Integrator(build_model(tight).system, 2e3, like=first).work is not first.work


def test_an_orbit_in_other_coordinates_leads_nothing():
    nominal = simulate(series_machine(0.0), 3000.0)
    tight = make_machine(make_layout(kinematics=GEOMETRIC), error=2e-6)
    alone = simulate(tight, 3000.0)
    beside = simulate(
        tight, 3000.0, guide=guide_of(Integrator(nominal.system, nominal.frequency), nominal.orbit)
    )
    assert np.array_equal(alone.coordinates, beside.coordinates)
    assert alone.periods_run == beside.periods_run and beside.orbit is not None


def test_only_an_orbit_of_one_mesh_period_that_draws_in_makes_a_guide():
    orbit, integrator = BOTH[0].orbit, Integrator(SYSTEM, SPEED)
    assert guide_of(integrator, orbit) is not None
    assert guide_of(integrator, None) is None
    assert guide_of(integrator, replace(orbit, period=2)) is None
    assert guide_of(integrator, replace(orbit, multipliers=orbit.multipliers / orbit.spectral_radius)) is None
