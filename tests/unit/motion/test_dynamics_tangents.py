"""Disturbances moved side by side, and the states that a run remembers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_machine
from references import against, agrees

from facegear.machine.machine import mesh_frequency
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.integrator.kernel_system import TAU
from facegear.motion.steady_state.periodicity import StateHistory
from facegear.motion.steady_state.simulate import build_model, static_start

TOLERANCE = 1e-8
BLOCK = 12
"""Disturbances that the kernels move side by side."""


@pytest.fixture(scope="module")
def losing_contact():
    """A machine that loses contact, ready to run, and where it stands after a while."""
    model = build_model(make_machine(torque=1500.0, backlash=100e-6, error=30e-6))
    omega = TAU * mesh_frequency(model.machine.layout, 9000.0)
    integrator = Integrator(model.system, omega, TOLERANCE, 12)
    return integrator, integrator.run(integrator.by_phase(static_start(model)), 40, fine=True).state


@pytest.mark.parametrize("count", [2, BLOCK, BLOCK + 1, 3 * BLOCK - 2])
def test_disturbances_side_by_side_move_as_each_does_alone(losing_contact, count):
    integrator, start = losing_contact
    tangents = np.random.default_rng(1).normal(size=(count, *start.shape))
    together = integrator.run(start, 2, tangents)
    assert together.fractions[0].max() > 0.0 and together.fractions[1].max() > 0.0
    alone = np.concatenate([integrator.run(start, 2, one[None]).tangents for one in tangents])
    np.testing.assert_allclose(together.tangents, alone, rtol=0.0, atol=1e-12 * np.abs(alone).max())


@against(
    "second implementation",
    "differences of two motions",
    capability="dynamics_response branches",
    module="facegear.motion.integrator.integrator",
)
def test_a_disturbance_is_the_difference_of_two_motions(losing_contact):
    integrator, start = losing_contact
    tangents = np.zeros((2, *start.shape))
    tangents[0, 0] = tangents[1, 1] = integrator.scale * np.sin(1.0 + np.arange(integrator.size))
    off = [integrator.run(start + sign * 1e-4 * tangents[0], 1, fine=True).state for sign in (1.0, -1.0)]
    found = integrator.run(start, 1, tangents).tangents[0]
    expected = (off[0] - off[1]) / 2e-4
    agrees("tangent", found, expected, relative=1e-7, absolute=2e-3 * np.abs(expected).max())


@settings(max_examples=100, deadline=None)
@given(st.integers(1, 12), st.lists(st.integers(1, 40), min_size=1, max_size=12))
def test_a_run_remembers_its_last_states_in_order_however_long_its_blocks(kept, blocks):
    passed, total = StateHistory(kept, (1, 1)), 0
    for block in blocks:
        passed.reserve(block)[:, 0, 0] = np.arange(total, total + block)
        total += block
        assert passed.states[:, 0, 0].tolist() == list(range(max(total - kept, 0), total))
    passed.forget()
    assert not len(passed.states)
