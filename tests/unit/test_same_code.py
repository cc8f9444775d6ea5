"""`validation.same_code` tells renamed names from changed code."""

from pathlib import Path

import pytest

from validation.same_code import compare_files, follows
from validation.scopes import Names

ROOT = Path(__file__).parents[2]
BEFORE = '''
"""Doc."""
from pathlib import Path

LIMIT = 3


class Mesh:
    """Doc."""

    taken: int = 0

    def force(self, asked: float) -> float:
        """Doc."""
        # why
        kept = [asked * own for own in range(LIMIT)]
        return sum(kept) + self.taken


def solve(mesh: Mesh, asked: float) -> float:
    return mesh.force(asked=asked)
'''


def compared(before, after, path="facegear/a.py", **others):
    files = {path: (before.encode(), after.encode())}
    files |= {f"facegear/{name}.py": (old.encode(), new.encode()) for name, (old, new) in others.items()}
    return [difference for result in compare_files(files) for difference in result.differences]


def replaced(*pairs):
    text = BEFORE
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


@pytest.mark.parametrize(
    "pairs",
    [
        [('"""Doc."""', '"""Return another."""'), ("# why", "# because")],
        [("kept", "forces"), ("own", "factor")],
        [("asked", "speed")],
        [("taken", "load")],
        [("LIMIT", "COUNT"), ("Mesh", "Pair"), ("solve", "compute")],
        [("(mesh: Mesh, asked: float)", "(\n    mesh: Mesh,\n    asked: float,\n)")],
    ],
)
def test_names_docstrings_and_layout_may_differ(pairs):
    assert compared(BEFORE, replaced(*pairs)) == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("= 3", "= 4"),
        ("sum(kept)", "max(kept)"),
        ("+ self.taken", "- self.taken"),
        ("return sum(kept)", "return sum(asked)"),
        ("asked * own", "asked * asked"),
        ("asked=asked", "speed=asked"),
        ("self.taken", "self.load"),
        ("import Path", "import PurePath as Path"),
        ("range(LIMIT)", "range(LIMIT, 1)"),
        ("kept = [asked", "asked = [asked"),
        ("asked: float) -> float:\n    return", "asked: int) -> float:\n    return"),
    ],
)
def test_changed_code_is_named(old, new):
    assert compared(BEFORE, replaced((old, new)))


def test_two_bindings_that_become_one_are_named():
    assert compared("def f(a):\n    b = 1\n    return b\n", "def f(a):\n    a = 1\n    return a\n")


def test_a_capture_by_an_inner_scope_is_named():
    before = "def f(a):\n    return [a * b for b in range(3)]\n"
    assert compared(before, "def f(b):\n    return [b * b for b in range(3)]\n")


def test_an_import_follows_the_name_in_its_module():
    imported = "from facegear.a import LIMIT\nprint(LIMIT)\n"
    followed = "from facegear.a import COUNT\nprint(COUNT)\n"
    after = replaced(("LIMIT", "COUNT"))
    assert compared(BEFORE, after, b=(imported, followed)) == []
    assert compared(BEFORE, BEFORE, b=(imported, followed))
    assert compared(BEFORE, after, b=(imported + "x = 1\n", imported + "x = 2\n"))


def test_order_of_imports_in_a_block_says_nothing():
    assert compared("from os import a, b\nimport c\n", "import c\nfrom os import b\nfrom os import a\n") == []


def test_a_text_follows_only_whole_renamed_words():
    pairs = {("kept", "forces")}
    assert follows(("a.kept", "a.forces"), pairs)
    assert not follows(("kept_n", "forces_n"), pairs)
    assert not follows(("kept", "kept "), pairs)


def test_names_in_formatted_strings_have_their_places():
    """Python 3.11 gives a name in the second of two strings the place of the first."""
    text = 'def f(a, b):\n    return f"{a} {b:{a}} {a!r}" f"ä {b} {{a}} {[a for c in b]}"\n'
    names = Names(text.encode())
    placed = [o for o in names.occurrences if names.start(o.node) > text.index("return")]
    assert [o.name for o in sorted(placed, key=lambda o: o.start)] == ["a", "b", "a", "a", "b", "a", "c", "b"]
    assert len({o.start for o in placed}) == len(placed)


def test_every_module_of_the_package_has_its_names_placed():
    """`Names` refuses a name that does not stand where it was looked for."""
    paths = sorted((ROOT / "facegear").rglob("*.py"))[::20]
    assert sum(len(Names(path.read_bytes()).occurrences) for path in paths) > 1000
