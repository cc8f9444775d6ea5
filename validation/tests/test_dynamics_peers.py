"""The integrators of the comparison solve the same equations."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from force_tables import power_table
from lumped_machines import PLACES, make_layout, make_machine
from references import against, agrees

from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.machine import FlankTables
from facegear.motion.integrator.integrator import Integrator
from validation.dynamics.heyoka_peer import batch, scale_system, trajectory
from validation.dynamics.methods import all_methods, rk4, run_ours, tangent_methods
from validation.dynamics.problems import (
    SAMPLES,
    law_problems,
    machine_problems,
    oscillator_problem,
    tangent_problems,
)
from validation.dynamics.right_side import compiled_right_side, plain_right_side
from validation.dynamics.work_precision import (
    Budget,
    cheapest_within_chance,
    error_of,
    reference,
    seconds_at,
    work_precision,
)


@pytest.fixture(scope="module")
def problems():
    return [*machine_problems(make_machine(), 7500.0), oscillator_problem()]


@against(
    "second implementation",
    "the equations of motion written plainly with NumPy",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_compiled_and_plain_right_hand_sides_agree(problems):
    for problem in (problems[1], problems[3]):
        integrator = Integrator(problem.system, problem.frequency)
        z = problem.system.scale * np.random.default_rng(0).normal(size=2 * integrator.size)
        first = compiled_right_side(integrator)(1.3, z)
        second = plain_right_side(problem.system, problem.frequency)(1.3, z)
        agrees(
            "right-hand side, scaled", first, second, relative=1e-12, absolute=1e-13 * np.abs(second).max()
        )


def test_every_method_converges_to_ours(problems):
    problem = problems[3]
    exact = run_ours(problem, 1e-14)
    assert exact.shape == (problem.periods * SAMPLES, 1)
    for method in all_methods():
        setting = 1024 if method.name.startswith("RK4") else 1e-6
        assert np.abs(method.prepare(problem, setting)() - exact).max() < 1e-3, method.name


def test_fixed_steps_lose_their_order_where_contact_switches(problems):
    kept, lost = problems[0], problems[1]

    def gain(problem, coarsest):
        exact = run_ours(problem, 1e-14)
        steps = coarsest * 2 ** np.arange(4)
        errors = [np.abs(rk4(problem, count)() - exact).max() for count in steps]
        return np.mean(np.log2(np.divide(errors[:-1], errors[1:])))

    # More steps would reach rounding where contact is kept.
    assert gain(kept, 64) == pytest.approx(4.0, abs=0.25)
    assert gain(lost, 256) < 3.2


def test_the_table_lists_failures_and_interpolates_times(problems):
    methods = [one for one in all_methods() if one.name in ("facegear", "RK4 fixed")]
    table = work_precision([problems[3]], methods, Budget(repeats=1, longest=1.0))
    assert set(table["method"]) == {"facegear", "RK4 fixed"}
    assert (table["failure"] == "").all()
    time = seconds_at(table, "oracle (a)", "facegear", 1e-8)
    assert table["seconds"].min() <= time <= table["seconds"].max()


@against(
    "third-party program",
    "heyoka: Taylor's method with located events",
    capability="dynamics_response",
    module="facegear.motion.integrator.integrator",
)
def test_heyoka_follows_the_same_motion_through_every_switch(problems):
    heyoka = pytest.importorskip("heyoka", reason="heyoka.py is not installed (extra `benchmark`)")
    lost, oscillator = problems[1], problems[3]
    runs = [(lost, trajectory(heyoka)), (oscillator, trajectory(heyoka)), (oscillator, batch(heyoka, 2))]
    for problem, prepare in runs:
        error, _ = error_of(problem, prepare(problem, 1e-9)(), reference(problem))
        agrees("largest error of the motion, scaled", error, 0.0, absolute=1e-9)


@against(
    "third-party program",
    "heyoka: Taylor's method with located events",
    capability="dynamics_response mesh_law",
    module="facegear.meshing.load_dependent",
)
@pytest.mark.parametrize("number", [0, 1], ids=["damper in contact only", "load-dependent law"])
def test_heyoka_follows_the_same_motion_on_other_laws(number):
    heyoka = pytest.importorskip("heyoka", reason="heyoka.py is not installed (extra `benchmark`)")
    layout = make_layout(PLACES[1:4], kinematics=GEOMETRIC)
    table = power_table(6, 0.1, 2e-6, 4e-4, 2.4e10)
    loaded = replace(make_machine(layout, 700.0, 0.0), tables=2 * (FlankTables(table, table),))
    problem = replace(law_problems(make_machine(), loaded, 7500.0)[number], periods=4)
    system = problem.system
    amounts = run_ours(problem, 1e-13) @ system.mesh_jacobian.T - system.upper
    beyond = (amounts[:, :, None] > system.law.levels.T).any(axis=1)
    assert beyond.any(axis=0)[: max(len(system.law.levels) - 1, 1)].all(), "all levels but the last are met"
    error, _ = error_of(problem, trajectory(heyoka)(problem, 1e-10)(), reference(problem))
    agrees("largest error of the motion, scaled", error, 0.0, absolute=1e-9)


@against(
    "third-party program",
    "heyoka: Taylor's method with located events",
    capability="dynamics_response branches",
    module="facegear.motion.integrator.integrator",
)
def test_heyoka_carries_the_same_tangents(problems):
    pytest.importorskip("heyoka", reason="heyoka.py is not installed (extra `benchmark`)")
    for problem in tangent_problems([problems[1], problems[3]]):
        for method in tangent_methods():
            error, _ = error_of(problem, method.prepare(problem, 1e-9)(), reference(problem))
            agrees("largest error of the tangents, scaled", error, 0.0, absolute=1e-8)


def test_heyoka_is_refused_what_its_setup_leaves_out(problems):
    with pytest.raises(ValueError, match="flanks that only push"):
        scale_system(replace(problems[1].system, push_only=True))


def test_an_rms_counts_as_right_only_where_every_finer_setting_is_right_too():
    rows = [("a", 1e-2, 0.01, 1.0), ("a", 1e-3, 0.09, 2.0), ("a", 1e-4, 0.02, 3.0), ("a", 1e-5, 0.01, 4.0)]
    table = pd.DataFrame(rows, columns=["method", "setting", "error", "seconds"])
    table = table.assign(problem="irregular", interval=0.03)
    found = cheapest_within_chance(table, "irregular")
    assert found["setting"].tolist() == [1e-4]
    assert cheapest_within_chance(table.assign(error=0.5), "irregular").empty
