"""Config mistakes are told in one line each: key, value, what is allowed."""

import pytest
from pydantic import Field, model_validator

from facegear.config.base import Section, parse, refuse
from facegear.config.yaml_file import read_yaml
from facegear.errors import ConfigErrors


class Bearing(Section):
    stiffness_n_per_m: float = Field(ge=0)
    teeth: int = Field(5, ge=1)


class Machine(Section):
    case: str
    bearing: Bearing
    pinions: tuple[Bearing, ...] = ()
    inner_mm: float = 1.0
    outer_mm: float = 2.0

    @model_validator(mode="after")
    def _ordered(self):
        if self.inner_mm >= self.outer_mm:
            refuse("outer_mm", self.outer_mm, f"must be greater than inner_mm = {self.inner_mm}")
        return self


GOOD = {"case": "a", "bearing": {"stiffness_n_per_m": 1}}


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"bearing": {"stifness_n_per_m": 1}}, "did you mean 'stiffness_n_per_m'?"),
        ({"bearing": {}}, "bearing.stiffness_n_per_m = (missing): this key is required"),
        (
            {"bearing": {"stiffness_n_per_m": -1}},
            "bearing.stiffness_n_per_m = -1: should be greater than",
        ),
        (
            {"bearing": {"stiffness_n_per_m": True}},
            "stiffness_n_per_m = true: should be a valid number",
        ),
        ({"bearing": {"stiffness_n_per_m": float("nan")}}, "should be a finite number"),
        ({"pinions": [GOOD["bearing"], {"stiffness_n_per_m": 1, "teeth": 2.5}]}, "pinions[1].teeth = 2.5"),
        ({"inner_mm": 3}, "outer_mm = 2.0: must be greater than inner_mm = 3.0"),
        ({"case": None}, "case = null"),
    ],
)
def test_each_mistake_names_key_value_and_what_is_allowed(change, line):
    with pytest.raises(ConfigErrors) as caught:
        parse(Machine, {**GOOD, **change}, "machine.yaml")
    (told,) = caught.value.lines
    assert line in told
    assert str(caught.value).startswith("machine.yaml: ")


def test_all_mistakes_of_a_file_are_told_at_once():
    with pytest.raises(ConfigErrors) as caught:
        parse(Machine, {"case": 3, "bearing": {"stiffness_n_per_m": "soft", "x": 1}})
    assert len(caught.value.lines) == 3


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a: 1\na: 2\n", "line 2: key 'a' stands twice"),
        ("a: [1, 2\n", "line"),
        ("- 1\n", "a config is a mapping"),
        ("a: !!python/object/apply:os.system ['true']\n", "line 1"),
        ("\x00", ""),
        ("a: *b\n", "line 1"),
    ],
)
def test_broken_yaml_ends_in_one_line(tmp_path, text, line):
    path = tmp_path / "broken.yaml"
    path.write_text(text)
    with pytest.raises(ConfigErrors, match=r"broken\.yaml") as caught:
        read_yaml(path)
    assert line in str(caught.value)
    assert "\n" not in str(caught.value)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigErrors, match="no such config file"):
        read_yaml(tmp_path / "none.yaml")


def test_numbers_without_a_dot_before_the_exponent_are_numbers(tmp_path):
    path = tmp_path / "n.yaml"
    path.write_text("a: 1e-8\nb: 6.5e7\nc: [4.1e8, 3]\nd: text\n")
    assert read_yaml(path) == {"a": 1e-8, "b": 6.5e7, "c": [4.1e8, 3], "d": "text"}
