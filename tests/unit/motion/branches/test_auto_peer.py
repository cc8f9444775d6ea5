"""Folds and period doublings that AUTO finds on a smoothed law, with the smoothing going to zero.

docs/measured/auto_peer.csv: AUTO as xpplab 0.1.2 brings it, oscillators of one coordinate
with max(y, 0) replaced by (y + sqrt(y^2 + e^2)) / 2 for e of 0.004, 0.002 and 0.001, the forcing from a limit
cycle of two more coordinates, 240 or 300 mesh intervals of 4 points. speed_at_0: Aitken's limit of the three.
What it cannot see is the law itself, which is written the same in both.
"""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from law_oscillators import law_period_map
from oscillators import backlash_oscillator
from references import against, agrees
from whole_branches import branch_at

from facegear.meshing.power import PowerLaw
from facegear.motion.branches.continuation import ContinuationSettings
from facegear.motion.branches.family import Family
from facegear.motion.branches.period_map import PeriodMap
from facegear.motion.branches.special import Kind

AUTO = pd.read_csv(Path(__file__).parents[4] / "docs" / "measured" / "auto_peer.csv")
LOADS = {"a": (0.1, 0.05), "b": (0.1, 0.1), "Fm2": (0.2, 0.05), "Fm3": (0.3, 0.05)}
"""Mean load and amplitude of the oscillators with backlash, dimensionless."""
KINDS = {"fold": Kind.FOLD, "period doubling": Kind.DOUBLING}


def make_branch(case):
    """Follow the motions of period one of a case over its speeds."""
    if case == "f":
        period_map = law_period_map(PowerLaw(), 0.02, 0.1, 1e-11)
        return branch_at(period_map, np.array([1.2, 0.0]), 1.0, ContinuationSettings(0.8, 1.2))
    mean, amplitude = LOADS[case]

    def at(speed):
        return backlash_oscillator(speed, 0.05, mean, amplitude, None), speed

    period_map = PeriodMap(Family("W", at), 1, 1e-13)
    return branch_at(period_map, np.array([1.0 + mean, 0.0]), 0.45, ContinuationSettings(0.4, 2.2))


@against(
    "third-party program",
    "AUTO by xpplab 0.1.2 on a smoothed law, the smoothing going to zero (docs/measured/auto_peer.csv)",
    capability="branches",
    module="facegear.motion.branches.continuation",
)
@pytest.mark.parametrize("case", AUTO["case"].unique())
def test_auto_finds_our_folds_and_doublings_as_its_smoothing_goes_to_zero(case):
    branch, rows = make_branch(case), AUTO[AUTO["case"] == case]
    for kind, expected in rows.groupby("kind")["speed_at_0"]:
        found = [special.point.value for special in branch.of(KINDS[kind])]
        agrees(f"speed of a {kind}, dimensionless", sorted(found), sorted(expected), relative=2e-5)


def test_the_peer_holds_twelve_points_that_converge():
    steps = [AUTO["speed_at_0.002"] - AUTO["speed_at_0.004"], AUTO["speed_at_0.001"] - AUTO["speed_at_0.002"]]
    assert len(AUTO) == 12
    assert (steps[1].abs() < 0.5 * steps[0].abs()).all()
