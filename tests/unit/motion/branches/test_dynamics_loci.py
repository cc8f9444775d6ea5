"""Curves of folds and doublings in two parameters against exact answers, and by scaling."""

from dataclasses import replace

import numpy as np
import pytest
from oscillators import backlash_oscillator
from references import against, agrees
from whole_branches import branch_at

from facegear.motion.branches.continuation import ContinuationSettings
from facegear.motion.branches.family import Plane
from facegear.motion.branches.loci import Corner, LocusRun, follow_locus
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.special import Kind


def parent(plane, second):
    period_map = PeriodMap(plane.line(second), 1, 1e-14)
    return period_map, branch_at(period_map, np.array([1.1, 0.0]), 0.5, ContinuationSettings(0.45, 2.1))


@against(
    "analytic",
    "folds and cusps of the oscillator with backlash, closed pieces with 50 digits",
    capability="branches_loci",
    module="facegear.motion.branches.loci",
)
@pytest.mark.parametrize(
    ("mean", "up", "down"),
    [
        (0.2, 0.906152433539, 0.843270350117),
        (0.3, 0.942820455680, 0.921792657119),
        (0.4, 0.968919631757, 0.968911121069),
    ],
)
def test_fold_locus_passes_the_folds_at_other_loads(mean, up, down):
    plane = Plane(("W", "Fm"), lambda speed, load: (backlash_oscillator(speed, 0.05, load), speed))
    period_map, branch = parent(plane, 0.1)
    for fold, expected in zip(branch.of(Kind.FOLD), (up, down), strict=True):
        locus = follow_locus(
            plane, 0.1, fold.kind, fold.point.x, period_map, LocusRun((0.5, 0.099), (1.2, mean))
        )
        speed, load = locus.points[-1].values
        assert load == pytest.approx(mean, rel=1e-12)
        agrees("speed of the fold at another load", speed, expected, relative=1e-8)


@against(
    "analytic",
    "folds and cusps of the oscillator with backlash, closed pieces with 50 digits",
    capability="branches_loci",
    module="facegear.motion.branches.loci",
)
def test_fold_locus_passes_its_cusp():
    plane = Plane(("W", "Fm"), lambda speed, load: (backlash_oscillator(speed, 0.05, load), speed))
    period_map, branch = parent(plane, 0.1)
    fold = branch.of(Kind.FOLD)[0]
    locus = follow_locus(plane, 0.1, fold.kind, fold.point.x, period_map, LocusRun((0.6, 0.09), (1.2, 0.6)))
    ((corner, cusp),) = locus.corners
    assert corner is Corner.CUSP
    agrees("speed and load of the cusp", cusp.values, (0.969082427114, 0.400569274852), relative=1e-8)
    speed = cusp.values[0]
    expected = np.array([1.572080659769, 0.399187896803 / speed])
    agrees("orbit at the cusp", cusp.x[:2], expected, absolute=1e-8)


@against(
    "analytic",
    "folds and cusps of the oscillator with backlash, closed pieces with 50 digits",
    capability="branches_loci",
    module="facegear.motion.branches.loci",
)
def test_two_period_doublings_meet_where_their_locus_turns():
    plane = Plane(("W", "Fa"), lambda speed, load: (backlash_oscillator(speed, 0.05, 0.1, load), speed))
    period_map, branch = parent(plane, 0.1)
    first, second = branch.of(Kind.DOUBLING)
    locus = follow_locus(plane, 0.1, first.kind, first.point.x, period_map, LocusRun((1.0, 0.05), (2.1, 0.1)))
    ((corner, turn),) = locus.corners
    assert corner is Corner.TURN
    agrees(
        "speed and load where doublings meet", turn.values, (1.793395595815, 0.074934624334), relative=1e-8
    )
    assert sorted(point.values[0] for point in (locus.points[0], locus.points[-1])) == pytest.approx(
        [first.point.value, second.point.value], rel=1e-9
    )


@against(
    "analytic",
    "scaling of the equation of motion",
    capability="branches_loci",
    module="facegear.motion.branches.loci",
)
def test_scaling_clearance_and_load_together_moves_no_fold():
    """x / s obeys the same equation: along the locus in the common scale s the speed stays."""

    def at(speed, scale):
        system = backlash_oscillator(speed)
        edges = {"lower": scale * system.lower, "upper": scale * system.upper}
        return replace(system, load=scale * system.load, **edges), speed

    plane = Plane(("W", "s"), at)
    period_map, branch = parent(plane, 1.0)
    fold = branch.of(Kind.FOLD)[1]
    locus = follow_locus(plane, 1.0, fold.kind, fold.point.x, period_map, LocusRun((0.5, 0.8), (1.2, 1.3)))
    speeds = np.array([point.values[0] for point in locus.points])
    assert np.ptp(np.array([point.values[1] for point in locus.points])) > 0.49
    agrees("speed of the fold", speeds, branch.of(Kind.FOLD)[1].point.value, relative=1e-10)
