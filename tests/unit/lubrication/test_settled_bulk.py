"""Bulk temperatures are the fixed point of the step from loss to temperature."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from facegear.errors import NotConverged
from facegear.lubrication.heat import BULK_TOLERANCE, TooHot
from facegear.lubrication.machine_loss import settled_bulk

KNOWN = SimpleNamespace(bulk=None, oil_temperature=20.0, oil=SimpleNamespace(flash_point=250.0))


def settled(step, rows=2):
    return settled_bulk(step, KNOWN, np.ones(rows), 100.0)


@given(slopes=st.lists(st.floats(-0.95, 0.6), min_size=4, max_size=4))
def test_a_step_that_contracts_settles_at_its_fixed_point(slopes):
    slopes = np.reshape(slopes, (2, 2))
    expected = 10.0 / (1.0 - slopes)
    bulk = settled(lambda before: slopes * before + 10.0)
    np.testing.assert_allclose(bulk, expected, atol=BULK_TOLERANCE * 2.5)


def test_a_step_that_never_settles_ends_in_one_line():
    turned = np.array([[0.0, -1.0], [1.0, 0.0]])
    with pytest.raises(NotConverged, match=r"bulk temperature did not converge at 100 rad/s: 60 steps"):
        settled(lambda before: 30.0 + 5.0 * np.sin(1e6 * before) @ turned)


def test_a_body_above_the_flash_point_of_the_oil_is_refused():
    with pytest.raises(TooHot):
        settled(lambda before: before + 100.0)
