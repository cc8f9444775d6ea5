"""Chunks resume after a kill, keep failures as rows, and give the same rows however they are cut."""

import gc
import weakref

import numpy as np
import pandas as pd
import pytest

from facegear.errors import FacegearError
from facegear.io import documents
from facegear.studies import summary
from facegear.studies.summary import run_chunk

COLUMNS = ("a", "b")


class Killed(BaseException):
    """Stands for a process that ends without a word."""


class Machine:
    """Counts its evaluations; sample 3 fails, and it is killed at a given number."""

    def __init__(self, killed_at=None):
        self.seen, self.killed_at = [], killed_at

    def __call__(self, number):
        if number == self.killed_at:
            raise Killed
        self.seen.append(number)
        if number == 3:
            raise FacegearError("cannot be assembled\nmore")
        return {"a": 1.0 / (number + 3), "b": np.pi * number}


def run(machine, path, numbers=range(8), identity="same"):
    return run_chunk(machine, numbers, COLUMNS, path, identity)


def test_killed_chunk_goes_on_after_its_last_sample(tmp_path):
    whole = run(Machine(), tmp_path / "whole")
    killed, path = Machine(killed_at=5), tmp_path / "partial"
    with pytest.raises(Killed):
        run(killed, path)
    resumed = Machine()
    pd.testing.assert_frame_equal(run(resumed, path), whole, check_exact=True)
    assert (killed.seen, resumed.seen) == ([0, 1, 2, 3, 4], [5, 6, 7])


@pytest.mark.parametrize("cut", range(1, 60, 7))
def test_record_that_was_half_written_is_made_again(tmp_path, cut):
    path = tmp_path / "partial"
    whole = run(Machine(), path)
    path.write_bytes(path.read_bytes()[:-cut])
    pd.testing.assert_frame_equal(run(Machine(), path), whole, check_exact=True)


class FullAfter:
    """A file on a disk that takes so many bytes more, the last record only in part."""

    def __init__(self, path, room):
        self.stream, self.room = open(path, "ab", buffering=0), room  # noqa: SIM115

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stream.close()

    def write(self, data):
        taken = self.stream.write(data[: self.room])
        self.room -= taken
        return taken


@pytest.mark.parametrize("room", [0, 30, 200])
def test_a_disk_that_fills_up_ends_the_chunk_in_one_line_and_no_finished_sample_is_lost(
    tmp_path, monkeypatch, room
):
    whole, path, first = run(Machine(), tmp_path / "whole"), tmp_path / "partial", Machine()
    with monkeypatch.context() as patch:
        patch.setattr(documents, "open", lambda at, *_, **__: FullAfter(at, room), raising=False)
        with pytest.raises(FacegearError, match="partial: no space left on the disk") as caught:
            run(first, path)
    assert "\n" not in str(caught.value)
    resumed = Machine()
    pd.testing.assert_frame_equal(run(resumed, path), whole, check_exact=True)
    assert set(first.seen[:-1]).isdisjoint(resumed.seen), "only the record that did not fit is made again"


def test_partial_rows_of_another_config_are_not_taken(tmp_path):
    run(Machine(), tmp_path / "partial", identity="before")
    machine = Machine()
    run(machine, tmp_path / "partial", identity="after")
    assert machine.seen == list(range(8))


def test_failed_sample_is_a_row_with_its_error(tmp_path):
    row = run(Machine(), tmp_path / "partial").set_index("sample").loc[3]
    assert row["error"] == "cannot be assembled"
    assert np.isnan(row["a"])


@pytest.mark.parametrize("size", [1, 7, 250])
def test_rows_are_equal_to_the_bit_for_any_size_of_chunk(tmp_path, size):
    count = 260
    whole = run(Machine(), tmp_path / "whole", range(count))
    starts = range(0, count, size)
    parts = [run(Machine(), tmp_path / str(at), range(at, min(at + size, count))) for at in starts]
    pd.testing.assert_frame_equal(pd.concat(parts, ignore_index=True), whole, check_exact=True)


class Ring:
    """Refers to itself, as machines with what they have computed do."""

    def __init__(self):
        self.itself = self


def test_what_finished_samples_leave_behind_does_not_pile_up(tmp_path, monkeypatch):
    monkeypatch.setattr(summary, "SAMPLES_PER_COLLECTION", 50)
    alive = weakref.WeakSet()
    most = [0]

    def evaluate(number):
        alive.add(Ring())
        most[0] = max(most[0], len(alive))
        return {"a": 0.0, "b": 0.0}

    gc.disable()
    try:
        run(evaluate, tmp_path / "partial", range(400))
    finally:
        gc.enable()
    assert most[0] <= 50
