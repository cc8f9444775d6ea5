"""Disturbances moved side by side, and the states that a run remembers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lumped_machines import make_machine

from facegear.dynamics.integrator.compiled import TAU, pack
from facegear.dynamics.integrator.periods import disturbance_step, make_log, run_periods
from facegear.dynamics.integrator.work import ABREAST, make_work
from facegear.dynamics.steady_state.settle import Passed
from facegear.dynamics.steady_state.simulate import build_model, by_phase, static_start
from facegear.transmission.machine import mesh_frequency

TOLERANCE = 1e-8


@pytest.fixture(scope="module")
def losing_contact():
    """A machine that loses contact, packed, and where it stands after a while."""
    model = build_model(make_machine(torque=1500.0, backlash=100e-6, error=30e-6))
    omega = TAU * mesh_frequency(model.machine.layout, 9000.0)
    packed = pack(model.system, omega)
    state = by_phase(packed, static_start(model), omega)
    moved(packed, state, np.zeros((0, *state.shape)), 40)
    return packed, state


def moved(packed, state, tangents, periods):
    """Moves state and tangents in place; the shares (3, m) of the phase."""
    work, log = make_work(packed, 12), make_log(packed, periods)
    longest = disturbance_step(packed, work.order, TOLERANCE)
    run_periods(packed, work, state[0], state[1], tangents, periods, 0, TOLERANCE, log, longest)
    return log.shares


@pytest.mark.parametrize("count", [2, ABREAST, ABREAST + 1, 3 * ABREAST - 2])
def test_disturbances_side_by_side_move_as_each_does_alone(losing_contact, count):
    packed, start = losing_contact
    tangents = np.zeros((count, *start.shape))
    tangents[..., : packed.n] = np.random.default_rng(1).normal(size=(count, 2, packed.n))
    alone = tangents.copy()
    shares = moved(packed, start.copy(), tangents, 2)
    assert shares[0].max() > 0.0 and shares[1].max() > 0.0
    for one in alone:
        moved(packed, start.copy(), one[None], 2)
    np.testing.assert_allclose(tangents, alone, rtol=0.0, atol=1e-12 * np.abs(alone).max())


def test_a_disturbance_is_the_difference_of_two_motions(losing_contact):
    packed, start = losing_contact
    tangents = np.zeros((2, *start.shape))
    tangents[0, 0, : packed.n] = tangents[1, 1, : packed.n] = packed.scale * np.sin(1.0 + np.arange(packed.n))
    off = [start + sign * 1e-4 * tangents[0] for sign in (1.0, -1.0)]
    for state in off:
        moved(packed, state, np.zeros((0, *start.shape)), 1)
    moved(packed, start.copy(), tangents, 1)
    expected = (off[0] - off[1]) / 2e-4
    np.testing.assert_allclose(tangents[0], expected, atol=2e-3 * np.abs(expected).max())


@settings(max_examples=100, deadline=None)
@given(st.integers(1, 12), st.lists(st.integers(1, 40), min_size=1, max_size=12))
def test_a_run_remembers_its_last_states_in_order_however_long_its_blocks(kept, blocks):
    passed, total = Passed(kept, (1, 1)), 0
    for block in blocks:
        passed.room_for(block)[:, 0, 0] = np.arange(total, total + block)
        total += block
        assert passed.states[:, 0, 0].tolist() == list(range(max(total - kept, 0), total))
    passed.forget()
    assert not len(passed.states)
