"""A value of a config is validated once, where the config is read; behind that it is only typed again."""

from copy import deepcopy
from pathlib import Path

import pytest

import facegear
from facegear.build.cases import expand_cases
from facegear.build.load import load_config
from facegear.build.tooth_pair import ToothPair
from facegear.errors import ConfigErrors
from facegear.pipeline.arguments import typed_arguments
from facegear.pipeline.results.chain import Chain
from facegear.pipeline.run import machine_inputs
from facegear.schema.base import parse
from facegear.schema.transmission import Transmission

CONFIG = Path(__file__).parents[3] / "config" / "concentric.yaml"


def test_cases_and_stages_do_not_repeat_the_checks_of_a_config(monkeypatch):
    checked = []
    known = Transmission._check_names
    monkeypatch.setattr(Transmission, "_check_names", lambda self: checked.append(1) or known(self))
    config = load_config(CONFIG).model_copy(update={"studies": ()})
    assert len(checked) == 1
    (values,) = expand_cases(config).values()
    assert Transmission.of_config(values["transmission"]).pinions == config.transmission.pinions
    chain = facegear.load(CONFIG, results=None)._chain
    monkeypatch.setattr(Chain, "part", lambda *asked: None)  # nothing of earlier stages is computed
    assert machine_inputs(chain.arguments("ratings")).transmission.pinions == config.transmission.pinions
    assert len(checked) == 2, "once for each reading of the file"


@pytest.mark.parametrize("section", ["transmission", "tooth_pair"])
def test_a_section_typed_again_is_the_one_that_was_validated(section):
    config = load_config(CONFIG)
    validated = getattr(config, section)
    assert type(validated).of_config(validated.model_dump(mode="json")) == validated


def test_a_section_of_new_values_is_validated():
    values = deepcopy(facegear.example().values["tooth_pair"])
    values["face_gear_teeth"] = values["pinion_teeth"]
    with pytest.raises(ConfigErrors, match="face_gear_teeth"):
        parse(ToothPair, values)


def test_plain_values_become_what_an_annotation_names():
    def stage(transmission: Transmission | None, tooth_pair: ToothPair, speed_rpm: float, plain: dict):
        """Never called: its annotations alone are read."""

    values = facegear.example().values
    given = {key: values[key] for key in ("transmission", "tooth_pair")} | {"speed_rpm": 3.0, "plain": {}}
    typed = typed_arguments(stage, given)
    assert [type(value) for value in typed.values()] == [Transmission, ToothPair, float, dict]
    assert typed_arguments(stage, {"transmission": None}) == {"transmission": None}
