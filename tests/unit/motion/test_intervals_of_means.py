import numpy as np
import pytest

from facegear.motion.steady_state.averages import independent_interval, mean_interval, successive_interval

BATCHES, RUNS, PARTS = 16, 1000, 16


def batches_alike(correlation):
    """Means of batches (BATCHES, RUNS) around zero, each as like the one before as the correlation says."""
    return autoregressive(correlation, BATCHES)


def autoregressive(correlation, count):
    """Series (count, RUNS) of mean 0 and variance 1 in which each value is correlated with the last."""
    random = np.random.default_rng(0)
    series = np.empty((count, RUNS))
    series[0] = random.normal(size=RUNS)
    for i in range(1, count):
        fresh = np.sqrt(1.0 - correlation**2) * random.normal(size=RUNS)
        series[i] = correlation * series[i - 1] + fresh
    return series


def batches_of_slow_motion(correlation_time):
    """Means of batches (BATCHES, RUNS) of a motion that forgets over a time given in batches."""
    motion = autoregressive(np.exp(-1.0 / (PARTS * correlation_time)), BATCHES * PARTS)
    return motion.reshape(BATCHES, PARTS, RUNS).mean(axis=1)


def share_held(batches, half_width):
    return np.mean(np.abs(batches.mean(axis=0)) <= half_width)


@pytest.mark.parametrize("correlation", [0.0, 0.2, 0.4])
def test_the_interval_of_a_mean_holds_it_about_as_often_as_it_says_though_batches_are_alike(correlation):
    batches = batches_alike(correlation)
    assert share_held(batches, mean_interval(batches)) >= 0.93


@pytest.mark.parametrize("correlation_time", [0.25, 0.5, 1.0, 2.0, 4.0])
def test_the_interval_holds_the_mean_of_a_motion_that_forgets_over_some_batches(correlation_time):
    batches = batches_of_slow_motion(correlation_time)
    assert share_held(batches, mean_interval(batches)) >= 0.93


def test_the_interval_sees_a_slow_change_no_larger_than_the_scatter_of_batches():
    slow = batches_of_slow_motion(1.0)
    batches = slow / slow.std() + np.random.default_rng(1).normal(size=slow.shape)
    assert share_held(batches, mean_interval(batches)) >= 0.93


def test_the_interval_of_independent_batches_is_at_most_half_as_wide_again_in_the_median():
    batches = batches_alike(0.0)
    assert np.median(mean_interval(batches) / independent_interval(batches)) <= 1.5


def test_halves_of_a_run_that_differ_are_not_hidden_by_their_own_doubt():
    halves = np.random.default_rng(2).normal(size=(BATCHES // 2, RUNS))
    assert np.quantile(successive_interval(halves) / independent_interval(halves), 0.95) <= 2.0


def test_batches_taken_for_independent_do_not_hold_the_mean_that_often():
    batches = batches_alike(0.4)
    assert share_held(batches, independent_interval(batches)) < 0.85


def test_the_interval_is_that_of_independent_batches_where_each_makes_up_for_the_one_before():
    swinging = np.tile([1.0, -1.0], BATCHES // 2)[:, None]
    assert mean_interval(swinging) == pytest.approx(independent_interval(swinging))


def test_a_mean_without_spread_or_from_one_batch_has_no_interval():
    assert mean_interval(np.ones((BATCHES, 1))) == 0.0
    assert mean_interval(np.ones((1, 1))) == 0.0
