"""Exact answers for oscillators of one and two degrees of freedom: every special point, and none besides.

The numbers were found in closed-form pieces with 50 digits or high-order Taylor series, their orbits
confirmed by DOP853 with located events.
"""

from functools import cache

import numpy as np
import pytest
from oscillators import backlash_oscillator, meissner, one_degree, two_coordinates
from references import against, agrees
from whole_branches import branch_at

from facegear.motion.branches.continuation import (
    Branch,
    BranchEnd,
    ContinuationSettings,
    follow,
    reverse_tangent,
)
from facegear.motion.branches.family import Family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import at_parameter
from facegear.motion.branches.special import Kind
from facegear.motion.branches.switching import doubled_branch, symmetry_broken_branch
from facegear.motion.plan import State

WIDE = ContinuationSettings(0.5, 2.2)


def backlash(amplitude=0.05, in_gap=None, mean=0.1, tolerance=1e-14):
    def at(speed):
        return backlash_oscillator(speed, 0.05, mean, amplitude, in_gap), speed

    return PeriodMap(Family("W", at), 1, tolerance)


def square_wave(in_gap=None):
    return PeriodMap(Family("W", lambda speed: (meissner(0.05, True, in_gap), speed)), 1, 1e-14)


def two_sided():
    def at(speed):
        return one_degree(0.1, load=((0.0, 0.0), (0.0, 2.0 * speed**2))), speed

    return PeriodMap(Family("W", at), 1, 1e-14)


def orbit(period_map, speed, place, velocity):
    u = float(np.log(speed))
    return at_parameter(
        period_map, period_map.to_weighted(State(np.array([place]), np.array([velocity])), u), u
    )


def state_of(period_map, point):
    state = period_map.state(point.z, point.u)
    return float(state.displacement[0]), float(state.velocity[0])


def places(branch: Branch, *kinds: Kind):
    return [special.point.value for special in branch.of(*kinds)]


