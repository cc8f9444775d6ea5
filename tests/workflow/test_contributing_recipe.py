"""The recipe for a new stage in CONTRIBUTING.md is followed step by step, in a copy of the sources."""

import pytest
from projects import ROOT, Project, copy_sources
from recipes import assert_test_passes, python, read_recipe

from validation.references import INDEPENDENT, declarations

STEPS = read_recipe("Add a stage")
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
    for step in STEPS:
        step.follow(sources)
    return sources


def test_a_new_stage_touches_at_most_eight_files():
    assert 4 <= len({step.file for step in STEPS}) <= MOST


def test_the_recipe_makes_a_stage_that_runs_draws_and_answers(followed, tmp_path):
    project = Project(tmp_path, followed)
    wanted = [f"results/harmonics_only/{name}" for name in ("ratio/gear_ratio.csv", "figures/gear_ratio.svg")]
    done = project.run("--configfile", CONFIG, "--", *wanted)
    assert "gear_ratio harmonics_only: ratio 6.217" in done.stderr
    code = DOOR.format(config=CONFIG, results=str(tmp_path / "results"), saved=str(tmp_path / "saved"))
    asked = python(followed, "-c", code, folder=tmp_path)
    assert asked.returncode == 0, asked.stderr
    assert {"gear_ratio", "modes_figures"} <= project.planned("--configfile", CONFIG, "--forceall")
    listed = python(followed, "-m", "facegear.pipeline.table").stdout
    assert "| gear_ratio | Ratio of the tooth numbers |" in listed


def test_the_test_of_the_recipe_passes_and_its_code_is_formatted(followed):
    assert_test_passes(followed, STEPS)


def test_the_recipe_gives_the_new_stage_an_independent_reference(followed):
    kinds = [one.kind for one in declarations(followed).values() if one.capability == "gear_ratio"]
    assert kinds and set(kinds) <= set(INDEPENDENT)
