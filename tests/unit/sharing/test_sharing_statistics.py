import numpy as np
import pytest

from facegear.sharing.even_shares import sharing_coefficient
from facegear.sharing.statistics import average, held_over_starts


def averaged(values, periodic=False):
    values = np.asarray(values, dtype=float)
    return average(values, np.zeros(values.shape, dtype=bool), periodic=periodic)


def test_undefined_instants_are_counted_and_not_averaged_in():
    found = averaged([[1.0, np.nan, 2.0, np.nan]])
    assert found.mean == 1.5
    assert found.undefined_fraction == 0.5


def test_a_machine_without_any_load_has_no_coefficient():
    found = averaged(sharing_coefficient(np.zeros((3, 8, 2))))
    assert np.isnan(found.mean)
    assert found.undefined_fraction == 1.0


def test_periodic_motion_has_an_exact_mean():
    assert averaged([[1.0, 2.0], [1.5, 1.7]], periodic=True).half_width == 0.0


def test_confidence_interval_holds_the_true_mean_of_correlated_cycles_about_as_often_as_it_says():
    random = np.random.default_rng(0)
    hits, runs = 0, 300
    for _ in range(runs):
        noise = random.normal(size=400)
        slow = np.zeros(400)
        for i in range(1, 400):
            slow[i] = 0.6 * slow[i - 1] + noise[i]
        found = averaged(1.5 + 0.05 * slow[:, None] * np.ones((1, 4)))
        hits += abs(found.mean - 1.5) <= found.half_width
    assert 0.88 <= hits / runs <= 0.99


def switching(random, cycles, stay):
    """Means of cycles of a motion that changes between two ways after `stay` cycles on average."""
    way, left, values = random.integers(2), random.exponential(stay), np.empty(cycles)
    for i in range(cycles):
        while left < 0.0:
            way, left = 1 - way, left + random.exponential(stay)
        values[i] = 1.0 + way + 0.2 * random.normal()
        left -= 1.0
    return values[:, None]


@pytest.mark.parametrize("stay", [1, 10, 100, 300])
def test_confidence_interval_over_starts_holds_the_true_mean_of_a_motion_slower_than_the_run(stay):
    random = np.random.default_rng(0)
    hits, runs = 0, 200
    for _ in range(runs):
        own, *again = (averaged(switching(random, 200, stay)) for _ in range(4))
        found = held_over_starts(own, [other.mean for other in again], 0.95)
        hits += abs(found.mean - 1.5) <= found.half_width
    assert hits / runs >= 0.92


def test_confidence_interval_stays_that_of_the_batches_where_starts_agree_or_are_missing():
    random = np.random.default_rng(0)
    own = averaged(1.5 + 0.05 * random.normal(size=(400, 1)))
    near = [own.mean + 0.3 * own.half_width, np.nan]
    assert held_over_starts(own, [], 0.95) == held_over_starts(own, near, 0.95) == own
    exact = averaged([[1.0, 2.0], [1.5, 1.7]], periodic=True)
    assert held_over_starts(exact, [1.9], 0.95) == exact


def test_single_cycles_scatter_more_than_the_mean_is_uncertain():
    random = np.random.default_rng(1)
    found = averaged(1.5 + 0.2 * random.random((200, 1)) * np.ones((1, 8)))
    assert found.cycle_low < found.mean - 3 * found.half_width
    assert found.cycle_high > found.mean + 3 * found.half_width
    assert found.minimum <= found.cycle_minimum <= found.mean


def test_extremes_are_those_of_all_cycles():
    found = averaged([[1.0, 1.2], [1.9, 1.3]])
    assert (found.minimum, found.maximum) == (1.0, 1.9)
    assert found.cycle_minimum == pytest.approx(np.median([1.0, 1.3]))
