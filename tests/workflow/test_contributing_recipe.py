"""The recipe for a new stage in CONTRIBUTING.md is followed step by step, in a copy of the sources."""

import os
import re
import subprocess
import sys

import pytest
from projects import ROOT, Project, copy_sources, environment

from validation.references import INDEPENDENT, declarations

TEXT = (ROOT / "CONTRIBUTING.md").read_text()
SECTION = re.search(r"^## Add a stage\n(.*?)^## ", TEXT, flags=re.DOTALL | re.MULTILINE)[1]
STEPS = re.findall(r"^\d+\. `([^`]+)`([^\n]*)\n((?:   .*\n|\n)*)", SECTION, flags=re.MULTILINE)
MOST = 8
"""Files that a stage with a figure, an answer of the door and a test may touch."""
CONFIG = str(ROOT / "config" / "harmonics_only.yaml")
DOOR = """
import facegear
found = facegear.load({config!r}, results={results!r}).gear_ratio()
assert found.table()["ratio"].tolist() == [143 / 23], found.table()
assert found.source == "stored", found.source
assert [path.name for path in found.save({saved!r})] == ["gear_ratio.csv"]
"""


@pytest.fixture(scope="module")
def followed(tmp_path_factory):
    """A copy of the sources in which every step was done."""
    sources = copy_sources(tmp_path_factory.mktemp("recipe"))
    for name, where, text in STEPS:
        block = re.search(r"```\w+\n(.*?)   ```", text, flags=re.DOTALL)
        if block:
            write(sources / name, where, without_list(block[1]))
    return sources


def without_list(text):
    """The code less the three columns by which the list indents it."""
    return "".join(line.removeprefix("   ") for line in text.splitlines(keepends=True))


def write(path, where, code):
    place = re.match(r", (below|above) `([^`]+)`", where)
    if place is None:
        assert where.startswith(", new") and not path.exists()
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(code)
        return
    line = f"{place[2]}\n"
    before, after = path.read_text().split(line)
    both = (line, code) if place[1] == "below" else (code, line)
    path.write_text(before + "".join(both) + after)


def python(sources, *arguments, folder=None):
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder or sources,
        env={**environment(), "PYTHONPATH": os.pathsep.join([str(sources), str(ROOT / "tests" / "helpers")])},
        capture_output=True,
        text=True,
        check=False,
    )


def test_a_new_stage_touches_at_most_eight_files():
    assert 4 <= len({name for name, _, _ in STEPS}) <= MOST


def test_the_recipe_makes_a_stage_that_runs_draws_and_answers(followed, tmp_path):
    project = Project(tmp_path, followed)
    wanted = [f"results/harmonics_only/{name}" for name in ("ratio/gear_ratio.csv", "figures/gear_ratio.svg")]
    done = project.run("--configfile", CONFIG, "--", *wanted)
    assert "gear_ratio harmonics_only: ratio 6.217" in done.stderr
    code = DOOR.format(config=CONFIG, results=str(tmp_path / "results"), saved=str(tmp_path / "saved"))
    asked = python(followed, "-c", code, folder=tmp_path)
    assert asked.returncode == 0, asked.stderr
    assert {"gear_ratio", "modes_figures"} <= project.planned("--configfile", CONFIG, "--forceall")
    listed = python(followed, "-m", "facegear.pipeline.listing").stdout
    assert "| gear_ratio | Ratio of the tooth numbers |" in listed


def test_the_test_of_the_recipe_passes_and_its_code_is_formatted(followed):
    names = [name for name, where, _ in STEPS if where.startswith(", new")]
    tested = ("pytest", "-q", "-p", "references", "-p", "no:cacheprovider", "-c", "/dev/null", names[-1])
    for command in (tested, ("ruff", "check", "--config", str(ROOT / "pyproject.toml"), *names)):
        done = python(followed, "-m", *command)
        assert done.returncode == 0, done.stdout + done.stderr


def test_the_recipe_gives_the_new_stage_an_independent_reference(followed):
    kinds = [one.kind for one in declarations(followed).values() if one.capability == "gear_ratio"]
    assert kinds and set(kinds) <= set(INDEPENDENT)
