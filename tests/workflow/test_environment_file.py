"""The environment: the files that name its versions agree, and `make` completes it beside a first run."""

import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from facegear.config.yaml_file import read_yaml
from facegear.machine_code.versions import is_known
from workflow.process.imports import modules
from workflow.process.job_server import COMMON

ROOT = Path(__file__).parents[2]


def test_conda_file_holds_the_locked_versions():
    environment = read_yaml(ROOT / "workflow" / "envs" / "facegear.yaml")
    pinned = environment["dependencies"][-1]["pip"]
    lock = (ROOT / "requirements.lock").read_text()
    assert len(pinned) > 10
    for requirement in pinned:
        assert re.search(rf"^{re.escape(requirement)}( |$)", lock, re.M), requirement


def test_numba_is_bounded_by_the_minor_version_above_the_locked_one():
    """Its private parts are used, so that the next release would break every installation."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    (bound,) = [one for one in map(Requirement, project["dependencies"]) if one.name == "numba"]
    locked = re.search(r"^numba==(\S+)", (ROOT / "requirements-run.lock").read_text(), re.M)[1]
    major, minor = map(int, locked.split(".")[:2])
    assert locked in bound.specifier and f"{major}.{minor}.99" in bound.specifier
    assert f"{major}.{minor + 1}.0" not in bound.specifier
    assert is_known(locked) and not is_known(f"{major}.{minor + 1}.0")


@pytest.mark.parametrize(
    ("name", "apart"), [("run", set()), ("cluster", {"snakemake-executor-plugin-slurm"})]
)
def test_runs_clusters_and_tests_use_the_same_versions(name, apart):
    part, whole = (
        dict(re.findall(r"^(\S+)==(\S+)", (ROOT / file).read_text(), re.M))
        for file in (f"requirements-{name}.lock", "requirements.lock")
    )
    own = {library for library in part if library.startswith(tuple(apart))} if apart else set()
    assert len(part) > 50
    assert apart <= own
    assert {library: whole.get(library) for library in part.keys() - own} == {
        library: version for library, version in part.items() if library not in own
    }


@pytest.fixture
def made(tmp_path):
    """Function: how `make` ends where Snakemake and uv end with these codes, and the programs called."""
    binaries = tmp_path / "bin"
    binaries.mkdir()
    (tmp_path / ".libraries").touch()

    def make(*arguments, python=0, snakemake=0, uv=0):
        for name, code in (("python", python), ("snakemake", snakemake), ("uv", uv)):
            text = f'#!/bin/sh\necho {name} "$@" >> {tmp_path}/called\nexit {code}\n'
            (binaries / name).write_text(text)
            (binaries / name).chmod(0o755)
        (tmp_path / "called").write_text("")
        environment = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
        done = subprocess.run(
            ["make", f"VENV={tmp_path}", *arguments],
            cwd=ROOT,
            env=environment,
            capture_output=True,
            check=False,
        )
        return done.returncode, (tmp_path / "called").read_text().splitlines()

    return make


def test_a_new_environment_is_completed_beside_its_first_run_and_left_alone_in_the_second(made):
    code, called = made()
    run = ["python -m facegear.system_check", "snakemake --cores 2"]
    beside = "python -m workflow.process.imports"
    assert code == 0 and [line for line in called if line in run] == run
    completed = [line for line in called if line not in run]
    assert completed[0] == beside and completed[1].startswith("uv pip install") and len(completed) == 2
    assert made()[1] == run


@pytest.mark.parametrize("codes", [{"snakemake": 3}, {"uv": 3}, {"python": 3}])
def test_make_fails_where_the_check_the_run_or_the_rest_of_the_environment_does(made, codes):
    assert made(**codes)[0] != 0


def test_make_that_is_only_to_print_runs_nothing(made):
    assert made("-n") == (0, [])


def test_what_most_jobs_import_is_compiled_first():
    assert modules()[: len(COMMON)] == list(COMMON)
    assert {"facegear.stages.dynamics_sweep", "facegear.plots.dynamics"} <= set(modules())
