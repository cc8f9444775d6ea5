"""Recipes of CONTRIBUTING.md for a stage, a config section and a kernel are followed in a copy."""

import shutil
import subprocess
import sysconfig
from pathlib import Path

import nanobind
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
    return follow(STEPS, copy_sources(tmp_path_factory.mktemp("recipe")))


def follow(steps, sources):
    """Do all steps in the sources, and return them."""
    for step in steps:
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


def test_the_recipe_of_a_section_makes_a_key_that_is_checked_and_documented(tmp_path):
    sources = follow(read_recipe("Add a config section"), copy_sources(tmp_path))
    assert '"steel_eur_per_kg"' in python(sources, "-m", "facegear.build.reference", "--schema").stdout
    page = python(sources, "-m", "facegear.build.reference").stdout
    assert "| `cost.steel_eur_per_kg` | `20.0` | number above 0, to 1e+06 | price of the steel |" in page
    code = "import facegear; print(facegear.load({values}).config.cost.steel_eur_per_kg)"
    given = python(sources, "-c", code.format(values={"extends": CONFIG, "cost": {}}))
    refused = python(sources, "-c", code.format(values={"extends": CONFIG, "cost": {"steel_eur_per_kg": -1}}))
    assert given.stdout == "20.0\n", given.stderr
    assert "cost.steel_eur_per_kg = -1" in refused.stderr.splitlines()[-1]


@pytest.mark.skipif(shutil.which("c++") is None, reason="the recipe's kernel is compiled by a C++ compiler")
def test_the_recipe_of_a_kernel_makes_one_that_checks_its_arguments(tmp_path):
    source = tmp_path / "facegear" / "_kernels" / "src"
    shutil.copytree(ROOT / "facegear" / "_kernels" / "src", source)
    follow(read_recipe("Add a kernel"), tmp_path)
    (tmp_path / "recipe.cpp").write_text(
        '#include "bindings/strength.cpp"\nNB_MODULE(recipe, module) { facegear::bind_strength(module); }\n'
    )
    library = Path(nanobind.include_dir()).parent
    places = [library / "include", library / "ext" / "robin_map" / "include", sysconfig.get_path("include")]
    command = [
        "c++",
        "-std=c++20",
        "-O0",
        "-shared",
        "-fPIC",
        "-fvisibility=hidden",
        "-Wno-psabi",
        f"-I{source}",
    ]
    command += [word for place in places for word in ("-isystem", str(place))]
    inputs = [tmp_path / "recipe.cpp", library / "src" / "nb_combined.cpp"]
    done = subprocess.run(
        [
            *command,
            *map(str, inputs),
            "-o",
            str(tmp_path / f"recipe{sysconfig.get_config_var('EXT_SUFFIX')}"),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[:2000]
    code = """
import numpy as np, recipe
numbers, largest = np.random.default_rng(1).normal(size=(5, 7)), np.empty(5)
recipe.largest(numbers, largest)
assert np.array_equal(largest, numbers.max(axis=1))
try:
    recipe.largest(numbers, np.empty(4))
except ValueError as error:
    print(error)
"""
    called = python(tmp_path, "-c", code)
    assert called.stdout == "largest must have an entry for each row\n", called.stderr
