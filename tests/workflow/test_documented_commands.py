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

from facegear import __main__ as command_line
from facegear.report.compare.answers import answer_names

ROOT = Path(__file__).parents[2]
DOCS = (ROOT / "docs" / part for part in (".", "tutorials", "how_to", "explanation", "reference"))
PAGES = [
    ROOT / "README.md",
    *(page for part in DOCS for page in sorted(part.glob("*.md"))),
    ROOT / "results" / "README.md",
]
COMMANDS = sorted(
    {
        line.split("#")[0].strip()
        for page in PAGES
        for block in re.findall(r"```console\n(.*?)```", page.read_text(), re.S)
        for line in block.splitlines()
        if line.split("#")[0].strip()
    }
)


INLINE = sorted(
    {
        (page, code)
        for page in (*PAGES, ROOT / "CONTRIBUTING.md", *sorted((ROOT / "examples").glob("*.ipynb")))
        for code in re.findall(
            r"`((?:snakemake|pip|make|facegear|python -m) [^`\n]+)`",
            re.sub(r"```.*?```", "", page.read_text().replace(chr(92) + chr(34), chr(34)), flags=re.S),
        )
    }
)
"""Commands inside a line of a page, which name a thing to do; some are beginnings of a command."""


def assert_installs_from_sources(what):
    """The package is on no index: pip installs the folder it is in, with extras that exist."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    wheel = r"\./facegear-VERSION-cp311-cp311-manylinux2014_x86_64\.manylinux_2_17_x86_64\.whl"
    match = re.fullmatch(rf"(?:\.|{wheel})(?:\[([a-z,]+)\])?", what)
    assert match, f"pip finds {what} on no index"
    assert set(match[1].split(",") if match[1] else ()) <= project["optional-dependencies"].keys()


def assert_runs(words):
    """Snakemake asks for cores or a profile wherever jobs run, and takes all words after --configfile."""
    assert {"--cores", "--workflow-profile", "-n", "--report"} & {*words}, "no --cores"
    if "--configfile" in words:
        after = words[words.index("--configfile") + 1 :]
        assert len(after) < 2 or after[1].startswith("-"), "no -- before the targets"


@pytest.mark.parametrize(("page", "command"), INLINE, ids=[code for _, code in INLINE])
def test_a_command_inside_a_line_can_work(page, command):
    """Only commands in blocks were tried; those inside lines had no --cores, or named a package index."""
    words = shlex.split(command.split(" > ")[0])
    if words[:2] == ["pip", "install"] and len(words) > 2:
        assert_installs_from_sources(words[2])
    elif words[0] == "snakemake" and words[-1] != "--configfile":
        assert_runs(words)
    elif words[0] == "make":
        assert re.search(rf"^([a-z_]+ )*{words[1]}( [a-z_]+)*:", (ROOT / "Makefile").read_text(), re.M)
    elif words[0] == "facegear" and len(words) > 2 and "--help" not in words:
        assert callable(command_line.parser().parse_args(words[1:]).command)
    elif words[:2] == ["python", "-m"]:
        assert find_spec(words[2]), words[2]


def test_stored_answers_that_pages_and_help_name_exist():
    """The help named one of a release that stored none."""
    pages = [page.read_text() for page in (*PAGES, ROOT / "CONTRIBUTING.md")]
    parsers = command_line.parser()._subparsers._group_actions[0].choices.values()
    texts = [*pages, *(" ".join(parser.format_help().split()) for parser in parsers)]
    named = {name for text in texts for name in re.findall(r"\b((?:current|\d+\.\d+\.\d+)/[a-z]+)\b", text)}
    assert "current/quick" in named and named <= set(answer_names())


def test_no_message_names_a_package_index():
    """A message that an extra is missing told users to ask an index for it."""
    for file in sorted((ROOT / "facegear").rglob("*.py")):
        for what in re.findall(r'pip install "?([^"\s)]+)', file.read_text()):
            assert what == "-e" or what.startswith(".["), f"{file}: {what}"


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
        assert_installs_from_sources(words[2])
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
        assert_runs(words)
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