@cache
def branch_a(amplitude=0.05, in_gap=None) -> Branch:
    period_map = backlash(amplitude, in_gap)
    return branch_at(period_map, np.array([1.1, 0.0]), 0.3, ContinuationSettings(0.25, 2.6))


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_oracle_a_has_two_folds_and_two_grazes():
    branch = branch_a()
    agrees("speed of a fold", places(branch, Kind.FOLD), [0.828463984388, 0.708031618722], relative=1e-9)
    agrees("speed of a graze", places(branch, Kind.GRAZE), [0.820631087712, 1.407088466023], relative=1e-9)
    assert len(branch.specials) == 4
    assert branch.ends == (BranchEnd.LIMIT, BranchEnd.LIMIT)
    for special, expected in zip(
        branch.of(Kind.FOLD),
        [(1.212219045727, 0.028689520565), (1.003241047571, 0.246715686858)],
        strict=True,
    ):
        agrees("orbit at a fold", state_of(branch.period_map, special.point), expected, absolute=1e-8)
        agrees("multiplier at a fold", special.multiplier, 1.0, absolute=1e-7)


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.points",
)
@pytest.mark.parametrize(
    ("speed", "state", "extremes", "multipliers"),
    [
        (
            0.75,
            (1.2287262208378, 0.1646816908020),
            (0.833101126210, 1.315277482800),
            (1.7871104711, 0.2421112145),
        ),
        (
            0.78,
            (1.2479943334064, 0.1062626746043),
            (0.888176189384, 1.286916018630),
            (1.9690045258, 0.2269411205),
        ),
    ],
)
def test_unstable_orbits_of_oracle_a(speed, state, extremes, multipliers):
    point = orbit(backlash(), speed, round(state[0], 2), round(state[1], 2))
    agrees("unstable orbit", state_of(backlash(), point), state, absolute=1e-10)
    maxima, minima = point.extrema[0]
    agrees("extremes of the unstable orbit", (minima[0], maxima[0]), extremes, absolute=1e-10)
    agrees("multipliers of the unstable orbit", point.multipliers.real, multipliers, absolute=1e-9)
    assert not point.stable


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_oracle_b_has_its_folds_and_doublings():
    branch = branch_a(0.1)
    agrees("speed of a fold", places(branch, Kind.FOLD), [0.731361127148, 0.585331569643], relative=1e-9)
    agrees(
        "speed of a period doubling",
        places(branch, Kind.DOUBLING),
        [1.226700634663, 1.952684741709],
        relative=1e-9,
    )
    assert len(branch.specials) == 4 + len(branch.of(Kind.GRAZE)) == 5
    expected = [(0.886008149142, 0.031390598949), (0.964001267987, 0.016454373324)]
    for special, state in zip(branch.of(Kind.DOUBLING), expected, strict=True):
        agrees("orbit at a period doubling", state_of(branch.period_map, special.point), state, absolute=1e-8)


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.switching",
)
@pytest.mark.parametrize("start", [0, 1])
def test_period_two_curve_of_oracle_b_joins_both_doublings(start):
    parent = branch_a(0.1)
    branch = doubled_branch(parent.period_map, parent.of(Kind.DOUBLING)[start], WIDE)
    assert branch.ends == (BranchEnd.DOUBLING, BranchEnd.DOUBLING)
    agrees(
        "ends of the period-two branch",
        sorted(branch.values[[0, -1]]),
        [1.226700634663, 1.952684741709],
        relative=1e-7,
    )
    agrees(
        "speed of a fold", sorted(places(branch, Kind.FOLD)), [1.030052101340, 1.404839759900], relative=1e-9
    )
    agrees(
        "speed of a period doubling",
        sorted(places(branch, Kind.DOUBLING)),
        [1.400378957838, 1.846195450789],
        relative=1e-9,
    )
    agrees(
        "speed of a graze",
        sorted(places(branch, Kind.GRAZE)),
        [1.316117205156, 1.843670922641],
        relative=1e-9,
    )
    assert len(branch.specials) == 6


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.points",
)
def test_unstable_period_two_orbit_of_oracle_b():
    point = orbit(backlash(0.1).over(2), 1.2, 0.4151, -0.0089)
    agrees("unstable orbit", state_of(backlash(0.1), point), (0.415105437149, -0.008886017208), absolute=1e-9)
    agrees(
        "multipliers of the unstable orbit",
        point.multipliers.real,
        (3.3609216924, 0.1044117773),
        absolute=1e-8,
    )


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_oracle_c_contact_only_damping():
    branch = branch_a(0.05, 0.01)
    agrees("speed of a fold", places(branch, Kind.FOLD), [0.828196556373, 0.625813889165], relative=1e-9)
    assert not branch.of(Kind.DOUBLING, Kind.TORUS, Kind.BRANCH)
    point = orbit(branch.period_map, 0.75, 1.27, 0.12)
    agrees(
        "unstable orbit", state_of(branch.period_map, point), (1.265801278624, 0.122418658071), absolute=1e-9
    )
    agrees(
        "multipliers of the unstable orbit",
        point.multipliers.real,
        (2.2526746161, 0.2628816387),
        absolute=1e-8,
    )


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.points",
)
def test_saltation_matters_where_damping_in_contact_meets_variable_stiffness():
    period_map = square_wave(0.01)
    point = orbit(period_map, 0.78, 2.714052622869, 1.718419252155)
    agrees("orbit", state_of(period_map, point), (2.714052622869, 1.718419252155), absolute=1e-9)
    assert point.pairs[0] == pytest.approx(0.25659969 + 0.75302207j, abs=1e-7)


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.switching",
)
def test_oracle_d_breaks_its_symmetry_at_a_branch_point():
    period_map = two_sided()
    start = orbit(period_map, 0.4, *SYMMETRIC)
    branch = follow(period_map, start, ContinuationSettings(0.3, 0.6))
    agrees("speed of the branch point", places(branch, Kind.BRANCH), [0.348540186191], relative=1e-8)
    assert len(branch.specials) == 1
    special = branch.specials[0]
    agrees(
        "orbit at the branch point",
        state_of(period_map, special.point),
        (1.674260831215, 0.364887573423),
        absolute=1e-8,
    )
    assert abs(special.point.tangent[-1]) > 0.1
    aside = symmetry_broken_branch(period_map, special, ContinuationSettings(0.345, 0.6))
    point = aside.points[-1]
    deepest, shallowest = point.extrema[0][0][0], point.extrema[0][1][0]
    assert abs(deepest + shallowest) > 1e-3
    assert np.abs(period_map.gap(point.z, point.u)).max() < 1e-9
    middle = aside.points[len(aside.points) // 2]
    for largest in (0.3, 0.1, 0.05, 0.02, 0.011):
        again = follow(period_map, middle, ContinuationSettings(0.345, 0.6, ds_max=largest))
        assert again.ends[0] is BranchEnd.SYMMETRY, "its mirror image is a branch of its own"
        agrees("end of the branch without symmetry", again.points[0].value, 0.348540186191, relative=1e-8)
        assert not again.of(Kind.FOLD, Kind.BRANCH)


SYMMETRIC = (1.674260831215, 0.364887573423)


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_oracle_e_square_wave_folds_and_unstable_orbit():
    period_map = square_wave()
    branch = follow(
        period_map, orbit(period_map, 0.75, 2.901723445814, -1.084165628890), ContinuationSettings(0.6, 1.3)
    )
    agrees(
        "speed of a fold", sorted(places(branch, Kind.FOLD)), [0.688016103000, 0.871223996023], relative=1e-9
    )
    assert not branch.of(Kind.DOUBLING, Kind.TORUS, Kind.BRANCH)
    point = orbit(period_map, 0.75, 2.9, -1.08)
    agrees("unstable orbit", state_of(period_map, point), (2.901723445814, -1.084165628890), absolute=1e-9)
    agrees(
        "multipliers of the unstable orbit",
        point.multipliers.real,
        (1.7914031721, 0.2415310486),
        absolute=1e-8,
    )


@against(
    "analytic",
    "special points of oscillators in closed pieces with 50 digits, or high-order Taylor series",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_two_coordinates_lose_stability_to_a_torus_and_regain_it():
    period_map = PeriodMap(Family("W", lambda speed: (two_coordinates(), speed)), 1, 1e-14)
    branch = branch_at(period_map, np.zeros(4), 2.0, ContinuationSettings(1.95, 2.6))
    agrees(
        "speed of a torus bifurcation",
        places(branch, Kind.TORUS),
        [2.199391673612, 2.374997781329],
        relative=1e-9,
    )
    assert len(branch.specials) == 2
    for special in branch.specials:
        agrees("magnitude of the multipliers there", abs(special.multiplier), 1.0, absolute=1e-9)
    assert branch.specials[0].multiplier == pytest.approx(-0.532627694 + 0.846349655j, abs=1e-8)


@against(
    "analytic",
    "onset of contact loss of the linear oscillator",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_a_brief_loss_of_contact_at_resonance_is_met_by_long_steps():
    """At the peak of a linear resonance the amplitude exceeds the mean deflection by 1 in 4000 only."""
    amplitude, mean, damping = 0.00999, 0.1, 0.1
    squares = np.roots([1.0 - (amplitude / mean) ** 2, damping**2 - 2.0, 1.0])
    branch = branch_at(
        backlash(amplitude, mean=mean), np.array([1.1, 0.0]), 0.5, ContinuationSettings(0.5, 2.0)
    )
    agrees("speed of a graze", places(branch, Kind.GRAZE), np.sqrt(np.sort(squares)), relative=1e-9)
    between = (branch.values**2 > squares.min()) & (branch.values**2 < squares.max())
    assert not between.any()
    assert np.diff(branch.values).min() > 0.0


@pytest.mark.parametrize("largest", [1.2, 0.075])
def test_same_points_with_other_steps_from_either_end(largest):
    period_map = backlash()
    expected = branch_a()
    start = reverse_tangent(orbit(period_map, 2.2, *state_of(period_map, expected.points[-1])))
    branch = follow(period_map, start, ContinuationSettings(0.25, 2.6, ds_max=largest, first=0.005))
    again = [(s.kind, pytest.approx(s.point.value, rel=1e-9)) for s in branch.specials[::-1]]
    assert [(s.kind, s.point.value) for s in expected.specials] == again


@against(
    "own convergence",
    "integration tolerance 1e-10",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
def test_tolerance_moves_special_points_by_no_more_than_a_millionth():
    lists = [
        branch_at(
            backlash(tolerance=tolerance), np.array([1.1, 0.0]), 0.3, ContinuationSettings(0.25, 2.6)
        ).specials
        for tolerance in (1e-6, 1e-10)
    ]
    assert [s.kind for s in lists[0]] == [s.kind for s in lists[1]]
    for loose, tight in zip(*lists, strict=True):
        agrees("speed of a special point", loose.point.value, tight.point.value, relative=1e-6)


def test_multipliers_over_two_periods_are_squares():
    period_map = backlash()
    point = orbit(period_map, 0.75, 1.2287, 0.1647)
    twice = at_parameter(period_map.over(2), point.z, point.u)
    assert np.sort(twice.multipliers.real) == pytest.approx(np.sort(point.multipliers.real) ** 2, rel=1e-9)


def test_a_period_two_orbit_may_be_started_at_its_other_phase():
    period_map = backlash(0.1)
    point = orbit(period_map.over(2), 1.2, 0.4151, -0.0089)
    other = period_map.over(2).images(point.z, point.u)[1]
    again = at_parameter(period_map.over(2), other, point.u)
    assert np.abs(again.z - point.z).max() > 0.1
    assert again.multipliers.real == pytest.approx(point.multipliers.real, rel=1e-8)
