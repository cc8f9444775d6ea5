"""Computations through the Python door run on one thread of BLAS, and leave the threads of the user alone."""

import pytest
import scipy.linalg  # noqa: F401 - its BLAS is loaded before threads are set
from threadpoolctl import threadpool_info, threadpool_limits

import facegear
from facegear.contact import gear_flank
from facegear.errors import FacegearError
from facegear.pipeline.run import call
from facegear.pipeline.stages import machine
from facegear.pipeline.table import STAGES

pytestmark = pytest.mark.xdist_group("notebooks")


class Seen(FacegearError):
    """Ends a computation once its threads are known."""


def blas_threads():
    """Threads of each library of linear algebra by its file."""
    return {each["filepath"]: each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"}


def observer():
    """A function for one that a computation calls, and the list to which it writes the threads it sees."""
    seen = []

    def observe(*given, **more):
        seen.extend(blas_threads().values())
        raise Seen("seen")

    return observe, seen


@pytest.fixture
def two_threads():
    """Give BLAS as many threads as a user of two cores has, where the tests have one."""
    with threadpool_limits(limits=2, user_api="blas"):
        before = blas_threads()
        assert set(before.values()) == {2}
        yield
        assert {name: blas_threads()[name] for name in before} == before


UNSEEN = {"tooth_pair.pinion.bore_radius_mm": 25.01, "transmission.pinion.mass_kg": 1.2003}
"""Values of a machine that no other test computes, so that nothing of it is known in this process."""


def _pinion_flank(gearbox):
    return gearbox._chain.part("compliance", "arrays", {"body": "pinion"})


@pytest.mark.parametrize(
    ("module", "name", "answer"),
    [
        (gear_flank, "flank_compliance", _pinion_flank),
        (machine, "frequency_table", lambda gearbox: gearbox.modes()),
    ],
)
def test_the_door_computes_on_one_blas_thread(two_threads, monkeypatch, module, name, answer):
    observe, seen = observer()
    monkeypatch.setattr(module, name, observe)
    with pytest.raises(Seen):
        answer(facegear.example().with_values(UNSEEN))
    assert set(seen) == {1}


@pytest.mark.parametrize("name", STAGES)
def test_every_stage_runs_on_one_blas_thread(two_threads, monkeypatch, name):
    observe, seen = observer()
    module, _, function = STAGES[name].function.partition(":")
    monkeypatch.setattr(f"{module}.{function}", observe)
    monkeypatch.setattr("facegear.pipeline.run.with_machine", lambda stage, given: given)
    with pytest.raises(Seen):
        call(STAGES[name], {})
    assert set(seen) == {1}
