"""A branch has the same special points, grazes too, whichever end it is followed from and with any step."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from oscillators import backlash_oscillator
from whole_branches import branch_at

from facegear.motion.branches.continuation import BranchEnd, ContinuationSettings, follow, reverse_tangent
from facegear.motion.branches.family import Family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.special import Kind
from facegear.motion.branches.switching import doubled_branch

WIDE = ContinuationSettings(0.25, 2.8)


def oscillator_branch(damping, mean, ratio, run):
    def at(speed):
        return backlash_oscillator(speed, damping, mean, ratio * mean), speed

    return branch_at(PeriodMap(Family("W", at), 1, 1e-10), np.array([1.0 + mean, 0.0]), run.p_max, run)


def assert_same_points(branch, other):
    there, again = (sorted((s.kind, s.point.value) for s in each.specials) for each in (branch, other))
    assert [kind for kind, _ in there] == [kind for kind, _ in again]
    assert [value for _, value in there] == pytest.approx([value for _, value in again], rel=1e-6)


def doubled_from_both_ends(parent, run):
    """Pairs of one branch of twice the period, from the doublings at both its ends."""
    children = [
        (special, doubled_branch(parent.period_map, special, run)) for special in parent.of(Kind.DOUBLING)
    ]
    return [
        (first, second)
        for number, (_, first) in enumerate(children)
        for special, second in children[number + 1 :]
        if first.ends[1] is BranchEnd.DOUBLING
        and abs(first.points[-1].value / special.point.value - 1.0) < 1e-6
    ]


@settings(max_examples=2, deadline=None)
@given(damping=st.floats(0.03, 0.08), mean=st.floats(0.08, 0.3), ratio=st.floats(0.8, 1.4))
@example(damping=0.022, mean=0.238, ratio=0.99).via("two doublings of a period-two branch in one step")
def test_period_two_branches_have_the_same_points_from_both_doublings(damping, mean, ratio):
    for first, second in doubled_from_both_ends(oscillator_branch(damping, mean, ratio, WIDE), WIDE):
        assert_same_points(first, second)


def test_a_graze_beside_the_doubling_that_a_branch_begins_at_is_found():
    parent = oscillator_branch(0.037, 0.171, 1.48, WIDE)
    beside = [special for special in parent.specials if special.point.value < 0.7]
    ((first, second),) = doubled_from_both_ends(replace(parent, specials=beside), WIDE)
    assert first.of(Kind.GRAZE)
    assert_same_points(first, second)


def test_period_four_branches_have_the_same_points_from_both_doublings():
    parent = oscillator_branch(0.05, 0.1, 1.0, WIDE)
    twice = doubled_branch(parent.period_map, parent.of(Kind.DOUBLING)[0], WIDE)
    pairs = doubled_from_both_ends(twice, WIDE)
    assert pairs
    for first, second in pairs:
        assert_same_points(first, second)


@pytest.mark.parametrize("largest", [1.2, 0.05])
def test_a_branch_has_the_same_points_backwards_with_other_steps(largest):
    branch = oscillator_branch(0.037, 0.171, 1.48, WIDE)
    back = follow(
        branch.period_map, reverse_tangent(branch.points[-1]), replace(WIDE, ds_max=largest), both_ways=False
    )
    assert len(branch.of(Kind.GRAZE)) >= 1
    assert_same_points(branch, back)
