"""The recipe for a feature of the machine in CONTRIBUTING.md is followed, in a copy of the sources."""

import json

import pytest
from projects import Project, copy_sources
from recipes import assert_test_passes, python, read_recipe

from validation.references import INDEPENDENT, declarations

STEPS = read_recipe("Add a feature of the machine")
MOST = 12
"""Files that a feature with a section, a stage and a test may touch (issue 52)."""
PADS = {"count": 24, "area_mm2": 400, "thickness_mm": 5, "young_modulus_gpa": 3}
PADDED = f"""
extends: harmonics_only.yaml
case: padded
reproduction: null
thrust_pads: {json.dumps(PADS)}
"""
MOTION = """
import numpy as np
import facegear
stiffness = 24 * 3e9 * 400e-6 / 5e-3
plain = facegear.load("config/harmonics_only.yaml", None)
bearing = plain.config.transmission.face_gear.bearing_stiffness_n_per_m.z
padded = facegear.load("config/padded.yaml", None)
stiffer = plain.with_values({"transmission.face_gear.bearing_stiffness_n_per_m.z": bearing + stiffness})
spectra = [one.response().content["spectrum"]["amplitude_um"].to_numpy() for one in (plain, padded, stiffer)]
assert np.abs(spectra[1] - spectra[0]).max() > 1e-2 * spectra[0].max(), "pads change nothing"
np.testing.assert_allclose(spectra[1], spectra[2], rtol=1e-6, atol=1e-9)
"""


@pytest.fixture(scope="module")
def followed(tmp_path_factory):
    """A copy of the sources in which every step was done."""
    sources = copy_sources(tmp_path_factory.mktemp("recipe"))
    for step in STEPS:
        step.follow(sources)
    (sources / "config" / "padded.yaml").write_text(PADDED)
    return sources


def test_a_feature_of_the_machine_touches_at_most_twelve_files():
    assert 9 <= len({step.file for step in STEPS}) <= MOST


def test_generated_files_of_the_recipe_name_the_feature(followed):
    schema = json.loads(python(followed, "-m", "facegear.build.reference", "--schema").stdout)
    assert "thrust_pads" in schema["properties"]
    assert "`thrust_pads`" in python(followed, "-m", "facegear.build.reference").stdout
    assert "| thrust_pads | Stiffness of the pads" in python(followed, "-m", "facegear.pipeline.table").stdout


def test_every_stage_of_the_machine_takes_the_feature(followed):
    code = """
from facegear.pipeline.table import STAGES
missing = [name for name, stage in STAGES.items() if stage.machine and "thrust_pads" not in stage.upstream]
assert not missing, missing
"""
    done = python(followed, "-c", code)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("section", ["tolerances", "search"])
def test_varied_machines_refuse_the_feature_that_they_do_not_take(followed, section):
    values = {"extends": f"config/{section}.yaml", "thrust_pads": PADS}
    plain, padded = (
        python(followed, "-c", f"import facegear; facegear.load({one}, None)")
        for one in ({"extends": values["extends"]}, values)
    )
    assert plain.returncode == 0, plain.stderr
    assert f'{section} = "given": must be left out beside thrust_pads' in padded.stderr.splitlines()[-1]


def test_the_workflow_makes_the_stage_and_hands_it_to_the_machine(followed, tmp_path):
    project = Project(tmp_path, followed)
    done = project.run(
        "--configfile", str(followed / "config" / "padded.yaml"), "--", "results/padded/modal/frequencies.csv"
    )
    assert "thrust_pads padded: 5760 N/um behind each face gear" in done.stderr


def test_the_motion_with_the_feature_is_that_of_stiffer_bearings(followed):
    done = python(followed, "-c", MOTION)
    assert done.returncode == 0, done.stderr


def test_the_test_of_the_recipe_passes_and_its_code_is_formatted(followed):
    assert_test_passes(followed, STEPS)


def test_the_recipe_gives_the_feature_an_independent_reference(followed):
    kinds = [one.kind for one in declarations(followed).values() if one.capability == "thrust_pads"]
    assert kinds and set(kinds) <= set(INDEPENDENT)
