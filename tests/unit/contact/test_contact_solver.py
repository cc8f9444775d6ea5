"""The contact problem by itself, on random compliances."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from references import against, agrees

from facegear._kernels import contact as kernels
from facegear.contact import position_solver
from facegear.contact.position_solver import kkt_residual, solve_contact
from facegear.errors import NotConverged


def random_problem(seed, size):
    """Compliance like a layer's (decaying influence), wavy gaps, lever arms near one."""
    rng = np.random.default_rng(seed)
    x = np.sort(rng.uniform(0, 1, size))
    compliance = np.exp(-6 * np.abs(x[:, None] - x)) + 0.05 * np.eye(size)
    gap = 0.3 * (x - rng.uniform()) ** 2 + 0.05 * rng.uniform(size=size)
    return compliance, gap, rng.uniform(0.8, 1.2, size)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10**6), size=st.integers(1, 60), torque=st.floats(1e-4, 1e4))
def test_solution_meets_all_contact_conditions_to_rounding(seed, size, torque):
    compliance, gap, lever_arm = random_problem(seed, size)
    contact = solve_contact(compliance, gap, lever_arm, torque)
    assert contact.residual < 1e-12
    assert kkt_residual(compliance, gap, lever_arm, torque, contact.force, contact.rotation) < 1e-12
    assert lever_arm @ contact.force == pytest.approx(torque, rel=1e-12)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), start=st.integers(0, 2**20 - 1))
def test_solution_does_not_depend_on_the_start(seed, start):
    compliance, gap, lever_arm = random_problem(seed, 20)
    guess = np.array([bool(start >> bit & 1) for bit in range(20)])
    cold, warm = (solve_contact(compliance, gap, lever_arm, 1.0, begin) for begin in (None, guess))
    np.testing.assert_allclose(warm.force, cold.force, atol=1e-10 * cold.force.max())
    assert warm.rotation == pytest.approx(cold.rotation, rel=1e-12)


@pytest.mark.parametrize("steps", [40, 1])
def test_change_of_the_forces_with_the_torque_holds_while_the_same_points_touch(steps):
    """Whether the set is reached by Newton steps or by exchanges."""
    problem, kept = random_problem(3, 30), 0
    for torque in np.linspace(0.1, 3.0, 20).tolist():
        first, more = (
            kernels.solve_active_set(*problem, load, np.ones(30, bool), steps, 1e-11)
            for load in (torque, 1.001 * torque)
        )
        if np.array_equal(first["force"] > 0, more["force"] > 0):
            kept += 1
            changed = first["force"] + 0.001 * torque * first["force_change"]
            np.testing.assert_allclose(changed, more["force"], rtol=1e-9)
    assert kept > 10


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), size=st.integers(2, 60))
def test_exchanging_one_point_at_a_time_leads_to_the_same_solution(seed, size):
    problem = random_problem(seed, size)
    usual = solve_contact(*problem, 1.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(position_solver, "NEWTON_STEPS", 1)
        slow = solve_contact(*problem, 1.0)
    np.testing.assert_allclose(slow.force, usual.force, atol=1e-10 * usual.force.max())
    assert slow.residual < 1e-12


@against(
    "second implementation",
    "enumeration of all active sets",
    capability="contact",
    module="facegear.contact.position_solver",
)
@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_solution_is_the_best_of_all_active_sets(seed):
    compliance, gap, lever_arm = random_problem(seed, 6)
    contact = solve_contact(compliance, gap, lever_arm, 0.7)

    def energy(force):
        return 0.5 * force @ compliance @ force + gap @ force

    best = np.inf
    for count in range(1, 7):
        for chosen in itertools.combinations(range(6), count):
            rows = np.array(chosen)
            system = np.block(
                [
                    [compliance[np.ix_(rows, rows)], -lever_arm[rows, None]],
                    [lever_arm[None, rows], np.zeros((1, 1))],
                ]
            )
            force = np.zeros(6)
            force[rows] = np.linalg.solve(system, np.append(-gap[rows], 0.7))[:-1]
            if force.min() >= 0:
                best = min(best, energy(force))
    agrees("energy of the contact", energy(contact.force), best, relative=1e-10, absolute=1e-12)


@against(
    "second implementation",
    "difference of two solutions",
    capability="contact",
    module="facegear.contact.position_solver",
)
def test_slope_is_the_change_of_rotation_with_torque():
    compliance, gap, lever_arm = random_problem(7, 40)
    contact, more = (solve_contact(compliance, gap, lever_arm, torque) for torque in (2.0, 2.0 + 1e-6))
    assert np.array_equal(contact.active, more.active)
    agrees(
        "slope of rotation over torque",
        (more.rotation - contact.rotation) / 1e-6,
        contact.slope,
        relative=1e-6,
    )


@against(
    "analytic",
    "linear elasticity",
    capability="contact",
    module="facegear.contact.position_solver",
)
def test_without_gaps_rotation_grows_in_proportion_to_torque():
    compliance, _, lever_arm = random_problem(3, 30)
    one, many = (
        solve_contact(compliance, np.zeros(30), lever_arm, torque).rotation for torque in (1.0, 1000.0)
    )
    agrees("rotation at a thousand times the torque", many, 1000.0 * one, relative=1e-12)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), size=st.integers(2, 60))
