"""Contact switches are passed however the motion meets them."""

import numpy as np
import pytest
from oscillators import backlash_oscillator

from facegear.dynamics.integrator.compiled import pack
from facegear.dynamics.integrator.trajectory import step
from facegear.dynamics.integrator.work import make_work


@pytest.mark.parametrize("rate", [1.0, 100.0, 1e4])
@pytest.mark.parametrize("gap", [3e-14, 1e-13, 1e-12, 1e-11])
def test_time_moves_on_where_an_edge_is_nearer_than_time_can_tell(gap, rate):
    """At 10 224 rpm the paper's machine once stood for ever a rounding error before a fast contact switch."""
    packed = pack(backlash_oscillator(0.75), 0.75)
    displacement, velocity = np.zeros(packed.omega_squared.size), np.zeros(packed.omega_squared.size)
    displacement[0], velocity[0] = packed.upper[0] - gap, rate
    s = 6.0
    length, _ = step(packed, make_work(packed, 12), s, 2.0 * np.pi, displacement, velocity, 1e-6)
    assert s + length > s
