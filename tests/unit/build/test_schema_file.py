"""The schema that editors use, the models and the config files agree."""

from pathlib import Path

import pytest

from facegear.build.config import Config
from facegear.build.load import load_config, read_layers
from facegear.build.reference import SCHEMA, json_schema, reference
from facegear.errors import ConfigErrors
from facegear.schema.base import parse

ROOT = Path(__file__).parents[3]


def test_schema_file_is_what_the_models_say():
    assert SCHEMA.read_text() == json_schema(), (
        "run: python -m facegear.build.reference --schema > facegear/schema/config.schema.json"
    )


def test_the_page_of_all_keys_is_what_the_models_say():
    stored = (ROOT / "docs" / "reference" / "config.md").read_text()
    assert stored == reference(), "run: python -m facegear.build.reference > docs/reference/config.md"
    assert "| `transmission.pinions[].angle_deg` | `null` | number from -360, to 360 or null |" in stored


@pytest.mark.parametrize("path", sorted((ROOT / "config").glob("*.yaml")), ids=lambda path: path.stem)
def test_dumped_config_is_the_same_config(path):
    config = load_config(path)
    assert parse(Config, config.model_dump(mode="json")) == config


def test_a_config_extends_another_in_its_folder_key_by_key(tmp_path):
    (tmp_path / "base.yaml").write_text("case: base\na: {x: 1, y: [1, 2]}\n")
    (tmp_path / "own.yaml").write_text("extends: base.yaml\ncase: own\na: {y: [3]}\n")
    assert read_layers(tmp_path / "own.yaml") == {"case": "own", "a": {"x": 1, "y": [3]}}


@pytest.mark.parametrize("base", ["own.yaml", "../base.yaml", "/etc/passwd", "none.yaml", "3"])
def test_a_config_cannot_extend_itself_or_a_file_elsewhere(tmp_path, base):
    (tmp_path / "own.yaml").write_text(f"extends: {base}\n")
    with pytest.raises(ConfigErrors, match="extends = "):
        read_layers(tmp_path / "own.yaml")


def test_bodies_are_optional_only_where_harmonics_are_given():
    values = load_config(ROOT / "config" / "harmonics_only.yaml").model_dump(mode="json")
    assert values["tooth_pair"]["pinion"] is None
    values["mesh_stiffness"] |= {"source": "fem", "torque_n_m": 400.0, "table": []}
    with pytest.raises(ConfigErrors, match=r"tooth_pair\.pinion = null: must be given"):
        parse(Config, values)


def test_files_named_in_a_config_count_from_its_folder(tmp_path, monkeypatch):
    folder = tmp_path / "machines"
    folder.mkdir()
    (folder / "base.yaml").write_text("reproduction: claims/own.yaml\nmesh_stiffness: {csv: k.csv}\n")
    (folder / "own.yaml").write_text("extends: base.yaml\nreproduction: null\n")
    monkeypatch.chdir(tmp_path)
    found = read_layers("machines/own.yaml")
    assert found == {"reproduction": None, "mesh_stiffness": {"csv": "machines/k.csv"}}
    assert read_layers(folder / "base.yaml")["reproduction"] == "machines/claims/own.yaml"
