"""Counts and their nouns agree in all texts: one function writes them."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PARTS = ("facegear", "paper/scorecard", "paper/scripts")
FILES = [path for part in PARTS for path in sorted((ROOT / part).rglob("*.py"))]
VERBS = {"is", "was", "has", "does", "times"}


def is_count(node):
    """Whether an expression is a count: a length, a size, a sum, or one more or less."""
    if isinstance(node, ast.BinOp):
        return is_count(node.left) or is_count(node.right)
    if isinstance(node, ast.Call):
        return isinstance(node.func, ast.Name) and node.func.id == "len"
    return isinstance(node, ast.Attribute) and node.attr == "size"


def plurals_beside_counts(text):
    """Parts of formatted texts in which a plural follows a count, or an s hangs on a condition."""
    for part in [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.JoinedStr)]:
        for value, after in zip(part.values, part.values[1:], strict=False):
            if not (isinstance(value, ast.FormattedValue) and isinstance(after, ast.Constant)):
                continue
            words = after.value.removeprefix(" ").split()
            noun = words[0].strip(",;:.)") if words and after.value.startswith(" ") else ""
            if is_count(value.value) and noun.endswith("s") and noun not in VERBS:
                yield f"{ast.unparse(value.value)} {noun}"
        for value in part.values:
            if isinstance(value, ast.FormattedValue) and "'s' *" in ast.unparse(value.value):
                yield ast.unparse(value.value)


def test_no_text_builds_a_plural_beside_a_count_by_hand():
    """A run with one study case said "1 cases"; `count_noun` writes counts."""
    found = {path.relative_to(ROOT).as_posix(): [*plurals_beside_counts(path.read_text())] for path in FILES}
    assert {name: texts for name, texts in found.items() if texts} == {}


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("f'{len(rows)} cases'", 1),
        ("f'{a.size - 1} modes'", 1),
        ("f\"{n} jump{'s' * (n != 1)}\"", 1),
        ("f'{len(rows)} of them, {rows.size} x'", 0),
    ],
)
def test_only_plurals_by_hand_are_found(text, count):
    assert len(list(plurals_beside_counts(text))) == count
