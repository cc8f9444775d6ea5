"""Long stages say how far they are and how long it will take."""

import io

import pytest

from facegear import progress


@pytest.fixture
def clock(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    return now


def test_estimate_is_the_mean_pace_times_what_is_left(clock):
    stream = io.StringIO()
    told = progress.Progress("contact", total=10, interval=5.0, stream=stream)
    for _ in range(4):
        clock[0] += 3.0
        told.step()
    assert stream.getvalue().splitlines() == [
        "contact: 2/10, about 24 s left",
        "contact: 4/10, about 18 s left",
    ]


def test_a_short_stage_prints_no_progress(clock):
    stream = io.StringIO()
    told = progress.Progress("contact", total=3, interval=5.0, stream=stream)
    for _ in range(3):
        clock[0] += 0.5
        told.step()
    assert stream.getvalue() == ""
