import numpy as np
import pytest

from facegear.dynamics.steady_state.averages import independent_interval, mean_interval

BATCHES, RUNS = 16, 1000


def batches_alike(correlation):
    """Means of batches (BATCHES, RUNS) around zero, each as like the one before as the correlation says."""
    random = np.random.default_rng(0)
    series = np.empty((BATCHES, RUNS))
    series[0] = random.normal(size=RUNS)
    for batch in range(1, BATCHES):
        fresh = np.sqrt(1.0 - correlation**2) * random.normal(size=RUNS)
        series[batch] = correlation * series[batch - 1] + fresh
    return series


def share_held(batches, half_width):
    return np.mean(np.abs(batches.mean(axis=0)) <= half_width)


@pytest.mark.parametrize("correlation", [0.0, 0.2, 0.4])
def test_the_interval_of_a_mean_holds_it_about_as_often_as_it_says_though_batches_are_alike(correlation):
    batches = batches_alike(correlation)
    assert share_held(batches, mean_interval(batches)) >= 0.88


def test_batches_taken_for_independent_do_not_hold_the_mean_that_often():
    batches = batches_alike(0.4)
    assert share_held(batches, independent_interval(batches)) < 0.85


def test_the_interval_is_that_of_independent_batches_where_each_makes_up_for_the_one_before():
    swinging = np.tile([1.0, -1.0], BATCHES // 2)[:, None]
    assert mean_interval(swinging) == independent_interval(swinging)


def test_a_mean_without_spread_or_from_one_batch_has_no_interval():
    assert mean_interval(np.ones((BATCHES, 1))) == 0.0
    assert mean_interval(np.ones((1, 1))) == 0.0
