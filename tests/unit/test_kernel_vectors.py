"""Vectors of the kernels compute what NumPy does, lane by lane."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from facegear._kernels import arithmetic

FINITE = st.floats(-1e100, 1e100)


@pytest.mark.parametrize("width", [4, 8])
@given(numbers=arrays(float, (3, 16), elements=FINITE))
def test_product_and_sum_are_those_of_numpy_to_one_rounding(width, numbers):
    first, second, third = numbers
    out = np.full(16, np.nan)
    arithmetic.multiply_add(first, second, third, out, width)
    scale = np.abs(first * second) + np.abs(third)
    assert np.all(np.abs(out - (first * second + third)) <= 2**-52 * scale + 1e-307)


@pytest.mark.parametrize("width", [4, 8])
def test_numbers_that_are_none_stay_in_their_lane(width):
    first = np.ones(8)
    first[5] = np.nan
    out = np.zeros(8)
    arithmetic.multiply_add(first, np.ones(8), np.ones(8), out, width)
    assert np.isnan(out[5]) and np.all(np.delete(out, 5) == 2.0)
