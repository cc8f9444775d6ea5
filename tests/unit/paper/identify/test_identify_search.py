from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from facegear.config.load import load_config
from facegear.config.machines import case_machine
from facegear.dynamics.steady_state.simulate import build_model, static_start
from facegear.harmonics.series import Harmonics
from facegear.paper.identify.budget import Budget
from facegear.paper.identify.inputs import Branch, Inputs, Meaning, Space, StiffnessLoad, Waveform
from facegear.paper.identify.judge import confirmed
from facegear.paper.identify.objective import coefficients, misfit
from facegear.paper.identify.resonance import jump_speeds
from facegear.paper.identify.search import QUICK, QUICK_SWEEP, Problem, inputs_row, search_branch
from facegear.paper.identify.targets import BacklashTarget, Targets
from facegear.transmission.phases import PhaseConvention

VALUES = load_config(Path(__file__).parents[4] / "config" / "paper.yaml").model_dump(mode="json")
STIFFNESS = Harmonics(4.1e8 * np.array([0.0, 0.08]), 4.1e8 * np.array([1.0, 0.0]))
BRANCH = Branch(Meaning.RANGE, True, PhaseConvention.GEOMETRIC, Waveform.SINE, StiffnessLoad.OPERATING)
TRUTH = Inputs(BRANCH, 1100.0, 0.06, 0.85)
NO_TARGETS = Targets(7500.0, (), ())


@pytest.fixture(scope="module")
def twin():
    """A problem whose targets were computed from known inputs."""
    space = Space((600.0, 2000.0), (0.0, 0.2))
    base = case_machine(VALUES, STIFFNESS)
    empty = Problem(base, 50e-6, lambda _: STIFFNESS, 175.0, NO_TARGETS, space)
    machine = empty.machine(TRUTH)
    targets = []
    for backlash in (80e-6, 100e-6):
        model = build_model(replace(machine, half_backlash=0.5 * backlash))
        found = coefficients(model, 7500.0, QUICK, static_start(model))
        targets.append(BacklashTarget(backlash, *found))
    return replace(empty, targets=Targets(7500.0, tuple(targets), ()))


def test_known_inputs_have_no_misfit(twin):
    found = misfit(twin.machine(TRUTH), twin.targets, QUICK, QUICK_SWEEP)
    assert found.total == pytest.approx(0.0, abs=1e-9)


def test_search_finds_inputs_that_reproduce_the_coefficients_of_a_known_machine(twin):
    evaluations = search_branch(twin, BRANCH, Budget(scan=32, population=6, generations=6))
    assert len(evaluations) >= 32 + 6 * 6
    assert evaluations["misfit"].min() < 0.8
    assert evaluations["misfit"].min() < 0.6 * evaluations["misfit"].head(32).min()


def test_search_with_the_same_seed_repeats_itself(twin):
    budget = Budget(scan=8, population=5, generations=1, seed=3)
    first, second = (search_branch(twin, BRANCH, budget) for _ in range(2))
    np.testing.assert_array_equal(first["misfit"], second["misfit"])


def test_jumps_are_steps_of_the_level_and_not_its_slope():
    speeds = np.arange(10.0)
    level = np.where(speeds < 4.5, 1.0, 2.0) * (1.0 + 0.02 * speeds)
    assert jump_speeds(speeds, level).tolist() == [4.5]


def test_a_point_that_full_accuracy_does_not_confirm_is_dropped(twin):
    row = {**inputs_row(TRUTH), "misfit": 0.0, "worst_mean": 0.0}
    rows = pd.DataFrame([row, {**row, "misfit": 0.1, "worst_mean": 0.5}])
    kept = confirmed(twin, rows.assign(misfit=[1.0, 1.1]), QUICK, slack=2.0)
    assert kept["misfit"].tolist() == [1.0]
    assert kept["judged_worst_mean"].iloc[0] == pytest.approx(0.0, abs=1e-9)
