"""The file behind a config's key `reproduction`: read, validated, its designs turned into cases."""

from pathlib import Path

import pytest

from facegear.config.load import load_values
from facegear.errors import ConfigErrors
from facegear.paper.config.reproduction import design_cases, read_reproduction

ROOT = Path(__file__).parents[4]


@pytest.fixture
def stored():
    return read_reproduction(ROOT / "config" / "reproduction" / "paper.yaml")


def test_files_are_found_wherever_the_reader_works(stored, tmp_path, monkeypatch):
    assert Path(stored.claims).resolve() == ROOT / "config" / "claims" / "paper.yaml"
    monkeypatch.chdir(tmp_path)
    config = load_values([ROOT / "config" / "paper.yaml"], {})
    again = read_reproduction(config["reproduction"])
    assert Path(again.sets).resolve() == ROOT / "config" / "identified" / "paper.csv"


def test_each_design_is_a_case_with_its_own_teeth_and_no_studies(stored):
    values = load_values([ROOT / "config" / "paper.yaml"], {})
    cases = design_cases(values, stored.identify)
    rim = cases["paper/designs/rim_24_mm"]
    assert len(cases) == 4
    assert rim["tooth_pair"]["face_gear"]["rim_thickness_mm"] == 24
    assert rim["studies"] == [] and rim["reproduction"] is None
    assert rim["case"] == "paper/designs/rim_24_mm"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("claim: a.yaml\n", "did you mean 'claims'?"),
        ("claims: a.yaml\nidentify: {ranges: {tail_share: [0.4, 0.1]}}\n", "identify.ranges.tail_share"),
        ("claims: a.yaml\nidentify: {search: {by_upper: 40}}\n", "identify.search.by_upper"),
    ],
)
def test_mistake_in_the_file_names_file_key_and_what_is_allowed(tmp_path, text, line):
    path = tmp_path / "own.yaml"
    path.write_text(text)
    with pytest.raises(ConfigErrors, match=r"own\.yaml: ") as caught:
        read_reproduction(path)
    assert line in str(caught.value)


def test_design_that_no_gear_can_have_is_named(stored):
    values = load_values([ROOT / "config" / "paper.yaml"], {})
    (design, *_) = stored.identify.designs
    wrong = design.model_copy(update={"set": {"tooth_pair.face_gear.rim_thickness_mm": -1}})
    with pytest.raises(ConfigErrors, match=r"identify\.designs\.rim_24_mm"):
        design_cases(values, stored.identify.model_copy(update={"designs": (wrong,)}))


def test_inputs_of_the_scorecard_move_with_the_checkout(monkeypatch):
    """An absolute path stood among them, and the sets of the scorecard ran again in a copy."""
    monkeypatch.chdir(ROOT)
    values = load_values([ROOT / "config" / "paper.yaml"], {})
    read = read_reproduction(values["reproduction"])
    assert read.claims == "config/claims/paper.yaml"
    assert read.sets == "config/identified/paper.csv"
