import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from references import against, agrees

from facegear.harmonics import Harmonics, fit_harmonics

GIVEN = Harmonics(np.array([0.0, 3.0, -1.0, 0.5]), np.array([40.0, 2.0, 0.7, -0.2]))


@against(
    "manufactured",
    "a series of three harmonics",
    capability="stiffness",
    module="facegear.harmonics",
)
@given(count=st.integers(8, 90))
def test_a_series_sampled_often_enough_comes_back(count):
    fit = fit_harmonics(GIVEN(np.arange(count) / count))
    agrees("sine coefficient", fit.series.sine[:4], GIVEN.sine, relative=1e-7, absolute=1e-12)
    agrees("cosine coefficient", fit.series.cosine[:4], GIVEN.cosine, relative=1e-7, absolute=1e-12)
    assert np.abs(fit.series.amplitudes[4:]).max(initial=0.0) < 1e-12


def test_truncation_error_falls_to_nothing_at_the_last_order_present():
    fit = fit_harmonics(GIVEN(np.arange(32) / 32))
    assert fit.truncation[2] > 0.3
    assert fit.truncation[3:].max() < 1e-12
    assert fit.orders_within(0.001) == 3


def test_orders_needed_grow_as_the_error_allowed_shrinks():
    cycles = np.arange(64) / 64
    fit = fit_harmonics(np.abs(cycles - 0.5))
    needed = [fit.orders_within(level) for level in (0.05, 0.01, 0.005)]
    assert needed == sorted(needed)
    assert needed[0] < needed[-1]


def test_sampling_error_tells_the_aliasing_of_a_kinked_curve():
    def curve(cycles):
        return np.maximum(0.0, np.cos(2 * np.pi * cycles))

    coarse, fine = (fit_harmonics(curve(np.arange(n) / n)) for n in (16, 4096))
    actual = np.abs(coarse.series.amplitudes[:4] - fine.series.amplitudes[:4])
    assert (actual <= 1.5 * coarse.sampling[:4] + 1e-9).all()


def test_too_few_samples_are_refused():
    with pytest.raises(ValueError, match="four"):
        fit_harmonics(np.ones(3))
