"""Killed runs, corrupt files, bad configs and two runs at once."""

import os
import random
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from filelock import FileLock
from projects import ROOT, Project, copy_sources, environment

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]
QUICK = ("--configfile", str(ROOT / "config" / "quick.yaml"))


def data_files(project):
    return {
        str(path.relative_to(project.folder)): path.read_bytes()
        for path in sorted((project.folder / "results").rglob("*.csv"))
        if "benchmarks" not in path.parts and path.name != "quality.csv"
    }


@pytest.mark.parametrize("seed", [1, 2])
def test_a_killed_run_started_again_gives_the_same_files(quick, tmp_path, seed):
    project = quick.copied(tmp_path)
    targets = [
        "results/quick/modal/frequencies.csv",
        "results/quick/dynamics/response.csv",
        "results/quick/load_sharing/nominal.csv",
    ]
    for stage in ("modal", "dynamics", "load_sharing"):
        shutil.rmtree(tmp_path / "results" / "quick" / stage)
    process = subprocess.Popen(
        project.command(*targets, *QUICK),
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    time.sleep(random.Random(seed).uniform(2.0, 8.0))
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    project.run(*targets, *QUICK)
    undisturbed, resumed = data_files(quick), data_files(project)
    for target in targets:
        assert resumed[target] == undisturbed[target], target
    assert not list((tmp_path / "results").rglob(".[0-9]*")), "no temporary file is left behind"


def test_a_run_killed_in_the_contact_stage_resumes(quick, tmp_path):
    project = quick.copied(tmp_path)
    shutil.rmtree(tmp_path / "results" / "quick" / "contact")
    log = tmp_path / "results" / "quick" / "logs" / "contact.log"
    log.unlink()
    process = subprocess.Popen(
        project.command("results/quick/contact/ltca.csv", *QUICK),
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    deadline = time.monotonic() + 60
    while not log.exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert not (tmp_path / "results" / "quick" / "contact" / "contact.provenance.json").exists()
    project.run("results/quick/contact/ltca.csv", *QUICK)
    assert data_files(project) == data_files(quick)


@pytest.mark.parametrize("spelling", ["-np", "--dryrun"])
def test_no_spelling_of_a_dry_run_changes_anything_on_disk(tmp_path, spelling):
    project = Project(tmp_path)
    for name in ("locks/0.input.lock", "incomplete/cmVzdWx0cw==", "facegear.lock"):
        path = tmp_path / ".snakemake" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("of a run that was killed\n")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    done = project.run(spelling, "results/paper/modal/frequencies.csv")
    assert "This was a dry-run" in done.stdout + done.stderr
    after = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert {path: held for path, held in after.items() if path.parent.name != "iocache"} == before


def test_a_dry_run_beside_a_working_run_is_reported_the_plan(tmp_path):
    project = Project(tmp_path)
    (tmp_path / ".snakemake").mkdir()
    with FileLock(tmp_path / ".snakemake" / "facegear.lock"):
        assert project.planned("results/paper/modal/frequencies.csv") == {"modal"}


def may_mount():
    try:
        own = ["unshare", "--user", "--map-root-user", "--mount", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]
        return subprocess.run(own, capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        return False


def in_own_namespace(script):
    """Run a shell script that may mount disks which nobody else sees."""
    command = ["unshare", "--user", "--map-root-user", "--mount", "bash", "-c", script]
    return subprocess.run(command, env=environment(), capture_output=True, text=True, check=False)


@pytest.mark.skipif(
    not may_mount(), reason="no small disk may be mounted here; /dev/full stands for it in the unit tests"
)
@pytest.mark.parametrize("size", ["4k", "16k", "56k"])
def test_a_full_disk_stops_the_stage_in_one_line_and_nothing_half_written_stays(tmp_path, size):
    disk = tmp_path / "results"
    disk.mkdir()
    command = Project(tmp_path).command("results/paper/modal/frequencies.csv")
    done = in_own_namespace(
        f"mount -t tmpfs -o size={size} tmpfs {disk} && {shlex.join(command)}; code=$?; "
        f"cd {disk}; find * -type f | sed 's/^/left: /'; exit $code"
    )
    assert done.returncode != 0
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("error in ")]
    assert "no space left on the disk; free some and run again" in line
    assert "Traceback" not in done.stderr
    left = [Path(row.removeprefix("left: ")) for row in done.stdout.splitlines() if row.startswith("left: ")]
    assert "modal.log" in {path.name for path in left}
    assert not [path for path in left if path.suffix == ".csv" or re.match(r"\.\d", path.name)]


@pytest.mark.parametrize(
    ("file", "target"),
    [
        ("stiffness/harmonics.csv", "dynamics/response.csv"),
        ("contact/ltca.csv", "stiffness/tvms.csv"),
        ("modal/shapes.csv", "figures/mode_shapes.svg"),
    ],
)
def test_an_altered_intermediate_is_named_with_the_command_that_rebuilds_it(quick, tmp_path, file, target):
    project = quick.copied(tmp_path)
    path = tmp_path / "results" / "quick" / file
    times = path.stat()
    path.write_bytes(path.read_bytes()[:-20] + b"1" * 20)
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    done = project.run(
        *QUICK,
        "--force",
        "--rerun-triggers",
        "mtime",
        "--",
        f"results/quick/{target}",
        check=False,
    )
    assert done.returncode != 0
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("error in ")]
    assert f"results/quick/{file}" in line
    assert f" --force results/quick/{file} (log: " in line


def test_the_command_printed_with_a_damaged_file_makes_it_again_from_any_folder(quick, tmp_path, monkeypatch):
    """It lacked --snakefile and --directory, so that it worked in the folder of the run alone."""
    project = quick.copied(tmp_path)
    path = tmp_path / "results" / "quick" / "modal" / "shapes.csv"
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    done = project.run(*QUICK, "--force", "--", "results/quick/figures/mode_shapes.svg", check=False)
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("error in ")]
    words = shlex.split(line.split("rebuild it with: ")[1].split(" (log: ")[0])
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    subprocess.run([sys.executable, "-m", *words], env=environment(), check=True, capture_output=True)
    assert path.read_bytes() == whole


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("module_mm: 3.75", "modul_mm: 3.75", "did you mean 'module_mm'?"),
        ("mass_kg: 1.199", "mass_kg: -1.199", "transmission.pinion.mass_kg = -1.199"),
        ("backlash_um: 100", "backlash_um: wide", "transmission.backlash_um"),
        ("inner_radius_mm: 250", "inner_radius_mm: 200", "inner_radius_mm"),
        ("outer_radius_mm: 275", "outer_radius_mm: 320", "outer_radius_mm"),
        ("resolution: coarse", "resolution: {profile_mm: 6, width_mm: 6, thickness_mm: 6}", "too coarse"),
    ],
)
def test_a_config_mistake_stops_before_any_work_in_one_line(tmp_path, old, new, line):
    text = (ROOT / "config" / "paper.yaml").read_text()
    assert old in text
    config = tmp_path / "bad.yaml"
    known = text.replace(
        "reproduction: reproduction/paper.yaml", f"reproduction: {ROOT}/config/reproduction/paper.yaml"
    )
    config.write_text(known.replace(old, new, 1))
    project = Project(tmp_path / "run")
    done = project.run("--configfile", str(config), check=False)
    assert done.returncode != 0
    message = [message for message in done.stderr.splitlines() if message.strip()]
    assert any(line in message_line for message_line in message), done.stderr
    assert len(message) <= 2, done.stderr
    assert "Traceback" not in done.stderr + done.stdout
    assert not (project.folder / "results").exists()


