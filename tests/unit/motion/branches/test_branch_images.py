"""Motions that break a symmetry of their machine come with their images, as random starts find them."""

from functools import cache

import numpy as np
import pytest
from oscillators import one_degree

import facegear
from facegear.build.machine import MachineInputs
from facegear.build.tooth_numbers import ToothNumbers
from facegear.motion.branches.continuation import ContinuationSettings
from facegear.motion.branches.explore import explore, lies_on
from facegear.motion.branches.family import Family, speed_family
from facegear.motion.branches.margins import coexistence_ranges, stability_limits, stable_at
from facegear.motion.branches.motion_arrays import special_arrays
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.points import at_parameter
from facegear.motion.branches.special import Kind
from facegear.motion.branches.survey import survey
from facegear.motion.branches.tables import end_table
from facegear.motion.plan import Settings, State
from facegear.motion.steady_state.simulate import build_model, simulate, static_start

QUICK = Settings(tolerance=1e-8, settle=256, window=32, extensions=0, longest_period=4)
RANGE = ContinuationSettings(0.3, 0.6)


def two_sided():
    """Oracle (d): no mean load, so half a period later the flanks have changed places."""

    def at(speed):
        return one_degree(0.1, load=((0.0, 0.0), (0.0, 2.0 * speed**2))), speed

    return PeriodMap(Family("W", at), 1, 1e-10)


@cache
def oscillator_survey():
    period_map, u = two_sided(), float(np.log(0.4))
    state = State(np.array([1.674260831215]), np.array([0.364887573423]))
    start = at_parameter(period_map, period_map.to_weighted(state, u), u)
    return period_map, survey((period_map, start), [], RANGE, 2, 9)


def test_both_motions_that_break_the_symmetry_of_time_are_listed_as_random_starts_find_them():
    period_map, found = oscillator_survey()
    starts = np.random.default_rng(1).uniform(-2.0, 2.0, size=(40, 2))
    motions = explore(period_map, 0.33, starts, QUICK)
    states = sorted(tuple(point.z) for _, point in stable_at(found.branches, 0.33))
    assert len(states) == len(motions) == 2
    np.testing.assert_allclose(states, sorted(tuple(one.z) for one in motions), atol=1e-7)


def test_an_image_is_marked_and_its_special_points_are_not_counted_twice():
    _, found = oscillator_survey()
    assert [branch.image_of for branch in found.branches] == [None, None, 1]
    assert end_table(found.branches)["image_of"].tolist() == ["", "", "1"]
    ((low, high, numbers),) = coexistence_ranges(found.branches)
    assert (low, high) == (0.3, pytest.approx(0.348540186191, rel=1e-8))
    assert numbers == (1, 2)
    assert set(special_arrays(found.branches)["number"]) <= {0, 1}


def test_images_have_the_margins_of_their_original():
    period_map, found = oscillator_survey()
    limits = stability_limits(found.branches, [(period_map.family, 0.33, RANGE)], 0.33)
    by_branch = {n: [(one.direction, one.end_value) for one in limits if one.branch == n] for n in (1, 2)}
    assert by_branch[1] == by_branch[2]
    assert by_branch[1]


@cache
def machine_survey():
    gearbox = facegear.load("config/harmonics_only.yaml")
    teeth = ToothNumbers.of_config(gearbox.values["tooth_pair"])
    harmonics = gearbox.stiffness().content["harmonics"]
    model = build_model(
        MachineInputs(transmission=gearbox.config.transmission, teeth=teeth, harmonics=harmonics).build()
    )
    period_map = PeriodMap(speed_family(model), 1, 1e-7)
    u = float(np.log(9400.0))
    response = simulate(model, 9400.0, Settings(tolerance=1e-7))
    start = at_parameter(period_map, period_map.to_weighted(response.state, u), u)
    motions = [(period_map, motion.point, "starts") for motion in motions_of_starts(model, period_map, 8, 2)]
    run = ContinuationSettings(9400.0, 9500.0)
    return model, period_map, survey((period_map, start), motions, run, 1, 9)


def motions_of_starts(model, period_map, count, seed):
    """Motions of one mesh period at 9450 rpm on which random starts end."""
    rest = period_map.to_weighted(static_start(model), float(np.log(9450.0)))
    aside = np.random.default_rng(seed).uniform(-0.3, 0.3, size=(count, rest.size))
    motions = explore(period_map, 9450.0, rest + aside, QUICK)
    return [motion for motion in motions if motion.point is not None and motion.period == 1]


def test_with_its_images_a_few_starts_show_every_motion_that_many_starts_find():
    """Exchanging the idlers left and right maps three of the seven stable motions to another one."""
    model, period_map, found = machine_survey()
    motions = motions_of_starts(model, period_map, 60, 3)
    assert len(motions) >= 6
    for motion in motions:
        assert sum(lies_on(branch, motion.point, 1) for branch in found.branches) == 1
    stable = [number for number, _ in stable_at(found.branches, 9450.0)]
    assert len(stable) == len(motions)
    assert sum(found.branches[number].image_of is not None for number in stable) == 3


def test_an_image_has_the_multipliers_and_special_points_that_following_it_gives():
    _, period_map, found = machine_survey()
    image = next(branch for branch in found.branches if branch.image_of is not None)
    original = found.branches[image.image_of]
    for point, other in zip(image.points[1::5], original.points[1::5], strict=True):
        assert np.abs(point.multipliers) == pytest.approx(np.abs(other.multipliers), abs=1e-4)
    assert [s.kind for s in image.specials] == [s.kind for s in original.specials]
    for special in image.of(Kind.GRAZE):
        values = special.point.extrema[special.meshes[0]].ravel()
        edges = [edge[special.meshes[0]] for edge in period_map.edges(special.point.u)]
        assert min(np.abs(values - edge).min() for edge in edges) < 1e-5
