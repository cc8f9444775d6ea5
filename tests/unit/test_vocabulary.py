"""The code keeps the rules of language; a glossary term stands once."""

import re
from pathlib import Path
from textwrap import dedent

import pytest

from validation import language

pytestmark = pytest.mark.xdist_group("vocabulary")  # all modules are parsed in one process
ROOT = Path(__file__).parents[2]
GLOSSARY = (ROOT / "docs" / "reference" / "glossary.md").read_text(encoding="utf-8")
SAMPLE = '''"""The same of a module."""

KEPT = 1
"""Of a constant."""
SPEED, _LOAD = 1.0, 2.0
FORCE = 1.0  # N, of the example
# Turns of the example.
TURNS: int = 3


class Others:
    """A class."""

    def area(self, width: float, height: Array) -> float:
        """Return an area.

        Parameters
        ----------
        width
            Width, m.
        height : Array
            Heights (n,).

        Returns
        -------
        float
            The area.
        """
        own = width
        return own

    def load(self, torque: float, lines: Array) -> Array:
        """Return a load.

        Parameters
        ----------
        torque : float
            Torque, N m.
        lines
            Lengths, mm.

        Returns
        -------
        Array
            Loads (n,), N.
        """

    def _asked(self):
        """As above."""


def is_closed(gap):
    """Whether a gap is closed. Ofen and Asgard are words."""

    def inner(others):
        """Some gap."""


def write() -> None:
    """Write nothing."""
'''
BROKEN = {
    "<module>::opening",
    "KEPT::name",
    "KEPT::opening",
    "SPEED::constant",
    "_LOAD::constant",
    "Others::name",
    "Others.area.own::name",
    "Others.area::units",
    "Others.load::shapes",
    "Others._asked::name",
    "Others._asked::opening",
    "is_closed::parameters",
    "is_closed.inner.others::name",
    "is_closed.inner::opening",
}


def test_no_code_breaks_a_rule_of_language():
    offenders = sorted(language.find_offenders())
    assert not offenders, "\n".join(
        ["break a rule of language (CONTRIBUTING.md, Language):", *offenders[:40]]
    )


def test_each_rule_refuses_what_breaks_it_and_nothing_else():
    offenders = language.offenders_of(Path("facegear/a.py"), SAMPLE)
    assert {key.removeprefix("facegear/a.py::") for key in offenders} == BROKEN
    assert language.offenders_of(Path("facegear/asked.py"), '"""A module."""\n') == {
        "facegear/asked.py::<module>::name"
    }


def test_names_and_sections_of_tests_are_free_and_their_docstrings_are_not():
    offenders = language.offenders_of(Path("tests/unit/test_a.py"), SAMPLE)
    assert {key.rpartition("::")[2] for key in offenders} == {"opening"}


@pytest.mark.parametrize("name", ["OWN", "_kept", "founds", "Others", "abreast", "Courses"])
def test_bare_names_are_seen_in_any_case_and_number(name):
    assert language.is_bare(name)


@pytest.mark.parametrize(
    "name", ["__all__", "own_mesh", "lowest", "is_closed", "speed", "seed", "mesh", "least", "bearing"]
)
def test_plain_words_are_allowed(name):
    assert not language.is_bare(name)


def test_the_code_that_contributing_shows_keeps_the_rules():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    blocks = [dedent(block) for block in re.findall(r"(?s)```\w+\n(.*?) *```", text) if "def " in block]
    assert len(blocks) >= 4
    for block in blocks:
        folder = "tests" if "def test_" in block else "facegear"
        assert not language.offenders_of(Path(folder) / "gear_ratio.py", block)


def test_the_command_names_what_breaks_a_rule_and_fails(monkeypatch, capsys):
    monkeypatch.setattr(language, "find_offenders", lambda: {"b.py::f::opening", "a.py::f.own::name"})
    assert language.main([]) == 1
    shown = capsys.readouterr()
    assert "a.py::f.own::name: breaks a rule" in shown.err and shown.out == "name: 1, opening: 1\n"


def test_a_public_name_is_free_only_as_long_as_it_is_there(monkeypatch):
    monkeypatch.setattr(language, "PUBLIC_NAMES", {"facegear/gone.py::f.own::name": "no such method"})
    offenders = language.find_offenders()
    assert "facegear/gone.py::f.own::name" in offenders
    assert "facegear/gearbox.py::Gearbox.following::name" in offenders


def rows(title):
    """Cells of the table below a heading of the glossary, without its head."""
    section = GLOSSARY.split(f"\n## {title}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("|")][2:]
    return [[cell.strip().strip("`") for cell in line.strip("|").split("|")] for line in lines]


def test_names_of_code_in_the_terms_are_those_of_the_code():
    paths = [path for folder in language.SOURCES for path in (ROOT / folder).rglob("*.py")]
    code = "\n".join(path.read_text(encoding="utf-8") for path in paths)
    quoted = {name for _, meaning in rows("Terms") for name in re.findall(r"`([A-Za-z_]+)`", meaning)}
    assert quoted and all(re.search(rf"\b{name}\b", code) for name in quoted)


def test_each_term_stands_once_in_the_glossary():
    terms = [part.strip() for term, *_ in rows("Terms") for part in term.split(",")]
    assert len(terms) == len(set(terms))
