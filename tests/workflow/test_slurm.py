"""A chunked study on a throw-away Slurm of two nodes: killed, changed, run again, equal to the bit."""

import os
import re
import signal
import subprocess
import time
from importlib.util import find_spec

import pandas as pd
import pytest
from projects import ROOT, environment
from slurm_cluster import cluster, missing
from test_tolerance_jobs import FILE, project

import facegear

PROFILE = ("--workflow-profile", str(ROOT / "workflow" / "profiles" / "slurm"))
CHUNKS = ("samples_0_799", "samples_800_1599")
HARMONICS = "results/tolerances/stiffness/harmonics.csv"


def why_not():
    if not os.environ.get("FACEGEAR_SLURM"):
        return "only where FACEGEAR_SLURM is set, as by `make ci`: a minute, and a Slurm of its own"
    if find_spec("snakemake_executor_plugin_slurm") is None:
        return "snakemake-executor-plugin-slurm is not installed (extra `cluster`)"
    return missing()


pytestmark = [
    pytest.mark.workflow,
    pytest.mark.xdist_group("slurm"),  # a machine has one Slurm at a time
    pytest.mark.skipif(bool(why_not()), reason=why_not()),
]


def jobs():
    """Read every job that Slurm remembers: chunk, node, start and end in seconds, state."""
    message = subprocess.run(
        ["scontrol", "--oneliner", "show", "job"], capture_output=True, text=True, check=True
    )
    found = []
    for line in message.stdout.splitlines():
        fields = dict(re.findall(r"(\w+)=(\S*)", line))
        start, end = (pd.Timestamp(fields[key]) for key in ("StartTime", "EndTime"))
        found.append((fields["Comment"], fields["NodeList"], start, end, fields["JobState"]))
    return found


def started(folder):
    """Whether every chunk has written down some samples."""
    partials = [folder / f"results/tolerances/tolerances/chunks/{name}.partial" for name in CHUNKS]
    return all(path.exists() and len(path.read_bytes().splitlines()) > 4 for path in partials)


def test_a_killed_study_on_two_nodes_is_made_again_and_keeps_nothing_stale(tmp_path):
    """A new job waits for an old one of its chunk inside Slurm (test_tolerance_jobs.py), so both may run."""
    found, target = project(tmp_path / "run", 1600, 800)  # still at work when the second run looks for it
    with cluster(tmp_path / "slurm"):
        running = subprocess.Popen(
            found.command(*PROFILE, *target),
            env=environment(),
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        deadline = time.monotonic() + 120
        while not started(found.folder) and running.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
        os.killpg(running.pid, signal.SIGKILL)
        running.wait()
        assert [job[-1] for job in jobs()].count("RUNNING") == 2, "Slurm goes on without the scheduler"
        own = found.folder / "config" / "own.yaml"
        own.write_text(own.read_text().replace("index_blocks: 0", "index_blocks: 0, hunting_cycles: 30"))
        message = found.run(*PROFILE, *target).stderr
        every = jobs()
    assert "tolerances_chunk tolerances samples 800 1599: 800 samples, 0 of them" in message
    completed = [(name, node) for name, node, *_, state in every if state == "COMPLETED"]
    assert {node for _, node in completed} == {"n0", "n1"}
    assert len(completed) == 4, (
        "jobs of the killed run end by themselves, and are made again as the config changed"
    )
    whole = facegear.load(own, results=None).tolerances(1600).samples()
    pd.testing.assert_frame_equal(pd.read_parquet(found.folder / FILE), whole, check_exact=True)


@pytest.mark.parametrize("nodes", [1, 4])
def test_nodes_share_the_chunks_evenly_and_give_the_same_table(tmp_path, nodes):
    found, target = project(tmp_path / "run", 160, 40)
    found.run(*target[:-1], HARMONICS)
    with cluster(tmp_path / "slurm", nodes):
        found.run(*PROFILE, "--default-resources", "mem_mb=900", "runtime=10", *target)
        chunks = [job for job in jobs() if job[0].startswith("rule_tolerances_chunk")]
    places = [node for _, node, *_, state in chunks if state == "COMPLETED"]
    assert sorted(places.count(node) for node in set(places)) == [4 // nodes] * nodes
    whole = facegear.load(found.folder / "config" / "own.yaml", results=None).tolerances(160).samples()
    pd.testing.assert_frame_equal(pd.read_parquet(found.folder / FILE), whole, check_exact=True)


def test_a_job_that_fails_on_a_node_tells_its_own_line_in_the_terminal(tmp_path):
    found, target = project(tmp_path / "run", 40, 40)
    found.run(*target[:-1], HARMONICS)
    path = found.folder / HARMONICS
    path.write_text(path.read_text().replace("410000000", "420000000"))
    with cluster(tmp_path / "slurm", 1):
        message = found.run(*PROFILE, *target, check=False)
    assert message.returncode != 0
    assert "error in tolerances_chunk of tolerances" in message.stderr
    assert "differs from what its stage wrote" in message.stderr
    assert "Traceback" not in message.stderr
