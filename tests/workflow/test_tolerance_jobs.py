"""Samples as jobs: what exists is kept, a killed chunk goes on inside, cores and chunks change no bit."""

import os
import signal
import subprocess
import time

import pandas as pd
import psutil
import pytest
from projects import ROOT, Project, environment

import facegear

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("tolerance_jobs")]
FILE = "results/tolerances/tolerances/samples.parquet"
CONFIG = """
extends: tolerances.yaml
tooth_pair: {pinion: null, face_gear: null, shaper: null}
mesh_stiffness:
  source: harmonics
  mesh_law: constant_load
  mean_n_per_m: 4.1e8
  torque_n_m: null
  table: [{order: 1, sin_n_per_m: 2.0e7, cos_n_per_m: 0}]
transmission: {transmission_error: {amplitude_um: 3}, pinion: {runout: null}, face_gear: {runout: null}}
strength: null
tolerances: {samples: SAMPLES, chunk_samples: CHUNK, index_blocks: 0}
"""


def project(folder, samples, chunk):
    """A folder with the example of tolerances, given harmonics, as small as asked for."""
    configs = folder / "config"
    if not configs.exists():
        configs.mkdir(parents=True)
        for path in (ROOT / "config").glob("*.*"):
            (configs / path.name).symlink_to(path)
    own = configs / "own.yaml"
    own.write_text(CONFIG.replace("SAMPLES", str(samples)).replace("CHUNK", str(chunk)))
    return Project(folder), ("--configfile", str(own), "--", FILE)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Samples computed by the front door, in one process and one piece."""
    found, _ = project(tmp_path_factory.mktemp("whole"), 64, 64)
    return facegear.load(found.folder / "config" / "own.yaml", results=None).tolerances(64).samples()


def test_samples_are_equal_to_the_bit_in_other_chunks_and_added_ones_run_alone(whole, tmp_path):
    found, target = project(tmp_path, 32, 32)
    found.run(*target)
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / FILE), whole.iloc[:32], check_exact=True)
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("samples_*.parquet")}
    found, target = project(tmp_path, 64, 32)
    found.run(*target)
    assert {path: path.stat().st_mtime_ns for path in before} == before
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / FILE), whole, check_exact=True)


def killed(found, target, jobs_too):
    """Start a run and kill it when its chunk has some samples; returns its jobs that live on, halted."""
    running = subprocess.Popen(
        found.command(*target), env=environment(), stderr=subprocess.DEVNULL, start_new_session=True
    )
    partial = found.folder / "results/tolerances/tolerances/chunks/samples_0_63.partial"
    deadline = time.monotonic() + 120
    while running.poll() is None and time.monotonic() < deadline:
        if partial.exists() and len(partial.read_bytes().splitlines()) > 4:
            break
        time.sleep(0.005)
    jobs = psutil.Process(running.pid).children(recursive=True)
    for job in jobs:
        job.suspend()
    assert 0 < len(partial.read_bytes().splitlines()) - 1 < 64
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    for job in jobs if jobs_too else ():
        job.kill()
    return jobs


def test_a_killed_chunk_goes_on_inside_and_gives_the_same_table(whole, tmp_path):
    found, target = project(tmp_path, 64, 64)
    killed(found, target, jobs_too=True)
    found.run(*target)
    assert not list(tmp_path.rglob("*.partial"))
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / FILE), whole, check_exact=True)


def test_a_chunk_is_not_made_by_two_jobs_at_once(whole, tmp_path):
    """The jobs of a run live on if it alone is killed."""
    found, target = project(tmp_path, 64, 64)
    jobs = killed(found, target, jobs_too=False)
    with open(tmp_path / "said", "w") as stream:
        again = subprocess.Popen(found.command(*target), env=environment(), stderr=stream)
    deadline = time.monotonic() + 120
    while "waiting for a job that a killed run has left" not in (tmp_path / "said").read_text():
        assert again.poll() is None and time.monotonic() < deadline
        time.sleep(0.05)
    for job in jobs:
        job.resume()
    assert again.wait() == 0
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / FILE), whole, check_exact=True)