def test_the_points_that_touch_as_a_start_leave_one_step_to_do(seed, size):
    problem = random_problem(seed, size)
    cold = solve_contact(*problem, 1.0)
    assert cold.steps < position_solver.NEWTON_STEPS
    assert solve_contact(*problem, 1.0, cold.active).steps == 1


def test_force_that_pulls_and_a_gap_that_closes_too_far_count_as_violations():
    compliance, gap, lever_arm = np.eye(3), np.array([0.0, 0.0, 5.0]), np.ones(3)
    good = solve_contact(compliance, gap, lever_arm, 2.0)
    assert np.allclose(good.force, [1.0, 1.0, 0.0])
    assert kkt_residual(compliance, gap, lever_arm, 2.0, good.force, good.rotation) < 1e-12
    through = np.array([0.0, 0.0, 0.5])  # the third point would lie 0.5 inside the other body
    assert kkt_residual(compliance, through, lever_arm, 2.0, good.force, good.rotation) == pytest.approx(0.5)
    pulled = np.array([3.0, -1.0, 0.0])
    assert kkt_residual(compliance, gap, lever_arm, 2.0, pulled, 3.0) > 0.3


def test_no_point_that_can_carry_the_torque_is_reported_with_its_place():
    with pytest.raises(NotConverged, match=r"position 0\.25, torque 600 N m"):
        solve_contact(np.eye(3), np.zeros(3), -np.ones(3), 600.0, place_text="position 0.25, torque 600 N m")
    with pytest.raises(NotConverged, match="no candidate point can carry the torque"):
        solve_contact(np.eye(3), np.zeros(3), -0.05 * np.ones(3), 600.0)


def test_contact_without_a_solution_is_reported_with_the_steps_that_were_tried():
    with pytest.raises(NotConverged, match="here: 40 Newton and 160 exchange steps"):
        position_solver.check_solved(0, 0.0, 3, "here")


def test_torque_that_does_not_drive_is_refused():
    with pytest.raises(ValueError, match="torque"):
        solve_contact(np.eye(3), np.zeros(3), np.ones(3), 0.0)


@pytest.mark.parametrize("apart", [1e3, 1e6])
def test_gaps_that_a_common_turn_closes_change_no_force_however_wide_they_are(apart):
    compliance, gap, lever_arm = random_problem(7, 60)
    near = solve_contact(compliance, gap, lever_arm, 1.0)
    far = solve_contact(compliance, gap + apart * lever_arm, lever_arm, 1.0)
    assert far.rotation - near.rotation == pytest.approx(apart, rel=1e-12)
    # The gaps themselves are rounded, which the inverse of the compliance enlarges by 20 at most.
    np.testing.assert_allclose(far.force, near.force, rtol=0, atol=2e-14 * apart)
