"""A run plan returns the same by itself and beside others."""

import numpy as np
import pytest
from oscillators import backlash_oscillator

from facegear.errors import NotConverged
from facegear.motion.integrator.integrator import Integrator
from facegear.motion.plan import Settings
from facegear.motion.requests import FEWEST, WIDTH, RunRequest, _in_lanes, alone, side_by_side
from facegear.motion.steady_state.settle import settle, settling

SETTINGS = Settings(tolerance=1e-10, periodic_residual=1e-9)
MANY = FEWEST + 2


def oscillators():
    """Integrators of an oscillator at speeds a little apart, and starts (2, 1)."""
    speeds = np.linspace(0.72, 0.8, MANY)
    found = [Integrator(backlash_oscillator(speed), speed, SETTINGS.tolerance) for speed in speeds]
    return found, [np.array([[1.2 + 0.01 * i], [0.1]]) for i in range(MANY)]


def test_runs_settle_beside_others_where_each_settles_alone():
    found, starts = oscillators()
    together = side_by_side([settling(*pair, SETTINGS) for pair in zip(found, starts, strict=True)])
    for one, start, settled in zip(found, starts, together, strict=True):
        expected = settle(one, start, SETTINGS)
        assert settled.period == expected.period > 0
        assert settled.periods_run == expected.periods_run
        assert np.abs(settled.state - expected.state).max() < 1e-9


def asking(integrator, start, periods):
    """A run plan of runs of one period each; a failure ends it with the number of runs before it."""
    for number in range(periods):
        try:
            start = (yield RunRequest(integrator, start, 1)).state
        except NotConverged:
            return number
        if number == 1:
            start = start * np.nan
    return start


def test_a_run_that_fails_fails_in_its_own_plan():
    found, starts = oscillators()
    ended = side_by_side([asking(one, start, 2) for one, start in zip(found[1:], starts[1:], strict=True)])
    assert all(np.isnan(state).all() for state in ended)
    plans = [asking(found[0], starts[0], 3), *(settling(one, starts[0], SETTINGS) for one in found[1:])]
    failed, *settled = side_by_side(plans)
    assert failed == 2
    assert all(each.period for each in settled)
    assert alone(asking(found[0], starts[0], 3)) == 2


def test_what_a_plan_does_not_catch_is_raised():
    found, starts = oscillators()
    beyond = [starts[0] * np.nan, *starts[1:]]
    with pytest.raises(NotConverged, match="beyond all bounds"):
        side_by_side([settling(*pair, SETTINGS) for pair in zip(found, beyond, strict=True)])


def test_the_longest_of_few_runs_does_not_keep_the_other_lanes_waiting():
    """Lanes take as long for one machine as for all."""
    even = dict.fromkeys(range(WIDTH + 1), 16)
    assert len(_in_lanes(even, FEWEST)) == WIDTH, "the last one alone would cost as much as all"
    assert _in_lanes({**even, 3: 200}, FEWEST) == [0, 1, 2, *range(4, WIDTH + 1)]
    assert not _in_lanes({0: 16, 1: 16, 2: 200}, FEWEST)
    mixed = {number: 16 + number for number in range(5 * WIDTH)}
    assert _in_lanes(mixed, FEWEST) == list(mixed)[::-1], "longest first, so that the lanes end together"
