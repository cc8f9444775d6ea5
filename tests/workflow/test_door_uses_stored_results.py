"""After a run of the workflow the front door reads what is stored, as long as it is up to date."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest
from projects import ROOT

import facegear
from facegear.pipeline.results import store

pytestmark = [pytest.mark.workflow, pytest.mark.xdist_group("workflow")]
ANSWERS = ("geometry", "contact", "stiffness", "modes", "response", "sweep", "load_sharing")
CONFIG = ROOT / "config" / "quick.yaml"


@pytest.fixture
def results(quick, tmp_path):
    """A copy of the stored results that a test may damage."""
    shutil.copytree(quick.folder / "results", tmp_path / "results")
    return tmp_path / "results"


@pytest.mark.parametrize("answer", ANSWERS)
def test_every_answer_of_a_finished_run_is_read(quick, answer):
    found = getattr(facegear.load(CONFIG, quick.folder / "results"), answer)()
    assert found.source == "stored"
    assert found.plot().axes


def test_what_is_computed_anew_is_what_was_stored(quick):
    stored, anew = (facegear.load(CONFIG, folder).modes() for folder in (quick.folder / "results", None))
    assert anew.source == "computed"
    pd.testing.assert_frame_equal(anew.table(), stored.table(), rtol=1e-9)


def test_saving_writes_the_files_that_the_workflow_wrote(quick, tmp_path):
    found = facegear.load(CONFIG, quick.folder / "results").contact()
    for path in found.save(tmp_path):
        written = quick.folder / "results" / "quick" / path.relative_to(tmp_path)
        assert abs(written.stat().st_size / path.stat().st_size - 1) < 0.01
        if path.suffix == ".csv":
            pd.testing.assert_frame_equal(pd.read_csv(path), pd.read_csv(written), rtol=1e-14)


def test_a_changed_backlash_takes_the_stored_contact(quick):
    gearbox = facegear.load(CONFIG, quick.folder / "results").with_values({"transmission.backlash_um": 90})
    assert gearbox.contact().source == gearbox.stiffness().source == "stored"
    assert gearbox.load_sharing().source == "computed"


def test_stiffness_from_another_contact_is_not_up_to_date(results):
    manifest = results / "quick" / "stiffness" / "stiffness.provenance.json"
    document = json.loads(manifest.read_text())
    document["inputs"] = dict.fromkeys(document["inputs"], "0" * 64)
    manifest.write_text(json.dumps(document))
    gearbox = facegear.load(CONFIG, results)
    assert gearbox.contact().source == "stored"
    assert gearbox.stiffness().source == "computed"


def test_a_damaged_file_is_computed_anew_with_a_warning(results):
    table = results / "quick" / "modal" / "frequencies.csv"
    text = table.read_text()
    table.write_text(text.replace("1", "2", 1))
    with pytest.warns(UserWarning, match="the content differs"):
        found = facegear.load(CONFIG, results).modes()
    assert found.source == "computed"
    assert not np.isnan(found.table()["frequency_hz"]).any()


def test_results_of_other_code_are_computed_anew(quick, monkeypatch):
    monkeypatch.setattr(store, "stage_fingerprint", lambda module, root: "0" * 16)
    assert facegear.load(CONFIG, quick.folder / "results").modes().source == "computed"
