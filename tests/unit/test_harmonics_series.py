import numpy as np
import pytest

from facegear.harmonics import Harmonics

SERIES = Harmonics(np.array([0.0, 2.0, -1.0]), np.array([10.0, 0.5, 3.0]))


def test_series_is_the_sum_of_its_sines_and_cosines():
    t = np.linspace(0.0, 2.0, 17)
    w = 2 * np.pi
    expected = 10 + 2 * np.sin(w * t) - np.sin(2 * w * t) + 0.5 * np.cos(w * t) + 3 * np.cos(2 * w * t)
    np.testing.assert_allclose(SERIES(t), expected, atol=1e-13)


def test_shifted_series_is_the_series_delayed():
    t = np.linspace(0.0, 1.0, 11)
    np.testing.assert_allclose(SERIES.shift(0.37)(t), SERIES(t - 0.37), atol=1e-13)


def test_mean_is_the_average_over_a_period_and_amplitudes_are_phase_free():
    t = np.arange(64) / 64
    assert SERIES(t).mean() == pytest.approx(SERIES.mean)
    np.testing.assert_allclose(SERIES.shift(0.2).amplitudes, SERIES.amplitudes)


def test_kept_series_drops_the_higher_orders_only():
    assert SERIES.truncate(1).order == 1
    np.testing.assert_array_equal(SERIES.truncate(1).cosine, SERIES.cosine[:2])


@pytest.mark.parametrize(
    ("a", "b"),
    [([1.0], [2.0]), ([0.0, 1.0], [1.0]), ([0.0, np.nan], [1.0, 1.0]), ([], [])],
)
def test_malformed_series_is_refused(a, b):
    with pytest.raises(ValueError):
        Harmonics(np.array(a), np.array(b))


def test_amplitudes_that_are_kept_cannot_be_overwritten():
    """They are found once: written into, they would have been wrong for the next who asks."""
    with pytest.raises(ValueError, match="read-only"):
        SERIES.amplitudes[1] = 0.0
