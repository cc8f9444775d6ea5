"""A new value in a study costs its own runs only; of stages that take a second, those of its job."""

import re

import pytest
from projects import Project, copy_sources

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]
POINT = "          - {label: 100 um, set: {transmission.backlash_um: 100}}\n"
NEW = "          - {label: 90 um, set: {transmission.backlash_um: 90}}\n"


def test_new_value_of_a_study_runs_that_value_and_what_collects_it(quick, tmp_path):
    sources = copy_sources(tmp_path)
    config = sources / "config" / "quick.yaml"
    text = config.read_text()
    assert POINT in text
    config.write_text(text.replace(POINT, POINT + NEW))
    done = Project(quick.folder, sources).run("-n", "--configfile", str(config))
    jobs = dict(re.findall(r"^(\w+) +(\d+)$", done.stdout + done.stderr, re.MULTILINE))
    assert jobs["load_sharing_studies_1"] == "1"
    assert not {"load_sharing", "geometry", "mesh", "compliance", "contact", "stiffness", "modal"} & set(jobs)
    assert not {"dynamics_response", "dynamics_sweep", "dynamics_sweep_chunk"} & set(jobs)
