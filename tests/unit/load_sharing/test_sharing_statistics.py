import numpy as np
import pytest

from facegear.load_sharing.coefficients import sharing_coefficient
from facegear.load_sharing.statistics import average


def averaged(values, periodic=False):
    values = np.asarray(values, dtype=float)
    return average(values, np.zeros(values.shape, dtype=bool), periodic=periodic)


def test_undefined_instants_are_counted_and_not_averaged_in():
    found = averaged([[1.0, np.nan, 2.0, np.nan]])
    assert found.mean == 1.5
    assert found.undefined == 0.5


def test_a_machine_without_any_load_has_no_coefficient():
    found = averaged(sharing_coefficient(np.zeros((3, 8, 2))))
    assert np.isnan(found.mean)
    assert found.undefined == 1.0


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
