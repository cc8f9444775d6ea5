"""Every command shown in the README and in docs/ works."""

import re
import shlex
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path

import pytest
from projects import dry_run, environment

import facegear.__main__ as command_line

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "results" / "README.md"]
COMMANDS = sorted(
    {
        line.split("#")[0].strip()
        for page in PAGES
        for block in re.findall(r"```console\n(.*?)```", page.read_text(), re.S)
        for line in block.splitlines()
        if line.split("#")[0].strip()
    }
)


def test_the_pages_show_commands():
    assert "make" in COMMANDS
    assert len(COMMANDS) >= 8


@pytest.mark.xdist_group("dry_runs")  # those of shipped configs are made once a process
@pytest.mark.parametrize("command", COMMANDS)
def test_shown_command_is_accepted(command):
    words = shlex.split(command)
    if words[0] == "cp":
        assert (ROOT / words[-1]).parent.is_dir()
        return
    if words[:2] == ["pip", "install"]:
        extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
        assert words[2].removeprefix("facegear[").removesuffix("]") in extras
        return
    if "workflow/profiles/slurm" in words and find_spec("snakemake_executor_plugin_slurm") is None:
        pytest.skip("snakemake-executor-plugin-slurm is not installed (extra `cluster`, as by `make ci`)")
    if words[0] == "facegear":
        assert callable(command_line.parser().parse_args(words[1:]).command)
        return
    if words[0] == "make":
        done = subprocess.run(
            [*words, "-n"], cwd=ROOT, capture_output=True, text=True, env=environment(), check=False
        )
    elif words[0] == "snakemake":
        arguments = [str(ROOT / word) if word.startswith("config/") else word for word in words[1:]]
        if arguments[:2] == ["--cores", "2"]:  # as all runs of the tests
            del arguments[:2]
        done = dry_run(*arguments)
    elif words[:2] == ["python", "-m"]:
        done = subprocess.run(
            [sys.executable, "-c", f"import importlib.util as u; assert u.find_spec({words[2]!r})"],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
        )
    else:
        pytest.fail(f"a command of a kind this test does not know: {command}")
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_between_pages_hold(page):
    for target in re.findall(r"\]\(([^)#]+?)(?:#[^)]*)?\)", page.read_text()):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target
