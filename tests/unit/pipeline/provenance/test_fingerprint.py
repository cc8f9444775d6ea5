"""A stage's fingerprint changes when, and only when, a function that it can reach changes."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from facegear.pipeline.provenance import sources
from facegear.pipeline.provenance.fingerprint import fingerprint, reached_functions, stage_fingerprint
from facegear.pipeline.provenance.sources import recall, remember

ROOT = Path(__file__).parents[4]


@pytest.fixture
def package(tmp_path):
    files = {
        "facegear/__init__.py": "",
        "facegear/teeth/__init__.py": "",
        "facegear/teeth/flank.py": (
            "from facegear.io import tables\n\ndef flank():\n    '''Doc.'''\n    return tables.x\n"
        ),
        "facegear/io/__init__.py": "",
        "facegear/io/tables.py": "x = 1\n",
        "facegear/report/figures/__init__.py": "",
        "facegear/report/figures/flank.py": "import facegear.teeth.flank\n",
        "script.py": "from facegear.teeth.flank import flank\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def edit(path, text):
    path.write_text(text)
    stamp = path.stat().st_mtime_ns + 1_000_000
    os.utime(path, ns=(stamp, stamp))


def test_functions_are_found_through_the_names_that_they_use(package):
    assert reached_functions(["facegear.teeth.flank:flank"], package) == {
        "facegear.teeth.flank:flank",
        "facegear.io.tables:x",
    }


@pytest.mark.parametrize(
    ("file", "text", "changes"),
    [
        ("facegear/io/tables.py", "x = 2\n", True),
        ("facegear/io/tables.py", "# only a comment\nx  =  1\n", False),
        ("facegear/io/tables.py", "x = 1\n\ndef unused():\n    return x\n", False),
        ("facegear/teeth/__init__.py", '"""Only a docstring."""\n', False),
        ("facegear/report/figures/flank.py", "import facegear.teeth.flank\ny = 2\n", False),
        ("script.py", "from facegear.teeth.flank import flank\nflank()\n", True),
    ],
)
def test_only_reached_code_counts(package, file, text, changes):
    before = fingerprint(package / "script.py", package)
    edit(package / file, text)
    assert (fingerprint(package / "script.py", package) != before) is changes


@pytest.mark.parametrize("name", ["flanks/rays.hpp", "bindings/flanks.cpp"])
def test_sources_of_compiled_kernels_count_for_what_reaches_them(package, name):
    """A changed formula in C++ would otherwise leave the stored results of the one before."""
    kernels = package / "facegear/_kernels"
    (kernels / "src" / name).parent.mkdir(parents=True)
    edit(kernels / "__init__.py", "")
    edit(kernels / "src" / name, "1")
    without = fingerprint(package / "script.py", package)
    edit(
        package / "script.py",
        (package / "script.py").read_text() + "from facegear._kernels import motion\nmotion\n",
    )
    before = fingerprint(package / "script.py", package)
    edit(kernels / "src" / name, "2")
    assert without != before != fingerprint(package / "script.py", package)


STAGE = """
import math
from functools import cache
from typing import TYPE_CHECKING

from facegear import parts, tables
from facegear.parts import LIMITS, Mesh, build, registered, renamed
from facegear.star import *

if TYPE_CHECKING:
    from facegear.types import Kind


def stage(section: Mesh) -> "Kind":
    from facegear.late import late

    def inner(mesh: "Kind"):
        return mesh.force() + late()

    count: Unknown = LIMITS[0]
    return inner(build(count)), renamed(), tables.values.first(), [registered(name) for name in "ab"]


def beside():
    return parts.unused()
"""
PARTS = """
import math
from math import floor as rounded

from facegear.registry import TABLE, noted
from facegear.tables.values import origin as renamed

LIMITS = [3, 4]
FREE = 5
TABLE["a"] = lambda: FREE


class Base:
    def force(self):
        return helper()


class Mesh(Base):
    count: int = 1

    def unused_method(self):
        return Base


class Other:
    def force(self):
        return 1


def helper(scale=math.sqrt(2.0)):
    return rounded(scale)


def build(count):
    return Mesh(count)


def registered(name):
    return TABLE[name]()


def unused():
    return Other()


@noted
def by_decorator():
    return 1
"""


REGISTRY = """
TABLE = {}


def noted(function):
    TABLE['b'] = function
    return function
"""
VALUES = """
def first():
    return 1


def origin():
    return 1


def last():
    return 2
