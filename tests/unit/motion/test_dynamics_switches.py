"""Contact switches are passed however the motion meets them."""

import numpy as np
import pytest
from oscillators import backlash_oscillator

from facegear.motion.integrator.integrator import Integrator


@pytest.mark.parametrize("rate", [1.0, 100.0, 1e4])
@pytest.mark.parametrize("gap", [3e-14, 1e-13, 1e-12, 1e-11])
def test_time_moves_on_where_an_edge_is_nearer_than_time_can_tell(gap, rate):
    """At 10 224 rpm the paper's machine once stood for ever a rounding error before a fast contact switch."""
    integrator = Integrator(backlash_oscillator(0.75), 0.75, 1e-6, 12)
    state, s = np.array([integrator.edges[1] - gap, [rate]]), 6.0
    _, count, steps = integrator.steps(state, 1, 1, begin=s)
    assert steps.starts[0] == s and s + steps.lengths[0] > s
    assert count < 100