def test_a_second_run_in_a_folder_ends_in_one_line(tmp_path):
    (tmp_path / ".snakemake").mkdir()
    with FileLock(tmp_path / ".snakemake" / "facegear.lock"):
        second = Project(tmp_path).run("results/paper/modal/frequencies.csv", check=False)
    assert second.returncode == 1
    assert second.stderr.splitlines()[1:] == [
        f"another run is working in {tmp_path}; wait for it or stop it first"
    ]
    assert not (tmp_path / "results").exists()


def test_a_killed_run_leaves_no_lock_behind(tmp_path):
    (tmp_path / ".snakemake").mkdir()
    path = str(tmp_path / ".snakemake" / "facegear.lock")
    holder = f"from filelock import FileLock; FileLock({path!r}).acquire(); print(1, flush=True); input()"
    command = [sys.executable, "-c", holder]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        process.stdout.readline()
        process.kill()
    Project(tmp_path).run("results/paper/modal/frequencies.csv")


@pytest.mark.parametrize("name", ["with blank", "a{case}b"])
def test_a_run_works_in_a_folder_of_any_name_and_from_sources_in_one(tmp_path, name):
    sources = copy_sources(tmp_path / name)
    target = "results/harmonics_only/modal/frequencies.csv"
    config = ("--configfile", str(sources / "config" / "harmonics_only.yaml"))
    Project(sources, sources).run(*config, "--", target)
    assert (sources / target).exists()


def test_results_that_are_a_file_end_the_run_in_one_line(tmp_path):
    (tmp_path / "results").write_text("mine")
    done = Project(tmp_path).run("results/paper/modal/frequencies.csv", check=False)
    assert done.returncode == 1
    assert done.stderr.splitlines()[1:] == [
        f"{tmp_path / 'results'} is a file; move it away, as results go there"
    ]
    assert (tmp_path / "results").read_text() == "mine"


@pytest.mark.skipif(not may_mount(), reason="no disk may be mounted read-only here")
def test_a_folder_that_cannot_be_written_ends_the_run_in_one_line(tmp_path):
    command = Project(tmp_path).command("results/paper/modal/frequencies.csv")
    mount = f"mount --bind {tmp_path} {tmp_path} && mount -o remount,bind,ro {tmp_path}"
    done = in_own_namespace(f"{mount} && exec {shlex.join(command)}")
    assert done.returncode == 1
    *others, message = done.stderr.splitlines()
    assert message == f"{tmp_path} cannot be written; choose another folder with --directory"
    assert len(others) == 2, "which Snakemake prints before: its profile and its log file"
    assert not list(tmp_path.iterdir())


def test_no_config_writes_outside_results(tmp_path):
    for case in ("../outside", "/tmp/outside", "a/b", ".", ""):
        done = Project(tmp_path).run("-n", "--config", f"case={case}", check=False)
        assert done.returncode != 0
        assert "case = " in done.stderr
