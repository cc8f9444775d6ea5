"""The conda file that rules name and the lock agree."""

import re
from pathlib import Path

from facegear.config.yaml_file import read_yaml

ROOT = Path(__file__).parents[2]


def test_conda_file_holds_the_locked_versions():
    environment = read_yaml(ROOT / "workflow" / "envs" / "facegear.yaml")
    pinned = environment["dependencies"][-1]["pip"]
    lock = (ROOT / "requirements.lock").read_text()
    assert len(pinned) > 10
    for requirement in pinned:
        assert re.search(rf"^{re.escape(requirement)}( |$)", lock, re.M), requirement


def test_runs_and_tests_use_the_same_versions():
    run, whole = (
        dict(re.findall(r"^(\S+)==(\S+)", (ROOT / name).read_text(), re.M))
        for name in ("requirements-run.lock", "requirements.lock")
    )
    assert len(run) > 50
    assert {name: whole.get(name) for name in run} == run
