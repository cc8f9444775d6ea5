"""The file behind a config's key `reproduction`: read and validated."""

from pathlib import Path

import pytest

from facegear.build.load import load_config
from facegear.errors import ConfigErrors
from paper.reproduction import read_reproduction

ROOT = Path(__file__).parents[2]


@pytest.fixture
def stored():
    return read_reproduction(ROOT / "config" / "reproduction" / "paper.yaml")


def test_files_are_found_wherever_the_reader_works(stored, tmp_path, monkeypatch):
    assert Path(stored.claims).resolve() == ROOT / "config" / "claims" / "paper.yaml"
    monkeypatch.chdir(tmp_path)
    config = load_config(ROOT / "config" / "paper.yaml").model_dump(mode="json")
    again = read_reproduction(config["reproduction"])
    assert Path(again.sets).resolve() == ROOT / "config" / "identified" / "paper.csv"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("claim: a.yaml\n", "did you mean 'claims'?"),
        ("claims: ''\n", "claims"),
        ("claims: a.yaml\nidentify: {}\n", "identify"),
    ],
)
def test_mistake_in_the_file_names_file_key_and_what_is_allowed(tmp_path, text, line):
    path = tmp_path / "own.yaml"
    path.write_text(text)
    with pytest.raises(ConfigErrors, match=r"own\.yaml: ") as caught:
        read_reproduction(path)
    assert line in str(caught.value)


def test_inputs_of_the_scorecard_move_with_the_checkout(monkeypatch):
    """An absolute path stood among them, and the sets of the scorecard ran again in a copy."""
    monkeypatch.chdir(ROOT)
    values = load_config(ROOT / "config" / "paper.yaml").model_dump(mode="json")
    read = read_reproduction(values["reproduction"])
    assert read.claims == "config/claims/paper.yaml"
    assert read.sets == "config/identified/paper.csv"
