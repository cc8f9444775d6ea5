"""Interpolation of many small tables."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from facegear.lubrication.loss import monotone_at


@given(nodes=st.integers(2, 7), seed=st.integers(0, 2**32 - 1))
def test_tables_are_interpolated_as_by_scipy_s_pchip(nodes, seed):
    rng = np.random.default_rng(seed)
    at_nodes = np.cumsum(rng.uniform(0.05, 1.0, nodes))
    values = rng.normal(size=(2, 8, nodes))
    values[:, :3] = np.sort(values[:, :3])
    values[:, 3] = 1.0
    places = rng.uniform(at_nodes[0], at_nodes[-1], 8)
    places[0], places[1] = at_nodes[0], at_nodes[-1]
    expected = [
        [PchipInterpolator(at_nodes, row)(at) for row, at in zip(table, places, strict=True)]
        for table in values
    ]
    np.testing.assert_allclose(monotone_at(at_nodes, values, places), expected, rtol=1e-12, atol=1e-12)
