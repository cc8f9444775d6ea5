"""Names and text use the terms of docs/glossary.md, and none of the words that it refuses."""

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from functools import cache
from itertools import chain
from pathlib import Path

import pytest

pytestmark = pytest.mark.xdist_group("vocabulary")  # a module is parsed once a process
ROOT = Path(__file__).parents[2]
GLOSSARY = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
AREAS = ("facegear", "paper", "validation", "workflow")
SOURCES = [
    path
    for area in AREAS
    for path in sorted((ROOT / area).rglob("*.py"))
    if "tests" not in path.relative_to(ROOT).parts
]
PAGES = [
    path
    for path in (*sorted((ROOT / "docs").glob("*.md")), ROOT / "README.md", ROOT / "CONTRIBUTING.md")
    if path.name != "glossary.md"
]


def rows(title: str) -> list[list[str]]:
    """Cells of the table below a heading of the glossary, without its head."""
    section = GLOSSARY.split(f"\n## {title}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("|")][2:]
    return [[cell.strip().strip("`") for cell in line.strip("|").split("|")] for line in lines]


REFUSED = rows("Words that are refused")
WHOLE = {word for word, names, *_ in REFUSED if names}
PARTS = {word for word, names, *_ in REFUSED if names == "any part"}
TESTS = [path for folder in (".", "paper", "validation") for path in (ROOT / folder / "tests").rglob("*.py")]
SPOKEN = [word.replace("_", "[ _]") for word, _, text, *_ in REFUSED if text]
IN_TEXT = re.compile(rf"\b(?:{'|'.join(SPOKEN)})\b", re.IGNORECASE)
ALLOWED = {name for name, *_ in rows("Exceptions")}


def defined_names(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and name of all that a module defines: functions, classes, arguments, variables, attributes."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.lineno, node.name
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.attr
        elif isinstance(node, ast.alias) and node.asname:
            yield node.lineno, node.asname


@cache
def names_in(path: Path) -> tuple[tuple[int, str], ...]:
    return tuple(defined_names(ast.parse(path.read_text(encoding="utf-8"))))


def refused(name: str) -> bool:
    return name not in ALLOWED and (name in WHOLE or not PARTS.isdisjoint(name.lower().split("_")))


def texts(source: str) -> Iterator[tuple[int, str]]:
    """Line and content of all comments and strings of a module."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type in (tokenize.COMMENT, tokenize.STRING):
            yield from enumerate(token.string.splitlines(), start=token.start[0])


@pytest.mark.parametrize("area", AREAS)
def test_names_use_the_terms_of_the_glossary(area):
    wrong = [
        f"{path.relative_to(ROOT)}:{line} {name}"
        for path in SOURCES
        if path.is_relative_to(ROOT / area)
        for line, name in names_in(path)
        if refused(name)
    ]
    assert not wrong, "\n".join(["names that docs/glossary.md refuses:", *wrong])


def test_names_of_tests_hold_no_word_that_text_refuses():
    spoken = {word for word, names, text, *_ in REFUSED if names == "any part" and text}
    wrong = [
        f"{path.relative_to(ROOT)}:{line} {name}"
        for path in TESTS
        for line, name in names_in(path)
        if not spoken.isdisjoint(name.lower().split("_"))
    ]
    assert spoken and not wrong, "\n".join(["names that docs/glossary.md refuses:", *wrong])


def test_text_uses_the_terms_of_the_glossary():
    of_code = ((path, texts(path.read_text(encoding="utf-8"))) for path in SOURCES)
    of_pages = ((path, enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)) for path in PAGES)
    wrong = [
        f"{path.relative_to(ROOT)}:{number} {line.strip()[:90]}"
        for path, lines in chain(of_code, of_pages)
        for number, line in lines
        if IN_TEXT.search(line)
    ]
    assert not wrong, "\n".join(["text with words that docs/glossary.md refuses:", *wrong])


def test_every_exception_is_needed():
    names = {name for path in SOURCES for _, name in names_in(path)}
    assert names >= ALLOWED
    for name in ALLOWED:
        assert name in WHOLE or not PARTS.isdisjoint(name.lower().split("_"))


def test_a_name_of_each_kind_and_each_kind_of_text_is_seen():
    source = (
        'class told:\n    """found"""\n    def one(self, place, *least): self.most = flow = lambda wide: 1\n'
    )
    assert {name for _, name in defined_names(ast.parse(source))} == {
        *("told", "one", "self", "place", "least", "most", "flow", "wide")
    }
    assert refused("ring_play") and refused("MOST_STEPS") and refused("one") and not refused("one_sided")
    assert [
        line for line, text in texts(source + "# afloat\n") if "found" in text or IN_TEXT.search(text)
    ] == [2, 4]


def test_names_of_code_in_the_terms_are_those_of_the_code():
    code = "\n".join(path.read_text(encoding="utf-8") for path in SOURCES)
    quoted = {name for _, meaning in rows("Terms") for name in re.findall(r"`([A-Za-z_]+)`", meaning)}
    assert quoted and all(re.search(rf"\b{name}\b", code) for name in quoted)


def test_each_term_stands_once_in_the_glossary():
    terms = [part.strip() for term, *_ in rows("Terms") for part in term.split(",")]
    words = [word for word, *_ in REFUSED]
    assert len(terms) == len(set(terms)) and len(words) == len(set(words))
    assert not set(terms) & set(words)
