"""The example machine has clean folds: rounding, chunks, threads and other speeds of a sweep move no jump."""

import numpy as np
import pytest

import facegear

pytestmark = pytest.mark.xdist_group("notebooks")  # the example's contact is computed once a process

WITHIN_RPM = 2.0
"""Twice the width of a bracket."""
BACKLASH_UM = 100.0
VARIANTS = {
    "perturbed": {"transmission.backlash_um": BACKLASH_UM * (1.0 + 1e-12)},
    "chunks": {"dynamics.sweep.chunks": 3},
    "other speeds": {"dynamics.sweep.from_rpm": 6050, "dynamics.sweep.points": 20},
}


@pytest.fixture(scope="module")
def gearbox():
    return facegear.example()


@pytest.fixture(scope="module")
def swept(gearbox):
    return gearbox.sweep()


def jumps_of(sweep):
    """Direction and both speeds (rpm) of every jump."""
    jumps = sweep.jumps()
    return jumps["direction"].to_list(), jumps[["speed_before_rpm", "speed_after_rpm"]].to_numpy()


def test_example_is_periodic_at_nine_speeds_of_ten(swept):
    assert swept.table()["periodic"].mean() >= 0.9


def test_example_jumps_up_and_down_between_periodic_motions(swept):
    jumps = swept.jumps()
    assert sorted(jumps["direction"]) == ["down", "up"]
    for side in ("class_before", "class_after"):
        assert jumps[side].str.startswith("period").all()


@pytest.mark.parametrize("name", VARIANTS)
def test_jumps_of_the_example_survive(gearbox, swept, name):
    assert gearbox.values["transmission"]["backlash_um"] == BACKLASH_UM
    directions, speeds = jumps_of(swept)
    other_directions, other_speeds = jumps_of(gearbox.with_values(VARIANTS[name]).sweep(threads=2))
    assert other_directions == directions
    np.testing.assert_allclose(other_speeds, speeds, rtol=0.0, atol=WITHIN_RPM)
