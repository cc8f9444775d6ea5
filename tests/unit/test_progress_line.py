"""Long stages say how far they are and how long it will take."""

import io
import re
from itertools import pairwise

import pytest

from facegear import progress


@pytest.fixture
def clock(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    return now


def lines(clock, durations, interval=5.0):
    stream = io.StringIO()
    message = progress.Progress("contact", len(durations), interval, stream)
    for duration in durations:
        clock[0] += duration
        message.step()
    return stream.getvalue().splitlines()


def seconds(message):
    return [int(found[1]) for line in message if (found := re.search(r"about (\d+) s left", line))]


def by_mean_pace(durations, interval=5.0):
    """Estimate of the former version: all time so far over all steps so far."""
    found, now, last = [], 0.0, 0.0
    for done, duration in enumerate(durations, start=1):
        now += duration
        if now - last >= interval:
            last = now
            found.append(now / done * (len(durations) - done))
    return found


def steady(message):
    """Whether no estimate is far from the last one less the six seconds between two lines."""
    return len(message) > 3 and all(0.6 * (a - 6.0) <= b <= 1.6 * a for a, b in pairwise(message))


def test_estimate_is_the_pace_after_the_first_step_times_what_is_left(clock):
    assert lines(clock, [3.0] * 6) == [
        "contact: 2/6, about 12 s left",
        "contact: 4/6, about 6 s left",
        "contact: 6/6",
    ]


def test_compiling_in_the_first_step_is_not_taken_for_the_pace(clock):
    """A stored log of the contact stage: `1/32, about 295 s left`, and 5 s later it was done."""
    durations = [9.5] + [0.16] * 31
    assert by_mean_pace(durations)[0] == pytest.approx(294.5)
    assert lines(clock, durations) == ["contact: 1/32", "contact: 32/32"]


def test_estimate_does_not_jump_where_steps_cost_unlike(clock):
    """77, 22 and 45 s were told one after another: compiling, quick steps, and one that was long."""
    durations = [5.13, *[1.27] * 4, 16.8, *[2.0] * 10]
    assert [round(left) for left in by_mean_pace(durations)[:3]] == [77, 22, 45]
    assert not steady(by_mean_pace(durations))
    assert steady(seconds(lines(clock, durations)))


def test_estimate_rises_where_the_work_has_become_slower(clock):
    message = seconds(lines(clock, [1.0] * 11 + [20.0] * 29))
    assert message[1] < message[0] + 5 < max(message)


def test_a_short_stage_prints_no_progress(clock):
    assert lines(clock, [0.5] * 3) == []
