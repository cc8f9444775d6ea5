"""Jumps at the folds of the example are found on grids that are drawn at random around them."""

import pytest

import facegear

UP, DOWN = 8777.0, 8244.2
"""Folds of the example's motions, rpm, as its own sweep and the continuation of branches have them."""


@pytest.fixture(scope="module")
def gearbox():
    return facegear.example()


@pytest.mark.parametrize(
    ("low", "high", "points"),
    [
        (8175.0, 9132.8, 2),
        (8222.9, 9051.3, 6),
        (8027.8, 8909.8, 6),
        (8196.3, 8962.9, 5),
        (6100.0, 9900.0, 12),
    ],
)
def test_both_folds_of_the_example_are_jumps_on_any_grid(gearbox, low, high, points):
    """A run from the last orbit before a fold fell over it, and the jump was lost."""
    jumps = gearbox.sweep(low, high, points=points).jumps().set_index("direction")
    for direction, fold in (("up", UP), ("down", DOWN)):
        found = jumps.loc[[direction]]
        near = found[(found["speed_after_rpm"] - fold).abs() <= found["error_rpm"] + 1.0]
        assert len(near) == 1, direction


@pytest.mark.parametrize(
    ("low", "high", "points"), [(8021.6, 8800.2, 5), (8187.9, 8797.5, 2), (8140.8, 8934.8, 4)]
)
def test_an_orbit_lost_just_before_a_fold_leaves_the_error_small(gearbox, low, high, points):
    """Newton's method ended a resolution before the fold, and the error was the step of the sweep."""
    jumps = gearbox.sweep(low, high, points=points).jumps()
    assert (jumps["kind"] == "jump").all()
    assert (jumps["error_rpm"] < 5.0).all()
    assert {"up", "down"} == set(jumps["direction"])
