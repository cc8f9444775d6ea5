"""Config mistakes are told in one line each: key, value, what is allowed."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field, model_validator

from facegear.errors import ConfigErrors
from facegear.schema.base import Section, parse, refuse
from facegear.schema.yaml_file import read_yaml


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
            refuse("outer_mm", self.outer_mm, f"greater than inner_mm = {self.inner_mm}")
        return self


GOOD = {"case": "a", "bearing": {"stiffness_n_per_m": 1}}


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"bearing": {"stifness_n_per_m": 1}}, "did you mean 'stiffness_n_per_m'?"),
        ({"bearing": {}}, "bearing.stiffness_n_per_m = (missing): this key is required"),
        (
            {"bearing": {"stiffness_n_per_m": -1}},
            "bearing.stiffness_n_per_m = -1: must be greater than",
        ),
        (
            {"bearing": {"stiffness_n_per_m": True}},
            "stiffness_n_per_m = true: must be a valid number",
        ),
        ({"bearing": {"stiffness_n_per_m": float("nan")}}, "must be a finite number"),
        ({"pinions": [GOOD["bearing"], {"stiffness_n_per_m": 1, "teeth": 2.5}]}, "pinions[1].teeth = 2.5"),
        ({"inner_mm": 3}, "outer_mm = 2.0: must be greater than inner_mm = 3.0"),
        ({"case": None}, "case = null"),
    ],
)
def test_each_mistake_names_key_value_and_what_is_allowed(change, line):
    with pytest.raises(ConfigErrors) as caught:
        parse(Machine, {**GOOD, **change}, "machine.yaml")
    (message,) = caught.value.lines
    assert line in message
    assert str(caught.value).startswith("machine.yaml: ")


def test_all_mistakes_of_a_file_are_reported_at_once():
    with pytest.raises(ConfigErrors) as caught:
        parse(Machine, {"case": 3, "bearing": {"stiffness_n_per_m": "soft", "x": 1}})
    assert len(caught.value.lines) == 3


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a: 1\na: 2\n", ':2: not valid YAML: while constructing a mapping, found duplicate key "a"'),
        ("a: [1, 2\n", ":2: not valid YAML"),
        ("- 1\n", "a config is a mapping"),
        (
            "a: !!python/object/apply:os.system ['true']\n",
            ":1: not valid YAML: could not determine a constructor",
        ),
        ("\x00", "not valid YAML"),
        ("a: *b\n", ":1: alias *b"),
        ("a: &x [*x]\n", ":1: alias *x"),
        ("a:\n  b: 1\n c: 2\n", ":3: not valid YAML"),
        ("a: 1\n---\nb: 2\n", ":2: not valid YAML: expected a single document"),
        ("%YAML 1.1\n---\na: 025\n", ":2: a config follows YAML 1.2"),
        ("a: 2024-13-45\n", "not valid YAML: month must be in 1..12"),
        (f"a: {'9' * 5000}\n", "not valid YAML: Exceeds the limit"),
    ],
)
def test_broken_yaml_ends_in_one_line(tmp_path, text, line):
    path = tmp_path / "broken.yaml"
    path.write_text(text)
    with pytest.raises(ConfigErrors, match=r"broken\.yaml") as caught:
        read_yaml(path)
    assert line in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("case: 2024-01-01\n", "(2024-01-01: put text in quotes)"),
        ("case: !!set {x}\n", "({'x'}: put text in quotes)"),
        ("case: a\n? [1, 2]\n: 3\n", "(keys must be str"),
        ("1: 2\n", "1 = 2: unknown key"),
    ],
)
def test_what_no_config_holds_is_refused_by_its_value(tmp_path, text, line):
    path = tmp_path / "strange.yaml"
    path.write_text(text)
    with pytest.raises(ConfigErrors) as caught:
        parse(Machine, read_yaml(path))
    assert any(line in said for said in caught.value.lines)
    assert not any("\n" in line for line in caught.value.lines)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigErrors, match="no such config file"):
        read_yaml(tmp_path / "none.yaml")


def test_a_folder_and_a_file_that_is_not_utf8_are_named_in_one_line(tmp_path):
    with pytest.raises(ConfigErrors, match="is a directory"):
        read_yaml(tmp_path)
    path = tmp_path / "latin.yaml"
    path.write_bytes("case: a\n# Getriebe für zwei\n".encode("latin-1"))
    with pytest.raises(ConfigErrors, match=r"latin\.yaml:2: byte 0xfc is not UTF-8"):
        read_yaml(path)


@pytest.mark.parametrize("opening", ["[", "{a: ", "- "])
def test_nesting_is_bounded(tmp_path, opening):
    path = tmp_path / "deep.yaml"
    path.write_text("case: deep\na:\n  " + opening * 3000)
    with pytest.raises(ConfigErrors, match=r"deep\.yaml:3: nested more than 32 levels deep"):
        read_yaml(path)


def test_length_is_bounded(tmp_path):
    (tmp_path / "long.yaml").write_text("a: 1\n" + "# long\n" * 100_000)
    with pytest.raises(ConfigErrors, match="longer than 500000 bytes"):
        read_yaml(tmp_path / "long.yaml")


def test_a_bomb_of_aliases_is_refused_at_once(tmp_path):
    """Nine lists of nine aliases each, twelve levels deep, stand for 9**12 values."""
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 12)]
    (tmp_path / "bomb.yaml").write_text("\n".join(lines))
    with pytest.raises(ConfigErrors, match=r"bomb\.yaml:5: more than 50000 values, aliases written out"):
        read_yaml(tmp_path / "bomb.yaml")


def test_aliases_and_merge_keys_stand_for_what_they_name(tmp_path):
    path = tmp_path / "n.yaml"
    path.write_text("a: &a {x: 1, y: 2}\nb: *a\nc: {<<: *a, y: 3}\n")
    assert read_yaml(path) == {"a": {"x": 1, "y": 2}, "b": {"x": 1, "y": 2}, "c": {"x": 1, "y": 3}}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *(("1e-8", 1e-8), ("6.5e7", 6.5e7), (".5", 0.5), ("-3", -3), ("0o25", 21), ("0x1F", 31)),
        *(("025", 25), ("1:20", "1:20"), ("yes", "yes"), ("on", "on"), ("'80'", "80")),
        *(("true", True), ("~", None), (".inf", float("inf"))),
    ],
)
def test_scalars_follow_yaml_1_2(tmp_path, text, value):
    """Under the rules of YAML 1.1, 025 was 21 and 1:20 was 80."""
    path = tmp_path / "n.yaml"
    path.write_text(f"value: {text}\n")
    (found,) = read_yaml(path).values()
    assert found == value and type(found) is type(value)


@given(st.text(alphabet=st.sampled_from("ab:-?[]{}#&*!|>'\"%@`~<,. 01e\n\t\\x"), max_size=80))
def test_any_text_is_read_or_refused_in_one_line(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("any") / "any.yaml"
    path.write_text(text)
    try:
        assert isinstance(read_yaml(path), dict)
    except ConfigErrors as error:
        assert "\n" not in str(error)
