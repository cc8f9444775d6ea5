"""Branches where points fall together, bodies float, or nothing damps: right, and never turned round."""

from dataclasses import replace

import numpy as np
import pytest
from lumped_machines import make_machine
from oscillators import backlash_oscillator, one_degree, square_wave
from whole_branches import branch_at

from facegear.meshing.linear import LinearLaw
from facegear.motion.branches.continuation import (
    Branch,
    BranchEnd,
    ContinuationSettings,
    follow,
    reverse_tangent,
)
from facegear.motion.branches.explore import crossings, distance
from facegear.motion.branches.family import Family, speed_family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.special import Kind
from facegear.motion.plan import Settings
from facegear.motion.steady_state.simulate import build_model, simulate

EXACT = [0.828463984388, 0.820631087712, 0.708031618722, 1.407088466023]
"""Two folds and two grazes of oracle (a)."""
WIDE = ContinuationSettings(0.25, 2.6)


def period_map_of(at, tolerance=1e-12) -> PeriodMap:
    return PeriodMap(Family("W", lambda speed: (at(speed), speed)), 1, tolerance)


def listed(branch: Branch):
    return [(special.kind, special.point.value) for special in branch.specials]


def assert_same_from_the_other_end(branch: Branch, run: ContinuationSettings):
    """Assert equal special points by another way along the branch, and no turning round on either."""
    assert branch.ends == (BranchEnd.LIMIT, BranchEnd.LIMIT)
    back = follow(
        branch.period_map, reverse_tangent(branch.points[-1]), replace(run, ds_max=0.11), both_ways=False
    )
    assert back.ends[1] is BranchEnd.LIMIT
    assert back.points[-1].value == pytest.approx(branch.points[0].value, rel=1e-12)
    there, again = sorted(listed(branch)), sorted(listed(back))
    assert [kind for kind, _ in there] == [kind for kind, _ in again]
    assert [value for _, value in there] == pytest.approx([value for _, value in again], rel=1e-8)


def mirrored(speed):
    """Oracle (a) with its mesh split in two alike that turn against each other."""
    one = backlash_oscillator(speed)
    return replace(
        one,
        mesh_jacobian=np.array([[1.0], [-1.0]]),
        law=LinearLaw(0.5 * one.law.fourier, np.zeros(2, dtype=int)),
        error_kind=np.zeros(2, dtype=int),
        mesh_damping=np.zeros(2),
        lower=np.full(2, -1.0),
        upper=np.full(2, 1.0),
    )


def test_mirrored_meshes_that_switch_at_one_instant_graze_at_one_speed():
    branch = branch_at(period_map_of(mirrored), np.array([1.1, 0.0]), 0.3, WIDE)
    folds, grazes = ([special.point.value for special in branch.of(kind)] for kind in (Kind.FOLD, Kind.GRAZE))
    assert len(branch.specials) == len(folds) + len(grazes)
    assert folds == pytest.approx([EXACT[0], EXACT[2]], rel=1e-9)
    assert grazes == pytest.approx([EXACT[1], EXACT[1], EXACT[3], EXACT[3]], rel=1e-9)
    touched = [(special.meshes, special.edge) for special in branch.of(Kind.GRAZE)]
    for pair in (touched[:2], touched[2:]):
        assert sorted(pair) == [((0,), 1), ((1,), -1)]


def neutral(speed):
    """Oracle (a) beside a second body that no bearing holds and whose mesh never closes."""
    one = backlash_oscillator(speed)
    return replace(
        one,
        mesh_jacobian=np.array([[1.0, 0.0], [1.0, -1.0]]),
        omega_squared=np.zeros(2),
        damping=np.array([0.1, 0.1]),
        mesh_damping=np.zeros(2),
        lower=np.array([-1.0, -50.0]),
        upper=np.array([1.0, 50.0]),
        law=LinearLaw(one.law.fourier, np.zeros(2, dtype=int)),
        error_kind=np.zeros(2, dtype=int),
        load=np.concatenate([one.load, np.zeros_like(one.load)]),
    )


def test_a_floating_body_changes_no_special_point_and_its_one_is_no_fold():
    branch = branch_at(period_map_of(neutral), np.array([1.1, 0.0, 0.0, 0.0]), 0.3, WIDE)
    assert sorted(value for _, value in listed(branch)) == pytest.approx(sorted(EXACT), rel=1e-9)
    assert branch.points[0].linear.neutral.shape == (4, 1)
    assert branch.points[0].multipliers.size == 3
    assert branch.points[0].stable


