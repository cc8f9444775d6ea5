"""The environment: the files that name its versions agree, and the Makefile stays short."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from facegear.config.yaml_file import read_yaml
from facegear.machine_code.versions import is_known

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


def test_the_makefile_has_at_most_seventy_lines_and_names_all_its_targets():
    text = (ROOT / "Makefile").read_text()
    targets = {name for line in re.findall(r"^([a-z][a-z ]*):(?!=)", text, re.M) for name in line.split()}
    assert len(text.splitlines()) <= 70
    assert targets == set(re.search(r"^\.PHONY: (.*)", text, re.M)[1].split())


@pytest.mark.parametrize("target", ["all", "env", "tools", "ci"])
def test_make_that_is_only_to_print_runs_nothing(target, tmp_path):
    done = subprocess.run(
        ["make", "-n", "BIN=/nowhere", target], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