"""


@pytest.fixture
def functions(tmp_path):
    files = {
        "__init__": "",
        "stage": STAGE,
        "parts": PARTS,
        "registry": REGISTRY,
        "late": "def late():\n    return 1\n\n\ndef never():\n    return 2\n",
        "star": "anything = 1\n",
        "types": "class Kind:\n    pass\n",
        "tables/__init__": "from facegear.tables import values\n",
        "tables/values": VALUES,
    }
    for name, text in files.items():
        path = tmp_path / "facegear" / f"{name}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path


def is_changed(root, name, old, new):
    path = root / "facegear" / f"{name}.py"
    before = stage_fingerprint(["facegear.stage:stage"], root)
    text = path.read_text()
    assert old in text
    edit(path, text.replace(old, new))
    return stage_fingerprint(["facegear.stage:stage"], root) != before


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("parts", "return Mesh(count)", "return Mesh(2 * count)"),
        ("parts", "LIMITS = [3, 4]", "LIMITS = [3, 5]"),
        ("parts", "return helper()", "return 2 * helper()"),
        ("parts", "return rounded(scale)", "return -rounded(scale)"),
        ("parts", "floor as rounded", "ceil as rounded"),
        ("parts", "math.sqrt(2.0)", "math.sqrt(3.0)"),
        ("parts", "class Mesh(Base)", "class Mesh(Other)"),
        ("parts", "return Base\n", "return Other\n"),
        ("parts", "count: int = 1", "count: float = 1"),
        ("parts", "FREE = 5", "FREE = 6"),
        ("parts", "lambda: FREE", "lambda: -FREE"),
        ("parts", "def by_decorator():\n    return 1", "def by_decorator():\n    return 2"),
        ("parts", "values import origin as", "values import last as"),
        ("registry", "TABLE['b'] = function", "TABLE['c'] = function"),
        ("late", "return 1", "return 3"),
        ("star", "anything = 1", "anything = 2"),
        ("tables/values", "first():\n    return 1", "first():\n    return 3"),
        ("tables/values", "origin():\n    return 1", "origin():\n    return 3"),
        ("stage", "section: Mesh", "section: 'parts.Other'"),
        ("stage", "def inner", "@cache\n    def inner"),
    ],
)
def test_code_that_may_be_called_counts(functions, name, old, new):
    assert is_changed(functions, name, old, new)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("parts", "def unused():\n    return Other()", "def unused():\n    return 3"),
        ("parts", "class Other:\n    def force(self):\n        return 1", "class Other:\n    pass"),
        ("late", "return 2", "return 4"),
        ("tables/values", "last():\n    return 2", "last():\n    return 3"),
        ("stage", "return parts.unused()", "return parts"),
        ("stage", 'mesh: "Kind"', "mesh: int"),
        ("stage", "count: Unknown", "count: int"),
        ("stage", '-> "Kind"', "-> int"),
        ("types", "pass", "number = 1"),
        (
            "parts",
            "return helper()",
            '"""Return a force."""\n        # of springs\n        return (helper())',
        ),
        (
            "parts",
            "    count: int = 1",
            '    """A mesh."""\n\n    count: int = 1\n    """Number of teeth."""',
        ),
    ],
)
def test_code_that_is_never_called_and_text_do_not_count(functions, name, old, new):
    assert not is_changed(functions, name, old, new)


@pytest.mark.parametrize(
    "body",
    [
        "return getattr(parts, name)()",
        "return vars(parts)",
        "return parts.missing()",
        'return import_module("facegear.parts").unused()',
        "from facegear.parts import missing\n    return missing",
    ],
)
def test_a_module_whose_names_are_not_spelled_counts_whole(functions, body):
    path = functions / "facegear/stage.py"
    edit(
        path,
        f"from importlib import import_module\nfrom facegear import parts\n\ndef stage(name):\n    {body}\n",
    )
    assert is_changed(functions, "parts", "return Other()", "return 3")


@pytest.mark.parametrize("use", ["globals()[name]", "import_module(name)", "sys.modules[name]", "undefined"])
def test_code_that_reaches_unknown_names_counts_with_its_module(functions, use):
    path = functions / "facegear/stage.py"
    imports = "import sys\nfrom importlib import import_module\n"
    edit(path, f"{imports}def stage(name):\n    return {use}\n\ndef other():\n    return 1\n")
    assert is_changed(functions, "stage", "return 1", "return 2")


def test_package_never_imports_snakemake():
    guilty = [
        str(path)
        for path in (ROOT / "facegear").rglob("*.py")
        if "import snakemake" in path.read_text() or "from snakemake" in path.read_text()
    ]
    assert guilty == []


def test_what_one_clone_has_parsed_gives_another_the_same_fingerprint_without_parsing(
    package, tmp_path, monkeypatch
):
    """The first start of every clone parsed some 700 files, for three seconds, before it could plan."""
    file = tmp_path / "sources.json"
    monkeypatch.setattr(sources, "_known_keys", set())  # of other tests of this process
    before = fingerprint(package / "script.py", package)
    remember(file)
    moved = shutil.copytree(package, tmp_path / "moved", copy_function=shutil.copyfile)  # with new times
    monkeypatch.setattr(sources, "_sources", {})
    monkeypatch.setattr(sources, "read_source", None)
    recall(file)
    assert fingerprint(moved / "script.py", moved) == before
    monkeypatch.undo()
    edit(moved / "facegear/io/tables.py", "x = 2\n")
    assert fingerprint(moved / "script.py", moved) != before


def test_sources_used_last_are_remembered_and_no_more_than_a_limit(package, tmp_path, monkeypatch):
    """Every version of a file that was ever edited would stay."""
    file = tmp_path / "sources.json"
    monkeypatch.setattr(sources, "_sources", {})
    monkeypatch.setattr(sources, "REMEMBERED", 3)
    fingerprint(package / "script.py", package)
    edit(package / "facegear/io/tables.py", "x = 3\n")
    fingerprint(package / "script.py", package)
    last = [*sources._sources][-3:]
    remember(file)
    monkeypatch.setattr(sources, "_sources", {})
    recall(file)
    assert [*sources._sources] == last


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"version": "another", "files": {}}', "\xff"])
def test_a_damaged_memory_is_passed_over(package, tmp_path, text):
    file = tmp_path / "sources.json"
    file.write_text(text, encoding="latin-1")
    recall(file)
    assert fingerprint(package / "script.py", package)


def test_reading_configs_leaves_solvers_and_tables_unloaded():
    """They took most of the five seconds in which a start with nothing to do ended."""
    code = (
        "import sys, paper.reproduction\n"
        "from facegear.build.cases import expand_cases\n"
        "from facegear.build.load import load_config\n"
        "expand_cases(load_config('config/paper.yaml'))\n"
        "print(*{'pandas', 'skfem', 'xarray', 'matplotlib', 'scipy.interpolate'} & {*sys.modules})"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
