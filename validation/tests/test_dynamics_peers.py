"""The integrators of the comparison solve the same equations."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from force_tables import power_table
from lumped_machines import PLACES, make_layout, make_machine
from references import against, agrees

from facegear.machine.disturbances import PARTS, MeshFriction
from facegear.machine.imperfections import perfect
from facegear.machine.kinematics import GEOMETRIC
from facegear.machine.machine import FlankTables, OpenFlanks
from facegear.meshing.linear import Piecewise
from facegear.meshing.power import PowerLaw
from facegear.motion.integrator.integrator import Integrator
from validation.dynamics.heyoka_equations import scale_system
from validation.dynamics.heyoka_peer import batch, trajectory
from validation.dynamics.methods import all_methods, rk4, run_ours, tangent_methods
from validation.dynamics.problems import (
    POWER,
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
    compared_values,
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


LAYOUT = make_layout(PLACES[1:4], kinematics=GEOMETRIC)


def make_other_law(name):
    """Return a machine whose contacts switch in the way that the name says."""
    machine = make_machine(LAYOUT, 700.0, 0.0)
    damping = machine.damping
    table = power_table(6, 0.1, 2e-6, 4e-4, 2.4e10)
    clearance = np.full(len(LAYOUT.pinions), 1e-5)
    ratios = 0.05 * np.random.default_rng(11).normal(size=(len(LAYOUT.meshes), len(PARTS), 2, 3))
    ratios[:, :, 0, 0] = 0.0
    changes = {
        "damper in contact only": {"damping": replace(damping, open_flanks=OpenFlanks.CONTACT_ONLY)},
        "load-dependent law": {"tables": len(LAYOUT.gears) * (FlankTables(table, table),)},
        "power law": {"law": PowerLaw(**POWER, contacts=2 * len(LAYOUT.meshes))},
        "flanks that only push": {"damping": replace(damping, mesh=12e3, open_flanks=OpenFlanks.PUSH_ONLY)},
        "friction": {"friction": MeshFriction(ratios)},
        "bearing clearance": {"imperfections": replace(perfect(LAYOUT), bearing_clearance=clearance)},
    }
    return replace(machine, **changes[name])


@against(
    "third-party program",
    "heyoka: Taylor's method with located events",
    capability="dynamics_response mesh_law",
    module="facegear.meshing.load_dependent",
)
@pytest.mark.parametrize(
    "name",
    [
        *("damper in contact only", "load-dependent law", "power law", "flanks that only push", "friction"),
        "bearing clearance",
    ],
)
def test_heyoka_follows_the_same_motion_on_other_laws(name):
    heyoka = pytest.importorskip("heyoka", reason="heyoka.py is not installed (extra `benchmark`)")
    (found,) = law_problems({name: make_other_law(name)}, 7500.0)
    problem = replace(found, periods=4)
    error, _ = error_of(problem, trajectory(heyoka)(problem, 1e-11)(), run_reference(problem))
    agrees("largest error of the motion, scaled", error, 0.0, absolute=1e-9)
    assert_switches(problem)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-5])
def test_heyoka_meets_every_switch_at_loose_tolerances(tolerance):
    heyoka = pytest.importorskip("heyoka", reason="heyoka.py is not installed (extra `benchmark`)")
    (found,) = law_problems({"flanks with errors": make_machine(LAYOUT, 700.0, 0.0, error=20e-6)}, 7500.0)
    problem = replace(found, periods=8)
    error, _ = error_of(problem, trajectory(heyoka)(problem, tolerance)(), run_reference(problem))
    assert error < 10.0 * tolerance


def run_reference(problem):
    """Return deflections of our own integrator."""
    return compared_values(problem, run_ours(problem, 1e-13))


def assert_switches(problem):
    """Assert that contacts open and pass the levels of a law but the last, and that bearings are met."""
    system = problem.system
    deflections = run_ours(problem, 1e-13) @ system.mesh_jacobian.T
    flanks = slice(system.contacts)
    amounts = deflections[:, flanks] - system.upper[flanks]
    beyond = (amounts[:, :, None] > system.law.levels.T).any(axis=1)
    assert beyond.any(axis=0)[: max(len(system.law.levels) - 1, 1)].all(), "all levels but the last are met"
    drive = amounts[:, : len(LAYOUT.meshes)]
    assert (drive > 0.0).any(), "flanks are in contact"
    across, along = deflections[:, system.contacts :: 3], deflections[:, system.contacts + 1 :: 3]
    pressed = np.hypot(across, along) > system.ring_clearance
    assert system.ring_clearance.size == 0 or pressed.any(), "bearings are pressed"


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
    pieces = (Piecewise(np.array([0.0, 0.5, 1.0]), np.array([[0.1], [-0.1]])),)
    system = problems[3].system
    with pytest.raises(ValueError, match="stiffness in pieces of the phase"):
        scale_system(replace(system, law=replace(system.law, pieces=pieces)))


def test_an_rms_counts_as_right_only_where_every_finer_setting_is_right_too():
    rows = [("a", 1e-2, 0.01, 1.0), ("a", 1e-3, 0.09, 2.0), ("a", 1e-4, 0.02, 3.0), ("a", 1e-5, 0.01, 4.0)]
    table = pd.DataFrame(rows, columns=["method", "setting", "error", "seconds"])
    table = table.assign(problem="irregular", interval=0.03)
    found = cheapest_within_chance(table, "irregular")
    assert found["setting"].tolist() == [1e-4]
    assert cheapest_within_chance(table.assign(error=0.5), "irregular").empty
