"""Counts of one compiled pass equal its definitions applied to whole arrays."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_layout

from facegear.machine.kinematics import GEOMETRIC
from facegear.sharing.even_shares import sharing_coefficient
from facegear.sharing.groups import load_groups
from facegear.sharing.quantities import tally
from facegear.sharing.statistics import defined_mean

LAYOUT = make_layout(kinematics=GEOMETRIC)
GROUPS = load_groups(LAYOUT)


@settings(deadline=None)
@given(seed=st.integers(0, 2**32 - 1), cycles=st.integers(1, 4), empty=st.sampled_from([0.0, 0.4, 0.95, 1.0]))
def test_one_pass_counts_what_the_definitions_say(seed, cycles, empty):
    random = np.random.default_rng(seed)
    flanks = random.uniform(1.0, 2.0, (20, 8 * cycles)) * (random.uniform(size=(20, 8 * cycles)) >= empty)
    found = tally(flanks, 8, GROUPS)
    drive, back = np.split(flanks, 2)
    loads = np.maximum(drive, back)
    np.testing.assert_allclose(found.mean, flanks.mean(axis=1), rtol=1e-13)
    np.testing.assert_array_equal(found.largest, flanks.max(axis=1))
    np.testing.assert_array_equal(found.largest_load, loads.max(axis=1))
    means = loads.reshape(10, cycles, 8).mean(axis=2)
    np.testing.assert_allclose(found.largest_mean, means.max(axis=1), rtol=1e-13)
    expected = [defined_mean(sharing_coefficient(loads[list(group.meshes)].T)) for group in GROUPS]
    np.testing.assert_allclose(found.coefficients, expected, rtol=1e-13)
    shared = [mesh for group in GROUPS for mesh in group.meshes]
    assert found.open == (loads[shared] == 0.0).any(axis=0).mean()
    works_back = back.mean(axis=1) > drive.mean(axis=1)
    idle = np.where(works_back[:, None], drive, back)
    assert found.reversed_fraction == pytest.approx((idle > 0.0).any(axis=0).mean())


def test_without_groups_nothing_is_shared():
    found = tally(np.ones((20, 8)), 8, ())
    assert found.coefficients.size == 0 and found.open == 0.0 and found.reversed_fraction == 1.0
