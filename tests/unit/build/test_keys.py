"""Refusals of a computation in its own words are printed with the key of the config."""

import json
from pathlib import Path

import pytest

import facegear
from facegear.build.reference import json_schema
from facegear.errors import ConfigError, InvalidInput
from facegear.pipeline.run import call
from facegear.pipeline.stage import Stage
from facegear.schema.base import KEYS, keys_named

LIBRARY = Path(facegear.__file__).parent


def schema_keys(schema, node, prefix=""):
    """Dotted keys of all sections, those of optional ones too."""
    if "$ref" in node:
        yield from schema_keys(schema, schema["$defs"][node["$ref"].rsplit("/", 1)[1]], prefix)
    for option in node.get("anyOf", ()):
        yield from schema_keys(schema, option, prefix)
    for name, inside in node.get("properties", {}).items():
        yield prefix + name
        yield from schema_keys(schema, inside, f"{prefix}{name}.")


def test_every_key_that_a_quantity_stands_for_is_one_of_the_config():
    schema = json.loads(json_schema())
    known = set(schema_keys(schema, schema))
    last = {key.rsplit(".", 1)[-1] for key in known}
    assert {key for key in KEYS.values() if key not in known} <= last


@pytest.mark.parametrize("words", KEYS)
def test_every_quantity_with_a_key_is_refused_somewhere(words):
    kept = words.replace("modelled teeth of the pinion", "modelled teeth of the ")
    kept = kept.replace("modelled teeth of the face gear", "modelled teeth of the ")
    texts = (path.read_text() for path in LIBRARY.rglob("*.py"))
    refusing = [text for text in texts if "raise InvalidInput(" in text]
    assert any(f'"{kept}' in text or f"`{kept}`" in text for text in refusing)


def test_a_refusal_names_the_key_and_the_keys_beside_it():
    with pytest.raises(ConfigError) as caught, keys_named():
        raise InvalidInput("element size", "9 mm", "smaller, or `torques of the contact analysis` larger")
    line = "mesh.resolution = '9 mm': must be smaller, or contact.torques_n_m larger"
    assert str(caught.value) == line and "`" not in str(caught.value.__cause__)


def refusing(**_):
    raise InvalidInput("torques", 3, "in balance")


def test_a_stage_refuses_by_the_key(monkeypatch):
    monkeypatch.setattr("facegear.pipeline.run.load", lambda _: refusing)
    with pytest.raises(ConfigError, match=r"transmission\.torque = 3: must be in balance"):
        call(Stage(name="any", title=""), {})
