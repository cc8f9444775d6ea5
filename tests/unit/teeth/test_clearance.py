"""Interference and backlash of the assembled pair."""

import numpy as np
import pytest
from references import against, agrees

from facegear.teeth.analysis import analyse
from facegear.teeth.clearance import smallest_gaps
from facegear.teeth.flank_shapes import Relief


@pytest.mark.parametrize(("teeth", "depth_um"), [(26, 24.0), (24, 51.0)])
def test_gear_tip_runs_into_the_fillet_of_a_large_rack_radius(pair, teeth, depth_um):
    """numerics.md: 24 and 51 um near the inner radius, measured along the line of action."""
    found = analyse(pair(teeth, rack_tip_radius=0.25)).interference
    assert found is not None
    assert (found.gear_part, found.pinion_part) == ("tip edge", "fillet")
    assert -1e6 * found.approach == pytest.approx(depth_um, abs=2.0)
    assert found.radius == pytest.approx(0.250, abs=1e-3)
    assert 0.9 < found.gap / found.approach < 1.0


def test_default_pair_clears_by_eight_micrometres(pair):
    result = analyse(pair(26, rack_tip_radius=0.1, thinning=1e-4))
    assert result.interference is None
    assert 1e6 * result.smallest.approach == pytest.approx(8.0, abs=2.0)
    assert result.smallest.pinion_part == "fillet"


@against(
    "own convergence",
    "finer sampling",
    capability="geometry",
    module="facegear.teeth.clearance",
)
def test_gaps_do_not_depend_on_sampling(pair):
    design = pair(26, rack_tip_radius=0.25)
    found = []
    for count in (32, 128):
        phi1 = (np.arange(count) / count - 0.5) * 2 * np.pi / 23
        found.append(smallest_gaps(design, phi1, phi1 * 23 / 143)[("fillet", "tip edge")].gap)
    agrees("smallest gap, m", found[0], found[1], absolute=5e-7)


@against(
    "analytic",
    "backlash of a thinned pinion",
    capability="geometry",
    module="facegear.teeth.analysis",
)
def test_backlash_is_the_thinning(pair):
    for thinning in (0.0, 1e-4):
        result = analyse(pair(26, thinning=thinning), positions=8)
        agrees("backlash, m", result.backlash, thinning, relative=1e-7, absolute=1e-11)


@against(
    "analytic",
    "twice the normal part of a displacement",
    capability="geometry",
    module="facegear.teeth.analysis",
)
def test_pulling_the_gear_back_opens_both_flanks(pair):
    result = analyse(pair(26, gear_axial=1e-6, thinning=1e-4), positions=8)
    agrees("backlash, m", result.backlash - 1e-4, 2e-6 * np.sin(np.radians(25)), relative=0.02)


def test_pushing_the_gear_in_beyond_the_backlash_is_interference(pair):
    result = analyse(pair(26, gear_axial=-1e-4), positions=8)
    assert np.all(result.backlash < 0)
    assert result.interference is not None
    assert result.interference.side == "back"


def test_modified_flanks_are_not_taken_for_interference(pair):
    result = analyse(pair(26, thinning=1e-4, tip_relief=Relief(30e-6, 0.0, 3e-3)), positions=8)
    assert result.interference is None
