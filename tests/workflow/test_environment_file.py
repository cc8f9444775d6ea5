"""The environment: the files that name its versions agree, and the Makefile stays short."""

import re
import subprocess
from pathlib import Path

import pytest

from facegear.schema.yaml_file import read_yaml

ROOT = Path(__file__).parents[2]


def test_conda_file_holds_the_locked_versions():
    environment = read_yaml(ROOT / "workflow" / "envs" / "facegear.yaml")
    pinned = environment["dependencies"][-1]["pip"]
    lock = (ROOT / "requirements.lock").read_text()
    assert len(pinned) > 10
    for requirement in pinned:
        assert re.search(rf"^{re.escape(requirement)}( |$)", lock, re.M), requirement


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
    targets = {name for line in re.findall(r"^([a-z][a-z_ ]*):(?!=)", text, re.M) for name in line.split()}
    assert len(text.splitlines()) <= 70
    assert targets == set(re.search(r"^\.PHONY: (.*)", text, re.M)[1].split())


@pytest.mark.parametrize("target", ["all", "env", "tools", "ci"])
def test_make_that_is_only_to_print_runs_nothing(target, tmp_path):
    done = subprocess.run(
        ["make", "-n", "BIN=/nowhere", target], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