def test_the_place_of_a_floating_body_makes_no_other_motion():
    """Nothing holds the body, so a sweep finds it anywhere; the rest of the motion must agree."""
    branch = branch_at(period_map_of(neutral), np.array([1.1, 0.0, 0.0, 0.0]), 0.3, WIDE)
    found = crossings(branch, 1.2)[0]
    shift = np.append(found.linear.neutral[:, 0], 0.0)
    assert distance(branch, replace(found, x=found.x + 3.0 * shift), 1) < 1e-12
    aside = replace(found, x=found.x + 1e-3 * np.array([1.0, 0.0, 0.0, 0.0, 0.0]))
    assert distance(branch, aside, 1) > 1e-4


def test_a_graze_within_a_hundred_thousandth_of_a_fold_is_distinguished_from_it():
    run = ContinuationSettings(0.33, 0.47)
    period_map = period_map_of(lambda speed: backlash_oscillator(speed, mean=0.0106))
    branch = branch_at(period_map, np.array([1.01, 0.0]), 0.335, run)
    folds, grazes = ([special.point.value for special in branch.of(kind)] for kind in (Kind.FOLD, Kind.GRAZE))
    nearest = min(abs(fold / graze - 1.0) for fold in folds for graze in grazes)
    assert 1e-7 < nearest < 1e-5
    assert_same_from_the_other_end(branch, run)


def test_two_folds_a_hundred_thousandth_apart_are_both_found():
    """The distance corresponds to 0.1 rpm at 11 000 rpm."""
    period_map = period_map_of(lambda speed: backlash_oscillator(speed, mean=0.4), 1e-14)
    branch = branch_at(period_map, np.array([1.4, 0.0]), 0.5, ContinuationSettings(0.45, 2.1))
    folds = [special.point.value for special in branch.of(Kind.FOLD)]
    assert folds == pytest.approx([0.968919631757, 0.968911121069], rel=1e-9)
    assert branch.ends == (BranchEnd.LIMIT, BranchEnd.LIMIT)


def test_contact_only_damping_with_a_square_wave_stiffness_gives_one_list_from_both_ends():
    period_map = period_map_of(
        lambda speed: one_degree(
            0.02,
            stiffness=((0.0,), (0.0,)),
            load=((0.0,), (1.0,)),
            lower=-np.inf,
            upper=0.0,
            pieces=(square_wave(),),
            contact_damping=0.08,
        )
    )
    run = ContinuationSettings(0.6, 1.3)
    branch = branch_at(period_map, np.array([2.714052622869, 1.718419252155 / 0.78]), 0.78, run)
    assert branch.of(Kind.GRAZE)
    assert_same_from_the_other_end(branch, run)


def test_multipliers_of_an_undamped_oscillator_multiply_to_one():
    run = ContinuationSettings(1.2, 2.4)
    period_map = period_map_of(lambda speed: backlash_oscillator(speed, 0.0))
    branch = branch_at(period_map, np.array([1.0, 0.0]), 2.35, run)
    assert branch.points[-1].value == pytest.approx(2.4)
    assert not branch.of(Kind.TORUS)
    for point in branch.points:
        assert np.prod(point.multipliers).real == pytest.approx(1.0, abs=1e-9)


def test_without_any_damping_a_branch_ends_for_a_named_reason_at_orbits_that_are_right():
    run = ContinuationSettings(0.3, 2.4, max_points=10)
    period_map = period_map_of(lambda speed: backlash_oscillator(speed, 0.0))
    branch = branch_at(period_map, np.array([1.1, 0.0]), 0.4, run)
    assert set(branch.ends) <= {BranchEnd.LIMIT, BranchEnd.POLE, BranchEnd.POINTS}
    assert not branch.of(Kind.TORUS), "the pair of a map that keeps areas cannot leave the circle"
    for point in branch.points:
        assert np.abs(period_map.gap(point.z, point.u)).max() < 1e-8


def test_a_machine_whose_meshes_damp_nothing_gives_one_list_from_both_ends():
    model = build_model(make_machine(torque=1300.0, mesh_damping=0.0))
    period_map = PeriodMap(speed_family(model), 1, 1e-9)
    state = simulate(model, 5000.0, Settings(tolerance=1e-7)).state
    run = ContinuationSettings(4900.0, 5200.0)
    branch = branch_at(period_map, period_map.to_weighted(state, float(np.log(5000.0))), 5000.0, run)
    assert_same_from_the_other_end(branch, run)
